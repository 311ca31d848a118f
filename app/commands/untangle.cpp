#include "app/commands/untangle.h"

#include <algorithm>
#include <cstdio>

#include "app/base/atomic_file.h"
#include "app/base/table.h"
#include "app/base/words.h"
#include "app/scene/load_mesh.h"
#include "app/simulation/sheets.h"
#include "app/simulation/time_loop.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/topology.h"

namespace drape::app {
namespace {

constexpr double rests_for = 0.3;     // s, after the last crossing: layers come apart up to their thickness
constexpr double gives_up_after = 2;  // s, without fewer crossings

// The mesh in weightless air: nothing moves it but its stiffness, and what brings it apart. It resists
// compression with all of its stiffness: cloth that may wrinkle finer than its mesh stays folded where it was
// crossed.
Scene weightless(const UntangleWords& words) {
  const std::string label = "drape untangle " + words.mesh;
  const auto text = [&](const std::string& value) { return Node::of_text(value, label); };
  Node simulation = Node::of_table(label), cloth = Node::of_table(label), root = Node::of_table(label);
  simulation.members["duration"] =
      words.duration.empty() ? text("10 s") : parse_toml_value(words.duration, "--duration");
  simulation.members["gravity"] = parse_toml_value("[0, 0, 0]", label);
  cloth.members["mesh"] = text(words.mesh);
  cloth.members["fabric"] = Node::of_text(words.fabric, "--fabric");
  cloth.members["warp"] = text("down");
  cloth.members["rest_angle"] = text("mesh");
  cloth.members["imperfection"] = text("0 m");
  cloth.members["self_contact"] = parse_toml_value("true", label);
  if (!words.layers.empty()) {
    Node layers = Node::of_table(label);
    for (std::size_t k = 0; k < words.layers.size(); ++k) {
      const auto added = layers.members.emplace(words.layers[k], parse_toml_value(std::to_string(k), label));
      if (!added.second) throw InputError("--layers: names '" + one_line(words.layers[k]) + "' twice");
    }
    cloth.members["layer"] = std::move(layers);
  }
  if (words.weld) cloth.members["weld"] = parse_toml_value("true", label);
  if (!words.scale.empty()) cloth.members["scale"] = parse_toml_value(words.scale, "--scale");
  if (!words.thickness.empty()) cloth.members["thickness"] = parse_toml_value(words.thickness, "--thickness");
  root.members["simulation"] = std::move(simulation);
  root.members["air"] = Node::of_table(label);
  root.members["cloth"] = Node::of_list({std::move(cloth)}, label);
  Scene scene = read_scene(root, {}, {}, label);
  scene.cloths.front().fabric.weave.compression = 1;
  return scene;
}

// The state with the fewest crossings so far, and how it came about.
class Search {
 public:
  // layered: layers come apart even where none crosses another, as where they are at exactly one place.
  Search(Simulation& simulation, bool layered)
      : simulation_(simulation), layered_(layered), best_(simulation.state) {
    at_start_ = fewest_ = Sheets(simulation.cloths, best_.x).crossings();
  }
  void look() {
    const State& state = simulation_.state;
    const int crossings = Sheets(simulation_.cloths, state.x).crossings();
    if (crossings > fewest_ || (crossings == fewest_ && crossings > 0)) return;
    if (crossings < fewest_) since_ = state.time;
    fewest_ = crossings;
    best_ = state;
  }
  bool over() const {
    return !searches() || simulation_.state.time >= since_ + (fewest_ == 0 ? rests_for : gives_up_after);
  }
  bool searches() const { return at_start_ > 0 || layered_; }
  const State& best() const { return best_; }
  int at_start() const { return at_start_; }
  int fewest() const { return fewest_; }
  double since() const { return since_; }  // s

