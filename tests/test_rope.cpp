// Laws of ropes: how they hang, swing, bend and keep what they have, against closed forms.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/ropes.h"
#include "tests/same_bits.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double g = 9.81;  // m/s^2

// Two straight halves between supports that are `span` apart, together of the length 1 m.
std::vector<Vec3> folded(double span, int segments) {
  const Vec3 low(0.5 * span, -std::sqrt(0.25 - 0.25 * span * span), 0);
  std::vector<Vec3> points = straight(Vec3::Zero(), low, segments / 2);
  for (const Vec3& x : straight(low, {span, 0, 0}, segments / 2))
    if (x != low) points.push_back(x);
  return points;
}

// How often a quantity has come down through zero, and when first and last [s].
struct Crossings {
  double before = 0, first = 0, last = 0;
  int count = 0;
  void look(double value, double time, double h) {
    if (before > 0 && value <= 0) {
      last = time - h * value / (value - before);
      if (count++ == 0) first = last;
    }
    before = value;
  }
  double period() const { return (last - first) / (count - 1); }
};

}  // namespace

TEST_CASE("a rope without stiffness hangs as a catenary, in the limit of fine segments", "[rope]") {
  struct Sag {
    double span, sag;  // of the length
  };
  // a sinh(S/2a) = L/2, sag = a (cosh(S/2a) - 1)
  const Sag sags[] = {{0.5, 0.3981942}, {0.8, 0.2654375}};
  for (const auto& [span, sag] : sags) {
    std::array<double, 3> errors{};
    for (std::size_t k = 0; k < 3; ++k) {
      const int segments = 10 << k;
      Rope rope(folded(span, segments), {.mass_per_length = 0.1, .stretch = 1e5, .bend = 0});
      rope.hold({0, segments});
      rope.settle();
      errors[k] = std::abs(-rope.at(segments / 2).y() - sag);
    }
    CAPTURE(span, errors[0], errors[1], errors[2]);
    CHECK(errors[2] < 3e-4);
    for (std::size_t k = 1; k < 3; ++k) {
      CHECK(errors[k - 1] / errors[k] > 3.5);
      CHECK(errors[k - 1] / errors[k] < 4.6);
    }
  }
}

TEST_CASE("a hanging rope carries its weight: tension and length are exact on any division", "[rope]") {
  for (const int segments : {1, 7, 40}) {
    const RopeMaterial material{.mass_per_length = 0.3, .stretch = 500, .bend = 0};
    Rope rope(straight(Vec3::Zero(), {0, -2, 0}, segments), material);
    rope.hold({0});
    rope.settle();
    const double weight = 0.3 * g * 2;
    for (int k = 0; k < segments; ++k)
      CHECK(rope.tension(k) == Approx(weight * (segments - k - 0.5) / segments).epsilon(1e-7));
    CHECK(-rope.at(segments).y() - 2 == Approx(weight * 2 / (2 * 500)).epsilon(1e-7));
  }
}

TEST_CASE("a hanging rope swings with the periods of Bernoulli's chain", "[rope]") {
  constexpr double j_01 = 2.404825557695773;  // J_0(j_01) = 0
  const double period = 4 * M_PI / j_01 / std::sqrt(g);
  const auto measured = [&](std::string_view name, int segments, double h) {
    Rope rope(straight(Vec3::Zero(), {0, -1, 0}, segments),
              {.mass_per_length = 0.1, .stretch = 2000, .bend = 0});
    rope.hold({0});
    rope.settle();  // its own weight makes it 0.02 % longer
    for (int k = 0; k <= segments; ++k)
      rope.state.x[3 * k] = 1e-3 * std::cyl_bessel_j(0, j_01 * std::sqrt(1 - double(k) / segments));
    rope.state.v.setZero();
    rope.use(std::string(name), "eigen-ldlt", precise());
    const double begin = rope.state.time;
    Crossings tip;
    while (rope.state.time < begin + 3.4 * period) {
      rope.go(h, 1);
      tip.look(rope.state.x[3 * segments], rope.state.time, h);
    }
    REQUIRE(tip.count >= 3);
    return tip.period() / period - 1;
  };
  std::array<double, 3> errors{};
  for (std::size_t k = 0; k < 3; ++k) errors[k] = std::abs(measured("bdf2", 10 << k, period / 800));
  CAPTURE(errors[0], errors[1], errors[2]);
  CHECK(errors[0] < 5e-3);
  CHECK(errors[0] / errors[1] > 3);
  CHECK(errors[2] < 5e-4);
  for (const char* name : {"implicit-euler", "symplectic-euler", "rk4"}) {
    const bool is_short = is_explicit(name);
    CAPTURE(name);
    CHECK(std::abs(measured(name, 20, is_short ? 2e-4 : period / 800)) < 5e-3);
  }
}

