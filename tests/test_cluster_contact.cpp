// Laws of clusters that meet bodies: a stiff one moves as a rigid body of its mass and inertia does.
#include <catch2/catch.hpp>

#include "mesh/triangles/generate.h"
#include "tests/cluster_bodies.h"

using namespace drape;
using namespace drape::test;

TEST_CASE("a cluster that falls flat leaves with the restitution of the floor", "[clusters][pbd]") {
  for (const double e : {0.0, 0.4, 1.0})
    for (const double v : {0.5, 3.0}) {
      Bodies one;
      one.add_box({3, 3, 4}, level, {0, 0.1 + 0.004, 0});
      one.constraints.add(Obstacle{.shape = Plane{}, .friction = 0.5, .margin = 2e-3, .restitution = e});
      one.make(Vec3::Zero());
      one.move(0, {0.2, -v, 0}, Vec3::Zero());
      one.run(0.01, 2, "restitution");
      INFO("e = " << e << ", v = " << v);
      CHECK(one.motion(0).velocity[1] == Approx(e * v).margin(1e-6 * v));
      CHECK(one.motion(0).velocity[0] == Approx(0.2).margin(1e-6));  // an impact has no friction
      CHECK(one.motion(0).spin.norm() < 1e-6);
    }
}

TEST_CASE("a cluster that hits with a corner leaves as a rigid body does", "[clusters][pbd]") {
  Random random(5);
  for (int k = 0; k < 20; ++k) {
    const double e = k % 2 ? 0.6 : 0.0;
    const std::string contact = k % 4 < 2 ? "restitution" : "velocity";
    if (e > 0 && contact == "velocity") continue;
    Bodies one;
    one.add_box({3, 4, 3}, random.rotation(), Vec3::Zero());
    double lowest = 1;
    int corner = 0;
    for (std::size_t i = 0; i < one.places.size(); ++i)
      if (one.places[i][1] < lowest) lowest = one.places[i][1], corner = static_cast<int>(i);
    one.constraints.add(Obstacle{
        .shape = Plane{{0, lowest - 1e-4, 0}, {0, 1, 0}}, .friction = 0.0, .margin = 0, .restitution = e});
    one.make(Vec3::Zero());
    const Vec3 velocity(0.3, -2, 0.1), spin(1, -0.5, 0.7), n(0, 1, 0);
    one.move(0, velocity, spin);
    const ClusterBody body = one.body(0);
    const Vec3 r = one.places[static_cast<std::size_t>(corner)] - body.centre;
    const double approach = n.dot(velocity + spin.cross(r));
    const double J = -(1 + e) * approach / n.dot(give_at(body, r) * n);
    const Vec3 v_after = velocity + J / body.mass * n, w_after = spin + body.inverse_inertia * r.cross(J * n);
    one.run(1e-4, 2, contact, 2);
    INFO(k << ": " << contact << ", e = " << e);
    CHECK((one.motion(0).velocity - v_after).norm() < 0.02 * velocity.norm());
    CHECK((one.motion(0).spin - w_after).norm() < 0.02 * w_after.norm());
  }
}

TEST_CASE("a cluster that slides is slowed by mu g, and one that stands on a slope stays",
          "[clusters][pbd]") {
  for (const char* contact : {"velocity", "restitution"}) {
    Bodies one;
    one.add_box({4, 3, 4}, level, {0, 0.1, 0});
    one.constraints.add(Obstacle{.shape = Plane{}, .friction = 0.3, .margin = 0});
    one.make({0, -g, 0});
    one.move(0, {2, 0, 0}, Vec3::Zero());
    one.run(0.01, 30, contact);
    INFO(contact);
    CHECK(one.motion(0).velocity[0] == Approx(2 - 0.3 * g * 0.3).epsilon(0.01));
    CHECK(one.motion(0).spin.norm() < 0.01);
    for (const double slope : {0.2, 0.5}) {
      Bodies on_slope;
      on_slope.add_box({4, 3, 4}, level, {0, 0.1, 0});
      on_slope.constraints.add(Obstacle{.shape = Plane{}, .friction = 0.3, .margin = 0});
      const double angle = std::atan(slope);
      on_slope.make(g * Vec3(std::sin(angle), -std::cos(angle), 0));
      on_slope.run(0.01, 30, contact);
      const double expected = slope < 0.3 ? 0 : 0.3 * g * (std::sin(angle) - 0.3 * std::cos(angle));
      INFO("slope " << slope);
      CHECK(on_slope.motion(0).velocity[0] == Approx(expected).margin(0.01));
    }
  }
}

