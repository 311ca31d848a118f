// Laws of clusters that meet each other, and cloth: stiff ones push each other as rigid bodies do.
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "solver/forces/impulses.h"
#include "tests/allocations.h"
#include "tests/cluster_bodies.h"
#include "tests/same_bits.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double thickness = 1e-3;  // m

Vec3 place(const Bodies& all, int i) { return all.state.x.segment<3>(3 * i); }

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};
Momenta momenta(const Bodies& all) {
  Momenta sum;
  for (int i = 0; i < all.system->particles(); ++i) {
    const Vec3 p = all.own[static_cast<std::size_t>(i)] * Vec3(all.state.v.segment<3>(3 * i));
    sum.linear += p;
    sum.angular += place(all, i).cross(p);
  }
  return sum;
}

double rigid_energy(const Bodies& all) {
  double sum = 0;
  for (int b = 0; b < static_cast<int>(all.sets.size()); ++b) {
    const ClusterMotion m = all.motion(b);
    sum += 0.5 * all.body(b).mass * m.velocity.squaredNorm() + 0.5 * m.spin.dot(all.inertia(b) * m.spin);
  }
  return sum;
}

// Moves the second body down until it is as far above the first one.
void bring_together(Bodies& two, double gap) {
  double high = -1, low = 1;
  for (const int i : two.sets[0]) high = std::max(high, two.places[static_cast<std::size_t>(i)][1]);
  for (const int i : two.sets[1]) low = std::min(low, two.places[static_cast<std::size_t>(i)][1]);
  for (const int i : two.sets[1]) two.places[static_cast<std::size_t>(i)][1] -= low - high - gap;
}

struct Kind {
  std::array<int, 3> first, second;
  double edge, density;  // of the second [m], [kg/m^3]
};
const std::array<Kind, 3> box_kinds = {{{{3, 3, 3}, {3, 4, 3}, 0.08, 300},
                                        {{2, 2, 2}, {4, 3, 5}, 0.05, 2000},
                                        {{5, 4, 5}, {2, 3, 2}, 0.1, 100}}};

// What a rigid body would do that starts as the first body and is hit where `contact` is: with friction it
// sticks.
ClusterMotion rigid_answer(const SelfContact& contact, double h, const std::array<ClusterBody, 2>& body,
                           const std::array<ClusterMotion, 2>& motion, const State& before, int first_size) {
  std::array<Vec3, 2> point = {Vec3::Zero(), Vec3::Zero()};
  double sign = 1;  // of the weights on the first body
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t side = contact.particles[k] < first_size ? 0 : 1;
    point[side] += std::abs(contact.weights[k]) * before.x.segment<3>(3 * contact.particles[k]);
    if (side == 0 && contact.weights[k] != 0) sign = contact.weights[k] > 0 ? 1 : -1;
  }
  const Vec3 n = sign * contact.normal, middle = 0.5 * (point[0] + point[1]);
  const Vec3 r_A = middle - body[0].centre, r_B = middle - body[1].centre;
  const double target = -(contact.normal.dot(contact.place) - contact.thickness) / h;
  const Vec3 u = motion[0].at(r_A) - motion[1].at(r_B);
  const Mat3 K = give_at(body[0], r_A) + give_at(body[1], r_B);
  const Vec3 J = contact.friction > 0 ? Vec3(K.inverse() * (target * n - u))
                                      : Vec3((target - n.dot(u)) / n.dot(K * n) * n);
  return {motion[0].velocity + J / body[0].mass, motion[0].spin + body[0].inverse_inertia * r_A.cross(J)};
}

}  // namespace

