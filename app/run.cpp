#include "app/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/interrupt.h"
#include "app/measure.h"
#include "app/progress.h"
#include "app/summary.h"
#include "mesh/threads.h"

namespace drape {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

int first_not_finite(const State& state) {
  for (int i = 0; i < state.particles(); ++i)
    if (!state.x.segment<3>(3 * i).allFinite() || !state.v.segment<3>(3 * i).allFinite()) return i;
  return -1;
}

// The force that pulls hardest at a particle: the term to look at when the solve itself names none.
std::string strongest_term(const System& system, const State& state, int particle) {
  std::string strongest = "gravity";
  double largest = system.masses()[static_cast<std::size_t>(particle)] * system.gravity_acceleration().norm();
  for (const auto& force : system.forces()) {
    VecX f = VecX::Zero(state.x.size());
    force->add_force(state.x, state.v, f);
    const double here = f.segment<3>(3 * particle).norm();
    if (here <= largest) continue;  // not a number counts as strongest
    largest = here;
    strongest = force->name();
  }
  return strongest;
}

// s, until when bodies or pins are moved, or seams close: cloth that rests before may still be set going.
double last_motion(const Scene& scene, const Simulation& simulation) {
  const Constraints& constraints = *simulation.constraints;
  double last = 0;
  for (const Cloth& cloth : simulation.cloths)
    for (const Cloth::Stitched& open : cloth.seams) last = std::max(last, open.seam.close);
  for (std::size_t k = 0; k < scene.cloths.size() + scene.softs.size(); ++k)
    for (const PinEntry& pin : scene.pins_of(k))
      if (pin.motion) last = std::max(last, pin.motion->last_time());
  for (const MovingBody& body : constraints.bodies()) {
    last = std::max(last, body.obstacle().motion.last_time());
    const auto* const deforming = std::get_if<DeformingBody>(&body.obstacle().shape);
    if (deforming && deforming->frames->frame_count() > 1)
      last = std::max(last, deforming->frames->last_time());
  }
  return last;
}

class Run {
 public:
  Run(const Scene& scene, Simulation& simulation, Output& output, const RunOptions& options);
  int to_the_end();

 private:
  bool step();
  bool at_rest(const StepRow& row) const;
  bool slow(double cloth_speed) const;
  void record_step(const StepRow& row);
  void write_due_frames();
  void write_frame();
  bool at_last_step() const { return next_step_ == step_count_; }
  bool at_end() const { return next_step_ > step_count_; }
  void conclude();
  void note_failure(const StepFailure& failure);
  void tell_once(bool& told, const std::string& line);
  void tell_of_open_seams();
  int exit_code() const { return record_.failure ? 1 : record_.interrupted ? 130 : 0; }

