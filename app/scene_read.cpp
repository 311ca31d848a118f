#include <algorithm>
#include <cmath>

#include "app/fabrics.h"
#include "app/motion_read.h"
#include "app/obstacle_read.h"
#include "app/scene.h"
#include "app/sewing_read.h"
#include "app/soft_read.h"
#include "app/table.h"
#include "mesh/obj.h"

namespace drape {
namespace {

namespace fs = std::filesystem;

template <class Infos>
Names names_of(const Infos& infos) {
  Names names;
  for (const auto& info : infos) names.emplace_back(info.name);
  return names;
}

void read_step(Table& table, StepOptions& step) {
  table.read("newton_iterations", step.newton_iterations, 1);
  table.read("newton_tolerance", step.newton_tolerance, dimension::number, Range::positive);
  table.read("tolerance", step.tolerance, dimension::number, Range::positive);
  if (!(step.tolerance < 1))
    table.fail("tolerance", "expected a part of the residual, less than 1, such as 1e-6");
  table.read("max_linear_iterations", step.max_linear_iterations, 0);
  table.read("max_contact_solves", step.max_contact_solves, 1);
  table.read("max_halvings", step.max_halvings, 0);
  table.read("relative_tolerance", step.relative_tolerance, dimension::number, Range::positive);
  table.read("absolute_tolerance_position", step.absolute_tolerance_position, dimension::length,
             Range::positive);
  table.read("absolute_tolerance_velocity", step.absolute_tolerance_velocity, dimension::speed,
             Range::positive);
  table.read("max_inner_steps", step.max_inner_steps, 1);
}

void read_contact(Table& table, SimulationOptions& options) {
  const Node* const node = table.take("contact");
  if (!node) return;
  std::string word;
  table.read("contact", word, names_of(contact_modes()));
  for (const ContactModeInfo& info : contact_modes())
    if (word == info.name) options.step.contact = info.mode;
  try {
    contact_mode(options.integrator, options.step.contact);
  } catch (const InputError& error) {
    throw InputError(node->where + ": " + error.what());
  }
}

SimulationOptions read_simulation(const Table* given) {
  SimulationOptions options;
  if (!given) return options;
  Table table = *given;
  table.read("duration", options.duration, dimension::time, Range::positive);
  table.read("time_step", options.time_step, dimension::time, Range::positive);
  table.read("frame_rate", options.frame_rate, dimension::rate, Range::not_negative);
  table.read("gravity", options.gravity, dimension::acceleration);
  table.read("integrator", options.integrator, names_of(integrators()));
  table.read("linear_solver", options.linear_solver, names_of(linear_solvers()));
  read_contact(table, options);
  read_step(table, options.step);
  table.read("recovery_speed", options.contact.recovery_speed, dimension::speed, Range::positive);
  table.read("threads", options.threads, 1);
  table.read("stop_when_settled", options.stop_when_settled);
  table.read("settle_speed", options.settle_speed, dimension::speed, Range::positive);
  table.finish();
  if (options.frame_rate * options.time_step > 10)
    table.fail("frame_rate",
               "is more than ten frames a step of " + rounded(options.time_step, 4) + " s; check the units");
  if (options.duration / options.time_step > 1e9)
    table.fail(
        table.has("time_step") ? "time_step" : "duration",
        "the run would take " + rounded(options.duration / options.time_step, 3) + " steps; check the units");
  return options;
}

// A name becomes a file name.
std::string read_name(Table& table, const fs::path& mesh) {
  std::string name = mesh.stem().string();
  table.read("name", name);
  const bool good =
      !name.empty() && name.front() != '.' &&
      std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 32 || c == '/' || c == '\\'; });
  if (!good)
    table.fail("name", "a name is used for files: it may not be empty, begin with a dot or hold a slash");
  return name;
}

PinRule read_pin_rule(Table& pin) {
  if (pin.has("vertices") + pin.has("box") + pin.has("group") != 1)
    pin.fail("", "expected one of vertices = [...], box = [[...], [...]], group = \"...\"");
  PinVertices by_number;
  PinGroup by_group;
  pin.read("vertices", by_number.vertices);
  pin.read("group", by_group.name);
  const Node* box = pin.take("box");
  if (pin.has("vertices")) return by_number;
  if (pin.has("group")) return by_group;
  if (box->kind != Node::Kind::array || box->items.size() != 2)
    pin.fail("box", "expected two corners, [[x, y, z], [x, y, z]]");
  PinBox by_box;
  try {
    by_box.lower = vector(box->items[0], dimension::length);
    by_box.upper = vector(box->items[1], dimension::length);
  } catch (const InputError& error) {
    pin.fail("box", error.what());
  }
  if ((by_box.lower.array() > by_box.upper.array()).any())
    pin.fail("box", "the first corner must be the lower one");
  return by_box;
}

PinEntry read_pin(Table& pin, const fs::path& folder) {
  for (const char* key : {"vertices", "box", "group", "follow", "motion"}) pin.take(key);
  pin.finish();
  PinEntry entry{read_pin_rule(pin), pin.where(), {}, {}, {}};
  pin.read("follow", entry.follow);
  if (pin.has("follow") && entry.follow.empty()) pin.fail("follow", "expected the name of an obstacle");
  if (pin.has("follow") && pin.has("motion"))
    pin.fail("follow", "a pin follows a body or has a motion of its own, not both");
  entry.motion = read_motion(pin, folder, Vec3::Zero(), entry.source);
  return entry;
}