TEST_CASE("clusters that collide keep momentum and angular momentum, and leave as rigid bodies do",
          "[clusters][pbd]") {
  Random random(6);
  int hits = 0, meetings = 0;
  for (int k = 0; k < 12; ++k) {
    const Kind& kind = box_kinds[static_cast<std::size_t>(k % 3)];
    const char* const contact = k % 4 < 2 ? "velocity" : "restitution";
    Bodies two;
    two.apart = k % 2 == 0;
    const Quaternion first = random.rotation(), second = random.rotation();
    two.add_box(kind.first, first, {0, 0, 0});
    two.add_box(kind.second, second, {0.02, 0.5, 0.01}, kind.edge, kind.density);
    bring_together(two, 2e-3);
    two.let_meet(thickness, k < 6 ? 0.0 : 10.0);
    two.make(Vec3::Zero());
    two.move(1, {0, -1, 0}, Vec3::Zero());
    const Momenta before = momenta(two);
    const double energy = two.kinetic(), h = 1e-4;
    bool met = false;
    INFO(k << ": " << contact);
    for (int n = 0; n < 600 && !met; ++n) {
      const State start = two.state;
      const std::array<ClusterMotion, 2> motion = {two.motion(0), two.motion(1)};
      const std::array<ClusterBody, 2> body = {two.body(0), two.body(1)};
      two.run(h, 1, contact, 1);
      std::vector<SelfContact> pushed;
      for (const SelfContact& c : two.constraints.self().pushed())
        if (c.before > 0) pushed.push_back(c);
      met = !pushed.empty();
      if (pushed.size() != 1) continue;
      ++hits;
      const ClusterMotion rigid =
          rigid_answer(pushed[0], h, body, motion, start, static_cast<int>(two.sets[0].size()));
      CHECK((two.motion(0).velocity - rigid.velocity).norm() < 2e-3 * rigid.velocity.norm());
      CHECK((two.motion(0).spin - rigid.spin).norm() < 2e-3 * rigid.spin.norm());
    }
    meetings += met;
    two.run(1e-3, 60, contact);
    const Momenta after = momenta(two);
    CHECK((after.linear - before.linear).norm() < 1e-7 * before.linear.norm());
    CHECK((after.angular - before.angular).norm() < 5e-3 * before.linear.norm() * 0.1);
    CHECK(two.kinetic() < energy);
    CHECK(rigid_energy(two) > (1 - 1e-4) * two.kinetic());  // they do not shake
  }
  CHECK(meetings > 9);  // turned boxes may pass beside each other
  CHECK(hits > 6);
}

TEST_CASE("clusters that hit each other flat go on together", "[clusters][pbd]") {
  for (const Kind& kind : box_kinds)
    for (const char* contact : {"velocity", "restitution"}) {
      Bodies two;
      two.add_box(kind.first, level, {0, 0, 0});
      two.add_box(kind.second, level, {0, 0.5, 0}, kind.edge, kind.density);
      bring_together(two, 2e-3);
      two.let_meet(thickness, 0.3);
      two.make(Vec3::Zero());
      two.move(1, {0, -1, 0}, Vec3::Zero());
      const double m_A = two.body(0).mass, m_B = two.body(1).mass;
      two.run(1e-3, 5, contact);
      INFO(contact << ", " << m_A << " kg and " << m_B << " kg");
      for (const int b : {0, 1}) {
        CHECK((two.motion(b).velocity - Vec3(0, -m_B / (m_A + m_B), 0)).norm() < 1e-6);
        CHECK(two.motion(b).spin.norm() < 1e-5);
      }
    }
}

