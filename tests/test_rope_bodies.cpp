// Ropes and bodies: anchored to bodies that hang, swing and fly, and drawn over a drum that rubs.
#include <Eigen/Eigenvalues>
#include <cmath>

#include "mesh/triangles/line.h"
#include "tests/ropes.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double g = 9.81;  // m/s^2

// A cube that moves by what acts on it. R: how it is turned.
Obstacle cube(double edge, double mass, const Vec3& centre, const Vec3& gravity = {0, -g, 0},
              const Mat3& R = Mat3::Identity()) {
  return {.shape = Box{centre, Vec3::Constant(edge), R},
          .margin = 0,
          .rigid = RigidBody{.mass = mass,
                             .inertia = mass * edge * edge / 6 * Mat3::Identity(),
                             .centre = centre,
                             .gravity = gravity}};
}

const ReactingBody& body(const Assembly& all, std::size_t k) {
  return *all.constraints->bodies()[k].reacting();
}

}  // namespace

TEST_CASE("a rope bears what is anchored to it, and no more", "[rope]") {
  for (const char* name : {"implicit-euler", "bdf2"}) {
    CAPTURE(name);
    const RopeMaterial material{.mass_per_length = 1, .stretch = 2000, .bend = 0, .damping = 20};
    Rope rope(straight(Vec3::Zero(), {0, -0.6, 0}, 6), material);
    rope.hold({0});
    rope.constraints->add(cube(0.2, 0.5, {0, -0.7, 0}));
    rope.constraints->pin_to_body({6}, 0, rope.state.x);
    rope.use(name, "eigen-ldlt");
    rope.go(5e-3, 400);
    CHECK(rope.tension(5) == Approx(g * (0.5 + 0.6 * 0.5 / 6)).epsilon(0.01));
    CHECK(rope.tension(0) == Approx(g * (0.5 + 0.6 * 5.5 / 6)).epsilon(0.01));
    CHECK(body(rope, 0).velocity().norm() < 5e-3);
    const Vec3 top = body(rope, 0).centre() + Vec3(0, 0.1, 0);
    CHECK((top - rope.at(6)).norm() < 1e-6);  // it is the point that it was
  }
}

// The rope is a rod without mass, since it is taut and light: a pendulum of two rods, in its slow mode.
TEST_CASE("a box on a rope swings with the period of a compound pendulum", "[rope]") {
  constexpr double L = 0.8, a = 0.1, m = 2, I = m * 0.2 * 0.2 / 6;
  Eigen::Matrix2d M, K;  // M q'' + K q = 0 for the angles of rope and box
  M << m * L * L, m * L * a, m * L * a, I + m * a * a;
  K << m * g * L, 0, 0, m * g * a;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> modes(K, M);
  const Eigen::Vector2d mode = modes.eigenvectors().col(0) / modes.eigenvectors()(0, 0);
  const double exact = 2 * M_PI / std::sqrt(modes.eigenvalues()[0]);
  struct Way {
    const char* integrator;
    double h;
    int segments;
  };
  for (const Way& way :
       {Way{"implicit-euler", 1e-3, 8}, Way{"bdf2", 4e-3, 1}, Way{"bdf2", 4e-3, 6}, Way{"bdf2", 4e-3, 20}}) {
    CAPTURE(way.integrator, way.segments, exact);
    const double angle = 0.03, turn = mode[1] * angle;
    const Vec3 end(L * std::sin(angle), -L * std::cos(angle), 0),
        centre = end + a * Vec3(std::sin(turn), -std::cos(turn), 0);
    Rope rope(straight(Vec3::Zero(), end, way.segments),
              {.mass_per_length = 1e-4, .stretch = 1e5, .bend = 0, .radius = 1e-3});
    rope.hold({0});
    rope.constraints->add(cube(0.2, m, centre, {0, -g, 0}, test::rotation(turn, {0, 0, 1})));
    rope.constraints->pin_to_body({way.segments}, 0, rope.state.x);
    rope.use(way.integrator, "eigen-ldlt");
    double before = 1, first = 0, last = 0;
    int count = 0;
    while (rope.state.time < 3.5 * exact) {
      rope.go(way.h, 1);
      const double x = body(rope, 0).centre().x();
      if (before > 0 && x <= 0) {
        last = rope.state.time - way.h * x / (x - before);
        if (count++ == 0) first = last;
      }
      before = x;
    }
    REQUIRE(count >= 3);
    CHECK((last - first) / (count - 1) == Approx(exact).epsilon(5e-3));
    CHECK(rope.tension(0) == Approx(m * g).epsilon(0.01));
  }
}