TEST_CASE("a clamped rope sags as a beam", "[rope]") {
  // Of two held points the clamp is half way between, to second order.
  const auto tip = [](int segments, double B, double q) {
    const double l = 1 / (segments - 0.5);
    Rope rope(straight({-0.5 * l, 0, 0}, {1, 0, 0}, segments),
              {.mass_per_length = q / g, .stretch = 1e5, .bend = B});
    rope.hold({0, 1});
    rope.settle(0.3, {.newton_tolerance = 1e-9, .tolerance = 1e-9});
    return Vec3(rope.at(segments));
  };
  SECTION("a little: q L^4 / (8 B)") {
    std::array<double, 3> errors{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double w = -tip(8 << k, 12.5, 1).y(), exact = 1 / (8 * 12.5);
      errors[k] = std::abs(w / exact - 1);
    }
    CAPTURE(errors[0], errors[1], errors[2]);
    CHECK(errors[2] < 3e-3);
    for (std::size_t k = 1; k < 3; ++k) CHECK(errors[k - 1] / errors[k] > 3);
  }
  SECTION("far: the heavy elastica, B t'' = -q (L - s) cos t") {
    constexpr double q_by_B = 8;  // q L^3 / B
    const auto shoot = [&](double curvature, Vec3& end) {
      constexpr int n = 4000;
      double t = 0, k = curvature;
      end.setZero();
      for (int i = 0; i < n; ++i) {  // the midpoint rule
        const double ds = 1.0 / n, s = i * ds;
        const double t_mid = t + 0.5 * ds * k, k_mid = k - 0.5 * ds * q_by_B * (s - 1) * std::cos(t);
        end += ds * Vec3(std::cos(t_mid), std::sin(t_mid), 0);
        t += ds * k_mid;
        k -= ds * q_by_B * (s + 0.5 * ds - 1) * std::cos(t_mid);
      }
      return k;  // is zero at a free end
    };
    double low = -8, high = 0;
    Vec3 exact;
    for (int i = 0; i < 60; ++i) {
      const double mid = 0.5 * (low + high);
      (shoot(mid, exact) < 0 ? low : high) = mid;
    }
    CAPTURE(exact.transpose());
    REQUIRE(exact.y() < -0.5);
    std::array<double, 3> errors{};
    for (std::size_t k = 0; k < 3; ++k) errors[k] = (tip(10 << k, 1 / q_by_B, 1) - exact).norm();
    CAPTURE(errors[0], errors[1], errors[2]);
    CHECK(errors[2] < 1e-3);
    for (std::size_t k = 1; k < 3; ++k) CHECK(errors[k - 1] / errors[k] > 3);
  }
}

