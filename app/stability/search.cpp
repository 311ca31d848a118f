#include "app/stability/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "app/simulation/time_loop.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

// Round numbers of their own: the standard's distributions differ from library to library.
void shake(const Simulation& simulation, double speed, State& state) {
  std::mt19937 engine(1);
  const Constraints& constraints = *simulation.constraints;
  for (int i = 0; i < state.particles(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double random = static_cast<double>(engine()) / 2147483648.0 - 1;
      const bool held = std::binary_search(constraints.pinned().begin(), constraints.pinned().end(), i);
      if (!held && simulation.system->masses()[i] > 0) state.v[3 * i + k] += speed * random;
    }
}

// The rule of stability, step by step.
class EnergyWatch {
 public:
  EnergyWatch(const Simulation& simulation, double h) : s_(simulation) {
    start_gravity_ = lowest_ = s_.system->gravity_energy(s_.state.x);
    given_ = s_.system->kinetic_energy(s_.state.v) + s_.system->stored_energy(s_.state.x);
    start_ = given_ + start_gravity_;
    const double mass = std::accumulate(s_.system->masses().begin(), s_.system->masses().end(), 0.0);
    const double fall = h * s_.system->gravity_acceleration().norm();
    given_ += mass * fall * fall;
  }
  // What has been made, as a part of what was given.
  double growth() {
    const double work = s_.constraints->work() + s_.given - seams_,
                 gravity = s_.system->gravity_energy(s_.state.x);
    seams_ = s_.given;
    work_ += work;
    given_ += std::max(0.0, work);
    lowest_ = std::min(lowest_, gravity);
    const double now = s_.system->kinetic_energy(s_.state.v) + s_.system->stored_energy(s_.state.x) + gravity;
    const double made = now - work_ - start_, given = given_ + start_gravity_ - lowest_;
    return made <= 0 && given == 0 ? 0 : made / given;
  }

 private:
  const Simulation& s_;
  double start_ = 0, start_gravity_ = 0, lowest_ = 0, given_ = 0, work_ = 0, seams_ = 0;  // J
};

struct Trial {
  bool stable = true;
  std::string failure;
  long steps_cut = 0;
};

Trial run_at(const Scene& scene, double h, const StabilityOptions& options) {
  Trial trial;
  Simulation simulation = make_simulation(scene);
  shake(simulation, options.shake, simulation.state);
  EnergyWatch watch(simulation, h);
  const double steps = std::ceil(options.time / h * (1 - 1e-9));  // all of them whole
  TimeLoop loop(simulation, Schedule(StepGrid(h), 0, steps * h));
  march(loop, [&](const StepReport& report) {
    const std::string at = "step " + std::to_string(loop.number()) + " (" +
                           rounded(static_cast<double>(loop.number()) * h, 3) + " s): ";
    trial.steps_cut += report.substeps > 1 ? 1 : 0;
    double growth = 0;
    if (!report.done)
      trial.failure = at + one_line(report.failure.what);
    else if (growth = watch.growth(); !(growth <= options.growth))
      trial.failure = at + "energy has been made, " + rounded(growth, 2) + " times what was given";
    trial.stable = trial.failure.empty();
    return trial.stable;
  });
  return trial;
}

// The scene with this integrator; contact as the scene asks, where the integrator can.
Scene with_integrator(Scene scene, const std::string& integrator) {
  scene.simulation.integrator = integrator;
  try {
    contact_mode(integrator, scene.simulation.step.contact);
  } catch (const InputError&) {
    scene.simulation.step.contact.reset();
  }
  return scene;
}

std::optional<double> theory_of(const std::string& integrator, const Spectrum& spectrum) {
  for (const Tableau& tableau : tableaux())
    if (tableau.name == integrator) return step_limit(tableau, spectrum);
  return {};
}

}  // namespace

Spectrum spectrum_of(const Scene& scene) {
  Simulation simulation = make_simulation(scene);
  return stiffest_modes(*simulation.system, *simulation.constraints, simulation.state);
}

std::optional<StabilityRow> largest_stable_step(const Scene& given, const std::string& integrator,
                                                const StabilityOptions& options, const Spectrum& spectrum) {
  const Scene scene = with_integrator(given, integrator);
  StabilityRow row;
  row.integrator = integrator;
  row.contact = name(contact_mode(integrator, scene.simulation.step.contact));
  row.theory = theory_of(integrator, spectrum);
  const auto stable = [&](double h) {
    const Trial trial = run_at(scene, h, options);
    ++row.runs;
    if (trial.stable)
      row.largest = h, row.steps_cut = trial.steps_cut;
    else
      row.limited = true, row.failure = trial.failure;
    return trial.stable;
  };
  const bool limit_known = row.theory && *row.theory > 0 && std::isfinite(*row.theory);
  double h =
      std::clamp(limit_known ? *row.theory : scene.simulation.time_step, options.shortest, options.longest);
  double good = 0, bad = std::numeric_limits<double>::infinity();
  while (!interrupted()) {  // a bracket
    (stable(h) ? good : bad) = h;
    if (good >= options.longest || (good == 0 && bad <= options.shortest) || (good > 0 && std::isfinite(bad)))
      break;
    h = good > 0 ? std::min(options.longest, (limit_known ? 1.1 : 2.0) * good)
                 : std::max(options.shortest, (limit_known && row.runs == 1 ? 0.9 : 0.5) * bad);
  }
  while (!interrupted() && good > 0 && std::isfinite(bad) && bad > (1 + options.precision) * good) {
    const double middle = std::sqrt(good * bad);
    (stable(middle) ? good : bad) = middle;
  }
  if (interrupted()) return {};
  return row;
}

}  // namespace drape::app
