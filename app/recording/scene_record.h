// What was run: fabrics, pins, seams, friction and margins after all defaults and settings, in SI units. It
// goes into run.json and compare.json, and in words onto the pages made from them.
#pragma once

#include <string>
#include <vector>

#include "app/base/json.h"
#include "app/simulation/simulation.h"

namespace drape::app {

// cloth: the same, made ready to run; null when it is not, and then a warp that is chosen by its mesh is not
// known.
Json fabric_json(const ClothEntry& entry, const Cloth* cloth);
Json material_json(const SoftMaterial& material);
Json rope_material_json(const RopeMaterial& material);
Json ends_json(const RopeEntry& entry);  // those that are anchored or joined
Json pins_json(const std::vector<PinEntry>& pins, const Cloth& cloth);
Json seams_json(const Cloth& cloth);  // those that are open
Json settings_json(const std::vector<Setting>& settings);
Json::Members contact_json(const Obstacle& obstacle);           // friction, margin, restitution
Json::Members numerics_json(const SimulationOptions& options);  // what the steps are made with

// The cloths, soft bodies, ropes and bodies of a scene with all of these, as run.json has them. Pins and
// seams are included where `simulation` is that of the scene; it is null when there is none.
Json::Members scene_json(const Scene& scene, const Simulation* simulation);

struct SceneFact {
  std::string name, value;  // "Fabric of sheet", "cotton-poplin, noh-jung, 0.11 kg/m^2, ..."
};
// Reads these facts from run.json or compare.json. The list is empty when the file has none, such as a file
// of an earlier version.
std::vector<SceneFact> scene_facts(const Json& run);

}  // namespace drape::app