TEST_CASE("a rope in free flight keeps momentum, and angular momentum with the time step", "[rope]") {
  const auto flight = [](std::string_view name, double h, Vec3& momentum, Vec3& turning, double& gained) {
    Rope rope(straight(Vec3::Zero(), {1, 0, 0}, 20),
              {.mass_per_length = 0.1, .stretch = 300, .bend = 1e-2, .damping = 0.1, .bend_damping = 1e-4},
              Vec3::Zero());
    rope.state.v = random_vector(rope.state.v.size(), 1, 3);
    rope.use(std::string(name), "eigen-ldlt", precise());
    const auto sums = [&](Vec3& p, Vec3& L) {
      p.setZero(), L.setZero();
      for (int i = 0; i < rope.count(); ++i) {
        const Vec3 mv = rope.system->masses()[i] * rope.state.v.segment<3>(3 * i);
        p += mv;
        L += rope.at(i).cross(mv);
      }
    };
    Vec3 p_0, L_0;
    sums(p_0, L_0);
    double energy = rope.system->total_energy(rope.state);
    gained = 0;
    for (int n = 0; n < static_cast<int>(std::lround(0.2 / h)); ++n) {
      rope.go(h, 1);
      const double now = rope.system->total_energy(rope.state);
      gained = std::max(gained, now - energy);
      energy = now;
    }
    sums(momentum, turning);
    momentum -= p_0;
    turning -= L_0;
  };
  for (const std::string& name : integrator_names()) {
    const Traits& t = traits_of(name);
    CAPTURE(name);
    Vec3 p, L;
    double gained;
    flight(name, 2e-4, p, L, gained);
    CHECK(p.norm() < (t.order > 0 ? 1e-10 : 1e-4));
    CHECK(L.norm() < (t.order == 1 ? 2e-3 : 2e-4));
    if (!t.is_explicit && t.order == 1) CHECK(gained < 1e-12);
  }
  Vec3 p, coarse, fine;
  double gained;
  flight("implicit-euler", 1e-4, p, coarse, gained);
  flight("implicit-euler", 2.5e-5, p, fine, gained);
  CHECK(coarse.norm() / fine.norm() > 3);
  flight("implicit-euler", 1e-2, p, coarse, gained);
  CHECK(gained < 1e-12);  // J, of 0.1
}

TEST_CASE("the bending of a rope is damped as a beam's, on any division and in any plane", "[rope]") {
  const double length = 0.5, line = 0.05, B = 1e-2, zeta = 0.05;
  const double omega = M_PI * M_PI / (length * length) * std::sqrt(B / line), period = 2 * M_PI / omega;
  const Vec3 along = Vec3(1, 0.7, -0.4).normalized(), side = along.unitOrthogonal();
  for (const int segments : {10, 20, 40})
    for (const double amplitude : {1e-3, 1e-5})
      for (const Vec3& way : {side, Vec3(along.cross(side))}) {
        CAPTURE(segments, amplitude);
        Rope rope(straight(Vec3::Zero(), length * along, segments),
                  {.mass_per_length = line, .stretch = 50, .bend = B, .bend_damping = B * 2 * zeta / omega},
                  Vec3::Zero());
        rope.hold({0, segments});
        for (int i = 1; i < segments; ++i)
          rope.state.v.segment<3>(3 * i) = amplitude * omega * std::sin(M_PI * i / segments) * way;
        rope.use("bdf2", "eigen-ldlt", precise());
        const double before = rope.system->total_energy(rope.state);
        rope.go(period / 200, 400);
        const double decay = std::log(before / rope.system->total_energy(rope.state));
        CHECK(decay / (2 * zeta * omega * 2 * period) == Approx(1).epsilon(0.03));
      }
}

// Dampers turn with the motion, and count in each iteration as they were linearised in it.
TEST_CASE("a damped rope makes no energy by implicit Euler, however many iterations it takes", "[rope]") {
  for (const auto& [damping, bend_damping] : {std::pair{0.0, 1e-2}, {0.0, 1e-3}, {100.0, 0.0}, {10.0, 0.0}})
    for (const int iterations : {2, 3, 5, 10})
      for (const unsigned seed : {1u, 2u, 3u}) {
        CAPTURE(damping, bend_damping, iterations, seed);
        Rope rope(straight(Vec3::Zero(), {0.5, 0, 0}, 20), {.damping = damping, .bend_damping = bend_damping},
                  Vec3::Zero());
        rope.state.v = random_vector(rope.state.v.size(), 1, seed);
        StepOptions options;
        options.newton_iterations = iterations;
        rope.use("implicit-euler", "eigen-ldlt", options);
        const double start = rope.system->total_energy(rope.state);
        double energy = start, gained = 0;
        for (int n = 0; n < 30; ++n) {
          rope.go(0.01, 1);
          const double now = rope.system->total_energy(rope.state);
          gained = std::max(gained, now - energy);
          energy = now;
        }
        CHECK(gained < 0.05 * start);
      }
}

