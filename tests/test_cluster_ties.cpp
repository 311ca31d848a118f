// Laws of clusters that something ties: a rope that hangs on one, pins that hold one; and of a step that
// failed.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>

#include "solver/assembly/assembly.h"
#include "tests/cluster_bodies.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double thickness = 1e-3;  // m

// Moves the last particle, which is in no cluster, to no place at all where it is told to.
struct Breaking final : Force {
  const bool& breaks;
  explicit Breaking(const bool& when) : breaks(when) {}
  std::string_view name() const override { return "breaking"; }
  void list_pairs(std::vector<ParticlePair>&) const override {}
  void bind(const BlockLayout&) override {}
  double energy(const VecX&) const override { return 0; }
  void add_force(const VecX&, const VecX&, VecX&) const override {}
  void add_linearised(const VecX&, const VecX&, const VecX&, double, Stiffness, BlockMatrix&,
                      VecX&) const override {}
  bool projects() const override { return true; }
  void project(Substep& substep) override {
    if (breaks) substep.x[substep.x.size() - 1] = std::numeric_limits<double>::quiet_NaN();
  }
};

// Three boxes of these counts on each other, on a floor, and a particle far away.
struct Tower : Bodies {
  bool breaks = false;
  Tower(const std::array<int, 3>& counts, bool covered) {
    const double edge = 0.1, height = edge * (counts[1] - 1);
    for (int b = 0; b < 3; ++b)
      add_box(counts, level, {0.013 * b, 0.5 * height + b * (height + thickness), 0.007 * b}, edge);
    if (covered) add_sheet(5, 0.3, {0.01, 3 * (height + thickness), 0});
    places.push_back({9, 9, 9});
    own.push_back(1);
    let_meet(thickness, 0.5);
    constraints.add(Obstacle{.shape = Plane{}, .friction = 0.5, .margin = 0});
    make({0, -g, 0});
    system->add(std::make_unique<Breaking>(breaks));
  }
  std::unique_ptr<Integrator> stepper(const std::string& contact) {
    StepOptions options;
    options.projection.substeps = 2;
    if (contact == "restitution") options.contact = ContactMode::restitution;
    return make_integrator("pbd", *system, constraints, make_linear_solver("mpcg"), options);
  }
};

}  // namespace

TEST_CASE("after a step that failed, clusters that touch go on as with a stepper that never tried it",
          "[clusters][pbd]") {
  struct Kind {
    std::array<int, 3> counts;
    bool cloth;
  };
  for (const Kind& kind : {Kind{{3, 3, 3}, false}, {{2, 3, 2}, true}, {{4, 2, 3}, false}})
    for (const char* contact : {"velocity", "restitution"}) {
      INFO(kind.counts[0] << " x " << kind.counts[1] << ", " << contact);
      State ends[2];
      for (const bool failed : {false, true}) {
        Tower tower(kind.counts, kind.cloth);
        const auto stepper = tower.stepper(contact);
        if (failed) {
          tower.breaks = true;
          const State start = tower.state;
          REQUIRE_FALSE(stepper->advance(tower.state, 0.01).done);
          CHECK(same_bits(start.x, tower.state.x));
          tower.breaks = false;
        }
        REQUIRE(stepper->advance(tower.state, 0.01).done);
        ends[failed] = tower.state;
      }
      CHECK(same_bits(ends[0].x, ends[1].x));
      CHECK(same_bits(ends[0].v, ends[1].v));
    }
}

TEST_CASE("a cluster that falls on one that is pinned comes to rest on it, and is not thrown",
          "[clusters][pbd]") {
  struct Kind {
    std::array<int, 3> lower, upper;
    double density;  // of the upper one [kg/m^3]
    bool all;        // all of the lower layer is pinned, else a single particle and the floor bears the rest
  };
  for (const char* contact : {"velocity", "restitution"})
    for (const Kind& kind : {Kind{{3, 3, 3}, {3, 3, 3}, 300, true},
                             {{5, 2, 5}, {2, 3, 2}, 1000, false},
                             {{4, 3, 4}, {3, 2, 4}, 100, false}}) {
      INFO(contact << ", " << kind.density << " kg/m^3");
      constexpr double edge = 0.1, fall = 0.02;
      const double top = edge * (kind.lower[1] - 1), half = 0.5 * edge * (kind.upper[1] - 1);
      Bodies two;
      two.add_box(kind.lower, level, {0, 0.5 * top, 0}, edge);
      two.add_box(kind.upper, level, {0.013, top + thickness + fall + half, 0.007}, edge, kind.density);
      two.let_meet(thickness, 0.5);
      two.constraints.add(Obstacle{.shape = Plane{}, .friction = 0.5, .margin = 0});
      for (const int i : two.sets[0])
        if (two.places[static_cast<std::size_t>(i)][1] < 0.01 && (kind.all || i == two.sets[0][0]))
          two.constraints.pin(i);
      two.make({0, -g, 0});
      const auto height = [&] { return two.body(1).centre[1] - half - top; };  // over the lower one
      for (int n = 0; n < 60; ++n) {
        two.run(0.01, 1, contact);
        CHECK(height() > 0.8 * thickness);
        if (n > 8) CHECK(height() < 0.5 * fall);  // it has hit at 64 ms
        CHECK(two.motion(1).velocity.norm() < std::sqrt(2 * g * fall));
        CHECK(std::abs(two.body(0).centre[1] - 0.5 * top) < 1e-3);
      }
      CHECK(height() == Approx(thickness).margin(5e-5));
      CHECK(two.motion(1).velocity.norm() < 1e-3);
      CHECK(two.motion(1).spin.norm() < 5e-3);
    }
}

