#include "tests/integrators.h"

#include <stdexcept>

#include "solver/forces/buckling_spring.h"
#include "solver/forces/tension_spring.h"

namespace drape::test {

const Traits& traits_of(std::string_view name) {
  for (const Traits& t : traits)
    if (t.name == name) return t;
  throw std::logic_error("tests/integrators.h knows no integrator " + std::string(name));
}

int order_of(std::string_view name) { return traits_of(name).order; }

bool is_explicit(std::string_view name) { return traits_of(name).is_explicit; }

bool only_responds(std::string_view name) { return name == "pbd"; }

bool bears_stiff(std::string_view name) { return traits_of(name).bears_stiff; }

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const IntegratorInfo& info : integrators()) names.emplace_back(info.name);
  return names;
}

StepOptions Method::options(StepOptions others) const {
  others.contact = contact;
  return others;
}

std::vector<Method> methods() {
  std::vector<Method> all;
  for (const std::string& name : integrator_names()) all.push_back({name, name, {}});
  for (const std::string& name : integrator_names())
    if (is_explicit(name)) all.push_back({name, name + " with constraints", ContactMode::constraint});
  return all;
}

Course pendulum() {
  Course m{System({0.0, 0.5}), Constraints(), {0, VecX::Zero(6), VecX::Zero(6)}, 1};
  m.system.add(std::make_unique<PairForce<TensionSpring>>(
      std::vector<PairForce<TensionSpring>::Element>{{0, 1, {1, 40}}}));
  m.system.add(Gravity{});
  m.start.x.segment<3>(3) = Vec3(0.6, -1, 0.1);
  m.start.v.segment<3>(3) = Vec3(0.2, 0.1, 0.5);
  return m;
}

Course drum() {
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

Course buckled() {
  Course m{System({0.0, 0.2}), Constraints(), {0, VecX::Zero(6), VecX::Zero(6)}, 0.4};
  m.system.add(std::make_unique<PairForce<BucklingSpring>>(
      std::vector<PairForce<BucklingSpring>::Element>{{0, 1, BucklingSpring::rest(1, 0.15, 1e9)}}));
  m.system.add(Gravity{});
  m.start.x.segment<3>(3) = Vec3(0.3, 0.6, 0.05);
  m.start.v.segment<3>(3) = Vec3(-0.4, 0.1, 0.3);
  return m;
}

State fine_reference(const Course& m, int steps) {
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

StepOptions precise() { return {.newton_tolerance = 1e-12, .tolerance = 1e-12}; }

State run(Course& m, std::string_view name, int steps, StepOptions options) {
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

double distance(const State& a, const State& b) {
  return std::max((a.x - b.x).cwiseAbs().maxCoeff(), 0.1 * (a.v - b.v).cwiseAbs().maxCoeff());
}

}  // namespace drape::test