TEST_CASE("two boxes on a rope keep their momentum, and energy does not grow", "[rope]") {
  Rope rope(straight({-0.5, 0, 0}, {0.5, 0, 0}, 10),
            {.mass_per_length = 0.2, .stretch = 2000, .bend = 1e-3, .damping = 1}, Vec3::Zero());
  rope.constraints->add(cube(0.2, 1, {-0.6, 0, 0}, Vec3::Zero()));
  Obstacle other = cube(0.3, 2, {0.65, 0, 0}, Vec3::Zero());
  other.rigid->velocity = {0.5, 1, 0.2};  // it pulls, and turns all
  rope.constraints->add(other);
  rope.constraints->pin_to_body({0}, 0, rope.state.x);
  rope.constraints->pin_to_body({10}, 1, rope.state.x);
  rope.use("implicit-euler", "eigen-ldlt");
  const auto momentum = [&] {
    Vec3 p = body(rope, 0).momentum() + body(rope, 1).momentum();
    for (int i = 0; i < rope.count(); ++i) p += rope.system->masses()[i] * rope.state.v.segment<3>(3 * i);
    return p;
  };
  const auto energy = [&] {
    double e = rope.system->total_energy(rope.state);
    for (std::size_t k : {0, 1}) {
      const double mass = k == 0 ? 1 : 2, edge = k == 0 ? 0.2 : 0.3;
      e += 0.5 * mass * body(rope, k).velocity().squaredNorm() +
           0.5 * mass * edge * edge / 6 * body(rope, k).spin().squaredNorm();
    }
    return e;
  };
  rope.go(5e-3, 1);
  const Vec3 p = momentum();
  const double most = energy();
  for (int n = 0; n < 300; ++n) {
    rope.go(5e-3, 1);
    const double now = energy();
    CHECK(now < most * (1 + 1e-3));
  }
  CAPTURE(p.transpose(), momentum().transpose());
  CHECK((momentum() - p).norm() < 0.01 * p.norm());
  CHECK(body(rope, 0).velocity().norm() > 0.3);  // it has been drawn along
}

TEST_CASE("a rope that slides over a drum pulls exp(mu phi) times as hard as what hangs on it", "[rope]") {
  constexpr double R = 0.1, radius = 4e-3, margin = 1e-3, r = R + radius + margin;
  for (const double mu : {0.3, 0.5}) {
    std::vector<Vec3> course = {{-r, -0.5, 0}};
    for (int k = 0; k <= 96; ++k)
      course.emplace_back(-r * std::cos(M_PI * k / 96), r * std::sin(M_PI * k / 96), 0);
    course.emplace_back(r, -0.2, 0);
    const int segments = static_cast<int>(std::lround(length_of(course) / (M_PI * r / 24)));
    Rope rope(evenly_divided(course, segments),
              {.mass_per_length = 2e-3, .stretch = 5e3, .bend = 0, .damping = 5, .radius = radius});
    rope.constraints->add(
        {.shape = Plate{.centre = Vec3::Zero(), .radius = R, .height = 0.3, .axis = Vec3::UnitZ()},
         .friction = mu,
         .margin = margin});
    rope.constraints->add(cube(0.1, 1, {-r, -0.55, 0}));
    rope.constraints->pin_to_body({0}, 1, rope.state.x);
    rope.constraints->pin_along({segments}, Motion::constant({0, -0.05, 0}, Vec3::Zero(), Vec3::Zero()),
                                rope.state.x);
    rope.use("implicit-euler", "eigen-ldlt");
    double low = 0, high = 0;
    for (int n = 0; n < 1000; ++n) {
      rope.go(2e-3, 1);
      if (n < 500) continue;
      low += rope.tension(2) / 500;
      high += rope.tension(segments - 3) / 500;
    }
    CAPTURE(mu, low, high, high / low);
    CHECK(low == Approx(g).epsilon(0.01));
    CHECK(high / low == Approx(std::exp(mu * M_PI)).epsilon(0.02));
  }
}