TEST_CASE("what hits a cluster where a body holds it gives this body its momentum", "[clusters][pbd]") {
  struct Kind {
    std::array<int, 3> first, second;
    double mass;  // of the body [kg]
  };
  for (const double k : {1e4, 1e5, 1e6})
    for (const Kind& kind :
         {Kind{{3, 3, 3}, {3, 3, 3}, 1}, {{4, 2, 4}, {2, 3, 2}, 10}, {{3, 2, 3}, {4, 2, 3}, 0.2}}) {
      INFO("k = " << k << ", " << kind.mass << " kg");
      const double top = 0.1 * (kind.first[1] - 1), half = 0.05 * (kind.second[1] - 1);
      Bodies two;
      two.add_box(kind.first, level, {0, 0.5 * top, 0});
      two.add_box(kind.second, level, {0.013, top + half + 2 * thickness, 0.007});
      two.let_meet(thickness, 0.3);
      two.k = k;
      const Vec3 centre(0, 0.5 * top, 0);  // of the body, which nothing touches
      two.constraints.add(Obstacle{.shape = Sphere{{0, -5, 0}, 0.1},
                                   .rigid = RigidBody{.mass = kind.mass,
                                                      .inertia = 0.1 * kind.mass * Mat3::Identity(),
                                                      .centre = centre,
                                                      .gravity = Vec3::Zero()}});
      two.make(Vec3::Zero());
      std::vector<int> held;
      for (const int i : two.sets[0])
        if (two.places[static_cast<std::size_t>(i)][1] > top - 0.01) held.push_back(i);
      two.constraints.pin_to_body(held, 0, two.state.x);
      two.move(1, {0.1, -1, 0}, Vec3::Zero());
      const auto momentum = [&] {
        Vec3 sum = two.constraints.bodies()[0].reacting()->momentum();
        for (int i = 0; i < two.system->particles(); ++i)
          sum += two.own[static_cast<std::size_t>(i)] * two.state.v.segment<3>(3 * i);
        return sum;
      };
      const Vec3 before = momentum();
      two.run(1e-3, 20, "velocity");
      CHECK((momentum() - before).norm() < 1e-8 * before.norm());
      CHECK(two.constraints.bodies()[0].reacting()->velocity()[1] < -0.02);
    }
}

namespace {

// Soft bodies of clusters, and a rope that hangs on one of their particles.
struct Hung : Assembly {
  Hung() : Assembly(Vec3::Zero()) {}
  void add_box(const std::array<int, 3>& counts, const Vec3& at, int clusters) {
    SoftPart part{.lattice = box_lattice(counts, Vec3::Constant(0.05))};
    part.clusters = SoftClusters{clusters};
    part.material.young = 1e6;
    part.place.translation = at;
    part.self_contact = SelfContactOptions{.thickness = thickness, .friction = 0.3};
    add(part);
  }
  void hang_rope(int particle, double mass_per_length, const Vec3& way) {
    std::vector<Vec3> points;
    for (int k = 0; k < 5; ++k) points.push_back(state.x.segment<3>(3 * particle) + 0.05 * k * way);
    add(RopePart{.points = points,
                 .material = {.mass_per_length = mass_per_length, .radius = 1e-4},
                 .first = particle});
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < state.particles(); ++i) sum += system->masses()[i] * state.v.segment<3>(3 * i);
    return sum;
  }
  Vec3 velocity_of(int begin, int end) const {  // mean of these particles, m/s
    Vec3 sum = Vec3::Zero();
    for (int i = begin; i < end; ++i) sum += state.v.segment<3>(3 * i) / (end - begin);
    return sum;
  }
};

}  // namespace

TEST_CASE("a cluster on which a rope hangs keeps the momentum when it meets another",
          "[clusters][rope][pbd]") {
  struct Kind {
    std::array<int, 3> first, second;
    int clusters;  // of the first
  };
  for (const Kind& kind :
       {Kind{{3, 3, 3}, {3, 3, 3}, 1}, {{2, 3, 4}, {4, 2, 3}, 2}, {{3, 2, 3}, {2, 2, 2}, 0}})
    for (const double heavy : {0.05, 1.0, 20.0}) {
      INFO(kind.clusters << " clusters, " << heavy << " kg/m");
      Hung all;
      all.add_box(kind.first, Vec3::Zero(), kind.clusters);
      const int first = all.state.particles();
      int lowest = 0;  // at a corner below
      const auto depth = [&](int i) { return -Vec3(all.state.x.segment<3>(3 * i)).dot(Vec3(1, 1.1, 1.2)); };
      for (int i = 0; i < first; ++i)
        if (depth(i) > depth(lowest)) lowest = i;
      const double bottom = all.state.x[3 * lowest + 1], half = 0.025 * (kind.second[1] - 1);
      all.add_box(kind.second, {0.01, bottom - half - 2 * thickness, 0.007}, 1);
      const int rope = all.state.particles();
      all.hang_rope(lowest, heavy, Vec3(-1, 1, 0).normalized());
      for (int i = 0; i < all.state.particles(); ++i)
        if (i < first || i >= rope) all.state.v.segment<3>(3 * i) = Vec3(0.1, -1, 0);
      all.use("pbd", "mpcg");
      REQUIRE(all.system->masses()[static_cast<std::size_t>(lowest)] > 0.02 * heavy);
      const Vec3 before = all.momentum();
      for (int n = 0; n < 10; ++n) REQUIRE(all.advance(2e-3).done);
      CHECK((all.momentum() - before).norm() < 1e-9 * before.norm());
      CHECK(all.velocity_of(first, rope)[1] < -0.1);  // it was hit
    }
}
