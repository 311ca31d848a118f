#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "app/base/table.h"
#include "app/base/text_file.h"
#include "app/scene/fabrics.h"
#include "app/scene/obstacle_read.h"
#include "app/scene/pin_read.h"
#include "app/scene/rope_read.h"
#include "app/scene/scene.h"
#include "app/scene/self_contact_read.h"
#include "app/scene/sewing_read.h"
#include "app/scene/simulation_read.h"
#include "app/scene/soft_read.h"
#include "app/scene/warp_read.h"
#include "mesh/base/errors.h"
#include "solver/forces/woven.h"

namespace drape::app {
namespace {

namespace fs = std::filesystem;

// A name becomes a file name.
std::string read_name(Table& table, const fs::path& mesh) {
  std::string name = mesh.stem().string();
  table.read(
      "name", name,
      {"of the output files; unique", "the mesh's, \"soft\" of a box of particles, or \"rope\" of points"});
  const bool good =
      !name.empty() && name.front() != '.' &&
      std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 32 || c == '/' || c == '\\'; });
  if (!good && !table.has("name") && name.find('\\') != name.npos)
    table.fail("mesh", "there is no such file; a path is written with /, also of Windows");
  if (!good)
    table.fail("name", "a name is used for files: it may not be empty, begin with a dot or hold a slash");
  return name;
}

constexpr std::array keys_of_connections = {"stretch_spring", "bend_spring", "buckling_clamp",
                                            "neighbour_weighting"};

// A fabric by name has the numbers of a cloth; a cloth that gives constants of connections wants springs.
void read_model(Table& table, ClothEntry& cloth) {
  const Fabric& f = cloth.fabric;
  const bool springs = std::any_of(keys_of_connections.begin(), keys_of_connections.end(),
                                   [&](const char* key) { return table.has(key); }) ||
                       f.stretch_spring || f.bend_spring || f.buckling_clamp || f.neighbour_weighting;
  if (!cloth.fabric_name.empty() && !springs) cloth.model = "woven";
  table.read(
      "model", cloth.model, model_names(),
      {"noh-jung: springs, of any mesh; choi-ko: springs, of a regular grid of quads (holes and tubes "
       "are welcome); woven: a membrane and a plate, of any mesh",
       "\"woven\" with `fabric`, else \"noh-jung\"; constants of connections (`stretch_spring` and the "
       "like) mean springs"});
  if (!cloth.seams.empty() && cloth.model == "choi-ko")
    table.fail("model", "a cloth with seams is no regular grid; expected \"noh-jung\" or \"woven\"");
}

// "flat", "mesh", or a share between them.
void read_rest_angle(Table& table, ClothEntry& cloth) {
  const Node* const node = table.take(
      "rest_angle", "\"flat\", \"mesh\", or a number from 0 to 1",
      {"of model = \"woven\": with which folds it rests: none, those of the mesh as it starts, or a "
       "share of them; the springs of the other models rest at the lengths of the mesh",
       "\"flat\""});
  if (!node) return;
  if (cloth.model != "woven") table.fail("rest_angle", "goes with model = \"woven\"");
  double& share = cloth.fabric.weave.rest_angle;
  const bool is_text = node->kind == Node::Kind::text;
  if (is_text && node->text == "flat") return;
  if (is_text && node->text == "mesh")
    share = 1;
  else if (node->kind == Node::Kind::number || node->kind == Node::Kind::integer)
    share = node->number;
  else
    share = -1;
  if (!(share >= 0 && share <= 1))
    table.fail("rest_angle", "expected \"flat\", \"mesh\", or a number from 0 (flat) to 1 (the mesh)");
  if (share > 0 && !cloth.seams.empty())
    table.fail("rest_angle", "where panels are sewn the mesh has no angle; expected \"flat\" with seams");
}

