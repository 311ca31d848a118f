// StepReport, the steps of a run, StepError.
#include "app/python/reports.h"

#include "app/base/words.h"

namespace drape::app::python {
namespace {

std::string text(const StepReport& r) {
  if (!r.done) return "not done: " + r.failure.what;
  return counted(r.linear_iterations, "linear iteration") + ", residual=" + rounded(r.residual, 3) +
         (r.converged ? "" : " (not converged)") + ", " + counted(r.contacts, "contact") + ", " +
         rounded(r.step_ms, 3) + " ms";
}

py::handle step_error() {
  // Never destroyed: when static objects are, the interpreter is gone.
  static const py::object* const type = new py::object(py::module_::import("drape").attr("StepError"));
  return *type;
}

}  // namespace

void raise_step_error(const std::string& what, const StepReport& report) {
  py::object error = step_error()(what);
  error.attr("report") = report;
  PyErr_SetObject(step_error().ptr(), error.ptr());
  throw py::error_already_set();
}

void require_done(const StepReport& report) {
  if (report.done) return;
  std::string what = "the step failed: " + report.failure.what;
  if (report.failure.particle >= 0) what += ", worst at particle " + std::to_string(report.failure.particle);
  if (!report.failure.force.empty()) what += "; the term is '" + report.failure.force + "'";
  raise_step_error(what, report);
}

void add_reports_of_steps(py::module_& m) {
  py::class_<StepReport>(m, "StepReport", "How a step went.")
      .def_readonly("done", &StepReport::done, "False: the state is as it was before")
      .def_property_readonly(
          "failure", [](const StepReport& r) { return r.failure.what; }, "why, when not done")
      .def_property_readonly(
          "failure_particle", [](const StepReport& r) { return r.failure.particle; },
          "where it is worst; -1: not known")
      .def_property_readonly(
          "failure_force", [](const StepReport& r) { return r.failure.force; },
          "which term, when it is known")
      .def_readonly("substeps", &StepReport::substeps,
                    "pieces the step was cut into, because it failed whole")
      .def_readonly("inner_steps", &StepReport::inner_steps, "of the integrators that choose them")
      .def_readonly("inner_rejected", &StepReport::inner_rejected, "inner steps tried in vain")
      .def_readonly("newton_iterations", &StepReport::newton_iterations)
      .def_readonly("linear_solves", &StepReport::linear_solves)
      .def_readonly("multigrid_solves", &StepReport::multigrid_solves,
                    "solves for which the linear solver 'auto' took ppcg+multigrid")
      .def_readonly("linear_iterations", &StepReport::linear_iterations)
      .def_readonly(
          "rescues", &StepReport::rescues,
          "Newton iterations, or whole steps, taken again because they raised the potential or made energy")
      .def_readonly("guarded", &StepReport::guarded, "particles stopped at a surface outside the equations")
      .def_readonly("self_contacts", &StepReport::self_contacts,
                    "pairs of cloth and cloth that push each other")
      .def_readonly("self_guarded", &StepReport::self_guarded,
                    "particles that were pushed or stopped so that no cloth passes through cloth")
      .def_readonly("self_held", &StepReport::self_held,
                    "of these, particles that were pushed aside only, and kept the rest of their way")
      .def_readonly("stood_still", &StepReport::stood_still,
                    "particles of pieces that were left where they began, since nothing else kept cloth from "
                    "passing through cloth")
      .def_readonly("tangled", &StepReport::tangled,
                    "particles where cloth passes through cloth, and is brought apart")
      .def_readonly("pinched", &StepReport::pinched,
                    "particles that a body may pass, because it could not be kept off them, or that two "
                    "bodies, or two sides of one, hold between them")
      .def_readonly("body_contacts", &StepReport::body_contacts, "points at which bodies press on each other")
      .def_readonly("body_overlap", &StepReport::body_overlap,
                    "m, how far bodies were inside each other at the start")
      .def_readonly("torn", &StepReport::torn, "edges of cloth that were cut at the end")
      .def_readonly("residual", &StepReport::residual,
                    "relative, the worst of the solves that the step ended with")
      .def_readonly("converged", &StepReport::converged,
                    "every solve reached its tolerance, and the contacts have settled")
      .def_readonly("contacts", &StepReport::contacts, "particles in contact at the end")
      .def_readonly("contact_residual", &StepReport::contact_residual,
                    "impulses of contacts that are wrong, relative to the weight")
      .def_readonly("penetration", &StepReport::penetration, "m, deepest particle inside a body at the start")
      .def_readonly("assemble_ms", &StepReport::assemble_ms)
      .def_readonly("solve_ms", &StepReport::solve_ms)
      .def_readonly("collide_ms", &StepReport::collide_ms)
      .def_readonly("step_ms", &StepReport::step_ms)
      .def("__repr__", [](const StepReport& r) { return "StepReport(" + text(r) + ")"; });
  py::class_<RunStep, StepReport>(m, "RunStep",
                                  "A step of a run: its report, and the state after it in numbers.")
      .def_readonly("step", &RunStep::step,
                    "from 1: in steps of this length since the time 0, or since the run began where that is "
                    "between two")
      .def_readonly("time", &RunStep::time, "s, at its end")
      .def_readonly("kinetic_energy", &RunStep::kinetic_energy,
                    "J, of cloth, soft bodies and ropes, as the other energies: not of bodies with a mass")
      .def_readonly("elastic_energy", &RunStep::elastic_energy, "J, stored in the cloth: of its shape alone")
      .def_readonly("contact_energy", &RunStep::contact_energy,
                    "J, stored where faces of the cloth give way to bodies")
      .def_readonly("gravity_energy", &RunStep::gravity_energy, "J, zero at the origin")
      .def_readonly("max_speed", &RunStep::max_speed, "m/s, of a particle")
      .def_readonly("max_edge_strain", &RunStep::max_edge_strain, "l / L - 1 of the most stretched edge")
      .def_readonly("strain_min", &RunStep::strain_min, "the least principal strain of a triangle")
      .def_readonly("strain_min_1pct", &RunStep::strain_min_1pct,
                    "one triangle in a hundred is compressed further")
      .def_readonly("strain_max", &RunStep::strain_max, "the largest principal strain of a triangle")
      .def_readonly("area_min", &RunStep::area_min,
                    "the least share of its area at rest that a triangle has kept")
      .def_readonly("area_kept", &RunStep::area_kept, "area of the cloths over that at rest")
      .def("__repr__", [](const RunStep& r) {
        return "RunStep(" + std::to_string(r.step) + ", time=" + rounded(r.time, 6) + " s, " + text(r) + ")";
      });
}

}  // namespace drape::app::python