ClothEntry read_cloth(Table& table, const fs::path& folder) {
  ClothEntry cloth;
  cloth.where = table.where();
  cloth.mesh = read_path(table, "mesh", folder);
  cloth.name = read_name(table, cloth.mesh);
  cloth.placement = read_placement(table);
  for (const char* key : {"edge", "min_angle"})
    if (table.has(key) && !is_pattern(cloth.mesh))
      table.fail(key, "is of a pattern (.svg or .toml) as mesh; an OBJ file has its edges");
  table.read("edge", cloth.pattern.edge, dimension::length, Range::positive);
  table.read("min_angle", cloth.pattern.min_angle, dimension::angle, Range::not_negative);
  std::string rest = is_pattern(cloth.mesh) ? "uv" : "mesh";
  table.read("rest", rest, Names{"mesh", "uv"});
  cloth.rest_is_flat = rest == "uv";
  table.read("uv_scale", cloth.uv_scale, dimension::length, Range::positive);
  if (table.has("uv_scale") && !cloth.rest_is_flat) table.fail("uv_scale", "goes with rest = \"uv\"");
  cloth.panels = read_panels(table);
  cloth.seams = read_seams(table);
  table.read("model", cloth.model, model_names());
  if (!cloth.seams.empty() && cloth.model != "noh-jung")
    table.fail("model", "a cloth with seams is no regular grid; expected \"noh-jung\"");
  table.read("fabric", cloth.fabric_name, fabric_names());
  if (!cloth.fabric_name.empty()) cloth.fabric = load_fabric(cloth.fabric_name).fabric;
  read_fabric(table, cloth.fabric);
  for (Table& pin : table.tables("pins")) cloth.pins.push_back(read_pin(pin, folder));
  table.finish();
  return cloth;
}

SoftEntry read_whole_soft(Table& table, const fs::path& folder) {
  SoftEntry soft = read_soft(table, folder);
  soft.name = read_name(table, soft.mesh.empty() ? fs::path("soft") : soft.mesh);
  for (Table& pin : table.tables("pins")) soft.pins.push_back(read_pin(pin, folder));
  table.finish();
  return soft;
}

// Cloths and soft bodies are written side by side.
void check_names(const Scene& scene) {
  std::vector<std::pair<std::string, std::string>> named;  // and where
  const auto add = [&](const std::string& name, const std::string& where, const char* kind) {
    for (const auto& before : named)
      if (before.first == name)
        throw InputError(where + ": two " + kind + " are called '" + name + "'; give one another name");
    named.emplace_back(name, where);
  };
  for (const ClothEntry& cloth : scene.cloths) add(cloth.name, cloth.where, "cloths");
  for (const SoftEntry& soft : scene.softs)
    add(soft.name, soft.where, scene.cloths.empty() ? "soft bodies" : "cloths or soft bodies");
}

// A pin follows an obstacle of the scene, of which there is one.
void check_follow(const PinEntry& pin, const std::vector<ObstacleEntry>& obstacles) {
  if (pin.follow.empty()) return;
  Names names;
  for (const ObstacleEntry& obstacle : obstacles) names.push_back(obstacle.name);
  const auto count = std::count(names.begin(), names.end(), pin.follow);
  if (count == 1) return;
  const std::string start = pin.where + ": follow = \"" + one_line(pin.follow) + "\": ";
  if (count == 0)
    throw InputError(start + "there is no obstacle of that name; " + suggestion(pin.follow, names));
  throw InputError(start + "there are " + std::to_string(count) +
                   " obstacles of that name; give each a name of its own");
}

}  // namespace

bool is_pattern(const fs::path& path) { return path.extension() == ".svg" || path.extension() == ".toml"; }

Names model_names() { return {"noh-jung", "choi-ko"}; }

Scene read_scene(Node root, const std::vector<Setting>& settings, const fs::path& folder, std::string label) {
  for (const Setting& setting : settings) apply(setting, root);
  Table table(root, "the scene");
  Scene scene;
  scene.label = std::move(label);
  const std::vector<Table> simulation = table.tables("simulation");
  std::vector<Table> cloths = table.tables("cloth"), softs = table.tables("soft"),
                     obstacles = table.tables("obstacle");
  table.finish();  // before anything is missed: it may be there with its name mistyped
  if (simulation.size() > 1) table.fail("simulation", "there may be only one");
  scene.simulation = read_simulation(simulation.empty() ? nullptr : simulation.data());
  if (!table.has("soft")) table.require("cloth");
  for (Table& cloth : cloths) scene.cloths.push_back(read_cloth(cloth, folder));
  for (Table& soft : softs) scene.softs.push_back(read_whole_soft(soft, folder));
  for (Table& obstacle : obstacles) scene.obstacles.push_back(read_obstacle(obstacle, folder));
  if (scene.cloths.empty() && scene.softs.empty()) table.fail("cloth", "there is no cloth");
  check_names(scene);
  for (const ClothEntry& cloth : scene.cloths)
    for (const PinEntry& pin : cloth.pins) check_follow(pin, scene.obstacles);
  for (const SoftEntry& soft : scene.softs)
    for (const PinEntry& pin : soft.pins) check_follow(pin, scene.obstacles);
  return scene;
}

Scene read_scene(const fs::path& path, const std::vector<Setting>& settings) {
  return read_scene(read_toml(path), settings, path.parent_path(), path.string());
}

}  // namespace drape
