#include "app/simulation/simulation.h"

#include <algorithm>

#include "app/simulation/assembly.h"
#include "app/simulation/obstacles.h"
#include "app/simulation/warnings.h"
#include "mesh/base/errors.h"

namespace drape {
namespace {

void pin_down(const PinEntry& pin, const Cloth& cloth, const Scene& scene, Simulation& simulation) {
  const std::vector<int> particles = pinned_particles(pin.rule, cloth, simulation.state.x);
  Constraints& constraints = *simulation.constraints;
  if (pin.motion) return constraints.pin_along(particles, *pin.motion, simulation.state.x);
  if (pin.follow.empty()) return constraints.pin(particles);
  const auto body = std::find_if(scene.obstacles.begin(), scene.obstacles.end(),
                                 [&](const ObstacleEntry& o) { return o.name == pin.follow; });
  constraints.pin_to_body(particles, static_cast<int>(body - scene.obstacles.begin()), simulation.state.x);
}

void add_pins(const Scene& scene, Simulation& simulation) {
  for (std::size_t k = 0; k < simulation.cloths.size(); ++k) {
    const Cloth& cloth = simulation.cloths[k];
    for (const PinEntry& pin : scene.pins_of(k)) {
      try {
        pin_down(pin, cloth, scene, simulation);
      } catch (const InputError& error) {
        throw InputError(pin.where + ": " + error.what());
      }
    }
  }
}

}  // namespace

StepReport Simulation::advance(double h) {
  bool open = false;
  for (Cloth& cloth : cloths)
    for (Cloth::Stitched& stitched : cloth.seams) {
      open = true;
      if (!stitched.force) continue;
      const double before = stitched.force->energy(state.x);
      close_until(*stitched.force, stitched.seam, state.time + h);
      const double more = stitched.force->energy(state.x) - before;
      integrator->count_given(std::max(0.0, more));
      given += more;
    }
  const StepReport report = integrator->advance(state, h);
  if (!open || !report.done) return report;
  const auto energy = [&] {
    return system->kinetic_energy(state.v) + system->elastic_energy(state.x) +
           system->gravity_energy(state.x);
  };
  const double before = energy();
  if (merge_closed_seams(*this)) {
    integrator = make_integrator(*system, *constraints);
    given += energy() - before;
  }
  return report;
}

void Simulation::use(std::function<std::unique_ptr<Integrator>(System&, Constraints&)> make) {
  make_integrator = std::move(make);
  integrator = make_integrator(*system, *constraints);
}

const Cloth& Simulation::cloth_of(int particle) const {
  const auto after =
      std::find_if(cloths.begin(), cloths.end(), [&](const Cloth& c) { return particle < c.end_particle; });
  return after == cloths.end() ? cloths.back() : *after;
}

Simulation make_simulation(const Scene& scene, bool keep_level_sets) {
  Simulation simulation;
  simulation.scene = std::make_shared<const Scene>(scene);
  simulation.constraints = std::make_unique<Constraints>(scene.simulation.contact);
  Particles particles = load_particles(scene, simulation);
  add_obstacles(scene, keep_level_sets, simulation);
  add_faces(scene, particles, simulation);
  add_pins(scene, simulation);  // some of them to bodies
  assemble(simulation, std::move(particles.masses), simulation.messages);
  add_warnings(scene, simulation);
  simulation.use([options = scene.simulation](System& system, Constraints& constraints) {
    return make_integrator(options.integrator, system, constraints, make_linear_solver(options.linear_solver),
                           options.step);
  });
  return simulation;
}

}  // namespace drape
