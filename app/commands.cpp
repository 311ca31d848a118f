#include "app/commands.h"

#include <chrono>
#include <cstdio>

#include "app/atomic_file.h"
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

std::string sides(const MeshReport& report) {
  const Vec3 size = report.upper - report.lower;
  return rounded(size[0], 4) + " x " + rounded(size[1], 4) + " x " + rounded(size[2], 4) + " m";
}

void print_report(const std::string& name, const MeshReport& report) {
  std::printf("%s: %s, %s, %s, %s, %s\n", name.c_str(), counted(report.vertices, "vertex").c_str(),
              counted(report.faces, "face").c_str(), counted(report.triangles, "triangle").c_str(),
              counted(report.edges, "edge").c_str(), counted(report.diagonals, "diagonal").c_str());
  std::printf("  size %s, area %s m^2, edges %s to %s m (median %s m), smallest angle %s deg\n",
              sides(report).c_str(), rounded(report.area, 4).c_str(),
              rounded(report.shortest_edge, 3).c_str(), rounded(report.longest_edge, 3).c_str(),
              rounded(report.median_edge, 3).c_str(),
              rounded(report.smallest_angle * 57.29577951308232, 3).c_str());
  std::printf("  %s, %s, %s\n", counted(report.pieces, "piece").c_str(),
              counted(report.boundary_loops, "boundary loop").c_str(),
              report.closed ? "closed" : "not closed");
}

void check_mesh(const std::filesystem::path& file) {
  const TriangleMesh mesh = read_obj(file);
  const MeshReport report = examine(mesh);
  Names messages;
  add_messages(report, file.string(), messages);
  print_report(file.string(), report);
  for (const VertexGroup& group : mesh.groups)
    std::printf("  group %s: %s\n", group.name.c_str(),
                counted(static_cast<long>(group.vertices.size()), "vertex").c_str());
  for (const std::string& message : messages) std::printf("%s\n", one_line(message).c_str());
}

void check_scene(const std::filesystem::path& file) {
  const Scene scene = read_scene(file, {});
  constexpr bool keep_level_sets = false;  // it changes nothing
  const Simulation simulation = make_simulation(scene, keep_level_sets);
  const SimulationOptions& s = scene.simulation;
  std::printf("%s: %s s in steps of %s s, %s, %s, tolerance %s\n", file.c_str(),
              rounded(s.duration, 4).c_str(), rounded(s.time_step, 4).c_str(), s.integrator.c_str(),
              s.linear_solver.c_str(), rounded(s.step.tolerance, 3).c_str());
  for (std::size_t k = 0; k < scene.cloths.size(); ++k) {
    const Fabric& f = scene.cloths[k].fabric;
    print_report("cloth " + simulation.cloths[k].name, simulation.cloths[k].report);
    std::printf("  %s kg/m^2, stretch %s, bend %s\n", rounded(f.area_density, 4).c_str(),
                f.stretch_spring ? (rounded(*f.stretch_spring, 4) + " N/m each edge").c_str()
                                 : (rounded(f.stretch, 4) + " N/m").c_str(),
                f.bend_spring ? (rounded(*f.bend_spring, 4) + " N.m^2 each diagonal").c_str()
                              : (rounded(f.bend, 4) + " N.m").c_str());
  }
  std::printf("%s pinned\n",
              counted(static_cast<long>(simulation.constraints->pinned().size()), "vertex").c_str());
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k) {
    const Obstacle& o = simulation.constraints->bodies()[k].obstacle();
    std::printf("obstacle %s: %s, friction %s / %s, margin %s mm\n", scene.obstacles[k].name.c_str(),
                std::string(name(o.shape)).c_str(), rounded(o.friction.statics, 3).c_str(),
                rounded(o.friction.kinetic, 3).c_str(), rounded(1000 * o.margin, 3).c_str());
    if (simulation.bodies[k].report.triangles > 0) print_report("  mesh", simulation.bodies[k].report);
    if (const std::string& text = simulation.bodies[k].level_set; !text.empty())
      std::printf("  level set: %s\n", text.c_str());
    if (const auto* body = std::get_if<DeformingBody>(&o.shape))
      std::printf("  %s, %s to %s s\n", counted(body->frames->frame_count(), "frame").c_str(),
                  rounded(body->frames->first_time(), 4).c_str(),
                  rounded(body->frames->last_time(), 4).c_str());
  }
  for (const std::string& message : simulation.messages) std::printf("%s\n", one_line(message).c_str());
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
    return text.empty() ? otherwise : quantity(parse_toml_value(text, option), dimension, Range::positive);
  };
  const double voxel = read(words.voxel, "--voxel", dimension::length, 0);
  const Placement scaled{.scale = read(words.scale, "--scale", dimension::number, 1)};
  const TriangleMesh mesh = placed(read_obj(input), scaled, words.mesh);
  const MeshReport report = examine(mesh);
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

int check_file(const std::filesystem::path& file) {
  if (file.extension() == ".toml") {
    check_scene(file);
  } else {
    check_mesh(file);
  }
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