TEST_CASE("a cluster that slides on another is slowed by mu g, until both go on together",
          "[clusters][pbd]") {
  for (const char* contact : {"velocity", "restitution"})
    for (const double density : {300.0, 1200.0}) {
      constexpr double mu = 0.3;
      Bodies two;
      two.add_box({5, 3, 5}, level, {0, 0.1, 0}, 0.1, density);
      two.add_box({3, 3, 3}, level, {0.013, 0.3 + thickness, 0.007});
      two.let_meet(thickness, mu);
      two.constraints.add(Obstacle{.shape = Plane{}, .friction = 0.0, .margin = 0});
      two.make({0, -g, 0});
      two.move(1, {1, 0, 0}, Vec3::Zero());
      const double ratio = two.body(1).mass / two.body(0).mass;
      for (int n = 1; n <= 40; ++n) {
        two.run(0.01, 1, contact);
        const double t = 0.01 * n;
        if (mu * g * t * (1 + ratio) > 1) continue;
        INFO(contact << ", " << density << " kg/m^3, at " << t << " s");
        CHECK(two.motion(1).velocity[0] == Approx(1 - mu * g * t).margin(1e-3));
        CHECK(two.motion(0).velocity[0] == Approx(mu * g * t * ratio).margin(1e-3));
        CHECK(std::abs(two.motion(1).velocity[1]) < 5e-3);
      }
      for (const int b : {0, 1}) CHECK(two.motion(b).velocity[0] == Approx(ratio / (1 + ratio)).margin(5e-3));
    }
}

TEST_CASE("clusters that lie on each other stay", "[clusters][pbd]") {
  for (const char* contact : {"velocity", "restitution"})
    for (const double density : {30.0, 300.0, 3000.0}) {
      Bodies all;
      all.add_box({3, 3, 3}, level, {0, 0.1, 0});
      const Quaternion turn(Eigen::AngleAxisd(0.3, Vec3::UnitY()));
      all.add_box({3, 3, 3}, turn, {0.013, 0.3 + thickness, 0.007}, 0.1, density);
      all.add_box({3, 4, 3}, level, {0, 0.55 + 2 * thickness, 0.007});
      all.let_meet(thickness, 0.5);
      all.constraints.add(Obstacle{.shape = Plane{}, .friction = 0.5, .margin = 0});
      all.make({0, -g, 0});
      std::vector<Vec3> start;
      for (const int b : {0, 1, 2}) start.push_back(all.body(b).centre);
      all.run(0.01, 50, contact);
      for (const int b : {0, 1, 2}) {
        INFO(contact << ", " << density << " kg/m^3, body " << b);
        CHECK((all.body(b).centre - start[static_cast<std::size_t>(b)]).norm() < 2e-5);
        CHECK(all.motion(b).velocity.norm() < 1e-4);
      }
    }
}

TEST_CASE("a cluster that falls on cloth that lies on the floor comes to rest on it with its weight",
          "[clusters][pbd]") {
  for (const double density : {30.0, 100.0, 1000.0}) {
    constexpr double thick = 2e-3;
    Bodies all;
    all.add_box({3, 3, 3}, level, {0.013, 0.12 + thick, 0.007}, 0.05, density);
    all.add_sheet(17, 0.8, Vec3::Zero());
    all.let_meet(thick, 0.3);
    all.constraints.add(Obstacle{.shape = Plane{}, .friction = 0.5, .margin = 0});
    all.make({0, -g, 0});
    all.run(0.01, 40, "velocity");
    double push = 0;
    for (const SelfContact& c : all.constraints.self().pushed())
      push += (c.particles[0] < 27 ? 1 : -1) * c.before * c.normal[1];
    INFO(density << " kg/m^3");
    CHECK(all.body(0).centre[1] == Approx(0.05 + thick).margin(2e-5));
    CHECK(all.motion(0).velocity.norm() < 1e-4);
    CHECK(push == Approx(g * all.body(0).mass).epsilon(1e-3));
  }
}

TEST_CASE("a cluster that falls on cloth gives it its momentum, and is held", "[clusters][pbd]") {
  Bodies all;
  all.add_box({3, 3, 3}, level, {0.013, 0.05 + 4e-3, 0.007}, 0.05, 100);
  all.add_sheet(17, 0.8, Vec3::Zero());
  all.let_meet(2e-3, 0.3);
  all.make(Vec3::Zero());
  all.move(0, {0.2, -1, 0}, Vec3::Zero());
  const Momenta before = momenta(all);
  all.run(0.01, 10, "velocity");
  CHECK((momenta(all).linear - before.linear).norm() < 1e-7 * before.linear.norm());
  CHECK(all.body(0).mass * (all.motion(0).velocity[1] + 1) > 0.02 * all.body(0).mass);
  double lowest = 1, of_body = 1;
  for (int v = 0; v < all.sheet.vertex_count(); ++v)
    lowest = std::min(lowest, place(all, all.sheet_first + v)[1]);
  for (const int i : all.sets[0]) of_body = std::min(of_body, place(all, i)[1]);
  CHECK(of_body > lowest + 1e-3);
}

