// The integrator "pbd" on sheets of 1 m that swing down from two corners: 0.2 kg/m^2, 1000 N/m, 10 uN.m,
// springs; steps of 10 ms in 30 substeps of one iteration. Beside it the same springs by a plain loop, in the
// order of the mesh and in one thread, as one would write it first; the same sheet with faces that are
// clusters; and implicit Euler. Strain: the largest of an edge at the end. Arguments: SIDE ... (vertices
// along an edge; 32, 100 and 200 unless given), --steps N (100).
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "mesh/base/stopwatch.h"
#include "mesh/base/threads.h"
#include "solver/drape.h"
#include "solver/forces/buckling_spring.h"
#include "solver/forces/face_clusters.h"
#include "solver/forces/noh_jung.h"
#include "solver/forces/tension_spring.h"
#include "tests/bench/bench.h"

namespace {

using namespace drape;

constexpr double h = 0.01;
constexpr int substeps = 30;
const Fabric fabric{.area_density = 0.2, .stretch = 1000, .bend = 1e-5};

struct Hung {
  TriangleMesh mesh;
  System system;
  Constraints constraints;
  State state;

  explicit Hung(int side, bool clusters = false)
      : mesh(grid(side, side, 1, 1)), system(lumped_mass(mesh, fabric.area_density)), state(at_rest(mesh)) {
    system.add(clusters ? clustered_noh_jung(mesh, mesh, fabric) : noh_jung(mesh, fabric));
    system.add(Gravity{});
    constraints.pin({0, side - 1});
  }
};

struct Measured {
  double seconds;  // for a simulated second
  double strain;
};

double strain(const TriangleMesh& mesh, const VecX& x) {
  double largest = 0;
  for (const Edge& e : edges(mesh)) {
    const auto [i, j] = std::pair(e.a, e.b);
    const double L =
        (mesh.positions[static_cast<std::size_t>(i)] - mesh.positions[static_cast<std::size_t>(j)]).norm();
    largest = std::max(largest, (x.segment<3>(3 * i) - x.segment<3>(3 * j)).norm() / L - 1);
  }
  return largest;
}

Measured by_integrator(const char* name, int side, int steps, int thread_count, bool clusters = false) {
  set_threads(thread_count);
  Hung sheet(side, clusters);
  StepOptions options{.tolerance = 1e-4};
  options.projection.substeps = substeps;
  auto stepper = make_integrator(name, sheet.system, sheet.constraints, make_linear_solver("auto"), options);
  double ms = 0;
  for (int k = 0; k < steps; ++k) ms += stepper->advance(sheet.state, h).step_ms;
  return {ms / 1000 / (steps * h), strain(sheet.mesh, sheet.state.x)};
}

// Every spring in the order of the mesh, with nothing done to make it fast.
class PlainLoop {
 public:
  explicit PlainLoop(const Hung& sheet) : mass_(sheet.system.masses()) {
    for (const auto& force : sheet.system.forces()) {
      if (const auto* s = dynamic_cast<const PairForce<TensionSpring>*>(force.get()))
        stretch_ = s->elements();
      if (const auto* b = dynamic_cast<const PairForce<BucklingSpring>*>(force.get())) bend_ = b->elements();
    }
    for (int i : sheet.constraints.pinned()) mass_[static_cast<std::size_t>(i)] = 1e300;
    for (int i = 0; i < sheet.state.particles(); ++i) {
      x_.push_back(sheet.state.x.segment<3>(3 * i));
      v_.emplace_back(0, 0, 0);
    }
    before_ = x_;
  }

  void step(double dt) {
    before_ = x_;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (mass_[i] < 1e200) v_[i].y() -= 9.81 * dt;
      x_[i] += dt * v_[i];
    }
    project<TensionSpring>(stretch_, dt);
    project<BucklingSpring>(bend_, dt);
    for (std::size_t i = 0; i < x_.size(); ++i) v_[i] = (x_[i] - before_[i]) / dt;
  }
  const std::vector<Vec3>& positions() const { return x_; }

 private:
  template <class Spring, class Elements>
  void project(const Elements& elements, double dt) {
    for (const auto& e : elements) {
      const auto i = static_cast<std::size_t>(e.particles[0]), j = static_cast<std::size_t>(e.particles[1]);
      const double wi = 1 / mass_[i], wj = 1 / mass_[j];
      const Vec3 d = x_[i] - x_[j];
      const double l = d.norm();
      const Tension law = Spring::tension(e.rest, l);
      const double k = std::max(law.dt, Spring::chord(e.rest, l));
      const Vec3 push = -dt * dt * law.t / (1 + dt * dt * (wi + wj) * k) / l * d;
      x_[i] += wi * push;
      x_[j] -= wj * push;
    }
  }

  std::vector<double> mass_;
  std::vector<PairForce<TensionSpring>::Element> stretch_;
  std::vector<PairForce<BucklingSpring>::Element> bend_;
  std::vector<Vec3> x_, v_, before_;
};

Measured by_plain_loop(int side, int steps) {
  Hung sheet(side);
  PlainLoop loop(sheet);
  double ms = 0;
  {
    const Stopwatch watch(ms);
    for (int k = 0; k < steps * substeps; ++k) loop.step(h / substeps);
  }
  return {ms / 1000 / (steps * h), strain(sheet.mesh, stacked(loop.positions()))};
}

}  // namespace

int main(int count, char** arguments) {
  std::vector<int> sides;
  int steps = 100;
  for (int k = 1; k < count; ++k) {
    if (std::string(arguments[k]) == "--steps" && k + 1 < count)
      steps = std::atoi(arguments[++k]);
    else
      sides.push_back(std::atoi(arguments[k]));
  }
  if (sides.empty()) sides = {32, 100, 200};
  std::printf(
      "| vertices | | threads | s per simulated second | largest strain | plain loop over this |\n"
      "| --- | --- | --- | --- | --- | --- |\n");
  for (int side : sides) {
    const Measured plain = by_plain_loop(side, steps);
    const auto row = [&](const char* what, int threads, const Measured& m) {
      std::printf("| %d | %s | %d | %.2g | %.2g %% | %.2f |\n", side * side, what, threads, m.seconds,
                  100 * m.strain, plain.seconds / m.seconds);
      std::fflush(stdout);
    };
    row("plain loop", 1, plain);
    for (int threads : {1, 2}) row("`pbd`", threads, by_integrator("pbd", side, steps, threads));
    for (int threads : {1, 2})
      row("`pbd`, clusters", threads, by_integrator("pbd", side, steps, threads, true));
    for (int threads : {1, 2})
      row("`implicit-euler`", threads, by_integrator("implicit-euler", side, steps, threads));
  }
}
