#include "solver/linear_solver.h"

#include <string>

#include "mesh/obj.h"
#include "solver/linear/mpcg.h"

namespace drape {

std::unique_ptr<LinearSolver> make_eigen_ldlt();
std::unique_ptr<LinearSolver> make_eigen_cg();
#ifdef DRAPE_HAVE_CHOLMOD
std::unique_ptr<LinearSolver> make_cholmod();
#endif

namespace {

struct Entry {
  LinearSolverInfo info;
  std::unique_ptr<LinearSolver> (*make)();
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = {
      {{"mpcg", "modified conjugate gradient of Baraff & Witkin, 3x3 block-Jacobi (default)"},
       [] { return std::unique_ptr<LinearSolver>(std::make_unique<Mpcg>()); }},
#ifdef DRAPE_HAVE_CHOLMOD
      {{"cholmod", "sparse LL^T of SuiteSparse"}, make_cholmod},
#endif
      {{"eigen-ldlt", "sparse LDL^T of Eigen"}, make_eigen_ldlt},
      {{"eigen-cg", "conjugate gradient of Eigen with incomplete Cholesky"}, make_eigen_cg},
  };
  return all;
}

}  // namespace

std::string_view name(StopReason reason) {
  switch (reason) {
    case StopReason::converged:
      return "converged";
    case StopReason::iteration_limit:
      return "iteration limit";
    case StopReason::indefinite:
      return "matrix not positive definite";
    case StopReason::not_finite:
      return "not finite";
  }
  return "";
}

std::unique_ptr<LinearSolver> make_linear_solver(std::string_view name) {
  std::string known;
  for (const Entry& entry : entries()) {
    if (entry.info.name == name) return entry.make();
    known += (known.empty() ? "" : ", ") + std::string(entry.info.name);
  }
  throw InputError("linear solver '" + std::string(name) + "' is not in this build; it has: " + known);
}

std::vector<LinearSolverInfo> linear_solvers() {
  std::vector<LinearSolverInfo> infos;
  for (const Entry& entry : entries()) infos.push_back(entry.info);
  return infos;
}

}  // namespace drape