TEST_CASE("a soft damped rope that falls on its end gains no speed where a segment becomes short", "[rope]") {
  for (const double damping : {0.0, 1e-4, 1e-3}) {
    CAPTURE(damping);
    Rope rope(straight({0, 0.05, 0}, {1e-3, 0.55, 0}, 30),
              {.mass_per_length = 0.2, .stretch = 1, .bend = 1e-5, .bend_damping = damping});
    rope.constraints->add(Obstacle{.shape = Plane{}, .margin = 5e-3});
    rope.use("implicit-euler", "eigen-ldlt");
    double fastest = 0;
    for (int n = 0; n < 100; ++n) {
      rope.go(0.005, 1);
      fastest = std::max(fastest, rope.state.v.cwiseAbs().maxCoeff());
    }
    CHECK(fastest < 3.3);  // m/s; no part of it falls farther than 0.55 m
  }
}

// The direction in which a straight rope is bent is that of round-off.
TEST_CASE("a straight rope whose bending is damped goes its way by every integrator", "[rope]") {
  for (const std::string& name : integrator_names())
    for (const int segments : {10, 20, 30})
      for (const double damping : {1e-4, 1e-3, 1e-2}) {
        if (!bears_stiff(name) || name == "newton-kinsol")
          continue;  // KINSOL may find no solution (docs/limits.md)
        CAPTURE(name, segments, damping);
        Rope rope(straight(Vec3::Zero(), {0.3, 0.2, 0.1}, segments),
                  {.mass_per_length = 0.06, .bend_damping = damping});
        rope.hold({0});
        rope.use(name, "eigen-ldlt");
        for (int n = 0; n < 10; ++n) {
          const StepReport report = rope.advance(0.01);
          INFO("step " << n << ": " << report.failure.what);
          REQUIRE(report.done);
          CHECK(report.substeps == 1);
        }
        double most = 0;
        for (int k = 0; k <= segments; ++k)
          most = std::max(most, std::abs(rope.at(k).norm() - rope.start[k].norm()));
        CHECK(most < 0.05);
        CHECK((rope.at(segments) - rope.start.back()).norm() > 0.01);  // it falls
      }
}

TEST_CASE("a straight rope that hangs is at rest by \"pbd\", however its bending is damped", "[rope][pbd]") {
  for (const int segments : {20, 40, 80})
    for (const double damping : {0.0, 1e-5, 1e-4, 1e-3}) {
      CAPTURE(segments, damping);
      Rope rope(straight(Vec3::Zero(), {0, -0.5, 0}, segments), {.bend_damping = damping});
      rope.hold({0});
      rope.use("pbd", "mpcg");
      rope.go(0.01, 50);
      CHECK(rope.state.v.cwiseAbs().maxCoeff() < 0.5);
    }
}

TEST_CASE("the axis of a rope rests at its radius and the margin, by every integrator", "[rope]") {
  for (const Method& method : methods()) {
    CAPTURE(method.label);
    Rope rope(straight({0, 0.02, 0}, {0.3, 0.02, 0}, 6),
              {.mass_per_length = 0.1, .stretch = 30, .bend = 1e-4, .damping = 0.05, .radius = 8e-3});
    rope.constraints->add({.shape = Plane{}, .friction = 0.5, .margin = 2e-3});
    rope.use(method.name, "eigen-ldlt", method.options());
    rope.go(is_explicit(method.name) ? 5e-4 : 5e-3, is_explicit(method.name) ? 1000 : 100);
    for (int k = 0; k < rope.count(); ++k) CHECK(rope.at(k).y() == Approx(0.01).margin(2e-4));
    for (const double depth : rope.constraints->penetration(rope.state.x)) CHECK(depth == 0);
    rope.state.x[1] = 5e-3;
    CHECK(rope.constraints->penetration(rope.state.x)[0] == Approx(3e-3));
  }
}

TEST_CASE("a rope is stopped at its radius, however fast it comes", "[rope]") {
  for (const double speed : {2.0, 50.0, 400.0}) {
    Rope rope(straight({-0.1, 0.2, 0}, {0.1, 0.2, 0}, 10),
              {.mass_per_length = 0.1, .stretch = 1e3, .bend = 1e-3, .radius = 5e-3});
    rope.constraints->add({.shape = Sphere{Vec3::Zero(), 0.05}, .margin = 1e-3});
    for (int k = 0; k < rope.count(); ++k) rope.state.v[3 * k + 1] = -speed;
    rope.use("implicit-euler", "eigen-ldlt");
    for (int n = 0; n < 20; ++n) {
      rope.go(2e-3, 1);
      for (int k = 0; k < rope.count(); ++k) CHECK(rope.at(k).norm() > 0.055 - 1e-9);
    }
  }
}