TEST_CASE("a ball of a cluster that slides comes to roll with 5/7 of its speed", "[clusters][pbd]") {
  const TriangleMesh surface =
      sphere(5, 0.1);  // a shell of 3/5 of the mass, and the rest at the middle: I = 2/5 M r^2
  std::vector<Vec3> points = surface.positions;
  const double shell = 0.6 / static_cast<double>(points.size());
  std::vector<double> mass(points.size(), shell);
  points.emplace_back(0, 0, 0);
  mass.push_back(0.4);
  for (Vec3& x : points) x[1] += 0.1;
  Bodies one;
  one.add(points, mass);
  one.constraints.add(Obstacle{.shape = Plane{}, .friction = 0.3, .margin = 0});
  one.make({0, -g, 0});
  one.move(0, {1, 0, 0}, Vec3::Zero());
  one.run(0.01, 11, "velocity");  // slides for 0.097 s
  CHECK(one.motion(0).velocity[0] == Approx(5.0 / 7).epsilon(0.03));
  CHECK(-one.motion(0).spin[2] * 0.1 == Approx(5.0 / 7).epsilon(0.03));
}

TEST_CASE("a cluster and a body that it hits keep momentum, and part as rigid bodies do", "[clusters][pbd]") {
  for (const double m_B : {1.0, 20.0, 500.0})
    for (const double e : {0.0, 0.5})
      for (const double off : {0.0, 0.03}) {
        Bodies one;
        one.add_box({3, 3, 3}, level, {off, 0.1 + 0.1005, 0});
        const Mat3 inertia = m_B * Vec3(0.05, 0.05, 0.05).asDiagonal();
        one.constraints.add(Obstacle{.shape = Box{.centre = Vec3::Zero(), .size = Vec3(0.8, 0.2, 0.8)},
                                     .friction = 0.0,
                                     .margin = 0,
                                     .restitution = e,
                                     .rigid = RigidBody{.mass = m_B, .inertia = inertia}});
        one.make({0, -g, 0});  // both fall
        one.move(0, {0, -1, 0}, Vec3::Zero());
        const double m_A = one.body(0).mass;
        INFO(m_B << " kg, e = " << e << ", " << off << " m off, cluster of " << m_A << " kg");
        one.run(1e-3, 2, e > 0 ? "restitution" : "velocity", 4);
        const ReactingBody& body = *one.constraints.bodies()[0].reacting();
        const Vec3 fallen(0, -g * 2e-3, 0);
        INFO(one.motion(0).velocity.transpose() << ", " << body.velocity().transpose());
        CHECK((m_A * one.motion(0).velocity + body.momentum() - Vec3(0, -m_A, 0) - (m_A + m_B) * fallen)
                  .norm() < 1e-3 * m_A);
        const auto leaving = [&](const Vec3& at) {
          const ClusterMotion m = one.motion(0);
          return m.at(at - one.body(0).centre)[1] -
                 (body.velocity() + body.spin().cross(at - body.centre()))[1];
        };
        // Where the face was pushed it leaves with e, and nowhere more slowly.
        double least = 10;
        for (const double x : {-0.1, 0.0, 0.1}) least = std::min(least, leaving({off + x, 0.1, 0}));
        CHECK(least == Approx(e).margin(0.01));
        if (off == 0)
          CHECK(body.velocity()[1] - fallen[1] == Approx(-(1 + e) * m_A / (m_A + m_B)).epsilon(0.01));
      }
}

TEST_CASE("a cluster with a pinned particle is no free body", "[clusters][pbd]") {
  Bodies one;
  one.add_box({3, 3, 3}, level, {0, 0.1, 0});
  one.constraints.add(Obstacle{.shape = Plane{}, .friction = 0.3, .margin = 0});
  one.make({0, -g, 0});
  one.constraints.pin(26);
  const Vec3 before = one.state.x.segment<3>(3 * 26);
  one.run(0.01, 20, "velocity");
  CHECK(Vec3(one.state.x.segment<3>(3 * 26)) == before);
  CHECK(one.state.x.allFinite());
}
