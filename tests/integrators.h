// What the laws need to know of each integrator of the build, and small systems to try them on.
#pragma once

#include <array>
#include <catch2/catch.hpp>
#include <string_view>

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
const Traits& traits_of(std::string_view name);
int order_of(std::string_view name);
bool is_explicit(std::string_view name);
// Whether it answers contact after the motion, and in no other way.
bool only_responds(std::string_view name);
bool bears_stiff(std::string_view name);

std::vector<std::string> integrator_names();

// An integrator with one way of treating contact.
struct Method {
  std::string name, label;
  std::optional<ContactMode> contact;  // none: its own

  StepOptions options(StepOptions others = {}) const;
};

// All integrators in their own way, and the explicit ones with constraints, too.
std::vector<Method> methods();

// A system that stays in one smooth branch of its forces, where it begins, and how long to follow it.
struct Course {
  System system;
  Constraints constraints;
  State start;
  double duration;  // s
};

// A mass on a soft spring that swings and bounces, always taut.
Course pendulum();

// A sheet stretched by a tenth in its frame, with a bump.
Course drum();

// A mass balanced on a buckled connection, falling over: the stiffness of the step leaves out what is
// negative in the true one, and puts a chord in the place of the slope.
Course buckled();

// The motion by a classical Runge-Kutta method written here, with steps far below any used in a test.
State fine_reference(const Course& m, int steps = 4000);

StepOptions precise();

// The end of the motion in so many steps.
State run(Course& m, std::string_view name, int steps, StepOptions options = precise());

double distance(const State& a, const State& b);

}  // namespace drape::test