TEST_CASE("bodies of many clusters that meet keep momentum, and make no energy", "[clusters][pbd]") {
  for (const double k : {1e4, 1e6, 1e8}) {
    Bodies two;
    two.k = k;
    const std::array<int, 3> counts = {4, 4, 4};
    two.add_box(counts, level, {0, 0, 0}, 0.05);
    const Quaternion turn(Eigen::AngleAxisd(0.3, Vec3(1, 1, 0.2).normalized()));
    two.add_box(counts, turn, {0.02, 0.5, 0.01}, 0.05);
    bring_together(two, 2e-3);
    two.sets = sets_of_cells(box_lattice(counts, Vec3::Constant(0.05)));
    const std::size_t cells = two.sets.size();
    for (std::size_t c = 0; c < cells; ++c) {
      two.sets.push_back(two.sets[c]);
      for (int& i : two.sets.back()) i += 64;
    }
    two.let_meet(thickness, 0.3);
    two.make(Vec3::Zero());
    for (int i = 64; i < 128; ++i) two.state.v[3 * i + 1] = -1;
    const Momenta before = momenta(two);
    const double energy = two.kinetic();
    double most = 0;
    int guarded = 0;
    for (int n = 0; n < 150; ++n) {
      two.run(1e-3, 1, "velocity");
      guarded += two.report.self_guarded;
      double stored = two.kinetic();
      for (const auto& force : two.system->forces())
        if (!force->from_contact()) stored += force->energy(two.state.x);
      most = std::max(most, stored);
    }
    const Momenta after = momenta(two);
    INFO("k = " << k);
    CHECK((after.linear - before.linear).norm() < 1e-6 * before.linear.norm());
    CHECK((after.angular - before.angular).norm() < 5e-3 * before.linear.norm() * 0.1);
    CHECK(most < 1.001 * energy);
    CHECK(guarded == 0);
    CHECK(two.state.v.head(3 * 64).norm() > 0.1);
  }
}

TEST_CASE("clusters that start inside a body are brought out, and stand", "[clusters][pbd]") {
  for (const char* contact : {"velocity", "restitution"})
    for (const double deep : {1e-3, 5e-3, 2e-2}) {
      Bodies one;
      one.add_box({3, 3, 3}, level, {0, 0.1 - deep, 0});
      one.constraints.add(Obstacle{.shape = Plane{}, .friction = 0.5, .margin = 0, .restitution = 0.5});
      one.make({0, -g, 0});
      one.run(0.01, 1, contact);
      INFO(contact << ", " << deep << " m deep");
      CHECK(one.body(0).centre[1] > 0.1 - deep + 0.9e-3);
      if (contact == std::string("restitution")) CHECK(one.motion(0).velocity.norm() < 0.01);
      one.run(0.01, 15, contact);
      CHECK(one.body(0).centre[1] == Approx(0.1).margin(1e-5));
      CHECK(one.motion(0).velocity.norm() < 1e-4);
    }
}

