// What the laws need to know of each integrator of the build, and small systems to try them on.
#pragma once

#include <array>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <string_view>

#include "solver/forces/buckling_spring.h"
#include "tests/tables.h"

namespace drape::test {

// What the laws take an integrator for. A new one gets a line here, and with it every test.
struct Traits {
  std::string_view name;
  int order;                // 0: inner steps of its own choice, to a tolerance
  bool is_explicit;         // its step is bounded by the stiffest vibration, and needs no solve
  bool bears_stiff;         // steps far longer than the stiffest vibration are stable
  bool foresees;            // contact is found along the motion, within the solve
  bool grows_undamped;      // unstable on a vibration without damping, however short the step
  double momentum_kept_to;  // relative, of cloth and a body that reacts together
};
inline constexpr std::array<Traits, 13> traits = {{
    {"implicit-euler", 1, false, true, true, false, 1e-6},
    {"bdf2", 2, false, true, true, false, 0.1},
    {"pbd", 1, false, true, false, false, 1e-2},
    {"explicit-euler", 1, true, false, false, true, 1e-6},
    {"symplectic-euler", 1, true, false, false, false, 1e-6},
    {"midpoint", 2, true, false, false, true, 1e-6},
    {"sb-implicit", 1, true, false, false, false, 1e-6},
    {"rk4", 4, true, false, false, false, 1e-6},
    {"newton-kinsol", 1, false, true, true, false, 1e-6},
    {"cvode-bdf", 0, false, true, false, false, 0.1},
    {"cvode-adams", 0, false, false, false, false, 0.1},
    {"arkode-erk", 0, false, false, false, false, 0.1},
    {"arkode-dirk", 0, false, true, false, false, 0.1},
}};
inline const Traits& traits_of(std::string_view name) {
  for (const Traits& t : traits)
    if (t.name == name) return t;
  throw std::logic_error("tests/integrators.h knows no integrator " + std::string(name));
}
inline int order_of(std::string_view name) { return traits_of(name).order; }
inline bool is_explicit(std::string_view name) { return traits_of(name).is_explicit; }
// Whether it answers contact after the motion, and in no other way.
inline bool only_responds(std::string_view name) { return name == "pbd"; }
inline bool bears_stiff(std::string_view name) { return traits_of(name).bears_stiff; }

inline std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const IntegratorInfo& info : integrators()) names.emplace_back(info.name);
  return names;
}

// An integrator with one way of treating contact.
struct Method {
  std::string name, label;
  std::optional<ContactMode> contact;  // none: its own

  StepOptions options(StepOptions others = {}) const {
    others.contact = contact;
    return others;
  }
};

// All integrators in their own way, and the explicit ones with constraints, too.
inline std::vector<Method> methods() {
  std::vector<Method> all;
  for (const std::string& name : integrator_names()) all.push_back({name, name, {}});
  for (const std::string& name : integrator_names())
    if (is_explicit(name)) all.push_back({name, name + " with constraints", ContactMode::constraint});
  return all;
}

// A system that stays in one smooth branch of its forces, where it begins, and how long to follow it.
struct Course {
  System system;
  Constraints constraints;
  State start;
  double duration;  // s
};

// A mass on a soft spring that swings and bounces, always taut.
inline Course pendulum() {
  Course m{System({0.0, 0.5}), Constraints(), {0, VecX::Zero(6), VecX::Zero(6)}, 1};
  m.system.add(std::make_unique<PairForce<TensionSpring>>(
      std::vector<PairForce<TensionSpring>::Element>{{0, 1, {1, 40}}}));
  m.system.add(Gravity{});
  m.start.x.segment<3>(3) = Vec3(0.6, -1, 0.1);
  m.start.v.segment<3>(3) = Vec3(0.2, 0.1, 0.5);
  return m;
}

// A sheet stretched by a tenth in its frame, with a bump.
inline Course drum() {
  const TriangleMesh mesh = grid(5, 5, 0.4, 0.4);
  const Fabric fabric{.area_density = 0.2, .stretch = 30, .damping = 2e-3};
  Course m{System(lumped_mass(mesh, 0.2)), Constraints(), at_rest(mesh), 0.1};
  m.system.add(noh_jung(mesh, fabric));
  m.system.add(Gravity{});
  m.start.x *= 1.1;
  for (int i = 0; i < 25; ++i) {
    if (i % 5 == 0 || i % 5 == 4 || i < 5 || i >= 20)
      m.constraints.pin(i);
    else
      m.start.x[3 * i + 1] += 0.01 * (i % 3);
  }
  return m;
}

// A mass balanced on a buckled connection, falling over: the stiffness of the step leaves out what is
// negative in the true one, and puts a chord in the place of the slope.
inline Course buckled() {
  Course m{System({0.0, 0.2}), Constraints(), {0, VecX::Zero(6), VecX::Zero(6)}, 0.4};
  m.system.add(std::make_unique<PairForce<BucklingSpring>>(
      std::vector<PairForce<BucklingSpring>::Element>{{0, 1, BucklingSpring::rest(1, 0.15, 1e9)}}));
  m.system.add(Gravity{});
  m.start.x.segment<3>(3) = Vec3(0.3, 0.6, 0.05);
  m.start.v.segment<3>(3) = Vec3(-0.4, 0.1, 0.3);
  return m;
}

// The motion by a classical Runge-Kutta method written here, with steps far below any used in a test.
inline State fine_reference(const Course& m, int steps = 4000) {
  State s = m.start;
  const double h = m.duration / steps;
  std::vector<char> held(static_cast<std::size_t>(s.particles()), 0);
  for (int i : m.constraints.pinned()) held[i] = 1;
  const auto acceleration = [&](const VecX& x, const VecX& v) {
    VecX a = m.system.force(x, v);
    for (int i = 0; i < s.particles(); ++i) {
      const double mass = m.system.masses()[i];
      const bool fixed = mass == 0 || held[i] != 0;
      a.segment<3>(3 * i) *= fixed ? 0 : 1 / mass;
    }
    return a;
  };
  for (int n = 0; n < steps; ++n) {
    const VecX a1 = acceleration(s.x, s.v), v1 = s.v;
    const VecX v2 = s.v + 0.5 * h * a1, a2 = acceleration(s.x + 0.5 * h * v1, v2);
    const VecX v3 = s.v + 0.5 * h * a2, a3 = acceleration(s.x + 0.5 * h * v2, v3);
    const VecX v4 = s.v + h * a3, a4 = acceleration(s.x + h * v3, v4);
    s.x += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    s.v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  s.time = m.duration;
  return s;
}

inline StepOptions precise() { return {.newton_tolerance = 1e-12, .tolerance = 1e-12}; }

// The end of the motion in so many steps.
inline State run(Course& m, std::string_view name, int steps, StepOptions options = precise()) {
  State s = m.start;
  Constraints constraints = m.constraints;
  auto stepper = make_integrator(name, m.system, constraints, make_linear_solver("eigen-ldlt"), options);
  for (int n = 0; n < steps; ++n) {
    const StepReport report = stepper->advance(s, m.duration / steps);
    INFO(name << ", step " << n << " of " << steps << ": " << report.failure.what);
    REQUIRE(report.done);
  }
  return s;
}

inline double distance(const State& a, const State& b) {
  return std::max((a.x - b.x).cwiseAbs().maxCoeff(), 0.1 * (a.v - b.v).cwiseAbs().maxCoeff());
}

}  // namespace drape::test
