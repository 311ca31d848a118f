// Integrators: a system, its constraints and a linear solver, and the step.
#include <pybind11/stl.h>

#include <algorithm>

#include "app/base/words.h"
#include "app/python/arrays.h"
#include "app/python/in_use.h"
#include "app/python/linear.h"
#include "app/python/released.h"
#include "app/python/reports.h"
#include "mesh/base/threads.h"
#include "solver/integrators/integrator.h"

namespace drape::app::python {
namespace {

using namespace py::literals;

std::optional<ContactMode> contact_mode_of(const std::optional<std::string>& word) {
  if (!word) return {};
  Names known;
  for (const ContactModeInfo& info : contact_modes()) {
    if (*word == info.name) return info.mode;
    known.emplace_back(info.name);
  }
  throw py::value_error("contact: there is no '" + *word + "'; " + suggestion(*word, known));
}

Links links_of(const std::string& word) {
  Names known;
  for (const LinksInfo& info : link_kinds) {
    if (word == info.name) return info.links;
    known.emplace_back(info.name);
  }
  throw py::value_error("links: there is no '" + word + "'; " + suggestion(word, known));
}

std::string_view name_of(Links links) {
  return std::find_if(link_kinds.begin(), link_kinds.end(),
                      [&](const LinksInfo& info) { return info.links == links; })
      ->name;
}

void check(const StepOptions& o) {
  const auto require = [](bool fulfilled, const char* text) {
    if (!fulfilled) throw py::value_error(text);
  };
  require(o.newton_iterations >= 1, "newton_iterations: expected 1 or more");
  require(o.newton_tolerance > 0, "newton_tolerance: expected a number greater than zero");
  require(o.tolerance >= least_tolerance && o.tolerance < 1,
          "tolerance: expected a part of the residual, less than 1 and no less than 1e-14, which round-off "
          "leaves");
  require(o.max_linear_iterations >= 0, "max_linear_iterations: expected 0 or more");
  require(contact_tolerance(o) > 0, "contact_tolerance: expected a number greater than zero");
  require(o.max_contact_solves >= 1, "max_contact_solves: expected 1 or more");
  require(o.max_halvings >= 0, "max_halvings: expected 0 or more");
  require(o.projection.substeps >= 1, "substeps: expected 1 or more");
  require(o.projection.iterations >= 1, "iterations: expected 1 or more");
  require(o.projection.alpha >= 0 && o.projection.alpha <= 1,
          "alpha: expected a share of the way, from 0 to 1");
}

// An integrator with all that it refers to.
struct Stepper {
  std::shared_ptr<System> system;
  std::shared_ptr<Constraints> constraints;
  Solver solver;
  SystemRecording recording;
  std::unique_ptr<Integrator> integrator;

  Stepper(const std::string& name, std::shared_ptr<System> s, std::shared_ptr<Constraints> c,
          const py::object& by, const StepOptions& options)
      : system(std::move(s)), constraints(std::move(c)), solver(solver_of(by)) {
    check(options);
    integrator = make_integrator(name, *system, *constraints, recorded(solver, recording), options);
  }