  const SimulationOptions& wanted_;
  Simulation& simulation_;
  Output& output_;
  bool quiet_;
  Progress progress_;
  RunRecord record_;
  State before_;  // the step under way
  Clock::time_point start_ = Clock::now();
  long step_count_, next_step_ = 1;
  long next_frame_ = 0;
  double last_motion_;         // s
  double last_step_;           // s, of the last step
  double settled_since_ = -1;  // s, -1: it moves
  bool told_cut_ = false, told_not_converged_ = false;
};

Run::Run(const Scene& scene, Simulation& simulation, Output& output, const RunOptions& options)
    : wanted_(scene.simulation),
      simulation_(simulation),
      output_(output),
      quiet_(options.quiet),
      progress_(wanted_.duration, quiet_),
      last_motion_(last_motion(scene, simulation)) {
  const double h = wanted_.time_step, exact = wanted_.duration / h;
  step_count_ = std::max(1L, std::lround(exact));
  last_step_ = h;
  if (std::abs(exact - static_cast<double>(step_count_)) >
      1e-6 * exact) {  // not a whole number: the last step is shorter
    step_count_ = static_cast<long>(std::ceil(exact));
    last_step_ = wanted_.duration - h * static_cast<double>(step_count_ - 1);
  }
  record_.scene = scene.label;
  record_.integrator = simulation.integrator->name();
  record_.contact = name(contact_mode(record_.integrator, wanted_.step.contact));
  record_.linear_solver = wanted_.linear_solver;
  record_.threads = threads();
  record_.duration = wanted_.duration;
  record_.time_step = h;
  record_.warnings = simulation.messages;
  for (const Cloth& c : simulation.cloths)
    if (c.soft)
      record_.softs.push_back({c.name, c.end_particle - c.first_particle, c.mesh.vertex_count(),
                               c.mesh.triangle_count(), *c.soft});
    else
      record_.cloths.push_back(
          {c.name, c.mesh.vertex_count(), c.mesh.triangle_count(), c.report.edges, c.report.diagonals});
}

int Run::to_the_end() {
  write_due_frames();
  while (!at_end() && !interrupted() && step()) {
  }
  record_.interrupted = interrupted() && !at_end() && !record_.failure;
  conclude();
  return exit_code();
}

// False when the run is over: it failed, or it has settled.
bool Run::step() {
  State& state = simulation_.state;
  before_ = state;
  StepRow row;
  row.step = next_step_;
  row.report = simulation_.advance(at_last_step() ? last_step_ : wanted_.time_step);
  if (const int bad = first_not_finite(state); bad >= 0) {  // out of the range of numbers
    if (row.report.done) row.report.failure = {"a position or velocity is not a finite number", bad, {}};
    row.report.done = false;
    state = before_;
  }
  if (!row.report.done) {
    note_failure(row.report.failure);
    return false;
  }
  // Whole steps from the start, not a sum that drifts by round-off.
  state.time = at_last_step() ? wanted_.duration : static_cast<double>(next_step_) * wanted_.time_step;
  row.time = state.time;
  row.kinetic_energy = simulation_.system->kinetic_energy(state.v);
  row.elastic_energy = simulation_.system->elastic_energy(state.x);
  row.gravity_energy = simulation_.system->gravity_energy(state.x);
  row.max_speed = max_speed(state.v);
  row.max_edge_strain = largest_strain(simulation_.cloths, state.x);
  record_step(row);
  ++next_step_;
  write_due_frames();
  progress_.show(row);

  if (!at_rest(row))
    settled_since_ = -1;
  else if (settled_since_ < 0)
    settled_since_ = row.time;
  return !(wanted_.stop_when_settled && settled_since_ >= 0 && row.time - settled_since_ >= settle_time);
}

// Nothing moves, nor is it going to.
bool Run::at_rest(const StepRow& row) const { return slow(row.max_speed) && !(row.time < last_motion_); }

// Neither cloth nor body with a mass moves. [m/s]
bool Run::slow(double cloth_speed) const {
  if (!(cloth_speed < wanted_.settle_speed)) return false;
  for (const MovingBody& body : simulation_.constraints->bodies())
    if (body.reacting() && !(body.reacting()->velocity().norm() < wanted_.settle_speed)) return false;
  return true;
}

void Run::tell_once(bool& told, const std::string& line) {
  if (std::exchange(told, true)) return;
  progress_.say(line);
  record_.warnings.push_back(line);
}

void Run::record_step(const StepRow& row) {
  const StepReport& report = row.report;
  const auto write_start = Clock::now();
  output_.step(row);
  record_.write_ms += 1000 * seconds_since(write_start);
  record_.steps = row.step;
  record_.step_ms.push_back(report.step_ms);
  record_.linear_iterations.push_back(report.linear_iterations);
  record_.inner_steps.push_back(report.inner_steps);
  record_.inner_rejected += report.inner_rejected;
  record_.assemble_ms += report.assemble_ms;
  record_.solve_ms += report.solve_ms;
  record_.collide_ms += report.collide_ms;
  record_.max_speed = row.max_speed;
  record_.max_edge_strain = row.max_edge_strain;
  record_.largest_speed = std::max(record_.largest_speed, row.max_speed);
  record_.largest_edge_strain = std::max(record_.largest_edge_strain, row.max_edge_strain);
  record_.max_penetration = std::max(record_.max_penetration, report.penetration);
  record_.substeps_max = std::max(record_.substeps_max, report.substeps);
  const std::string at = "warning: step " + std::to_string(row.step) + " (" + rounded(row.time, 4) + " s) ";
  if (report.substeps > 1) {
    ++record_.steps_cut;
    tell_once(told_cut_, at + "failed whole and was taken in " + std::to_string(report.substeps) +
                             " pieces; further ones are counted in run.json (steps_cut)");
  }
  if (!report.converged) {
    ++record_.steps_not_converged;
    tell_once(told_not_converged_,
              at + "had a solve that ended before it reached its tolerance; further ones are "
                   "counted in run.json (steps_not_converged)");
  }
}

void Run::write_frame() {
  const auto start = Clock::now();
  output_.frame(simulation_.state);
  record_.write_ms += 1000 * seconds_since(start);
}

// Frame k belongs to the time k / rate: the first state at or after it.
void Run::write_due_frames() {
  if (!(wanted_.frame_rate > 0)) return;
  const double soon = simulation_.state.time + 1e-6 * wanted_.time_step;
  while (static_cast<double>(next_frame_) <= soon * wanted_.frame_rate) {
    write_frame();
    ++next_frame_;
  }
}

void Run::note_failure(const StepFailure& failure) {
  Failure noted;
  noted.step = next_step_;
  noted.time = simulation_.state.time;
  noted.what = failure.what;
  noted.term = failure.force;
  std::string line = "error: step " + std::to_string(next_step_) + " (from " + rounded(noted.time, 4) +
                     " s) failed: " + failure.what;
  if (failure.particle >= 0 && failure.particle < simulation_.state.particles()) {
    const Cloth& cloth = simulation_.cloth_of(failure.particle);
    const Vec3 x = simulation_.state.x.segment<3>(3 * failure.particle);
    noted.cloth = cloth.name;
    if (noted.term.empty())
      noted.term = strongest_term(*simulation_.system, simulation_.state, failure.particle);
    noted.vertex = cloth.embedding.vertex(failure.particle);
    const std::string place =
        noted.vertex < 0 ? "a particle inside " : "vertex " + std::to_string(noted.vertex) + " of ";
    line += ", worst at " + place + cloth.name + " (at " + rounded(x[0], 4) + ", " + rounded(x[1], 4) + ", " +
            rounded(x[2], 4) + " m)";
  }
  if (!noted.term.empty()) line += "; the term is '" + noted.term + "'";
  line += "; try a smaller --time-step, a lower stiffness, or look at the mesh there with 'drape check'";
  progress_.clear();
  std::fprintf(stderr, "%s\n", one_line(line).c_str());
  record_.failure = noted;
}

// Those that should have closed by now.
void Run::tell_of_open_seams() {
  for (const Cloth& cloth : simulation_.cloths)
    for (const Cloth::Stitched& open : cloth.seams) {
      bool told = !open.seam.merge || record_.failure || simulation_.state.time < open.seam.close;
      tell_once(told, "warning: seam " + one_line(open.seam.name) + " of " + cloth.name +
                          " has not closed: it is " +
                          rounded(1000 * open.seam.gap(cloth.embedding, simulation_.state.x), 3) +
                          " mm open; is a body or a pin between its panels, is it the wrong pair, or the "
                          "stiffness too low?");
    }
}

void Run::conclude() {
  if (!(wanted_.frame_rate > 0)) write_frame();
  record_.simulated_seconds = simulation_.state.time;
  record_.settled = record_.steps > 0 && slow(record_.max_speed);
  for (double depth : simulation_.constraints->penetration(simulation_.state.x))
    record_.max_penetration = std::max(record_.max_penetration, depth);
  tell_of_open_seams();
  record_.bodies = body_records(simulation_);
  record_.state_hash = state_hash(simulation_.state);
  record_.wall_seconds = seconds_since(start_);
  output_.finish(simulation_.state, record_);
  progress_.clear();
  if (!quiet_) std::fputs(summary(record_, output_).c_str(), stdout);
}

}  // namespace

int run(const Scene& scene, const RunOptions& options) {
  if (scene.simulation.threads > 0) set_threads(scene.simulation.threads);
  Simulation simulation = make_simulation(scene);
  if (!options.quiet)
    for (const std::string& message : simulation.messages)
      std::fprintf(stderr, "%s\n", one_line(message).c_str());
  catch_interrupts();
  Output output(options.out, scene, simulation, options.frames);
  return Run(scene, simulation, output, options).to_the_end();
}

}  // namespace drape
