#include "app/commands/commands.h"

#include <chrono>
#include <cstdio>

#include "app/base/atomic_file.h"
#include "app/base/table.h"
#include "app/commands/check.h"
#include "app/run/run.h"
#include "app/scene/fabric_words.h"
#include "app/scene/level_set_cache.h"
#include "app/scene/load_mesh.h"
#include "app/scene/shape_table.h"
#include "app/simulation/simulation.h"
#include "mesh/obj/obj.h"

namespace drape::app {
namespace {

RunOptions run_options(const CommonOptions& common, const std::filesystem::path& input) {
  RunOptions options;
  options.out = common.out.empty() ? std::filesystem::path("out") / input.stem() : common.out;
  options.frames = common.frames;
  options.quiet = common.quiet;
  return options;
}

struct Part {
  std::string name, text;
};

// A kind of parts: what follows its name in the heading stands in `of_each`.
struct Kind {
  std::string name, of_each;
  std::vector<Part> parts;
};

template <class Infos>
std::vector<Part> parts_of(const Infos& infos) {
  std::vector<Part> parts;
  parts.reserve(std::size(infos));
  for (const auto& info : infos) parts.push_back({std::string(info.name), std::string(info.summary)});
  return parts;
}

std::vector<Part> fabric_parts() {
  std::vector<Part> parts;
  const auto in_short = [](const std::string& name) {
    try {
      const NamedFabric named = load_fabric(name);
      const std::string text = in_words(named.fabric) + "; " + named.description;
      return named.assumed.empty() ? text : text + " (assumed: " + listed(named.assumed) + ")";
    } catch (const InputError& error) {
      return std::string("cannot be read: ") + error.what();
    }
  };
  for (const std::string& name : fabric_names()) parts.push_back({name, one_line(in_short(name))});
  return parts;
}

std::vector<Part> shape_parts() {
  std::vector<Part> parts;
  for_each_built_in([&]<class Kind>(const Kind& standard) {
    Names keys;
    for_each_field<Kind>([&](const auto& field) { keys.emplace_back(field.key()); });
    parts.push_back({std::string(name(standard)), listed(keys) + ": " + Described<Kind>::what});
  });
  parts.push_back({"mesh", "an OBJ file: a closed body, or a thick surface"});
  parts.push_back(
      {"level-set", has_openvdb()
                        ? "a closed OBJ file or a .vdb file, as a grid of distances"
                        : "a closed OBJ file, as a grid of distances (.vdb files: not in this build)"});
  return parts;
}

std::vector<Part> force_parts() {
  return {{"noh-jung", "edges that pull, diagonals that buckle, damping along both"},
          {"choi-ko", "of a regular grid of quads: neighbours that pull, next but one that buckle, damping"},
          {"woven", "a membrane of triangles and a plate, along warp and weft, on any mesh"},
          {"soft", "springs of a lattice that resist both ways, damping along them"},
          {"rope", "a chain that resists stretching and bending, damping of both"},
          {"air", "drag and skin friction of the air, and its wind, on all triangles"},
          {"gravity", "mass times gravity"}};
}

std::vector<Kind> kinds() {
  return {{"fabrics", " (warp / weft)", fabric_parts()},
          {"shapes", "", shape_parts()},
          {"forces", "", force_parts()},
          {"integrators", "", parts_of(integrators())},
          {"contact modes", "", parts_of(contact_modes())},
          {"linear solvers", "", parts_of(linear_solvers())}};
}

void print(const Kind& kind, bool markdown) {
  if (markdown) {
    std::printf("| name | what%s |\n| --- | --- |\n", kind.of_each.c_str());
    for (const Part& part : kind.parts) std::printf("| `%s` | %s |\n", part.name.c_str(), part.text.c_str());
    return;
  }
  std::printf("%s%s:\n", kind.name.c_str(), kind.of_each.c_str());
  for (const Part& part : kind.parts) std::printf("  %-26s %s\n", part.name.c_str(), part.text.c_str());
}

}  // namespace

int simulate(const std::filesystem::path& scene, const CommonOptions& options) {
  return run(read_scene(scene, options.settings), run_options(options, scene));
}

int drop(const DropOptions& what, const CommonOptions& options, const std::string& label) {
  return run(drop_scene(what, options.settings, label), run_options(options, what.cloth));
}

int make_level_set(const LevelSetWords& words) {
  const std::filesystem::path input(words.mesh), output(words.out);
  if (!is_vdb(output)) throw InputError(words.out + ": expected a name that ends in .vdb");
  if (!has_openvdb()) LevelSet::read(output);  // says what is missing
  const auto read = [](const std::string& text, const char* option, const Dimension& dimension,
                       double otherwise) {
    if (text.empty()) return otherwise;
    try {
      return quantity(parse_toml_value(text, option), dimension, Range::positive);
    } catch (const InputError& error) {
      throw InputError(std::string(option) + " " + text + ": " + error.what());
    }
  };
  const double voxel = read(words.voxel, "--voxel", dimension::length, 0);
  const Placement scaled{.scale = read(words.scale, "--scale", dimension::number, 1)};
  const TriangleMesh mesh = placed(read_obj(input), scaled, words.mesh);
  const MeshReport report = examine(mesh);
  if (report.triangles > 0) check_size(report.box(), words.mesh);  // before its areas are judged
  Names messages;
  add_messages(report, words.mesh, messages);
  (void)AtomicFile(output);  // not kept: now, and not when all is computed
  const auto start = std::chrono::steady_clock::now();
  const LevelSet made = LevelSet::from_mesh(mesh, {.voxel = voxel}, words.mesh);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  warn_of_error(made, words.mesh, messages);
  AtomicFile file(output);
  file.write(made.vdb());
  file.keep();
  print_report(words.mesh, report);
  for (const std::string& message : messages) std::printf("%s\n", one_line(message).c_str());
  std::printf("level set: %s\n", described(made).c_str());
  std::printf("made in %s s, wrote %s (%s MB)\n", rounded(seconds.count(), 2).c_str(), words.out.c_str(),
              rounded(static_cast<double>(std::filesystem::file_size(output)) / 1e6, 3).c_str());
  return 0;
}

int list_parts(const std::string& which, bool markdown) {
  Names known;
  bool found = false;
  for (const Kind& kind : kinds()) {
    known.push_back(kind.name);
    if (!which.empty() && which != kind.name) continue;
    print(kind, markdown);
    found = true;
  }
  if (!found) throw InputError("there are no '" + which + "' to list; " + suggestion(which, known));
  return 0;
}

}  // namespace drape::app