  StepReport advance(State& state, double h) {
    check_step(*system, state, h);
    if (!constraints->pinned().empty() && constraints->pinned().back() >= system->particles())
      throw py::value_error("constraints: they pin particle " + std::to_string(constraints->pinned().back()) +
                            ", but the system has " + std::to_string(system->particles()) + ", from 0");
    const InUse in_use({this, system.get(), constraints.get(), solver.get(), &state});
    StepReport report;
    {
      const Released released;
      report = integrator->advance(state, h);
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();  // Ctrl-C: the step is done all the same
    require_done(report);
    return report;
  }
};

// The two that C++ has as types of their own.
struct OfOrder1 : Stepper {
  using Stepper::Stepper;
};
struct OfOrder2 : Stepper {
  using Stepper::Stepper;
};

template <class Kind>
void add_kind(py::module_& m, const char* python_name, const char* name, const char* text) {
  py::class_<Kind, Stepper>(m, python_name, text)
      .def(py::init([name](std::shared_ptr<System> system, std::shared_ptr<Constraints> constraints,
                           const py::object& solver, const StepOptions& options) {
             return std::make_unique<Kind>(name, std::move(system), std::move(constraints), solver, options);
           }),
           "system"_a.none(false), "constraints"_a.none(false), "solver"_a = "mpcg",
           "options"_a = StepOptions());
}

void add_options(py::module_& m) {
  const StepOptions usual;
  py::class_<StepOptions>(m, "StepOptions", "How a step is taken.")
      .def(py::init([](int newton_iterations, double newton_tolerance, double tolerance,
                       int max_linear_iterations, const std::optional<std::string>& contact,
                       std::optional<double> contact_tolerance, int max_contact_solves, int max_halvings,
                       int substeps, int iterations, const std::string& links, double alpha) {
             StepOptions options;
             options.newton_iterations = newton_iterations;
             options.newton_tolerance = newton_tolerance;
             options.tolerance = tolerance;
             options.max_linear_iterations = max_linear_iterations;
             options.contact = contact_mode_of(contact);
             options.contact_tolerance = contact_tolerance;
             options.max_contact_solves = max_contact_solves;
             options.max_halvings = max_halvings;
             options.projection = {
                 .substeps = substeps, .iterations = iterations, .links = links_of(links), .alpha = alpha};
             check(options);
             return options;
           }),
           py::kw_only(), "newton_iterations"_a = usual.newton_iterations,
           "newton_tolerance"_a = usual.newton_tolerance, "tolerance"_a = usual.tolerance,
           "max_linear_iterations"_a = usual.max_linear_iterations, "contact"_a = py::none(),
           "contact_tolerance"_a = py::none(), "max_contact_solves"_a = usual.max_contact_solves,
           "max_halvings"_a = usual.max_halvings, "substeps"_a = usual.projection.substeps,
           "iterations"_a = usual.projection.iterations,
           "links"_a = std::string(name_of(usual.projection.links)), "alpha"_a = usual.projection.alpha,
           "newton_iterations: linear solves per step, 1 is Baraff & Witkin's step; tolerance: relative "
           "residual of\n"
           "each; contact: 'constraint', 'velocity', 'restitution' or None, what the integrator does best; "
           "contact_tolerance:\n"
           "of the impulses of contacts, relative to the weight; None: ten times tolerance.\n"
           "Of 'pbd': substeps of a step, iterations in a substep; links 'compliance', 'length' or "
           "'squared-length', the\n"
           "last two draw every link the share alpha of the way to its length.")
      .def_readonly("newton_iterations", &StepOptions::newton_iterations, "linear solves per step")
      .def_readonly("newton_tolerance", &StepOptions::newton_tolerance, "of the nonlinear residual")
      .def_readonly("tolerance", &StepOptions::tolerance, "of the linear solve")
      .def_readonly("max_linear_iterations", &StepOptions::max_linear_iterations, "0: chosen by size")
      .def_property_readonly(
          "contact_tolerance", [](const StepOptions& o) { return contact_tolerance(o); },
          "of the impulses of contacts that are wrong, relative to the weight")
      .def_readonly("max_contact_solves", &StepOptions::max_contact_solves)
      .def_readonly("max_halvings", &StepOptions::max_halvings, "of a step that failed")
      .def_property_readonly(
          "substeps", [](const StepOptions& o) { return o.projection.substeps; }, "of 'pbd', in a step")
      .def_property_readonly(
          "iterations", [](const StepOptions& o) { return o.projection.iterations; },
          "of 'pbd', in a substep")
      .def_property_readonly("links", [](const StepOptions& o) { return name_of(o.projection.links); })
      .def_property_readonly("alpha", [](const StepOptions& o) { return o.projection.alpha; })
      .def("__repr__", [](const StepOptions& o) {
        return "StepOptions(newton_iterations=" + std::to_string(o.newton_iterations) +
               ", tolerance=" + rounded(o.tolerance, 6) + ")";
      });
}

}  // namespace

void add_integrators(py::module_& m) {
  add_options(m);
  add_reports_of_steps(m);
  py::class_<Stepper>(m, "Integrator",
                      "State(t) -> State(t + h). Keeps its system and its constraints alive.")
      .def("advance", &Stepper::advance, "state"_a, "h"_a,
           "One step of h [s]: changes the state and returns a StepReport. Other Python threads go on "
           "meanwhile.\n"
           "StepError, a RuntimeError with the report, when it fails: the state is then as it was before.\n"
           "ValueError when the state is not one of the system.")
      .def_property_readonly("name", [](const Stepper& s) { return s.integrator->name(); })
      .def_property_readonly("system", [](const Stepper& s) { return s.system; })
      .def_property_readonly("constraints", [](const Stepper& s) { return s.constraints; })
      .def_property_readonly("solver", [](const Stepper& s) { return s.solver; })
      .def_property(
          "record_systems", [](const Stepper& s) { return s.recording.on; },
          [](Stepper& s, bool on) { s.recording.on = on; }, "whether the linear system of each step is kept")
      .def_property_readonly(
          "last_system",
          [](const Stepper& s) {
            require_free(&s);
            return last_system(s.recording);
          },
          "the last LinearSystem that was solved while record_systems was True, a copy; or None")
      .def("__repr__", [](const Stepper& s) {
        return "Integrator('" + std::string(s.integrator->name()) + "', " +
               counted(s.system->particles(), "particle") + ", solver '" + std::string(s.solver->name()) +
               "')";
      });
  add_kind<OfOrder1>(m, "ImplicitEuler", "implicit-euler", "The step of Baraff & Witkin 1998, eq. 6 and 18.");
  add_kind<OfOrder2>(m, "Bdf2", "bdf2", "Backward differences of order 2. [Choi & Ko 2002]");
  m.def(
      "make_integrator",
      [](const std::string& name, std::shared_ptr<System> system, std::shared_ptr<Constraints> constraints,
         const py::object& solver, const StepOptions& options) {
        return std::make_unique<Stepper>(name, std::move(system), std::move(constraints), solver, options);
      },
      "name"_a, "system"_a.none(false), "constraints"_a.none(false), "solver"_a = "mpcg",
      "options"_a = StepOptions(),
      "An integrator that integrators() lists. The solver is a name or a LinearSolver.");
  m.def(
      "integrators",
      [] {
        py::dict all;
        for (const IntegratorInfo& info : integrators()) all[py::cast(info.name)] = info.summary;
        return all;
      },
      "name -> what it is, of this build");
  m.def("threads", &threads, "How many threads a step may use. The result does not depend on it.");
  m.def("set_threads", &set_threads, "count"_a, "ValueError when it is less than 1.");
}

}  // namespace drape::app::python
