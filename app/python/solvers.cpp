// Linear solvers, and the linear systems of a step to try them on.
#include <pybind11/stl.h>

#include "app/base/words.h"
#include "app/compare/plain_system.h"
#include "app/compare/solvers.h"
#include "app/python/arrays.h"
#include "app/python/in_use.h"
#include "app/python/linear.h"
#include "app/python/released.h"

namespace drape::app::python {
namespace {

using namespace py::literals;

struct SolveReport : LinearReport {
  std::vector<double> history;
  VecX solution;  // m/s, particle order
};

Array by_particle(const LinearSystem& system, const VecX& rows) {
  VecX all(rows.size());
  to_particles(system.A.pattern(), rows, all);
  return copied_rows(all);
}

SolveReport solve(LinearSolver& solver, const LinearSystem& system, std::optional<double> tolerance,
                  int max_iterations) {
  if (tolerance && !(*tolerance >= least_tolerance && *tolerance < 1))
    throw py::value_error(
        "tolerance: expected a part of the residual, less than 1 and no less than 1e-14, which round-off "
        "leaves");
  if (max_iterations < 0)
    throw py::value_error("max_iterations: expected a number of iterations, or 0 for the usual limit");
  const InUse in_use({&solver});
  const Released released;
  SolveReport report;
  LinearOptions options = system.options;
  if (tolerance) options.tolerance = *tolerance;
  options.max_iterations = max_iterations;
  options.history = &report.history;
  VecX dv = system.guess;
  static_cast<LinearReport&>(report) = solver.solve(system.A, system.b, system.filter, options, dv);
  report.solution.resize(dv.size());
  to_particles(system.A.pattern(), dv, report.solution);
  return report;
}

// All blocks, those below the diagonal too, row by row in particle order: what scipy.sparse.bsr_array takes.
py::tuple bsr(const LinearSystem& system) {
  const BlockPattern& pattern = system.A.pattern();
  std::vector<std::map<int, Mat3>> rows(static_cast<std::size_t>(pattern.rows()));
  for (int row = 0; row < pattern.rows(); ++row)
    for (int slot = pattern.diagonal(row); slot < pattern.row_start()[row + 1]; ++slot) {
      const int column = pattern.column()[slot];
      const int i = pattern.particle_of()[row];
      const int j = pattern.particle_of()[column];
      const Mat3 block = system.A.at(slot);
      rows[i][j] = block;
      rows[j][i] = block.transpose();
    }
  std::vector<int> columns, starts = {0};
  std::vector<double> values;
  for (const auto& row : rows) {
    for (const auto& [column, block] : row) {
      columns.push_back(column);
      for (int k = 0; k < 9; ++k) values.push_back(block(k / 3, k % 3));
    }
    starts.push_back(static_cast<int>(columns.size()));
  }
  const Array data({static_cast<py::ssize_t>(columns.size()), py::ssize_t{3}, py::ssize_t{3}}, values.data());
  return py::make_tuple(data, copied(columns), copied(starts));
}

// (n, 3) [m/s] in row order.
VecX rows_of(const LinearSystem& system, const py::object& dv) {
  const VecX given = stacked_rows(dv, "dv");
  if (given.size() != system.b.size())
    throw py::value_error("dv: expected an array of shape (" + std::to_string(system.A.rows()) +
                          ", 3), but got (" + std::to_string(given.size() / 3) + ", 3)");
  VecX rows(given.size());
  to_rows(system.A.pattern(), given, rows);
  return rows;
}

py::tuple filter(const LinearSystem& system) {
  const PlainFilter plain = plain_filter(system);
  std::vector<double> S;  // row by row
  S.reserve(9 * plain.S.size());
  for (const Mat3& block : plain.S)
    for (int k = 0; k < 9; ++k) S.push_back(block(k / 3, k % 3));
  return py::make_tuple(Array({system.A.rows(), 3, 3}, S.data()), copied_rows(plain.z));
}

py::tuple projected(const std::shared_ptr<LinearSystem>& system) {
  const PlainSystem plain = projected_system(*system);
  const PlainMatrix& A = plain.matrix;
  const py::cpp_function back(
      [system](const py::object& y) {
        const py::ssize_t n = system->A.rows();
        const py::array any = py::array::ensure(y);  // null: no array at all
        const bool flat = any && any.ndim() == 1;
        const Array given =
            flat ? numbers(y, "y", {3 * n}) : numbers(y, "y", {n, 3});  // they throw for any other shape
        return copied_rows(solution_within_constraints(*system, Eigen::Map<const VecX>(given.data(), 3 * n)));
      },
      "y"_a, "dv (n, 3) [m/s] = S y + z of a solution y, (3n,) or (n, 3), of the projected system.");
  return py::make_tuple(
      py::make_tuple(Array(A.nonZeros(), A.valuePtr()), IntArray(A.nonZeros(), A.innerIndexPtr()),
                     IntArray(A.cols() + 1, A.outerIndexPtr())),
      Array(plain.right.size(), plain.right.data()), back);
}

void add_systems_of_steps(py::module_& m) {
  py::class_<LinearSystem, std::shared_ptr<LinearSystem>>(
      m, "LinearSystem",
      "The linear system of a step: S (A dv - b) = 0 and (I - S) dv = z, where S and z are what pins and "
      "contacts allow.\n"
      "A [kg], b [N s], dv [m/s]; particle order.")
      .def_property_readonly("particles", [](const LinearSystem& system) { return system.A.rows(); })
      .def_property_readonly(
          "b", [](const LinearSystem& s) { return by_particle(s, s.b); }, "(n, 3) [N s], a copy")
      .def_property_readonly(
          "guess", [](const LinearSystem& s) { return by_particle(s, s.guess); },
          "(n, 3) [m/s], where the step started to iterate; a copy")
      .def_property_readonly(
          "solution", [](const LinearSystem& s) { return by_particle(s, s.solution); },
          "(n, 3) [m/s], what the step's own solver found; a copy")
      .def_property_readonly(
          "constrained", [](const LinearSystem& system) { return system.filter.entries().size(); },
          "how many particles are not free")
      .def_property_readonly("filter", &filter,
                             "(S, z): (n, 3, 3), the identity where a particle is free, and (n, 3) [m/s]; "
                             "copies")
      .def("bsr", &bsr,
           "A as (data (k, 3, 3), indices (k,), indptr (n + 1,)), for scipy.sparse.bsr_matrix; a copy. The\n"
           "constraints are not in it: see projected().")
      .def(
          "projected", &projected,
          "The system with the constraints in it, for any solver: (A, b, back). A = S A S + I - S as (data,\n"
          "indices, indptr), for scipy.sparse.csc_matrix or csr_matrix, symmetric and positive definite;\n"
          "b = S (b - A z), (3n,); back(y) gives dv = S y + z, (n, 3) [m/s], of a solution y. All are "
          "copies.")
      .def(
          "residual",
          [](const LinearSystem& system, const py::object& dv) {
            return whole_residual(system, rows_of(system, dv)) / reference_impulse(system);
          },
          "dv"_a,
          "Of (n, 3) [m/s]: what is left of both equations, relative as the tolerance is. A missed\n"
          "constraint counts as the impulse (I - S) A_ii ((I - S) dv - z) of its particle i.")
      .def(
          "constraint_violation",
          [](const LinearSystem& system, const py::object& dv) {
            return constraint_violation(system, rows_of(system, dv));
          },
          "dv"_a, "Of (n, 3) [m/s]: the largest |(I - S) dv - z| of a particle, m/s.")
      .def("__repr__", [](const LinearSystem& system) {
        return "LinearSystem(" + counted(system.A.rows(), "particle") + ", " +
               std::to_string(system.filter.entries().size()) + " constrained)";
      });
}

void add_reports(py::module_& m) {
  py::class_<SolveReport>(m, "LinearReport", "How a linear solve went.")
      .def_readonly("iterations", &SolveReport::iterations)
      .def_readonly("residual", &SolveReport::residual, "relative, computed afresh at the end")
      .def_readonly("residual_impulse", &SolveReport::residual_impulse, "N s, |S (b - A dv)|")
      .def_property_readonly(
          "reason", [](const SolveReport& r) { return name(r.reason); },
          "why it stopped: 'converged', 'iteration limit', ...")
      .def_property_readonly("converged",
                             [](const SolveReport& r) { return r.reason == StopReason::converged; })
      .def_readonly("setup_ms", &SolveReport::setup_ms, "projection, preconditioner or factor")
      .def_readonly("solve_ms", &SolveReport::solve_ms, "all else")
      .def_readonly("analyses", &SolveReport::analyses, "how often the pattern was looked at anew")
      .def_property_readonly(
          "method", [](const SolveReport& r) { return std::string(r.method); },
          "the solver that 'auto' took; empty for the others")
      .def_property_readonly(
          "note", [](const SolveReport& r) { return remark(r); }, "what the user should know")
      .def_property_readonly(
          "history", [](const SolveReport& r) { return copied(r.history); },
          "the relative residual of every iteration, from 0; empty for a direct solver and for those of "
          "other libraries")
      .def_property_readonly(
          "solution", [](const SolveReport& r) { return copied_rows(r.solution); },
          "(n, 3) [m/s], particle order")
      .def("__repr__", [](const SolveReport& r) {
        return "LinearReport(" + std::string(name(r.reason)) + ", " + counted(r.iterations, "iteration") +
               ", residual=" + rounded(r.residual, 3) + ")";
      });
}

}  // namespace

Solver solver_of(const py::object& given) {
  if (py::isinstance<py::str>(given)) return make_linear_solver(given.cast<std::string>());
  if (py::isinstance<LinearSolver>(given)) return given.cast<Solver>();
  throw py::type_error("solver: expected a name or a LinearSolver, but got a " +
                       std::string(py::str(py::type::of(given).attr("__name__"))));
}

std::unique_ptr<LinearSolver> recorded(const Solver& solver, SystemRecording& recording) {
  return std::make_unique<RecordingSolver>(std::make_unique<SharedSolver>(solver), recording);
}

py::object last_system(const SystemRecording& recording) {
  if (!recording.last) return py::none();
  return py::cast(std::make_shared<LinearSystem>(*recording.last));
}

void add_solvers(py::module_& m) {
  add_systems_of_steps(m);
  add_reports(m);
  py::class_<LinearSolver, Solver>(m, "LinearSolver", "Solves A dv = b within a filter.")
      .def_property_readonly("name", &LinearSolver::name)
      .def("solve", &solve, "system"_a, "tolerance"_a = py::none(), "max_iterations"_a = 0,
           "Starts at the system's guess. tolerance: relative residual, by default the step's; "
           "max_iterations 0: chosen.")
      .def("__repr__",
           [](const LinearSolver& solver) { return "LinearSolver('" + std::string(solver.name()) + "')"; });
  m.def(
      "make_linear_solver", [](const std::string& name) { return Solver(make_linear_solver(name)); },
      "name"_a, "A solver that linear_solvers() lists. ValueError for any other name.");
  m.def(
      "linear_solvers",
      [] {
        py::dict all;
        for (const LinearSolverInfo& info : linear_solvers()) all[py::cast(info.name)] = info.summary;
        return all;
      },
      "name -> what it is, of this build");
}

}  // namespace drape::app::python