 private:
  Simulation& simulation_;
  bool layered_;
  State best_;
  int at_start_, fewest_;
  double since_ = 0;
};

bool has_vertices_at_one_place(const Cloth& cloth) {
  const std::vector<int> first = welded(cloth.mesh.positions);
  for (int v = 0; v < static_cast<int>(first.size()); ++v)
    if (first[v] != v) return true;
  return false;
}

// [m]
std::string moved(const VecX& from, const VecX& to) {
  double most = 0;
  for (Eigen::Index i = 0; i < from.size() / 3; ++i)
    most = std::max(most, (to - from).segment<3>(3 * i).norm());
  return rounded(1000 * most, 3) + " mm";
}

// Why no more was done where something still crosses.
std::string reason(bool failed, const Search& search, const Cloth& cloth, const UntangleWords& words) {
  std::string why =
      failed                 ? "; a step failed, as told above"
      : interrupted()        ? "; it was interrupted"
      : search.fewest() == 0 ? ", as the polygons are cut in the file; none does as they were cut here"
      : search.over()        ? "; in the last " + rounded(gives_up_after, 2) + " s none came apart for good"
                             : "; --duration ended before they came apart";
  if (!words.weld && words.layers.empty() && has_vertices_at_one_place(cloth))
    why += "; vertices at one place are not joined, and what meets there may pass: --weld joins them";
  return why;
}

// Returns how many pairs cross in what was written; a polygon may be cut otherwise there. What crosses
// nowhere, and has no layers, is written as it was read.
int write(const UntangleWords& words, const Scene& scene, const Cloth& cloth, const Search& search) {
  const TriangleMesh mesh = read_obj(words.mesh);
  std::vector<Vec3> places = mesh.positions;
  const double scale = scene.cloths.front().placement.scale;
  if (search.searches()) {
    places = cloth.embedding.positions(search.best().x);
    for (Vec3& place : places) place /= scale;
  }
  write_obj(words.out, mesh, places);
  const TriangleMesh written = read_obj(words.out);
  Sheets sheets;
  sheets.add(words.out, written.triangles, written.positions);
  return sheets.crossings();
}

}  // namespace

int untangle_file(const UntangleWords& words) {
  if (!std::filesystem::path(words.mesh).extension().compare(".toml"))
    throw InputError(words.mesh + ": expected a mesh (.obj); a scene is untangled while it runs");
  if (std::filesystem::path(words.out).extension() != ".obj")
    throw InputError(words.out + ": expected a name that ends in .obj");
  std::error_code missing;
  if (std::filesystem::equivalent(words.mesh, words.out, missing))
    throw InputError(words.out +
                     ": is the mesh itself, which would be overwritten; choose another name with -o");
  (void)AtomicFile(words.out);  // whether it can be written: now, and not when all is computed
  const Scene scene = weightless(words);
  Simulation simulation = make_simulation(scene);
  if (!words.quiet)
    for (const std::string& message : simulation.messages)
      if (!message.starts_with("note")) std::fprintf(stderr, "%s\n", one_line(message).c_str());
  const VecX start = simulation.state.x;
  Search search(simulation, words.layers.size() > 1);
  TimeLoop loop(simulation, Schedule(StepGrid(scene.simulation.time_step), 0, scene.simulation.duration));
  catch_interrupts();
  bool failed = false;
  while (!loop.over() && !interrupted() && !search.over()) {
    const StepReport& report = loop.step();
    failed = !report.done;
    if (failed)
      std::fprintf(stderr, "error: the step from %s s failed: %s\n",
                   rounded(simulation.state.time, 4).c_str(), one_line(report.failure.what).c_str());
    simulation.state.v.setZero();  // what was moved does not coast
    search.look();
  }
  const int crossings = write(words, scene, simulation.cloths.front(), search);
  if (!words.quiet)
    std::printf("crossings: %s at the start, %s after %s s\nno vertex has moved by more than %s\nwrote %s\n",
                counted(search.at_start(), "pair").c_str(),
                crossings == 0 ? "none" : std::to_string(crossings).c_str(),
                rounded(search.since(), 3).c_str(), moved(start, search.best().x).c_str(), words.out.c_str());
  if (crossings > 0)
    std::fprintf(stderr, "error: %s still cross%s; 'drape check %s' says where\n",
                 counted(crossings, "pair").c_str(),
                 reason(failed, search, simulation.cloths.front(), words).c_str(), words.out.c_str());
  return interrupted() ? 130 : failed || crossings > 0 ? 1 : 0;
}

}  // namespace drape::app