void read_bending(Table& table, ClothEntry& cloth) {
  std::string word = name_of(cloth.fabric.weave.bending);
  table.read("bending", word, bending_names(),
             {"of model = \"woven\": a plate, which is right in every direction on any mesh; hinges, the "
              "angles between triangles; or the quadratic form of hinges, which rests flat",
              "\"plate\""});
  if (cloth.model != "woven" && table.has("bending")) table.fail("bending", "goes with model = \"woven\"");
  Weave& weave = cloth.fabric.weave;
  weave.bending = bending_of(word);
  if (weave.bending == Bending::quadratic_hinges && weave.rest_angle > 0)
    table.fail("bending", "quadratic hinges rest flat; expected \"hinges\" with this rest_angle");
}

void read_hysteresis(Table& table, ClothEntry& cloth) {
  bool asked = false;
  table.read(
      "hysteresis", asked,
      "of model = \"woven\": whether its threads rub when they are bent, as kes.2HB of the fabric says; a "
      "fold then does not open fully");
  if (cloth.model != "woven" && table.has("hysteresis"))
    table.fail("hysteresis", "goes with model = \"woven\"");
  if (!asked) return;
  try {
    use_hysteresis(cloth.fabric_record, cloth.fabric);
  } catch (const InputError& error) {
    table.fail("hysteresis", error.what());
  }
}

void read_tear(Table& table, ClothEntry& cloth) {
  table.read(
      "tear", cloth.tear, dimension::number, Range::positive,
      {"strain l / L - 1 of an edge above which the cloth tears there: 0.4 or \"40 %\"; the file that is "
       "written has the new borders, and the copies of vertices after the others",
       "it does not tear"});
  if (!cloth.tear) return;
  if (cloth.fabric.neighbour_weighting)
    table.fail("tear",
               "with neighbour_weighting a tear would change the mass of the cloth; leave one of them out");
}

// Faces that are clusters, in place of springs or of a membrane.
void read_clusters(Table& table, ClothEntry& cloth) {
  std::string what;
  table.read(
      "clusters", what, Names{"faces"},
      {"what holds the cloth together in its plane instead of springs or a membrane, for `pbd` and explicit "
       "integrators: each face "
       "is drawn to its own shape, as stiff as `stretch` says, and resists compression too; it bends as "
       "the model has it",
       "by the model"});
  if (what.empty()) return;
  cloth.clusters = true;
  if (cloth.model == "choi-ko")
    table.fail("clusters",
               "the springs of model = \"choi-ko\" are those of a grid; expected \"noh-jung\" or \"woven\"");
  const Fabric& f = cloth.fabric;
  if (f.stretch_spring || f.neighbour_weighting)
    table.fail("clusters", std::string(f.stretch_spring ? "stretch_spring" : "neighbour_weighting") +
                               " is of springs, and faces that are clusters have none; give stretch");
  if (table.has("compression"))
    table.fail("compression", "is of a membrane, and faces that are clusters resist it");
}

// A woven cloth has no connections, and a cloth of connections no warp.
void check_model(const Table& table, ClothEntry& cloth) {
  const bool woven = cloth.model == "woven";
  const Fabric& f = cloth.fabric;
  const std::array given = {f.stretch_spring.has_value(), f.bend_spring.has_value(),
                            f.buckling_clamp.has_value(), f.neighbour_weighting};
  for (std::size_t k = 0; k < given.size(); ++k) {
    if (!woven || !given[k]) continue;
    const std::string key = keys_of_connections[k];
    const std::string what = "is of connections, and model = \"woven\" has none";
    if (table.has(key)) table.fail(key, what);
    table.fail("fabric", std::string("its ").append(key).append(" ").append(what));
  }
  if (woven && needs_warp(cloth.fabric) && !cloth.warp && cloth.group_warps.empty() && !cloth.warp_is_down)
    table.fail("model",
               "the fabric differs, wrinkles or is viscous along warp and weft; give warp = [x, y, z], the "
               "direction of the warp in the rest shape, warp = \"down\", or rest = \"uv\", whose v it is");
  for (const char* key : {"compression", "viscosity"})
    if (table.has(key)) take_with_woven(table, cloth, key);
}

