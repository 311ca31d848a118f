// Soft bodies meet each other and cloth at their surfaces, and two sheets rub as their pair says.
#include "mesh/distance/triangle_crossings.h"
#include "solver/assembly/assembly.h"
#include "tests/integrators.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double r = 2e-3;  // m

struct Bodies : Assembly {
  using Assembly::Assembly;

  void add_cube(int n, double size, const Vec3& place, double turn = 0) {
    add(SoftPart{.name = "cube",
                 .lattice = box_lattice({n, n, n}, Vec3::Constant(size / (n - 1))),
                 .material = {.density = 100, .young = 2e4, .damping = 0.02},
                 .place = {Eigen::AngleAxisd(turn, Vec3(1, 2, 3).normalized()).toRotationMatrix(), place},
                 .self_contact = SelfContactOptions{.thickness = r, .friction = 0.3}});
  }
  void add_sheet(int n, double size, const Vec3& place, double thickness = r) {
    TriangleMesh mesh = grid(n, n, size, size);
    for (Vec3& x : mesh.positions) x += place;
    add(ClothPart{.mesh = mesh,
                  .fabric = {.area_density = 0.2, .stretch = 200, .bend = 1e-5, .damping = 0.002},
                  .imperfection = 0,
                  .self_contact = SelfContactOptions{.thickness = thickness, .friction = 0.3}});
  }
  Vec3 momentum(std::size_t k) const {
    Vec3 sum = Vec3::Zero();
    for (int i = cloths[k].first_particle; i < cloths[k].end_particle; ++i)
      sum += system->masses()[i] * state.v.segment<3>(3 * i);
    return sum;
  }
  void throw_at(std::size_t k, const Vec3& v) {
    for (int i = cloths[k].first_particle; i < cloths[k].end_particle; ++i) state.v.segment<3>(3 * i) = v;
  }
  int crossings() const {
    std::vector<Vec3> places;
    std::vector<Triangle> triangles;
    for (const Cloth& cloth : cloths) {
      const int first = static_cast<int>(places.size());
      const std::vector<Vec3> own = cloth.embedding.positions(state.x);
      places.insert(places.end(), own.begin(), own.end());
      for (const Triangle& t : cloth.mesh.triangles)
        triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    return crossing_count(crossing_contours(places, triangles));
  }
};

}  // namespace

TEST_CASE("two soft cubes that collide bounce off each other and keep their momentum", "[soft-contact]") {
  for (const IntegratorInfo& integrator : integrators()) {
    const std::string name(integrator.name);
    if (name == "newton-kinsol") continue;  // does not find the end of such a step (docs/limits.md)
    const bool implicit = name == "implicit-euler" || name == "bdf2";
    for (int n : {3, 4}) {
      if (!implicit && n > 3) continue;  // many short steps
      INFO(name << ", " << n << " particles along an edge");
      Bodies pair{Vec3::Zero()};
      pair.add_cube(n, 0.1, {0, 0, 0});
      pair.add_cube(n, 0.1, {0.01, 0.115, 0.02}, 0.2);
      pair.use(name, "auto", {.tolerance = 1e-6, .contact_tolerance = 1e-7});
      pair.throw_at(1, {0, -0.5, 0});
      const Vec3 before = pair.momentum(1);
      const double h = implicit ? 5e-3 : 1e-4;
      int met = 0;
      for (int k = 0; k * h < 0.12; ++k) {
        const StepReport report = pair.advance(h);
        INFO(k << ": " << report.failure.what);
        REQUIRE(report.done);
        met = std::max(met, report.self_contacts);
      }
      CHECK(met > 0);
      CHECK(pair.crossings() == 0);
      CHECK(pair.momentum(0)[1] < -0.3 * before.norm());  // the lower one was pushed
      CHECK((pair.momentum(0) + pair.momentum(1) - before).norm() < 1e-4 * before.norm());
    }
  }
}

TEST_CASE("a sheet comes to rest on a soft cube, as far above it as they are thick", "[soft-contact]") {
  for (int n : {4, 5, 7}) {
    INFO(n << " particles along an edge");
    Bodies all;
    all.constraints->add(Obstacle{.shape = Plane{}, .margin = 0});
    all.add_cube(n, 0.2, {0, 0.1, 0});
    all.add_sheet(9, 0.15, {0.004, 0.2 + r, 0.003});
    all.use("implicit-euler", "auto", {.tolerance = 1e-6});
    for (int k = 0; k < 150; ++k) REQUIRE(all.advance(0.01).done);
    CHECK(all.crossings() == 0);
    double top = -1, least = 1, most = -1;
    const Cloth &cube = all.cloths[0], &sheet = all.cloths[1];
    for (int i = cube.first_particle; i < cube.end_particle; ++i) top = std::max(top, all.state.x[3 * i + 1]);
    for (int i = sheet.first_particle; i < sheet.end_particle; ++i) {
      least = std::min(least, all.state.x[3 * i + 1]);
      most = std::max(most, all.state.x[3 * i + 1]);
    }
    CHECK(least > top + r - 1.5e-4 - 2e-3);  // the cube is not quite flat under its own weight
    CHECK(most < top + r + 1e-4);
    CHECK(all.momentum(1).norm() < 2e-3 * 0.2 * 0.15 * 0.15);
  }
}

TEST_CASE("a pair of sheets rubs as the pair says, and not as the two do", "[soft-contact]") {
  constexpr double g = 9.81, angle = 0.38, h = 0.01;  // tan 0.4
  for (const auto& [mu, holds] : {std::pair{0.6, true}, std::pair{0.1, false}})
    for (bool reversed : {false, true}) {
      INFO("mu " << mu);
      Bodies slope(Vec3(g * std::sin(angle), -g * std::cos(angle), 0));
      slope.add_sheet(7, 0.6, {0, 0, 0}, 1e-3);
      slope.add_sheet(6, 0.1, {0.003, 1e-3, 0.002}, 1e-3);
      slope.set_friction(0, 0, 3);
      slope.set_friction(reversed ? 1 : 0, reversed ? 0 : 1, mu);
      for (int i = slope.cloths[0].first_particle; i < slope.cloths[0].end_particle; ++i)
        slope.constraints->pin(i);
      slope.use("implicit-euler", "auto", {.tolerance = 1e-8, .contact_tolerance = 1e-6});
      const double mass = 0.2 * 0.1 * 0.1;
      for (int k = 0; k < 10; ++k) slope.advance(h);
      const double before = slope.momentum(1)[0];
      for (int k = 0; k < 20; ++k) REQUIRE(slope.advance(h).done);
      const double gained = (slope.momentum(1)[0] - before) / mass / (20 * h);
      if (holds)
        CHECK(std::abs(gained) < 1e-4);
      else
        CHECK(gained == Approx(g * (std::sin(angle) - mu * std::cos(angle))).epsilon(0.02));
    }
  Bodies slope;
  slope.add_sheet(3, 0.1, Vec3::Zero());
  CHECK_THROWS_WITH(slope.set_friction(0, 0, -1), Catch::Contains("not negative"));
}
