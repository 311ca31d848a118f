// A band of cloth that is drawn over a cylinder of cloth: friction between layers bears exp(mu angle) of the
// tension.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "solver/assembly/assembly.h"
#include "tests/integrators.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double radius = 0.05, thickness = 1e-3, hangs = 0.06;  // m

// A band of the given edges [m], wound about the z axis at `around` [m] over half a turn, whose ends hang
// down.
TriangleMesh wound(Kind kind, double edge, double around, double width) {
  const double over = std::numbers::pi * around, length = over + 2 * hangs;
  const int along = static_cast<int>(std::lround(length / edge)) + 1;
  const int across = std::max(2, static_cast<int>(std::lround(width / edge)) + 1);
  TriangleMesh mesh = kind == Kind::equilateral ? equilateral_sheet(along, across, length / (along - 1))
                                                : grid(along, across, length, width);
  std::mt19937 random(static_cast<unsigned>(along));
  std::uniform_real_distribution<double> off(-0.2 * edge, 0.2 * edge);
  for (Vec3& x : mesh.positions) {
    double s = x[0];
    if (kind == Kind::irregular && std::abs(s) < 0.5 * length - 0.5 * edge) s += off(random);
    const double past = std::abs(s) - 0.5 * over, angle = std::clamp(s, -0.5 * over, 0.5 * over) / around;
    x = Vec3(around * std::sin(angle), around * std::cos(angle) - std::max(past, 0.0), x[2]);
  }
  return mesh;
}

}  // namespace

TEST_CASE("a band drawn over a cylinder of cloth slips at the capstan's ratio of tensions",
          "[self-contact]") {
  for (double mu : {0.2, 0.4})
    for (double edge : {0.008, 0.006, 0.0045})
      for (Kind kind : kinds) {
        if (mu < 0.3 && edge < 0.005) continue;  // these take longest
        INFO("mu " << mu << ", edges of " << edge << " m, kind " << static_cast<int>(kind));
        Assembly all{Vec3::Zero()};
        const Fabric fabric{.area_density = 0.2, .stretch = 500, .bend = 1e-7};
        const SelfContactOptions rubs{.thickness = thickness, .friction = mu};
        const TriangleMesh band = wound(kind, edge, radius + thickness, 0.03);
        TriangleMesh shorter = band;  // at rest: the band is tight
        for (Vec3& x : shorter.positions) x *= 0.97;
        all.add(ClothPart{
            .mesh = band, .rest = shorter, .fabric = fabric, .imperfection = 0, .self_contact = rubs});
        all.add(ClothPart{.mesh = wound(Kind::squares, 0.7 * edge, radius, 0.05),
                          .fabric = fabric,
                          .imperfection = 0,
                          .self_contact = rubs});
        const Cloth& drum = all.cloths[1];
        for (int i = drum.first_particle; i < drum.end_particle; ++i) all.constraints->pin(i);
        std::vector<int> held, drawn;
        double lowest = 0;
        for (const Vec3& x : band.positions) lowest = std::min(lowest, x[1]);
        for (int i = 0; i < band.vertex_count(); ++i)
          if (band.positions[i][1] < lowest + 0.6 * edge)
            (band.positions[i][0] < 0 ? held : drawn).push_back(i);
        all.use("implicit-euler", "auto", {.tolerance = 1e-6});
        // The band goes over many edges of the drum.
        const auto lead = [&](const std::vector<int>& end, double speed) {
          all.constraints->pin_along(end, Motion::constant({0, speed, 0}, Vec3::Zero(), Vec3::Zero()),
                                     all.state.x);
        };
        lead(held, 0.05);
        lead(drawn, -0.05);
        const auto pull = [&](const std::vector<int>& end) {
          const VecX f = all.system->force(all.state.x, VecX::Zero(all.state.x.size()));
          double sum = 0;
          for (int i : end) sum += f[3 * i + 1];
          return sum;
        };
        double ratio = 0;
        for (int k = 1; k <= 100; ++k) {
          REQUIRE(all.advance(0.01).done);
          if (k > 40) ratio += pull(drawn) / pull(held) / 60;
        }
        CHECK(ratio == Approx(std::exp(mu * std::numbers::pi)).epsilon(0.02));
      }
}
