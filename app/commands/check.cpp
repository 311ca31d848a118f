#include "app/commands/check.h"

#include <algorithm>
#include <cstdio>

#include "app/base/toml_file.h"
#include "app/commands/crossings.h"
#include "app/pattern/pattern_read.h"
#include "app/scene/fabric_words.h"
#include "app/scene/load_mesh.h"
#include "app/scene/obstacle_read.h"
#include "app/simulation/motion_extent.h"
#include "app/simulation/schedule.h"
#include "app/simulation/simulation.h"
#include "mesh/obj/obj.h"

namespace drape::app {
namespace {

std::string sides(const MeshReport& report) {
  const Vec3 size = report.box().sizes();
  return rounded(size[0], 4) + " x " + rounded(size[1], 4) + " x " + rounded(size[2], 4) + " m";
}

}  // namespace

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
              report.closed                ? "closed"
              : report.boundary_loops == 0 ? "without a border, but not closed (see below)"
                                           : "not closed");
}

namespace {

// An OBJ file, or a drawing as it is cut with the default edge.
void check_mesh(const std::filesystem::path& file, const std::filesystem::path& mark) {
  Names messages;
  const bool drawing = is_pattern(file);
  const TriangleMesh mesh = drawing ? triangulate(read_pattern(file, messages), {}).mesh : read_obj(file);
  const MeshReport report = examine(mesh);
  add_messages(report, file.string(), messages);
  print_report(file.string(), report);
  for (const VertexGroup& group : mesh.groups)
    std::printf("  group %s: %s\n", group.name.c_str(),
                counted(static_cast<long>(group.vertices.size()), "vertex").c_str());
  print_crossings(file.stem().string(), mesh, mark);
  for (const std::string& message : messages) std::printf("%s\n", one_line(message).c_str());
}

void print_lines(const FabricRecord& record) {
  for (const std::string& line : lines_of(record)) std::printf("  %s\n", one_line(line).c_str());
}

void print_cloth(const ClothEntry& entry, const Cloth& cloth) {
  print_report("cloth " + cloth.name, cloth.report);
  std::printf(
      "  %s\n",
      (cloth.model == ClothModel::woven ? in_words(entry.fabric) : mean_in_words(entry.fabric)).c_str());
  print_lines(entry.fabric_record);
}

void print_seams(const Cloth& cloth, const VecX& x) {
  for (const Cloth::Stitched& open : cloth.seams) {
    const OpenSeam& seam = open.seam;
    const std::string what =
        seam.merge && seam.begins_closed()
            ? "begins closed and is merged in the first step"
            : "closes in " + rounded(seam.close, 3) + " s and is " + (seam.merge ? "merged" : "kept");
    std::printf("  seam %s: %s, up to %s m apart, %s\n", one_line(seam.name).c_str(),
                counted(static_cast<long>(seam.pairs.size()), "pair").c_str(),
                rounded(seam.gap(cloth.embedding, x), 3).c_str(), what.c_str());
  }
}

void print_soft(const SoftEntry& entry, const Cloth& cloth, const System& system) {
  print_report("soft body " + cloth.name, cloth.report);
  double mass = 0;
  for (int i = cloth.first_particle; i < cloth.end_particle; ++i) mass += system.masses()[i];
  const SoftMaterial& m = entry.material;
  std::printf("  %s, springs: %d structural, %d shear, %d bend; %s kg, %s\n",
              counted(cloth.end_particle - cloth.first_particle, "particle").c_str(), cloth.soft->structural,
              cloth.soft->shear, cloth.soft->bend, rounded(mass, 4).c_str(),
              m.young ? (rounded(*m.young, 4) + " Pa").c_str()
                      : (rounded(m.structural, 4) + " / " + rounded(m.shear, 4) + " / " + rounded(m.bend, 4) +
                         " N/m each")
                            .c_str());
}

void print_rope(const Cloth& rope) {
  double length = 0;
  for (const RestEdge& segment : rope.edges) length += segment.L;
  const RopeMaterial& m = *rope.rope;
  std::printf("rope %s: %s m in %s, %s kg/m, stretch %s N, bend %s N m^2, radius %s mm\n",
              one_line(rope.name).c_str(), rounded(length, 4).c_str(),
              counted(static_cast<long>(rope.edges.size()), "segment").c_str(),
              rounded(m.mass_per_length, 4).c_str(), rounded(m.stretch, 4).c_str(),
              rounded(m.bend, 4).c_str(), rounded(1000 * m.radius, 3).c_str());
}

// Of all vertices that are pinned: how many a body carries, and how many go along a path.
void print_pins(const Scene& scene, const Simulation& simulation) {
  const Constraints& constraints = *simulation.constraints;
  std::vector<long> carried(scene.obstacles.size());
  long along = 0;
  for (const MovingPin& pin : constraints.moving_pins()) ++(pin.body < 0 ? along : carried[pin.body]);
  std::string text = counted(static_cast<long>(constraints.pinned().size()), "vertex") + " pinned";
  for (std::size_t k = 0; k < carried.size(); ++k)
    if (carried[k] > 0) text += ", " + std::to_string(carried[k]) + " to " + scene.obstacles[k].name;
  if (along > 0) text += ", " + std::to_string(along) + " along a path";
  std::printf("%s\n", one_line(text).c_str());
}

// The path of the vertices' middle.
void print_paths(const std::vector<PinEntry>& pins, const Cloth& cloth, const State& start, double duration) {
  for (const PinEntry& pin : pins) {
    if (!pin.motion) continue;
    const std::vector<int> particles = pinned_particles(pin.rule, cloth, start.x);
    Vec3 x = Vec3::Zero();
    for (const int i : particles) x += start.x.segment<3>(3 * i);
    x /= static_cast<double>(particles.size());
    // The point that the motion carries is at x at time 0.
    const std::string text = described(*pin.motion, pin.source, pin.motion->at(0).to_body(x), duration);
    std::printf("  %s of %s: %s\n", counted(static_cast<long>(particles.size()), "vertex").c_str(),
                cloth.name.c_str(), one_line(text).c_str());
  }
}

void print_obstacle(const ObstacleEntry& entry, const Obstacle& o, const Body& body, double duration) {
  std::printf("obstacle %s: %s, friction %s / %s, margin %s mm\n", entry.name.c_str(),
              std::string(name(o.shape)).c_str(), rounded(o.friction.statics, 3).c_str(),
              rounded(o.friction.kinetic, 3).c_str(), rounded(1000 * o.margin, 3).c_str());
  if (body.report.triangles > 0) print_report("  mesh", body.report);
  if (!body.level_set.empty()) std::printf("  level set: %s\n", body.level_set.c_str());
  const DeformingBody* const frames = deforming(o.shape);
  if (frames)
    std::printf("  %s, %s to %s s\n", counted(frames->frames->frame_count(), "frame").c_str(),
                rounded(frames->frames->first_time(), 4).c_str(),
                rounded(frames->frames->last_time(), 4).c_str());
  if (o.rigid)
    std::printf("  mass %s kg, moves by what acts on it: at first %s m/s, %s deg/s\n",
                rounded(o.rigid->mass, 4).c_str(), rounded(o.rigid->velocity.norm(), 4).c_str(),
                rounded(o.rigid->spin.norm() * 57.29577951308232, 4).c_str());
  else if (!frames || o.motion.moves())
    std::printf("  %s\n", one_line(described(o.motion, entry.source, middle_of(o.shape), duration)).c_str());
}

void check_scene(const std::filesystem::path& file, const std::filesystem::path& mark) {
  const Scene scene = read_scene(file, {});
  constexpr bool keep_level_sets = false;  // it changes nothing
  const Simulation simulation = make_simulation(scene, keep_level_sets);
  const SimulationOptions& s = scene.simulation;
  std::printf("%s: %s s in steps of %s s, %s, %s, tolerance %s\n", file.c_str(),
              rounded(s.duration, 4).c_str(), rounded(StepGrid(s.time_step, s.frame_rate).step(), 4).c_str(),
              s.integrator.c_str(), s.linear_solver.c_str(), rounded(s.step.tolerance, 3).c_str());
  for (std::size_t k = 0; k < scene.cloths.size(); ++k) {
    print_cloth(scene.cloths[k], simulation.cloths[k]);
    print_seams(simulation.cloths[k], simulation.state.x);
  }
  for (std::size_t k = 0; k < scene.softs.size(); ++k)
    print_soft(scene.softs[k], simulation.cloths[scene.cloths.size() + k], *simulation.system);
  for (std::size_t k = 0; k < scene.ropes.size(); ++k)
    print_rope(simulation.cloths[scene.cloths.size() + scene.softs.size() + k]);
  print_pins(scene, simulation);
  for (std::size_t k = 0; k < simulation.cloths.size(); ++k)
    print_paths(scene.pins_of(k), simulation.cloths[k], simulation.state, s.duration);
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
    print_obstacle(scene.obstacles[k], simulation.constraints->bodies()[k].obstacle(), simulation.bodies[k],
                   s.duration);
  print_crossings(simulation.cloths, simulation.state.x, mark);
  for (const std::string& message : simulation.messages) std::printf("%s\n", one_line(message).c_str());
}

void check_fabric(const std::filesystem::path& file) {
  const NamedFabric named = load_fabric(file.string());
  std::printf("%s\n  %s\n", one_line(file.string() + ": " + named.description).c_str(),
              in_words(named.fabric).c_str());
  print_lines(named.record);
  if (const auto& drape = named.tests.drape)
    std::printf("  a drape test gave %s %%%s\n", rounded(100 * drape->coefficient, 4).c_str(),
                drape->nodes ? (", " + rounded(*drape->nodes, 3) + " nodes").c_str() : "");
  for (const auto& [what, names] :
       {std::pair{"measured", &named.measured}, std::pair{"converted", &named.converted},
        std::pair{"fitted", &named.fitted}, std::pair{"assumed", &named.assumed},
        std::pair{"not said whether measured", &named.unmarked}})
    if (!names->empty()) std::printf("  %s: %s\n", what, one_line(listed(*names)).c_str());
}

void check_folder(const std::filesystem::path& folder, const std::filesystem::path& mark) {
  const Recording recording(folder);
  std::printf("%s: %s", folder.c_str(), counted(recording.frames(), "frame").c_str());
  for (const RecordedShape& shape : recording.shapes())
    if (!shape.body) {
      const bool line = shape.mesh.triangle_count() == 0;  // a rope
      std::printf(", %s of %s", shape.name.c_str(),
                  (line ? counted(shape.mesh.vertex_count(), "point")
                        : counted(shape.mesh.triangle_count(), "triangle"))
                      .c_str());
    }
  std::printf("\n");
  print_crossings(recording, mark);
  for (const std::string& missing : recording.missing()) std::printf("%s\n", one_line(missing).c_str());
}

// A fabric file that lacks its area density is one, too.
bool is_fabric(const Node& file) {
  const Names keys = {"area_density",
                      "bend",
                      "stretch",
                      "shear",
                      "bending_length",
                      "overhang",
                      "kes",
                      "fast",
                      "measured_cantilever",
                      "measured_bias_extension",
                      "measured_picture_frame",
                      "measured_drape"};
  return std::any_of(keys.begin(), keys.end(),
                     [&](const std::string& key) { return file.members.contains(key); });
}

}  // namespace

int check_file(const std::filesystem::path& file, const std::filesystem::path& mark) {
  if (!mark.empty()) require_new_folder(mark);
  if (std::filesystem::is_directory(file)) {
    check_folder(file, mark);
    return 0;
  }
  const Node root = file.extension() == ".toml" ? read_toml(file) : Node();
  const bool fabric = is_fabric(root);
  if (fabric && !mark.empty())
    throw InputError(file.string() + ": a fabric has no triangles that could cross; leave --mark out");
  if (fabric)
    check_fabric(file);
  else if (file.extension() == ".toml" && !root.members.contains("panel"))
    check_scene(file, mark);
  else
    check_mesh(file, mark);
  return 0;
}

}  // namespace drape::app
