// A motion is the same in a frame that moves steadily or falls, and what flies makes no energy of its flight.
#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "solver/assembly/assembly.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

namespace {

const Fabric poplin{.area_density = 0.12, .stretch = 500, .bend = 8e-6};

StepOptions exact() {
  StepOptions options;
  options.tolerance = 1e-7;
  return options;
}

ClothPart woven_part(const TriangleMesh& mesh, const Fabric& fabric = poplin) {
  return {.mesh = mesh, .fabric = fabric, .model = ClothModel::woven, .imperfection = 0};
}

void set_velocity(Assembly& all, std::size_t cloth, const Vec3& v) {
  for (int i = all.cloths[cloth].first_particle; i < all.cloths[cloth].end_particle; ++i)
    all.state.v.segment<3>(3 * i) = v;
}

// Places and velocities as seen from a frame that is at `way` and moves by `speed`.
struct Seen {
  VecX x, v;
};
Seen seen(const State& state, const Vec3& way, const Vec3& speed) {
  Seen all{state.x, state.v};
  for (int i = 0; i < state.particles(); ++i) {
    all.x.segment<3>(3 * i) -= way;
    all.v.segment<3>(3 * i) -= speed;
  }
  return all;
}

double farthest(const VecX& a, const VecX& b) { return (a - b).cwiseAbs().maxCoeff(); }

// 10 cm wide, bent to a cylinder of 4 cm, flat at rest.
struct BentSheet {
  Assembly all;
  BentSheet(int n, Kind kind, const std::string& integrator, const Vec3& gravity, const Vec3& speed)
      : all(gravity) {
    constexpr double radius = 0.04;
    TriangleMesh flat = bent(n, kind, 0.1, [](double, double) { return 0.0; }), mesh = flat;
    for (Vec3& x : mesh.positions)
      x = {radius * std::sin(x[0] / radius), radius * (1 - std::cos(x[0] / radius)), x[2]};
    ClothPart part = woven_part(mesh, {.area_density = 0.15, .stretch = 500, .bend = 2e-5});
    part.rest = flat;
    all.add(part);
    all.use(integrator, "eigen-ldlt", exact());
    set_velocity(all, 0, speed);
  }
  Vec3 mean(const VecX& of) const {
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    for (int i = 0; i < all.state.particles(); ++i) {
      sum += all.system->masses()[static_cast<std::size_t>(i)] * of.segment<3>(3 * i);
      mass += all.system->masses()[static_cast<std::size_t>(i)];
    }
    return sum / mass;
  }
  Seen from_its_centre() const { return seen(all.state, mean(all.state.x), mean(all.state.v)); }
  double energy() const {  // about its centre [J]
    return all.system->kinetic_energy(from_its_centre().v) + all.system->stored_energy(all.state.x);
  }
};

const Vec3 at_rest_here = Vec3::Zero();

// A level sheet that moves by W with two of its corners, which are led on.
void hang_and_lead(const std::string& integrator, Assembly& all, int n, Kind kind, const Vec3& W) {
  all.add(woven_part(bent(n, kind, 0.2, [](double, double) { return 0.0; })));
  all.use(integrator, "eigen-ldlt", exact());
  set_velocity(all, 0, W);
  all.constraints->pin_along({0, n - 1}, Motion::constant(W, Vec3::Zero(), Vec3::Zero()), all.state.x);
}

}  // namespace

TEST_CASE("a bent sheet opens in free fall and in flight as it does at rest", "[integrators]") {
  for (const std::string integrator : {"implicit-euler", "bdf2", "newton-kinsol"})
    for (const Kind kind : kinds)
      for (const int n : {9, 13, 17})
        for (const double h : {0.01, 0.0025}) {
          INFO(integrator << ", " << n << " x " << n << " of kind " << static_cast<int>(kind) << ", " << h
                          << " s");
          BentSheet still(n, kind, integrator, Vec3::Zero(), at_rest_here),
              falls(n, kind, integrator, {0, -9.81, 0}, at_rest_here),
              flies(n, kind, integrator, Vec3::Zero(), {3, 12, -4});
          const double start = still.energy();
          for (int k = 0; k < std::lround(0.3 / h); ++k)
            for (BentSheet* sheet : {&still, &falls, &flies}) {
              REQUIRE(sheet->all.advance(h).done);
              REQUIRE(sheet->energy() < 1.01 * start);
            }
          const VecX x = still.from_its_centre().x;
          // Without gravity there is less room for round-off, so a step may be judged otherwise.
          const double same =
              integrator == "newton-kinsol" || (integrator != "bdf2" && h < 0.005) ? 1e-6 : 5e-3;
          CHECK(farthest(flies.from_its_centre().x, x) < 1e-6);
          CHECK(farthest(falls.from_its_centre().x, x) < same);
        }
}

