#include "app/scene/simulation_read.h"

#include "mesh/base/errors.h"
#include "mesh/base/threads.h"

namespace drape::app {
namespace {

template <class Infos>
Names names_of(const Infos& infos) {
  Names names;
  for (const auto& info : infos) names.emplace_back(info.name);
  return names;
}

// A part of which this build only knows what would have to be installed for it.
void refuse_missing(const Table& table, const std::string& key, std::string missing(std::string_view)) {
  const Node* const given = table.find(key);
  if (!given || given->kind != Node::Kind::text) return;
  if (const std::string why = missing(given->text); !why.empty()) table.fail(key, why);
}

void read_step(Table& table, StepOptions& step) {
  table.read("newton_iterations", step.newton_iterations, 1, "linear solves a step");
  table.read("newton_tolerance", step.newton_tolerance, dimension::number, Range::positive,
             "of the nonlinear residual, relative to the weight; without gravity the iterations end at "
             "round-off");
  table.read("tolerance", step.tolerance, dimension::number, Range::positive,
             "relative residual of the linear solve; less than 1");
  if (!(step.tolerance < 1) || step.tolerance < least_tolerance)
    table.fail("tolerance",
               "expected a part of the residual, less than 1 and no less than 1e-14, which round-off leaves, "
               "such as 1e-6");
  table.read(
      "max_linear_iterations", step.max_linear_iterations, 0,
      "0: chosen by size, and reaching it is a failure; given: the solve stops there and the step counts "
      "as not converged");
  table.read(
      "contact_tolerance", step.contact_tolerance, dimension::number, Range::positive,
      {"the contacts have settled when the impulses that are wrong come to this, relative to the weight",
       "ten times `tolerance`"});
  table.read("max_contact_solves", step.max_contact_solves, 1,
             "how often a step is solved again because a contact changed");
  table.read("max_halvings", step.max_halvings, 0, "how often a step that fails is halved");
  table.read("relative_tolerance", step.relative_tolerance, dimension::number, Range::positive,
             "of `cvode-` and `arkode-`: the error of a velocity in an inner step, relative to the speed");
  table.read("absolute_tolerance_position", step.absolute_tolerance_position, dimension::length,
             Range::positive,
             {"the error of a coordinate in an inner step",
              "a hundredth of what the weight of a vertex stretches the cloth around it"});
  table.read("absolute_tolerance_velocity", step.absolute_tolerance_velocity, dimension::speed,
             Range::positive,
             {"added to the error of a velocity", "as for a coordinate, at the stiffest vibration"});
  table.read("max_inner_steps", step.max_inner_steps, 1, "of these, in one step; more is a failure");
}

void read_projection(Table& table, ProjectionOptions& projection) {
  table.read("substeps", projection.substeps, 1, "of `pbd`: into how many it cuts a step");
  table.read(
      "iterations", projection.iterations, 1,
      "of `pbd`: how often it takes every spring in a substep; more substeps do better than more of these");
  std::string word(link_kinds.front().name);
  table.read(
      "links", word, names_of(link_kinds),
      "of `pbd`, for springs that stretch. compliance: by their stiffness; length, squared-length: drawn to "
      "their length without stiffness, the second without a square root");
  for (const LinksInfo& info : link_kinds)
    if (word == info.name) projection.links = info.links;
  table.read("alpha", projection.alpha, dimension::number, Range::not_negative,
             "of `pbd`: the share of the way, from 0 to 1, by which links are drawn to their length");
  if (projection.alpha > 1) table.fail("alpha", "expected a share of the way, from 0 to 1");
}

void read_contact(Table& table, SimulationOptions& options) {
  std::string word;
  table.read("contact", word, names_of(contact_modes()),
             {"constraint: held in the solve; velocity: velocities projected onto the surface, what explicit "
              "integrators do when nothing is said; restitution: impacts spring back, for these and pbd only",
              "by the integrator"});
  if (!table.has("contact")) return;
  for (const ContactModeInfo& info : contact_modes())
    if (word == info.name) options.step.contact = info.mode;
  try {
    contact_mode(options.integrator, options.step.contact);
  } catch (const InputError& error) {
    throw InputError(table.find("contact")->where + ": " + error.what());
  }
}

// A scene may have keys of several integrators, so that `--set simulation.integrator` can compare them.
Names idle_keys(const Table& table, const std::string& integrator) {
  Names idle;
  const auto look = [&](bool used, std::initializer_list<const char*> keys) {
    for (const char* key : keys)
      if (!used && table.has(key)) idle.emplace_back(key);
  };
  look(integrator == "pbd", {"substeps", "iterations", "links", "alpha"});
  look(integrator.starts_with("cvode-") || integrator.starts_with("arkode-"),
       {"relative_tolerance", "absolute_tolerance_position", "absolute_tolerance_velocity",
        "max_inner_steps"});
  const bool newton = integrator == "implicit-euler" || integrator == "bdf2" || integrator == "newton-kinsol";
  look(newton, {"newton_iterations", "newton_tolerance"});
  look(newton || integrator == "cvode-bdf" || integrator == "arkode-dirk",
       {"linear_solver", "max_linear_iterations"});
  return idle;
}

}  // namespace

SimulationOptions read_simulation(const Table* given) {
  SimulationOptions options;
  if (!given) return options;
  Table table = *given;
  table.read("duration", options.duration, dimension::time, Range::positive,
             "what is simulated; the end is the last frame, also where it is no whole number of frames");
  table.read("time_step", options.time_step, dimension::time, Range::positive,
             "length of a step; shorter, equal from frame to frame, where no whole number of them comes to a "
             "frame");
  table.read("frame_rate", options.frame_rate, dimension::rate, Range::not_negative,
             "of the frames that are written: frame k is the state at k / rate, the last frame the state at "
             "the end; 0: only the last");
  table.read("gravity", options.gravity, dimension::acceleration, "acts on all that has a mass");
  refuse_missing(table, "integrator", missing_integrator);
  refuse_missing(table, "linear_solver", missing_linear_solver);
  table.read_part("integrator", options.integrator, names_of(integrators()), "how time goes on");
  table.read_part("linear_solver", options.linear_solver, names_of(linear_solvers()),
                  "what solves the system of a step, NAME or NAME+PRECONDITIONER");
  read_contact(table, options);
  read_step(table, options.step);
  read_projection(table, options.step.projection);
  table.read("recovery_speed", options.contact.recovery_speed, dimension::speed, Range::positive,
             "at which what starts inside a body is brought out");
  table.read("threads", options.threads, 1,
             {"how many; the result does not depend on it", "as many as processors"});
  if (options.threads > most_threads)
    table.fail("threads", "expected at most " + std::to_string(most_threads));
  table.read("require_clean", options.require_clean,
             "refuse a start in which triangles of cloths or soft bodies pass through each other");
  table.read("stop_when_settled", options.stop_when_settled,
             "end when no cloth and no body with a mass has been faster than settle_speed for 0.2 s, and no "
             "motion or frame is still to come");
  table.read("settle_speed", options.settle_speed, dimension::speed, Range::positive,
             "also decides between \"settled\" and \"moving\" in run.json");
  table.finish();
  options.idle_keys = idle_keys(table, options.integrator);
  if (options.frame_rate * options.time_step > 10)
    table.fail(table.has("frame_rate") ? "frame_rate" : "time_step",
               "a frame_rate of " + rounded(options.frame_rate, 4) +
                   " Hz is more than ten frames in a time_step of " + rounded(options.time_step, 4) +
                   " s, which would be cut as often; check the units");
  constexpr double a_day = 24 * 3600;  // s
  if (options.duration / options.time_step > most_steps)
    table.fail(
        options.duration > a_day || !table.has("time_step") ? "duration" : "time_step",
        "the run would take " + rounded(options.duration / options.time_step, 3) + " steps; check the units");
  if (!(options.duration > least_of_a_step * options.time_step))
    table.fail(
        table.has("duration") ? "duration" : "time_step",
        "the duration is less than a millionth of a step, so that there would be none; check the units");
  return options;
}

Air read_air(Table& table) {
  Air air;
  table.read("wind", air.wind, dimension::speed, "the velocity of the air, the same everywhere and always");
  table.read("density", air.density, dimension::density, Range::not_negative, "of the air");
  table.read("drag", air.drag, dimension::number, Range::not_negative,
             "C of a plate square to the wind: its force per area is density C v^2 / 2");
  table.read("skin_friction", air.skin_friction, dimension::number, Range::not_negative,
             "C of a plate along the wind, of both sides together");
  table.finish();
  return air;
}

}  // namespace drape::app
