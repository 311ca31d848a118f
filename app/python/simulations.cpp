// A scene made ready, and runs of it.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "app/python/arrays.h"
#include "app/python/in_use.h"
#include "app/python/linear.h"
#include "app/python/released.h"
#include "app/python/reports.h"
#include "app/python/scenes.h"
#include "app/run/run.h"
#include "app/simulation/measure.h"
#include "app/view/view.h"
#include "mesh/base/errors.h"
#include "mesh/base/threads.h"

namespace drape::app::python {
namespace {

namespace fs = std::filesystem;
using namespace py::literals;

// With the recording that its integrator refers to; neither is moved.
struct Whole {
  Simulation simulation;
  SystemRecording recording;
  int runs_begun = 0;

  explicit Whole(const Scene& scene) : simulation(make_simulation(scene)) {
    simulation.use([this, wanted = scene.simulation](System& system, Constraints& constraints) {
      return make_integrator(wanted.integrator, system, constraints,
                             recorded(make_linear_solver(wanted.linear_solver), recording), wanted.step);
    });
  }
};
using Shared = std::shared_ptr<Whole>;

// Between two steps: what is copied from it has the same time everywhere.
const Simulation& between_steps(const Whole& whole) {
  require_free(&whole.simulation.state);
  return whole.simulation;
}

fs::path path_of(const py::object& given) {
  if (!py::isinstance<py::str>(given) && !py::isinstance<py::bytes>(given) &&
      !py::hasattr(given, "__fspath__"))
    throw py::type_error("scene: expected a path or a dict, but got a " +
                         std::string(py::str(py::type::of(given).attr("__name__"))));
  try {
    return given.cast<fs::path>();
  } catch (const py::cast_error&) {
    throw py::value_error("scene: " + std::string(py::repr(given)) + " cannot be a path");
  }
}

// A dict, or the path of a TOML file; paths in it are relative to `folder`,
// by default that of the file or the current one.
Scene scene_of(const py::object& given, const py::dict& settings, const std::optional<fs::path>& folder) {
  const bool data = py::isinstance<py::dict>(given);
  const fs::path path = data ? fs::path() : path_of(given);
  Node root = data ? node_of(given, "scene") : read_toml(path);
  std::vector<Setting> applied;
  for (const auto& [key, value] : settings) {
    const std::string where = "settings[" + std::string(py::repr(key)) + "]";
    const Node node = node_of(value, where);
    applied.push_back({std::string(py::str(key)), written(node), where});
    apply(applied.back().path, node, root);
  }
  Scene scene =
      read_scene(std::move(root), {}, folder.value_or(path.parent_path()), data ? "scene" : path.string());
  scene.settings = std::move(applied);
  return scene;
}

Shared made(const py::object& given, const py::dict& settings, const std::optional<fs::path>& folder) {
  const Scene scene = scene_of(given, settings, folder);
  const Released released;
  if (scene.simulation.threads > 0) set_threads(scene.simulation.threads);
  return std::make_shared<Whole>(scene);
}

// One of its cloths, soft bodies or ropes.
struct Part {
  Shared whole;
  std::size_t number;

  const Cloth& cloth() const { return whole->simulation.cloths[number]; }
  // Every vertex is a particle of its own, in order.
  bool plain() const {
    const Cloth& c = cloth();
    bool all = c.embedding.vertices() == c.end_particle - c.first_particle;
    for (int v = 0; all && v < c.embedding.vertices(); ++v)
      all = c.embedding.particle(v) == c.first_particle + v;
    return all;
  }
  // (vertices, 3) of x or v.
  py::object rows(const VecX& all) const {
    require_free(&whole->simulation.state.x);
    const Cloth& c = cloth();
    if (plain())
      return view(all.data() + 3 * c.first_particle, {c.embedding.vertices(), 3}, py::cast(whole),
                  Access::write);
    require_free(&whole->simulation.state);
    py::object copy = copied_rows(c.embedding.positions(all));
    copy.attr("setflags")("write"_a = false);
    return copy;
  }
};

std::vector<Part> parts(const Shared& whole) {
  std::vector<Part> all;
  for (std::size_t k = 0; k < whole->simulation.cloths.size(); ++k) all.push_back({whole, k});
  return all;
}

Frames frames_of(const std::string& word) {
  if (word == "pc2") return Frames::pc2;
  if (word == "obj") return Frames::obj;
  if (word == "none") return Frames::none;
  throw py::value_error("frames: there is no '" + word + "'; " + suggestion(word, {"pc2", "obj", "none"}));
}

// A run that is under way. Where it writes files, nobody else steps the simulation until it is finished; a
// run without files may be left in its middle, and ends where another one begins.
class PartialRun {
 public:
  PartialRun(Shared whole, const std::optional<fs::path>& out, const std::string& frames,
             std::optional<double> duration, std::optional<double> time_step)
      : whole_(std::move(whole)) {
    const std::vector<const void*> whole_run = {whole_.get()};
    in_use_.emplace(whole_run);
    const InUse state({&whole_->simulation.state});
    const RunOptions options{out.value_or(fs::path()), frames_of(frames), true, duration, time_step};
    {
      const Released released;
      run_.emplace(whole_->simulation, options);
    }
    number_ = ++whole_->runs_begun;
    if (!out) in_use_.reset();
  }

  bool over() const { return !run_ || run_->over(); }