TEST_CASE("what meets, is led or falls on bodies does so in any frame that moves steadily",
          "[integrators][self]") {
  struct Scene {
    const char* name;
    void (*make)(Assembly& all, int n, Kind kind, const Vec3& W);
    Vec3 gravity;
  };
  const Scene scenes[] = {
      {"two sheets meet",
       [](Assembly& all, int n, Kind kind, const Vec3& W) {
         for (const double above : {0.0, 0.01}) {
           ClothPart part =
               woven_part(bent(n, kind, 0.2, [](double x, double z) { return 0.1 * x * (x + z); }));
           for (Vec3& x : part.mesh.positions)  // no vertex is above another one
             x = above * Vec3(0.31, 1, 0.47) + (above > 0 ? Vec3(x[2] + 0.1 * x[0], x[1], -x[0]) : x);
           part.self_contact = SelfContactOptions{};
           all.add(part);
         }
         all.use("implicit-euler", "eigen-ldlt", exact());
         set_velocity(all, 0, W);
         set_velocity(all, 1, W + Vec3(0.2, -1.5, 0));
       },
       Vec3::Zero()},
      {"a sheet falls from two corners that are led",
       [](Assembly& all, int n, Kind kind, const Vec3& W) {
         hang_and_lead("implicit-euler", all, n, kind, W);
       },
       {0, -9.81, 0}},
      {"a sheet falls from two corners that are led, by bdf2",
       [](Assembly& all, int n, Kind kind, const Vec3& W) { hang_and_lead("bdf2", all, n, kind, W); },
       {0, -9.81, 0}},
      {"a sheet falls on a ball",
       [](Assembly& all, int n, Kind kind, const Vec3& W) {
         all.constraints->add({.shape = Sphere{{0.003, 0, 0.005}, 0.05},
                               .friction = 0.3,
                               .motion = Motion::constant(W, Vec3::Zero(), Vec3::Zero())});
         all.add(woven_part(bent(n, kind, 0.2, [](double, double) { return 0.06; })));
         all.use("implicit-euler", "eigen-ldlt", exact());
         set_velocity(all, 0, W + Vec3(0, -0.5, 0));
       },
       {0, -9.81, 0}},
  };
  for (const Scene& scene : scenes)
    for (const Kind kind : kinds)
      for (const int n : {7, 11, 15})
        for (const double h : {0.02, 0.01}) {
          INFO(scene.name << ", " << n << " x " << n << " of kind " << static_cast<int>(kind) << ", " << h
                          << " s");
          for (const Vec3& W : {Vec3(0, 3, 1), Vec3(-10, 0, 5)}) {
            Assembly moves(scene.gravity), again(scene.gravity);
            scene.make(moves, n, kind, W);
            scene.make(again, n, kind, at_rest_here);
            for (int k = 0; k < 6; ++k) {
              REQUIRE(moves.advance(h).done);
              REQUIRE(again.advance(h).done);
            }
            CHECK(farthest(seen(moves.state, 6 * h * W, W).x, again.state.x) < 1e-5);
          }
        }
}

TEST_CASE("layers lie still by bdf2, and a sheet that turns and trembles goes on turning",
          "[integrators][self]") {
  for (const double height : {0.012, 0.0121, 0.013}) {
    INFO("from " << height << " m");
    Assembly all;
    all.constraints->add({.shape = Plane{{0, 0, 0}, {0, 1, 0}}, .friction = 0.5});
    for (const auto& [n, size, y] : {std::tuple{13, 0.2, 0.0025}, std::tuple{9, 0.12, height}}) {
      ClothPart part = woven_part(bent(n, Kind::irregular, size, [y = y](double, double) { return y; }));
      part.self_contact = SelfContactOptions{};
      all.add(part);
    }
    all.use("bdf2", "mpcg+block-ic0");
    double fastest = 0;  // m/s, after 3 s
    for (int k = 0; k < 400; ++k) {
      REQUIRE(all.advance(0.01).done);
      if (k >= 300) fastest = std::max(fastest, all.state.v.cwiseAbs().maxCoeff());
    }
    CHECK(fastest < 0.02);
  }
  for (const Kind kind : kinds)
    for (const int n : {9, 13, 17}) {
      INFO(n << " x " << n << " of kind " << static_cast<int>(kind));
      BentSheet sheet(n, kind, "bdf2", Vec3::Zero(), at_rest_here);
      const auto spin = [&] {
        const Seen now = sheet.from_its_centre();
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < sheet.all.state.particles(); ++i)
          sum += sheet.all.system->masses()[static_cast<std::size_t>(i)] *
                 Vec3(now.x.segment<3>(3 * i)).cross(Vec3(now.v.segment<3>(3 * i)));
        return sum[1];
      };
      const VecX x = sheet.from_its_centre().x;
      for (int i = 0; i < sheet.all.state.particles(); ++i)
        sheet.all.state.v.segment<3>(3 * i) = Vec3(0, 6, 0).cross(Vec3(x.segment<3>(3 * i)));
      const double start = spin();
      for (int k = 0; k < 100; ++k) REQUIRE(sheet.all.advance(0.005).done);
      CHECK(std::abs(spin() / start - 1) < (n < 13 ? 0.2 : 0.1));
    }
}
