#include "app/simulation/simulation.h"

#include <algorithm>
#include <map>
#include <set>

#include "app/simulation/obstacles.h"
#include "app/simulation/parts.h"
#include "app/simulation/sheets.h"
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

// Neither is moved by a motion of its own, and both follow the same body or none.
bool surely_alike(const PinEntry& a, const PinEntry& b) {
  return a.follow == b.follow && !a.motion && !b.motion;
}

std::string place_of(const Cloth& cloth, int particle) {
  const int vertex = cloth.embedding.vertex(particle);
  return (vertex < 0 ? "a particle inside " : "vertex " + std::to_string(vertex) + " of ") +
         one_line(cloth.name);
}

// Of two pins that hold a particle the first one counts.
class PinsOfParticles {
 public:
  void add(const PinEntry& pin, const Cloth& cloth, Simulation& simulation) {
    for (int i : pinned_particles(pin.rule, cloth, simulation.state.x)) {
      const PinEntry* const first = first_.emplace(i, &pin).first->second;
      if (first == &pin || surely_alike(*first, pin) || !told_.emplace(first, &pin).second) continue;
      simulation.messages.push_back("warning: " + pin.where + ": " + place_of(cloth, i) +
                                    " is held by the pins of " + first->where +
                                    " already; it goes with those, and not with these");
    }
  }

 private:
  std::map<int, const PinEntry*> first_;
  std::set<std::pair<const PinEntry*, const PinEntry*>> told_;
};

void add_pins(const Scene& scene, Simulation& simulation) {
  PinsOfParticles all;
  for (std::size_t k = 0; k < simulation.cloths.size(); ++k) {
    const Cloth& cloth = simulation.cloths[k];
    for (const PinEntry& pin : scene.pins_of(k)) {
      try {
        pin_down(pin, cloth, scene, simulation);
        all.add(pin, cloth, simulation);
      } catch (const InputError& error) {
        throw InputError(pin.where + ": " + error.what());
      }
    }
  }
}

void add_anchors(const Scene& scene, Simulation& simulation) {
  const std::size_t before = scene.cloths.size() + scene.softs.size();
  for (std::size_t k = 0; k < scene.ropes.size(); ++k)
    anchor(scene.ropes[k], simulation.cloths[before + k], scene, simulation);
}

void rub(const Scene& scene, Simulation& simulation) {
  const auto number_of = [&](const std::string& name) {
    const auto cloth = std::find_if(simulation.cloths.begin(), simulation.cloths.end(),
                                    [&](const Cloth& one) { return one.name == name; });
    return static_cast<std::size_t>(cloth - simulation.cloths.begin());
  };
  for (const FrictionEntry& pair : scene.frictions)
    simulation.set_friction(number_of(pair.between[0]), number_of(pair.between[1]), pair.friction);
}

void require_clean(const Scene& scene, const Simulation& simulation) {
  const Sheets sheets(simulation.cloths, simulation.state.x);
  const std::vector<CrossingContour> contours = sheets.contours();
  if (contours.empty()) return;
  const auto [first, second] = contours.front().pairs.front();
  const Vec3& place = contours.front().place;
  throw InputError(
      scene.label + ": require_clean: " + counted(crossing_count(contours), "pair") +
      " of triangles cross at the start, such as " + one_line(sheets.name_of(first)) + " with " +
      (sheets.name_of(first) == sheets.name_of(second) ? "itself" : one_line(sheets.name_of(second))) +
      " at (" + rounded(place[0], 4) + ", " + rounded(place[1], 4) + ", " + rounded(place[2], 4) +
      ") m; 'drape check' lists them");
}

}  // namespace

Simulation make_simulation(const Scene& scene, bool keep_level_sets) {
  const SimulationOptions& options = scene.simulation;
  Simulation simulation(options.gravity, options.contact, options.air);
  simulation.scene = std::make_shared<const Scene>(scene);
  load_parts(scene, simulation);
  add_obstacles(scene, keep_level_sets, simulation);
  add_anchors(scene, simulation);
  add_pins(scene, simulation);  // some of them to bodies
  rub(scene, simulation);
  if (options.require_clean) require_clean(scene, simulation);
  simulation.use(options.integrator, options.linear_solver, options.step);
  add_warnings(scene, simulation);
  return simulation;
}

}  // namespace drape::app
