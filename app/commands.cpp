#include "app/commands.h"

#include <chrono>
#include <cstdio>

#include "app/atomic_file.h"
#include "app/check.h"
#include "app/fabrics.h"
#include "app/level_set_cache.h"
#include "app/run.h"
#include "app/simulation.h"
#include "app/table.h"
#include "mesh/obj.h"

namespace drape {
namespace {

RunOptions run_options(const CommonOptions& common, const std::filesystem::path& input) {
  RunOptions options;
  options.out = common.out.empty() ? std::filesystem::path("out") / input.stem() : common.out;
  options.frames = common.frames;
  options.quiet = common.quiet;
  return options;
}

void print_line(std::string_view name, std::string_view text) {
  std::printf("  %-26s %s\n", std::string(name).c_str(), std::string(text).c_str());
}

void list_fabrics() {
  std::printf("fabrics (area density, stretch, bending):\n");
  for (const std::string& name : fabric_names()) {
    const NamedFabric named = load_fabric(name);
    std::string text = rounded(1000 * named.fabric.area_density, 4) + " g/m^2, " +
                       rounded(named.fabric.stretch, 4) + " N/m, " + rounded(1e6 * named.fabric.bend, 4) +
                       " uN.m; " + named.description;
    if (!named.assumed.empty()) text += " (assumed: " + listed(named.assumed) + ")";
    print_line(name, one_line(text));
  }
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
  if (report.triangles > 0)
    check_size(report.lower, report.upper, words.mesh);  // before its areas are judged
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

int list_parts() {
  list_fabrics();
  std::printf("shapes:\n");
  print_line("plane", "point, normal");
  print_line("sphere", "centre, radius");
  print_line("bowl", "centre, inner radius, thickness, axis: a hemispherical shell open along the axis");
  print_line("box", "centre, size, rotate");
  print_line("capsule", "a, b, radius");
  print_line("mesh", "an OBJ file: a closed body, or a thick surface");
  print_line("level-set", has_openvdb()
                              ? "a closed OBJ file or a .vdb file, as a grid of distances"
                              : "a closed OBJ file, as a grid of distances (.vdb files: not in this build)");
  std::printf("forces:\n");
  print_line("noh-jung", "edges that pull, diagonals that buckle, damping along both");
  print_line("choi-ko",
             "of a regular grid of quads: neighbours that pull, next but one that buckle, damping");
  print_line("soft", "springs of a lattice that resist both ways, damping along them");
  print_line("gravity", "mass times gravity");
  std::printf("integrators:\n");
  for (const IntegratorInfo& info : integrators()) print_line(info.name, info.summary);
  std::printf("contact modes:\n");
  for (const ContactModeInfo& info : contact_modes()) print_line(info.name, info.summary);
  std::printf("linear solvers:\n");
  for (const LinearSolverInfo& info : linear_solvers()) print_line(info.name, info.summary);
  return 0;
}

}  // namespace drape