TEST_CASE("a rope has the same bits on any number of threads", "[rope]") {
  check_same_bits([] {
    std::vector<Vec3> points;
    for (int k = 0; k <= 3200; ++k) points.emplace_back(1e-3 * k, 0.02 * std::sin(0.01 * k), 0);
    Rope rope(std::move(points), {.mass_per_length = 0.1, .stretch = 1e3, .bend = 1e-3, .damping = 0.1});
    rope.hold({0, 3200});
    rope.constraints->add({.shape = Sphere{{1.6, -0.11, 0}, 0.1}});
    rope.use("implicit-euler", "auto");
    rope.go(0.01, 3);
    return rope.state;
  });
}

TEST_CASE("an end that is joined is a particle of the other part", "[rope]") {
  Assembly all;
  all.add(ClothPart{.mesh = grid(5, 5, 1, 1), .fabric = {.area_density = 0.2, .stretch = 2000}});
  const RopeMaterial material{.mass_per_length = 0.05, .stretch = 1e4, .bend = 0};
  const int corners[] = {0, 4, 20, 24};
  for (const int corner : corners) {
    const Vec3 x = all.state.x.segment<3>(3 * corner);
    all.add(RopePart{.points = straight(x + Vec3(0, 0.5, 0), x + Vec3(0, 1e-3, 0), 10),
                     .material = material,
                     .last = corner});
  }
  CHECK(all.state.particles() == 25 + 4 * 10);
  const Cloth& rope = all.cloths[1];
  CHECK(rope.embedding.particle(10) == 0);
  CHECK(rope.end_particle - rope.first_particle == 10);
  CHECK(rope.edges.back().L == Approx(0.0509));  // it rests from the vertex on
  for (std::size_t k = 1; k < 5; ++k) all.pin(PinEnd{}, k);
  all.use("implicit-euler", "eigen-ldlt", precise());
  double mass = 0;
  for (const double m : all.system->masses()) mass += m;
  CHECK(mass == Approx(0.2 + 4 * 0.05 * 0.5));
  for (int n = 0; n < 400; ++n) REQUIRE(all.advance(0.1).done);
  double carried = 0;  // N, at the tops
  for (std::size_t k = 1; k < 5; ++k) {
    const RestEdge& top = all.cloths[k].edges.front();
    const Vec3 along = all.state.x.segment<3>(3 * top.i) - all.state.x.segment<3>(3 * top.j);
    carried += material.stretch * (along.norm() / top.L - 1) * along.y() / along.norm();
  }
  CHECK(carried == Approx(g * (mass - 4 * 0.5 * 0.05 * 0.05)).epsilon(1e-4));
}

TEST_CASE("ropes that make no sense are refused", "[rope]") {
  const auto refused = [](RopePart part) -> std::string {
    Assembly all;
    try {
      all.add(std::move(part));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::vector<Vec3> two = {Vec3::Zero(), Vec3::UnitX()};
  CHECK(refused({.points = two}).empty());
  CHECK_THAT(refused({.points = {Vec3::Zero()}}), Catch::Contains("at least two"));
  CHECK_THAT(refused({.points = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitX()}}),
             Catch::Contains("points 1 and 2") && Catch::Contains("leave one"));
  CHECK_THAT(refused({.points = two, .material = {.mass_per_length = 0}}),
             Catch::Contains("mass_per_length"));
  CHECK_THAT(refused({.points = two, .material = {.stretch = -1}}), Catch::Contains("stretch = -1 N"));
  CHECK_THAT(refused({.points = two, .material = {.bend = -1}}), Catch::Contains("bend"));
  CHECK_THAT(refused({.points = two, .material = {.radius = 0}}), Catch::Contains("radius"));
  CHECK_THAT(refused({.points = two, .first = 3}), Catch::Contains("particle 3"));
  CHECK_THAT(refused({.points = {Vec3::Zero(), Vec3(NAN, 0, 0)}}), Catch::Contains("not finite"));
}
