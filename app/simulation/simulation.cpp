#include "app/simulation/simulation.h"

#include <algorithm>

#include "app/simulation/obstacles.h"
#include "app/simulation/parts.h"
#include "app/simulation/warnings.h"
#include "mesh/base/errors.h"

namespace drape::app {
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

Simulation make_simulation(const Scene& scene, bool keep_level_sets) {
  const SimulationOptions& options = scene.simulation;
  Simulation simulation(options.gravity, options.contact, options.air);
  simulation.scene = std::make_shared<const Scene>(scene);
  load_parts(scene, simulation);
  add_obstacles(scene, keep_level_sets, simulation);
  add_pins(scene, simulation);  // some of them to bodies
  simulation.use(options.integrator, options.linear_solver, options.step);
  add_warnings(scene, simulation);
  return simulation;
}

}  // namespace drape::app
