#include "app/run/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/base/interrupt.h"
#include "app/recording/scene_record.h"
#include "app/run/summary.h"
#include "app/simulation/measure.h"
#include "app/simulation/sheets.h"
#include "mesh/base/errors.h"
#include "mesh/base/threads.h"
#include "mesh/triangles/topology.h"

namespace drape::app {
namespace {

// The caches of frames keep floats, so it is their rounded places that are looked at.
int crossings_as_written(const Simulation& simulation) {
  const VecX written = simulation.state.x.cast<float>().cast<double>();
  return Sheets(simulation.cloths, written).crossings();
}

// Whether nothing in the scene may pass through anything else that is simulated.
bool all_meet(const Scene& scene) {
  const auto meets = [](const auto& part) { return part.self_contact; };
  return std::all_of(scene.cloths.begin(), scene.cloths.end(), meets) &&
         std::all_of(scene.softs.begin(), scene.softs.end(), meets) &&
         std::all_of(scene.ropes.begin(), scene.ropes.end(), meets);
}

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The force that pulls hardest at a particle: the term to look at when the solve itself names none.
std::string strongest_term(const System& system, const State& state, int particle) {
  std::string strongest = "gravity";
  double largest = system.masses()[particle] * system.gravity_acceleration().norm();
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
  for (std::size_t k = 0; k < scene.part_count(); ++k)
    for (const PinEntry& pin : scene.pins_of(k))
      if (pin.motion) last = std::max(last, pin.motion->last_time());
  for (const MovingBody& body : constraints.bodies()) {
    last = std::max(last, body.obstacle().motion.last_time());
    const DeformingBody* const deformed = deforming(body.obstacle().shape);
    if (deformed && deformed->frames->frame_count() > 1) last = std::max(last, deformed->frames->last_time());
  }
  return last;
}

Eigen::AlignedBox3d box_about(const Cloth& cloth, const VecX& x) {
  Eigen::AlignedBox3d box;
  for (const Vec3& place : cloth.embedding.positions(x)) box.extend(place);
  return box;
}

// Schedules count from zero.
double start_of(const State& state) {
  if (!(state.time >= 0) || !std::isfinite(state.time))
    throw InputError("the time of the state is " + rounded(state.time, 6) + " s; it has to be 0 or more");
  return state.time;
}

StepGrid grid_of(const SimulationOptions& wanted, const std::optional<double>& time_step) {
  if (!time_step) return StepGrid(wanted.time_step, wanted.frame_rate);
  if (!(*time_step > 0) || !std::isfinite(*time_step))
    throw InputError("time step = " + rounded(*time_step, 6) + " s: a time step is greater than zero");
  return StepGrid(*time_step);
}

// A run in parts ends each of them at a time of the whole.
double end_of(const SimulationOptions& wanted, const StepGrid& grid, double start,
              const std::optional<double>& duration) {
  if (!duration) return std::max(start, wanted.duration);
  if (!(*duration >= 0) || !std::isfinite(*duration))
    throw InputError("duration = " + rounded(*duration, 6) + " s: a duration is not negative");
  if (*duration / grid.step() > most_steps)
    throw InputError("duration = " + rounded(*duration, 6) + " s: would take " +
                     rounded(*duration / grid.step(), 3) + " steps; check the units");
  if (*duration > 0 && *duration <= least_of_a_step * grid.step())
    throw InputError("duration = " + rounded(*duration, 6) + " s: less than a millionth of a step of " +
                     rounded(grid.step(), 6) + " s, so that there would be none; check the units");
  return grid.rounded(start + *duration);
}

}  // namespace

Run::Run(Simulation& simulation, const RunOptions& options)
    : wanted_(simulation.scene->simulation),
      simulation_(simulation),
      grid_(grid_of(wanted_, options.time_step)),
      end_time_(end_of(wanted_, grid_, start_of(simulation.state), options.duration)),
      loop_(simulation, Schedule(grid_, simulation.state.time, end_time_)),
      progress_(end_time_, options.quiet),
      last_motion_(last_motion(*simulation.scene, simulation)),
      from_start_(simulation.state.time == 0) {
  for (const Cloth& cloth : simulation_.cloths) begins_.push_back(box_about(cloth, simulation_.state.x));
  if (!options.out.empty()) output_.emplace(options.out, *simulation.scene, simulation, options.frames);
  describe();
  write_due_frame();
}

void Run::describe() {
  record_.scene = simulation_.scene->label;
  record_.integrator = simulation_.integrator->name();
  record_.contact = name(contact_mode(record_.integrator, wanted_.step.contact));
  record_.linear_solver = wanted_.linear_solver;
  record_.threads = threads();
  record_.duration = end_time_;
  record_.time_step = grid_.step();
  record_.time_step_asked = grid_.asked();
  record_.step_as_asked = grid_.as_asked();
  record_.numerics = numerics_json(wanted_);
  record_.settings = settings_json(simulation_.scene->settings);
  record_.warnings = simulation_.messages;
  record_.energy.begin(simulation_.system->total_energy(simulation_.state));
  row_.crossings = crossings_as_written(simulation_);
  record_.crossings_at_start = record_.crossings_max = row_.crossings;
  const Scene& scene = *simulation_.scene;
  for (std::size_t k = 0; k < simulation_.cloths.size(); ++k) {
    const Cloth& c = simulation_.cloths[k];
    const Json pins = pins_json(scene.pins_of(k), c);
    if (c.soft)
      record_.softs.push_back({c.name, c.end_particle - c.first_particle, c.mesh.vertex_count(),
                               c.mesh.triangle_count(), *c.soft,
                               material_json(scene.softs[k - scene.cloths.size()].material), pins});
    else if (c.rope)
      describe_rope(scene.ropes[k - scene.cloths.size() - scene.softs.size()], c, pins);
    else
      record_.cloths.push_back({c.name, c.mesh.vertex_count(), c.mesh.triangle_count(), c.report.edges,
                                c.report.diagonals, fabric_json(scene.cloths[k], &c), pins, seams_json(c),
                                c.imperfection, c.tearing ? std::optional(c.tearing->limit) : std::nullopt});
  }
}

void Run::describe_rope(const RopeEntry& entry, const Cloth& rope, const Json& pins) {
  double length = 0;
  for (const RestEdge& segment : rope.edges) length += segment.L;
  record_.ropes.push_back({rope.name, rope.mesh.vertex_count(), static_cast<int>(rope.edges.size()), length,
                           rope_material_json(entry.material), pins, ends_json(entry)});
}

const StepRow& Run::step() {
  const State& state = simulation_.state;
  const double started = state.time;
  x_before_ = state.x;
  row_.report = loop_.step();
  row_.step = loop_.number();
  row_.time = state.time;
  row_.kinetic_energy = simulation_.system->kinetic_energy(state.v);
  row_.elastic_energy = simulation_.system->elastic_energy(state.x);
  row_.contact_energy = row_.report.contact_energy;
  row_.gravity_energy = simulation_.system->gravity_energy(state.x);
  row_.max_speed = max_speed(state.v);
  fastest_way_ = 0;
  if (state.x.size() == x_before_.size() && state.time > started) {
    x_before_ -= state.x;
    fastest_way_ = max_speed(x_before_) / (state.time - started);
  }
  row_.max_edge_strain = largest_strain(simulation_.cloths, state.x);
  row_.strains = triangle_strains(simulation_.cloths, state.x, strain_of_triangles_);
  if (!row_.report.done) {
    note_failure(row_.report.failure);
    return row_;
  }
  framed_ = false;
  watch_settling();
  count_crossings();
  record_step(row_);
  write_due_frame();
  progress_.show(row_);
  return row_;
}

void Run::watch_settling() {
  if (!at_rest(row_))
    settled_since_ = -1;
  else if (settled_since_ < 0)
    settled_since_ = row_.time;
  settled_ = wanted_.stop_when_settled && settled_since_ >= 0 && row_.time - settled_since_ >= settle_time;
}

// Nothing moves, nor is it going to.
bool Run::at_rest(const StepRow& row) const {
  return row.report.stood_still == 0 && slow(std::max(row.max_speed, fastest_way_)) &&
         !(row.time < last_motion_);
}

// Neither cloth nor body with a mass moves, nor turns. [m/s]
bool Run::slow(double cloth_speed) const {
  if (!(cloth_speed < wanted_.settle_speed)) return false;
  return std::ranges::none_of(simulation_.constraints->bodies(), [&](const MovingBody& body) {
    const ReactingBody* const r = body.reacting();
    if (!r) return false;
    const double size = 0.5 * bounds_of(body.obstacle().shape).diagonal().norm();
    return !(r->velocity().norm() + size * r->spin().norm() < wanted_.settle_speed);
  });
}

void Run::tell_once(bool& told, const std::string& line) {
  if (std::exchange(told, true)) return;
  progress_.say(line);
  record_.warnings.push_back(line);
}

void Run::record_step(const StepRow& row) {
  const StepReport& report = row.report;
  const auto write_start = Clock::now();
  if (output_) output_->step(row);
  record_.write_ms += 1000 * seconds_since(write_start);
  record_.steps = loop_.done();
  record_.step_ms.push_back(report.step_ms);
  record_.linear_iterations.push_back(report.linear_iterations);
  record_.linear_solves.push_back(report.linear_solves);
  record_.multigrid_solves += report.multigrid_solves;
  record_.self_contacts = report.self_contacts;
  record_.self_contacts_max = std::max(record_.self_contacts_max, report.self_contacts);
  record_.self_guarded += report.self_guarded;
  record_.self_held += report.self_held;
  touched_ = touched_ || report.contacts > 0 || report.self_contacts > 0 ||
             !simulation_.constraints->faces().touching().empty();
  record_.torn += report.torn;
  if (report.torn > 0 && !record_.first_torn) record_.first_torn = row.time;
  record_.pinched = report.pinched;
  record_.pinched_max = std::max(record_.pinched_max, report.pinched);
  record_.inner_steps.push_back(report.inner_steps);
  record_.inner_rejected += report.inner_rejected;
  record_.assemble_ms += report.assemble_ms;
  record_.solve_ms += report.solve_ms;
  record_.collide_ms += report.collide_ms;
  record_.energy.add(row.energy());
  record_.max_speed = row.max_speed;
  record_.max_edge_strain = row.max_edge_strain;
  record_.strains = row.strains;
  record_.largest_speed = std::max(record_.largest_speed, row.max_speed);
  record_.largest_edge_strain = std::max(record_.largest_edge_strain, row.max_edge_strain);
  record_.max_penetration = std::max(record_.max_penetration, report.penetration);
  record_.contact_residual = std::max(record_.contact_residual, report.contact_residual);
  record_.substeps_max = std::max(record_.substeps_max, report.substeps);
  const std::string at = "warning: step " + std::to_string(row.step) + " (" + rounded(row.time, 4) + " s) ";
  if (report.substeps > 1) {
    ++record_.steps_cut;
    tell_once(told_cut_, at + "failed whole and was taken in " + std::to_string(report.substeps) +
                             " pieces; further ones are counted in run.json (steps_cut)");
  }
  if (report.stood_still > 0)
    tell_once(told_still_,
              at + "left " + counted(report.stood_still, "particle") +
                  " of cloth where they were, since nothing else kept cloth from passing through "
                  "cloth: their motion is lost; is the cloth stretched or crumpled at the start, or "
                  "the time step too long?");
  if (!report.converged) {
    ++record_.steps_not_converged;
    tell_once(told_not_converged_,
              at + "had a solve that ended before it reached its tolerance, contacts that had not settled "
                   "(contact_residual of steps.csv), or cloth that had to stand still; further ones are "
                   "counted in run.json (steps_not_converged)");
  }
}

void Run::count_crossings() {
  if (!loop_.schedule().frame() && !over()) return;  // the end is a frame, too
  row_.crossings = crossings_as_written(simulation_);
  record_.crossings_max = std::max(record_.crossings_max, row_.crossings);
  if (row_.crossings > record_.crossings_at_start) tell_of_crossings(row_.crossings);
}

void Run::tell_of_crossings(int crossings) {
  if (!all_meet(*simulation_.scene)) return;
  tell_once(told_crossings_, "warning: after step " + std::to_string(row_.step) + " (" +
                                 rounded(row_.time, 4) + " s) " + counted(crossings, "pair") +
                                 " of triangles cross, " + std::to_string(record_.crossings_at_start) +
                                 " at the start; 'drape check' says where");
}

void Run::write_frame() {
  framed_ = true;
  if (!output_) return;
  const auto start = Clock::now();
  output_->frame(simulation_.state);
  record_.write_ms += 1000 * seconds_since(start);
}

void Run::write_due_frame() {
  if (loop_.schedule().frame()) write_frame();
}

void Run::note_failure(const StepFailure& failure) {
  Failure noted;
  noted.step = row_.step;
  noted.time = simulation_.state.time;
  noted.what = failure.what;
  noted.term = failure.force;
  std::string line = "step " + std::to_string(noted.step) + " (from " + rounded(noted.time, 4) +
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
  progress_.end();
  failure_ = one_line(line);
  record_.failure = noted;
}

// Those to be merged that a run leaves open.
void Run::tell_of_open_seams() {
  for (const Cloth& cloth : simulation_.cloths)
    for (const Cloth::Stitched& open : cloth.seams) {
      const double time = simulation_.state.time, whole = simulation_.scene->simulation.duration;
      const bool early = time < open.seam.close, goes_on = record_.interrupted || time < whole * (1 - 1e-9);
      bool told = !open.seam.merge || record_.failure || (early && goes_on);
      tell_once(told, "warning: seam " + one_line(open.seam.name) + " of " + cloth.name +
                          " has not closed: it is " +
                          rounded(1000 * open.seam.gap(cloth.embedding, simulation_.state.x), 3) +
                          (early ? " mm open, and closes at " + rounded(open.seam.close, 3) +
                                       " s, after the end of the run: give it a longer duration, or the seam "
                                       "a shorter close"
                                 : " mm open; is a body or a pin between its panels, is it the wrong pair, "
                                   "or the stiffness too low?"));
    }
}

// Cloth that fell past all bodies, which is most often a body in another place or in another unit.
void Run::tell_of_misses() {
  const Vec3 gravity = simulation_.system->gravity_acceleration();
  if (touched_ || !from_start_ || simulation_.constraints->bodies().empty() || gravity.isZero()) return;
  for (std::size_t k = 0; k < simulation_.cloths.size(); ++k) {
    const Cloth& cloth = simulation_.cloths[k];
    if (!simulation_.scene->pins_of(k).empty()) continue;
    const Vec3 way = box_about(cloth, simulation_.state.x).center() - begins_[k].center();
    const double fell = way.dot(gravity.normalized());
    bool told = !(fell > begins_[k].diagonal().norm());
    record_.missed = record_.missed || !told;
    tell_once(told,
              "warning: " + one_line(cloth.name) + " fell by " + rounded(fell, 3) +
                  " m and nothing touched a body; is a body where the cloth falls, and in the same unit? "
                  "'drape view' shows where they are");
  }
}

// Where a cloth tears it gets more particles and edges, and fewer diagonals.
void Run::describe_tears() {
  for (std::size_t k = 0; k < record_.cloths.size(); ++k) {
    const Cloth& cloth = simulation_.cloths[k];
    ClothCounts& counts = record_.cloths[k];
    counts.edges_at_end = counts.edges;
    counts.diagonals_at_end = counts.diagonals;
    if (!cloth.tearing) continue;
    counts.particles = cloth.mesh.vertex_count();
    counts.edges_at_end = static_cast<int>(edges(cloth.mesh).size());
    counts.diagonals_at_end = static_cast<int>(diagonals(cloth.mesh).size());
    counts.torn = cloth.tearing->cuts;
    counts.copy_of = cloth.tearing->copy_of;
  }
}

const RunRecord& Run::finish() {
  progress_.end();
  record_.interrupted = !over();
  describe_tears();
  if (!framed_) write_frame();  // the last frame is the end
  record_.simulated_seconds = simulation_.state.time;
  record_.settled =
      record_.steps > 0 && row_.report.stood_still == 0 && slow(std::max(record_.max_speed, fastest_way_));
  for (double depth : simulation_.constraints->penetration(simulation_.state.x))
    record_.max_penetration = std::max(record_.max_penetration, depth);
  record_.crossings = crossings_as_written(simulation_);
  record_.crossings_max = std::max(record_.crossings_max, record_.crossings);
  if (record_.crossings > record_.crossings_at_start) tell_of_crossings(record_.crossings);
  tell_of_open_seams();
  tell_of_misses();
  record_.bodies = body_records(simulation_);
  record_.state_hash = state_hash(simulation_.state);
  record_.wall_seconds = seconds_since(start_);
  if (output_) output_->finish(simulation_.state, record_);
  return record_;
}

std::string Run::summary() const { return output_ ? app::summary(record_, *output_) : std::string(); }

int run(const Scene& scene, const RunOptions& options) {
  if (scene.simulation.threads > 0) set_threads(scene.simulation.threads);
  Simulation simulation = make_simulation(scene);
  catch_interrupts();
  simulation.keep_outgrown = false;
  Run run(simulation, options);
  // The messages come after this, because a run that cannot begin ends with one line.
  if (!options.quiet)
    for (const std::string& message : simulation.messages)
      std::fprintf(stderr, "%s\n", one_line(message).c_str());
  march(run, [](const StepRow&) { return true; });
  if (!run.failure().empty()) std::fprintf(stderr, "error: %s\n", run.failure().c_str());
  const RunRecord& record = run.finish();
  if (!options.quiet) std::fputs(run.summary().c_str(), stdout);
  return record.failure ? 1 : record.interrupted ? 130 : 0;
}

}  // namespace drape::app
