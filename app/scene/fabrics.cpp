#include "app/scene/fabrics.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "mesh/base/errors.h"

namespace drape::app {
namespace {

namespace fs = std::filesystem;

fs::path data_folder;  // that was set

// The first of the candidate data folders that has fabrics.
fs::path fabric_folder() {
  if (const char* chosen = std::getenv("DRAPE_DATA"); chosen && *chosen) return fs::path(chosen) / "fabrics";
  if (!data_folder.empty()) return data_folder / "fabrics";
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    const fs::path installed = program.parent_path().parent_path() / "share" / "drape" / "fabrics";
    if (fs::is_directory(installed, error)) return installed;
  }
  return fs::path(DRAPE_DATA_DIR) / "fabrics";
}

}  // namespace

void set_data_folder(const fs::path& folder) { data_folder = folder; }

Names fabric_names() {
  Names names;
  std::error_code error;
  for (fs::directory_iterator file(fabric_folder(), error), end; !error && file != end; file.increment(error))
    if (file->path().extension() == ".toml") names.push_back(file->path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

void read_fabric(Table& table, Fabric& fabric) {
  table.read("area_density", fabric.area_density, dimension::area_density, Range::positive, "mass per area");
  for (const auto& [width, spring] :
       {std::pair{"stretch", "stretch_spring"}, std::pair{"bend", "bend_spring"}})
    if (table.has(width) && table.has(spring))
      table.fail(spring, "give either " + std::string(width) + " or " + spring + ", not both");
  if (table.has("stretch")) fabric.stretch_spring.reset();
  if (table.has("bend")) fabric.bend_spring.reset();
  table.read("stretch", fabric.stretch, dimension::stretch, Range::not_negative,
             "membrane stiffness: force per width for a strain of 1");
  table.read("stretch_spring", fabric.stretch_spring, dimension::spring, Range::not_negative,
             "instead of stretch: the constant of every edge, k_s");
  table.read("bend", fabric.bend, dimension::bend, Range::not_negative,
             "bending rigidity: moment per width for a curvature of 1/m");
  table.read("bend_spring", fabric.bend_spring, dimension::bend_spring, Range::not_negative,
             "instead of bend: the stiffness of every diagonal, k_b");
  table.read(
      "buckling_clamp", fabric.buckling_clamp, dimension::spring, Range::not_negative,
      {"c_b of every diagonal: how steeply its force sets in; a soft one makes the cloth limp where it is "
       "hardly bent",
       "chosen"});
  table.read("damping", fabric.damping, dimension::damping, Range::not_negative, "of every connection");
  std::string kind = fabric.damping_kind == DampingKind::axial ? "axial" : "relative";
  table.read("damping_kind", kind, Names{"relative", "axial"},
             "relative: of every difference of velocity of two neighbours; axial: of what goes along their "
             "connection");
  fabric.damping_kind = kind == "axial" ? DampingKind::axial : DampingKind::relative;
  table.read("neighbour_weighting", fabric.neighbour_weighting,
             "forces at a vertex times the largest number of neighbours over its own: Noh & Jung, eq. 1-3");
  try {
    check(fabric);
  } catch (const InputError& error) {
    throw InputError(table.where() + ": " + error.what());
  }
}

NamedFabric load_fabric(const std::string& name, KeyNotes* notes) {
  const Names known = fabric_names();
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw InputError("there is no fabric '" + name + "'; " + suggestion(name, known));
  const Node root = read_toml(fabric_folder() / (name + ".toml"));
  Table table(root, "the fabric", notes);
  NamedFabric named;
  named.name = name;
  table.read("description", named.description, "fibre and weave, for `drape list`");
  table.read("source", named.source, "where the numbers are from");
  table.read("assumed", named.assumed, "keys whose values nobody measured");
  table.require("area_density");
  read_fabric(table, named.fabric);
  table.finish();
  return named;
}

}  // namespace drape::app
