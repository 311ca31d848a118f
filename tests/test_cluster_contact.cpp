// Laws of clusters that meet bodies and each other: a stiff one moves as a rigid body of its mass and inertia does.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <numeric>

#include "mesh/triangles/generate.h"
#include "solver/forces/cluster_body.h"
#include "solver/forces/cluster_force.h"
#include "solver/forces/self_contact_force.h"
#include "solver/integrators/integrator.h"
#include "tests/clusters.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double stiff = 1e10;  // 1/s^2
constexpr double g = 9.81;

// Bodies of one cluster each, which are sets of particles after one another.
struct Bodies {
  std::vector<Vec3> places;
  std::vector<double> own;
  ParticleSets sets;
  std::unique_ptr<System> system;
  Constraints constraints;
  State state;
  double k = stiff;

  void add(const std::vector<Vec3>& points, const std::vector<double>& mass) {
    sets.emplace_back();
    for (std::size_t i = 0; i < points.size(); ++i) {
      sets.back().push_back(static_cast<int>(places.size()));
      places.push_back(points[i]);
      own.push_back(mass[i]);
    }
  }
  // A box of particles that is turned and moved.
  void add_box(const std::array<int, 3>& counts, const Quaternion& turn, const Vec3& at, double edge = 0.1) {
    const Lattice box = box_lattice(counts, Vec3::Constant(edge));
    std::vector<Vec3> points;
    for (const Vec3& x : box.positions) points.push_back(turn * x + at);
    add(points, masses(box, SoftMaterial{}));
  }
  void make(const Vec3& gravity) {
    system = std::make_unique<System>(own);
    state = {0, stacked(places), VecX::Zero(3 * static_cast<Eigen::Index>(places.size()))};
    system->add(std::make_unique<ClusterForce>(clusters(), k));
    system->add(Gravity{gravity});
  }
  Clusters clusters() const { return Clusters(sets, own, stacked(places), "bodies"); }
  ClusterBody body(int b) const { return body_of(clusters()[b], state.x); }
  ClusterMotion motion(int b) const { return motion_of(clusters()[b], body(b), state.x, state.v); }
  Mat3 inertia(int b) const { return inertia_of(clusters()[b], body(b).centre, state.x); }
  void move(int b, const Vec3& velocity, const Vec3& spin) {
    const Vec3 c = body(b).centre;
    for (const int i : sets[static_cast<std::size_t>(b)])
      state.v.segment<3>(3 * i) = velocity + spin.cross(Vec3(state.x.segment<3>(3 * i)) - c);
  }
  double kinetic() const { return system->kinetic_energy(state.v); }
  void run(double h, int steps, const std::string& contact, int substeps = 20) {
    StepOptions options;
    options.projection.substeps = substeps;
    options.contact = contact == "restitution" ? ContactMode::restitution : ContactMode::velocity;
    auto stepper = make_integrator("pbd", *system, constraints, make_linear_solver("mpcg"), options);
    for (int n = 0; n < steps; ++n) {
      INFO("step " << n);
      REQUIRE(stepper->advance(state, h).done);
    }
  }
};

const Quaternion level = Quaternion::Identity();

}  // namespace

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

TEST_CASE("clusters that collide keep momentum and angular momentum, and leave as rigid bodies would",
          "[clusters][pbd]") {
  Random random(6);
  for (int k = 0; k < 8; ++k) {
    Bodies two;
    const Quaternion turn = random.rotation();
    two.add_box({3, 3, 3}, turn, {0, 0, 0});
    two.add_box({3, 3, 3}, random.rotation(), {0.02, 0.5, 0.01});
    double gap = 1;  // brought together along y by what is between the lowest and the highest of both
    double high = -1, low = 1;
    for (const int i : two.sets[0]) high = std::max(high, two.places[static_cast<std::size_t>(i)][1]);
    for (const int i : two.sets[1]) low = std::min(low, two.places[static_cast<std::size_t>(i)][1]);
    gap = low - high - 2e-3;
    for (const int i : two.sets[1]) two.places[static_cast<std::size_t>(i)][1] -= gap;
    std::vector<SelfFace> faces;
    const Lattice box = box_lattice({3, 3, 3}, Vec3::Constant(0.1));
    std::vector<int> on_surface;
    const TriangleMesh surface = surface_of(box, on_surface);
    for (const int b : {0, 1})
      for (Triangle t : surface.triangles) {
        for (int& v : t) v = 27 * b + on_surface[static_cast<std::size_t>(v)];
        faces.push_back({t, 1e-3, 0.0, b});
      }
    two.constraints.add_self_faces(faces);
    two.make(Vec3::Zero());
    two.system->add(self_contact_force(two.constraints));
    two.move(1, {0, -1, 0}, Vec3::Zero());
    const auto angular = [&] {
      Vec3 L = Vec3::Zero();
      for (int i = 0; i < two.system->particles(); ++i)
        L += two.own[static_cast<std::size_t>(i)] *
             Vec3(two.state.x.segment<3>(3 * i)).cross(Vec3(two.state.v.segment<3>(3 * i)));
      return L;
    };
    const Vec3 L = angular();
    const double energy = two.kinetic(), m = two.body(0).mass;
    const Vec3 P = m * two.motion(1).velocity;
    two.run(1e-3, 60, "velocity");
    const ClusterMotion a = two.motion(0), b = two.motion(1);
    INFO(k << ": " << a.velocity.transpose() << "; " << b.velocity.transpose() << "; " << a.spin.transpose());
    CHECK(a.velocity.norm() > 0.1);
    CHECK((m * (a.velocity + b.velocity) - P).norm() < 1e-7 * P.norm());
    CHECK((angular() - L).norm() < 0.02 * (m * 0.1));
    CHECK(two.kinetic() < energy);
    const double rigid = 0.5 * m * (a.velocity.squaredNorm() + b.velocity.squaredNorm()) +
                         0.5 * a.spin.dot(two.inertia(0) * a.spin) +
                         0.5 * b.spin.dot(two.inertia(1) * b.spin);
    CHECK(rigid > 0.98 * two.kinetic());  // they do not shake
    // The push went through one point: its moment about the centre is across it.
    const Vec3 L_A = two.inertia(0) * a.spin, J = m * a.velocity;
    CHECK(std::abs(L_A.dot(J)) < 0.1 * L_A.norm() * J.norm());
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