void read_fabric_name(Table& table, const fs::path& folder, std::string& name) {
  const About about(
      "its values hold where the keys below say nothing; or a fabric file (.toml), looked for from the "
      "scene's folder");
  const Node* const given = table.find("fabric");
  if (!given || !is_fabric_file(given->text)) return table.read_part("fabric", name, fabric_names(), about);
  table.read("fabric", name, about);
  if (!fs::exists(folder / name))
    table.fail("fabric", "there is no file " + (folder / name).lexically_normal().string());
}

ClothEntry read_cloth(Table& table, const fs::path& folder) {
  ClothEntry cloth;
  cloth.where = table.where();
  cloth.mesh = read_path(
      table, folder, "OBJ file, or a sewing pattern (.svg, .toml), which is cut as `drape triangulate` does");
  cloth.name = read_name(table, cloth.mesh);
  cloth.placement = read_placement(table);
  for (const char* key : {"edge", "min_angle"})
    if (table.has(key) && !is_pattern(cloth.mesh))
      table.fail(key, "is of a pattern (.svg or .toml) as mesh; an OBJ file has its edges");
  table.read("edge", cloth.pattern.edge, dimension::length, Range::positive,
             {"of a pattern: no edge of its mesh is longer", "chosen"});
  table.read("min_angle", cloth.pattern.min_angle, dimension::angle, Range::not_negative,
             {"of a pattern: no angle of its mesh is smaller", "28 deg"});
  std::string rest = is_pattern(cloth.mesh) ? "uv" : "mesh";
  table.read("rest", rest, Names{"mesh", "uv"},
             {"the shape it rests in: the mesh as the file has it (scaled), or its texture coordinates",
              "\"mesh\"; of a pattern \"uv\""});
  cloth.rest_is_flat = rest == "uv";
  table.read("uv_scale", cloth.uv_scale, dimension::length, Range::positive,
             "length of one unit of the texture coordinates, with rest = \"uv\"; scale multiplies it, too");
  if (table.has("uv_scale") && !cloth.rest_is_flat) table.fail("uv_scale", "goes with rest = \"uv\"");
  cloth.panels = read_panels(table);
  cloth.seams = read_seams(table);
  read_fabric_name(table, folder, cloth.fabric_name);
  if (!cloth.fabric_name.empty()) {
    const NamedFabric named = load_fabric(cloth.fabric_name, folder);
    cloth.fabric = named.fabric;
    cloth.fabric_record = named.record;
  }
  read_model(table, cloth);
  read_warp(table, cloth);
  table.read("weld", cloth.weld,
             {"whether vertices at exactly the same place become one, as where a program has parted the mesh "
              "along the seams of its texture; what is written keeps all vertices. Layers that lie on one "
              "another are refused"});
  if (cloth.weld && cloth.model == "choi-ko")
    table.fail("weld",
               "the springs of model = \"choi-ko\" are those of a grid; weld the mesh itself in a modeller");
  table.read(
      "imperfection", cloth.imperfection, dimension::length, Range::not_negative,
      {"how far the start is off its own surface, in gentle waves: a cloth that is exactly flat and is "
       "pushed in its plane would stay in it",
       "1 um with model = \"woven\", else 0"});
  read_fabric(table, cloth.fabric, cloth.fabric_record);
  read_clusters(table, cloth);
  read_self_contact(table, cloth);
  cloth.has_own_damping = table.has("damping");
  read_rest_angle(table, cloth);
  read_bending(table, cloth);
  read_hysteresis(table, cloth);
  read_tear(table, cloth);
  check_model(table, cloth);
  for (Table& pin : table.tables("pins", pins_about)) cloth.pins.push_back(read_pin(pin, folder));
  table.finish();
  return cloth;
}

SoftEntry read_whole_soft(Table& table, const fs::path& folder) {
  SoftEntry soft = read_soft(table, folder);
  read_self_contact(table, soft);
  soft.name = read_name(table, soft.mesh.empty() ? fs::path("soft") : soft.mesh);
  for (Table& pin : table.tables("pins", pins_about)) soft.pins.push_back(read_pin(pin, folder));
  table.finish();
  return soft;
}