  RunStep step() {
    if (over()) throw py::value_error("the run is over");
    if (number_ != whole_->runs_begun)
      throw std::runtime_error(
          "this loop over the steps is over: another run of the simulation has begun since its last step");
    const InUse state(used());
    StepRow row;
    {
      const Released released;
      row = run_->step();
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();  // Ctrl-C: the step is done all the same
    if (!run_->failure().empty()) raise_step_error(run_->failure(), row.report);
    return RunStep(row);
  }

  std::string finish() {
    if (!run_) throw py::value_error("the run is finished");
    in_use_.reset();
    const InUse all({whole_.get(), &whole_->simulation.state, this});
    const Released released;
    const std::string json = run_json(run_->finish());
    run_.reset();
    return json;
  }

 private:
  // By a step. Where seams may close or cloth may tear, arrays may get other memory: so also what stands for
  // that.
  std::vector<const void*> used() const {
    const Simulation& simulation = whole_->simulation;
    std::vector<const void*> all = {&simulation.state, this};
    const auto changes = [](const Cloth& cloth) { return !cloth.seams.empty() || cloth.tearing; };
    if (std::any_of(simulation.cloths.begin(), simulation.cloths.end(), changes))
      all.push_back(&simulation.state.x);
    return all;
  }

  Shared whole_;
  int number_ = 0;
  std::optional<InUse> in_use_;
  std::optional<Run> run_;
};

void add_parts(py::module_& m) {
  py::class_<Part>(m, "Cloth", "A cloth, a soft body or a rope of a simulation.")
      .def_property_readonly("name", [](const Part& part) { return part.cloth().name; })
      .def_property_readonly(
          "mesh", [](const Part& part) { return TriangleMesh(part.cloth().mesh); },
          "as the file has it, placed, with the borders that tears have given it: a copy")
      .def_property_readonly(
          "soft", [](const Part& part) { return part.cloth().soft.has_value(); }, "a soft body, and no cloth")
      .def_property_readonly(
          "rope", [](const Part& part) { return part.cloth().rope.has_value(); }, "a rope, and no cloth")
      .def_property_readonly(
          "particles",
          [](const Part& part) {
            return py::slice(part.cloth().first_particle, part.cloth().end_particle, 1);
          },
          "where they are in the state: sim.state.x[cloth.particles]")
      .def_property_readonly(
          "positions", [](const Part& part) { return part.rows(part.whole->simulation.state.x); },
          "(vertices, 3) [m], now: a view that can be written where every vertex is a particle of its own, "
          "else\n"
          "(seams that have closed, vertices at one place, soft bodies) a read-only copy")
      .def_property_readonly(
          "velocities", [](const Part& part) { return part.rows(part.whole->simulation.state.v); },
          "(vertices, 3) [m/s], the same")
      .def("__repr__", [](const Part& part) {
        return "Cloth('" + part.cloth().name + "', " + counted(part.cloth().mesh.vertex_count(), "vertex") +
               ", " + counted(part.cloth().mesh.triangle_count(), "triangle") + ")";
      });
}

void add_runs(py::module_& m) {
  py::class_<PartialRun>(m, "Run", "A run under way; Simulation.run and `for step in simulation` make them.")
      .def(py::init<Shared, const std::optional<fs::path>&, const std::string&, std::optional<double>,
                    std::optional<double>>(),
           "simulation"_a.none(false), "out"_a = py::none(), "frames"_a = "pc2", "duration"_a = py::none(),
           "time_step"_a = py::none(),
           "From where the simulation is, for `duration` [s] or what is left of the scene's.")
      .def_property_readonly("over", &PartialRun::over,
                             "the end is reached, it has settled, or a step failed")
      .def("step", &PartialRun::step,
           "The next step. Other Python threads go on meanwhile. StepError when it fails.")
      .def("finish", &PartialRun::finish, "Writes the files and returns the text of run.json. Once.");
}

}  // namespace

void add_simulations(py::module_& m) {
  add_parts(m);
  py::class_<Whole, Shared>(m, "Simulation", "A scene made ready to run.")
      .def(py::init(&made), "scene"_a, "settings"_a = py::dict(), "folder"_a = py::none())
      .def_property_readonly(
          "state", [](Whole& whole) -> State& { return whole.simulation.state; },
          py::return_value_policy::reference_internal,
          "positions and velocities of all particles: writing into them changes the simulation")
      .def_property_readonly("cloths", &parts, "cloths, then soft bodies")
      .def_property_readonly(
          "messages", [](const Whole& whole) { return whole.simulation.messages; },
          "'warning: ...' and 'note: ...', a line each")
      .def_property_readonly(
          "time", [](const Whole& whole) { return whole.simulation.state.time; }, "s")
      .def_property_readonly(
          "time_step", [](const Whole& w) { return w.simulation.scene->simulation.time_step; },
          "s, as the scene asks for it; run() takes shorter steps where frames need them")
      .def_property_readonly(
          "duration", [](const Whole& w) { return w.simulation.scene->simulation.duration; },
          "s, of the scene")
      .def_property_readonly(
          "state_hash", [](const Whole& whole) { return state_hash(between_steps(whole).state); },
          "16 hexadecimal digits, as in run.json: the same when every bit is")
      .def_property_readonly(
          "masses", [](const Whole& whole) { return read_only(between_steps(whole).system->masses()); },
          "(n,) [kg], of the particles: a copy that cannot be written")
      .def_property(
          "record_systems", [](const Whole& whole) { return whole.recording.on; },
          [](Whole& whole, bool on) { whole.recording.on = on; },
          "whether the linear system of each step is kept")
      .def_property_readonly(
          "last_system",
          [](const Whole& whole) {
            between_steps(whole);
            return last_system(whole.recording);
          },
          "the last LinearSystem that was solved while record_systems was True, a copy; or None");
  add_runs(m);
  m.def("view_html", &view_html, "folder"_a, py::call_guard<Released>(),
        "The page that plays an output folder, as `drape view` writes it.");
  m.def("has_viewer", &has_viewer, "whether the viewer is in this build");
}

}  // namespace drape::app::python