TEST_CASE("two clusters that hit one free body at once share the rebound", "[clusters][pbd]") {
  for (const double M : {0.1, 1.0, 50.0})
    for (const double e : {0.0, 0.5, 1.0}) {
      Bodies two;
      two.apart = true;
      two.add_box({3, 3, 3}, level, {-0.3, 0.1 + 0.1005, 0});
      two.add_box({3, 3, 3}, level, {0.3, 0.1 + 0.1005, 0});
      const Mat3 inertia = M * Vec3(0.1, 0.1, 0.1).asDiagonal();
      two.constraints.add(Obstacle{.shape = Box{.centre = Vec3::Zero(), .size = Vec3(1.2, 0.2, 0.8)},
                                   .friction = 0.0,
                                   .margin = 0,
                                   .restitution = e,
                                   .rigid = RigidBody{.mass = M, .inertia = inertia}});
      two.make({0, -g, 0});  // all fall
      for (const int b : {0, 1}) two.move(b, {0, -1, 0}, Vec3::Zero());
      const double m = two.body(0).mass;
      two.run(1e-3, 2, "restitution", 4);
      const double body = -(1 + e) * 2 * m / (2 * m + M) - g * 2e-3;
      INFO(M << " kg, e = " << e);
      CHECK(two.constraints.bodies()[0].reacting()->velocity()[1] == Approx(body).margin(2e-3));
      for (const int b : {0, 1}) CHECK(two.motion(b).velocity[1] == Approx(body + e).margin(2e-3));
    }
}

TEST_CASE("impulses that have not settled say so", "[clusters]") {
  for (const double ratio : {1.0, 1e6}) {  // a tower that is heavier by this above, pressed on what stands
    Impulses impulses;
    const ClusterMotion rest = Impulses::at_rest, falls = {-Vec3::UnitY(), Vec3::Zero()};
    int below = -1;
    for (int b = 0; b < 3; ++b) {
      const int body = impulses.add({.inverse_mass = 1 / std::pow(ratio, b),
                                     .inverse_inertia = Mat3::Zero(),
                                     .before = rest,
                                     .free = falls});
      impulses.hold(body, 1, Vec3::Zero());
      if (below >= 0) impulses.hold(below, -1, Vec3::Zero());
      impulses.add_point(Vec3::UnitY(), Vec3::Zero());
      below = body;
    }
    impulses.begin(Phase::support);
    const double left = impulses.settle(Phase::support);
    INFO("ratio " << ratio << ", left " << left);
    CHECK((left <= 1e-9) == (impulses.bodies().back().now.velocity.norm() < 1e-8));
    CHECK((left <= 1e-9) == (ratio == 1));
  }
}

TEST_CASE("clusters that meet move with the same bits on any number of threads", "[clusters][pbd]") {
  check_same_bits([] {
    Bodies two;
    const Quaternion turn(Eigen::AngleAxisd(0.3, Vec3(1, 1, 0.2).normalized()));
    two.add_box({12, 12, 12}, level, {0, 0, 0}, 0.02);
    two.add_box({12, 12, 12}, turn, {0.02, 0.5, 0.01}, 0.02);
    bring_together(two, 1e-3);
    two.let_meet(thickness, 0.3);
    two.constraints.add(Obstacle{.shape = Plane{{0, -0.1105, 0}, {0, 1, 0}}, .friction = 0.5, .margin = 0});
    two.make({0, -g, 0});
    two.move(1, {0.1, -1, 0}, {1, 2, 3});
    two.run(0.01, 3, "velocity", 5);
    return two.state;
  });
}

TEST_CASE("clusters that lie on each other allocate nothing", "[clusters][pbd]") {
  if (!counts_allocations()) return;
  Bodies all;
  all.add_box({3, 3, 3}, level, {0, 0.1, 0});
  all.add_box({3, 3, 3}, level, {0.013, 0.3 + thickness, 0.007});
  all.let_meet(thickness, 0.5);
  all.constraints.add(Obstacle{.shape = Plane{}, .friction = 0.5, .margin = 0});
  all.make({0, -g, 0});
  StepOptions options;
  auto stepper = make_integrator("pbd", *all.system, all.constraints, make_linear_solver("mpcg"), options);
  for (int n = 0; n < 20; ++n) stepper->advance(all.state, 0.01);
  const long before = allocations();
  for (int n = 0; n < 10; ++n) stepper->advance(all.state, 0.01);
  CHECK(allocations() - before == 0);
}
