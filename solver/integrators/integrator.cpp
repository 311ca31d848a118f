#include "solver/integrators/integrator.h"

#include <algorithm>
#include <cmath>

#include "mesh/base/errors.h"
#include "mesh/base/stopwatch.h"
#include "solver/integrators/bdf.h"
#include "solver/integrators/explicit.h"
#include "solver/integrators/pbd.h"
#include "solver/integrators/sundials_integrators.h"

namespace drape {

using namespace internal;

void check_step(const System& system, const State& state, double h) {
  if (!(h > 0) || !std::isfinite(h))
    throw InputError("time step = " + std::to_string(h) + " s: a time step is greater than zero");
  if (system.particles() == 0) throw InputError("system: it has no particles, so there is nothing to step");
  if (!std::isfinite(state.time)) throw InputError("state: its time is not a finite number");
  if (state.particles() != system.particles() || state.v.size() != state.x.size())
    throw InputError("state: " + std::to_string(state.particles()) + " particles, but the system has " +
                     std::to_string(system.particles()));
  for (const auto& [values, what] : {std::pair{&state.x, "position"}, std::pair{&state.v, "velocity"}})
    if (!values->allFinite())
      for (int i = 0; i < state.particles(); ++i)
        if (!values->segment<3>(3 * i).allFinite())
          throw InputError("state: the " + std::string(what) + " of particle " + std::to_string(i) +
                           " is not three finite numbers");
}

void end_step(ContactStep& contacts, VecX& x, VecX& v, StepReport& report) {
  const Stopwatch watch(report.collide_ms);
  const ContactReport contact = contacts.finish(x, v);
  report.contacts = contact.contacts;
  report.guarded += contact.guarded;
  report.self_contacts = contact.self_contacts;
  report.self_guarded += contact.self_guarded;
  report.self_held += contact.self_held;
  report.stood_still = std::max(report.stood_still, contact.stood_still);
  report.tangled = contact.tangled;
  report.pinched = contact.pinched;
  report.body_contacts = contact.body_contacts;
  report.body_overlap = std::max(report.body_overlap, contact.body_overlap);
  report.converged = report.converged && contact.converged && contact.stood_still == 0;
  report.penetration = std::max(report.penetration, contact.deepest);
}

std::vector<IntegratorInfo> integrators() {
  std::vector<IntegratorInfo> all = {
      {"implicit-euler", "Baraff & Witkin's implicit step, 1 to n Newton iterations (default)"},
      {"bdf2", "backward differences of order 2, 1 to n Newton iterations"},
      {"pbd", "position-based: substeps in which every spring is taken in turn"}};
  for (const Tableau& tableau : tableaux()) all.push_back({tableau.name, tableau.summary});
#ifdef DRAPE_HAVE_SUNDIALS
  all.push_back({"newton-kinsol", "the equation of implicit Euler solved by SUNDIALS KINSOL"});
  for (const IntegratorInfo& info : sundials_ode_methods()) all.push_back(info);
#endif
  return all;
}

std::string missing_integrator([[maybe_unused]] std::string_view name) {
#ifndef DRAPE_HAVE_SUNDIALS
  for (const std::string_view missing :
       {"newton-kinsol", "cvode-bdf", "cvode-adams", "arkode-erk", "arkode-dirk"})
    if (name == missing)
      return "integrator '" + std::string(name) +
             "' is not in this build: install libsundials-dev and build again";
#endif
  return "";
}

ContactMode contact_mode(std::string_view integrator, std::optional<ContactMode> asked) {
  if (integrator == "pbd") {
    if (asked == ContactMode::constraint)
      throw InputError(
          "contact = \"constraint\": pbd solves no system that could hold contacts; take contact = "
          "\"velocity\" or \"restitution\"");
    return asked.value_or(ContactMode::velocity);
  }
  std::string names;
  for (const Tableau& tableau : tableaux()) {
    if (integrator == tableau.name) return asked.value_or(ContactMode::velocity);
    names += (names.empty() ? "" : ", ") + std::string(tableau.name);
  }
  if (asked.value_or(ContactMode::constraint) != ContactMode::constraint)
    throw InputError(
        "contact = \"" + std::string(name(*asked)) + "\": " + std::string(integrator) +
        " holds contacts as constraints while it solves for a step, and a velocity that is "
        "changed afterwards is not its solution; take contact = \"constraint\", or pbd or one of the "
        "explicit integrators: " +
        names);
  return ContactMode::constraint;
}

namespace {

// Explicit methods need the force alone.
void require_stiffness(std::string_view integrator, const System& system) {
  for (const Tableau& tableau : tableaux())
    if (integrator == tableau.name) return;
  for (const auto& force : system.forces())
    if (force->only_projects())
      throw InputError("integrator \"" + std::string(integrator) + "\": the force '" +
                       std::string(force->name()) +
                       "' has no stiffness for a matrix; take \"pbd\" or an explicit integrator");
}

}  // namespace

std::unique_ptr<Integrator> make_integrator(std::string_view name, System& system, Constraints& constraints,
                                            std::unique_ptr<LinearSolver> solver,
                                            const StepOptions& options) {
  const ContactMode contact = contact_mode(name, options.contact);
  if (name != "pbd") require_stiffness(name, system);
  if (name == "implicit-euler")
    return std::make_unique<Bdf>(system, constraints, std::move(solver), options, 1);
  if (name == "bdf2") return std::make_unique<Bdf>(system, constraints, std::move(solver), options, 2);
  if (name == "pbd") return std::make_unique<Pbd>(system, constraints, options, contact);
  for (const Tableau& tableau : tableaux())
    if (name == tableau.name)
      return std::make_unique<Explicit>(tableau, system, constraints, options, contact);
#ifdef DRAPE_HAVE_SUNDIALS
  if (name == "newton-kinsol") return make_newton_kinsol(system, constraints, std::move(solver), options);
  for (const IntegratorInfo& info : sundials_ode_methods())
    if (name == info.name) return make_sundials_ode(name, system, constraints, std::move(solver), options);
#endif
  if (const std::string missing = missing_integrator(name); !missing.empty()) throw InputError(missing);
  std::string names;
  for (const IntegratorInfo& info : integrators())
    names += (names.empty() ? "" : ", ") + std::string(info.name);
  throw InputError("integrator '" + std::string(name) + "' is not in this build; it has: " + names);
}

}  // namespace drape