RopeEntry read_whole_rope(Table& table, const fs::path& folder) {
  RopeEntry rope = read_rope(table, folder);
  read_self_contact(table, rope);
  rope.name = read_name(table, rope.mesh.empty() ? fs::path("rope") : rope.mesh);
  for (Table& pin : table.tables("pins", pins_about))
    rope.pins.push_back(read_pin(pin, folder, PinsOf::rope));
  table.finish();
  return rope;
}

// Cloths, soft bodies and ropes are written side by side.
void check_names(const Scene& scene) {
  std::set<std::string> named;
  const auto add = [&](const std::string& name, const std::string& where, const char* kind) {
    if (!named.insert(name).second)
      throw InputError(where + ": two " + kind + " are called '" + name + "'; give one another name");
  };
  for (const ClothEntry& cloth : scene.cloths) add(cloth.name, cloth.where, "cloths");
  for (const SoftEntry& soft : scene.softs)
    add(soft.name, soft.where, scene.cloths.empty() ? "soft bodies" : "cloths or soft bodies");
  for (const RopeEntry& rope : scene.ropes)
    add(rope.name, rope.where,
        scene.cloths.empty() && scene.softs.empty() ? "ropes" : "cloths, soft bodies or ropes");
}

}  // namespace

bool is_tetrahedra(const fs::path& path) { return lower_extension(path) == ".msh"; }
bool is_pattern(const fs::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".svg" || extension == ".toml";
}

Names model_names() { return {"noh-jung", "choi-ko", "woven"}; }

Scene read_scene(Node root, const std::vector<Setting>& settings, const fs::path& folder, std::string label,
                 KeyNotes* notes) {
  for (const Setting& setting : settings) apply(setting, root);
  Table table(root, "the scene", notes);
  Scene scene;
  scene.label = std::move(label);
  scene.settings = settings;
  std::optional<Table> simulation = table.one("simulation", "how long, how exactly, by which methods"),
                       air = table.one("air", {"the air that the cloth moves in, and its wind",
                                               "none: nothing but what it touches slows the cloth"});
  std::vector<Table> cloths = table.tables("cloth", "each a cloth"),
                     softs = table.tables("soft", "each a soft body, a lattice of springs"),
                     ropes = table.tables("rope", "each a rope, a line of particles"),
                     obstacles = table.tables("obstacle", "each a body that the cloth meets"),
                     pairs = table.tables("pair", {"each how two cloths, soft bodies or ropes meet",
                                                   "by what is said of both"});
  refuse_misplaced(table, "scene");
  table.finish();  // before anything is missed: it may be there with its name mistyped
  scene.simulation = read_simulation(simulation ? &*simulation : nullptr);
  if (air) scene.simulation.air = read_air(*air);
  if (!table.has("soft") && !table.has("rope")) table.require("cloth");
  for (Table& cloth : cloths) scene.cloths.push_back(read_cloth(cloth, folder));
  for (Table& soft : softs) scene.softs.push_back(read_whole_soft(soft, folder));
  for (Table& rope : ropes) scene.ropes.push_back(read_whole_rope(rope, folder));
  for (Table& obstacle : obstacles) scene.obstacles.push_back(read_obstacle(obstacle, folder));
  for (Table& pair : pairs) scene.frictions.push_back(read_friction_pair(pair));
  if (scene.cloths.empty() && scene.softs.empty() && scene.ropes.empty())
    table.fail("cloth", "there is no cloth");
  check_names(scene);
  for (const FrictionEntry& pair : scene.frictions) check_friction_pair(pair, scene);
  for (std::size_t k = 0; k < scene.part_count(); ++k)
    for (const PinEntry& pin : scene.pins_of(k)) check_follow(pin, scene.obstacles);
  for (const RopeEntry& rope : scene.ropes) check_ends(rope, scene);
  return scene;
}

Scene read_scene(const fs::path& path, const std::vector<Setting>& settings) {
  return read_scene(read_toml(path), settings, path.parent_path(), path.string());
}

}  // namespace drape::app
