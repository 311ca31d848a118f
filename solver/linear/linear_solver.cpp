#include "solver/linear/linear_solver.h"

#include <string>

#include "mesh/base/errors.h"
#include "solver/linear/pcg.h"

namespace drape {

using namespace internal;

using Make = std::unique_ptr<LinearSolver> (*)();  // null: this build lacks the solver

namespace internal {
std::unique_ptr<LinearSolver> make_auto();
}
std::unique_ptr<LinearSolver> make_eigen_ldlt();
std::unique_ptr<LinearSolver> make_eigen_cg();
#ifdef DRAPE_HAVE_CHOLMOD
std::unique_ptr<LinearSolver> make_cholmod();
#else
constexpr Make make_cholmod = nullptr;
#endif
#ifdef DRAPE_HAVE_SUNDIALS
std::unique_ptr<LinearSolver> make_sundials_pcg(std::string name,
                                                std::unique_ptr<Preconditioner> preconditioner);
constexpr Make sundials_pcg = [] { return make_sundials_pcg("sundials-pcg", make_block_jacobi()); };
constexpr Make sundials_multigrid = [] {
  return make_sundials_pcg("sundials-pcg+multigrid", make_multigrid());
};
#else
constexpr Make sundials_pcg = nullptr, sundials_multigrid = nullptr;
#endif
#ifdef DRAPE_HAVE_PETSC
std::unique_ptr<LinearSolver> make_petsc();
#else
constexpr Make make_petsc = nullptr;
#endif

namespace {

struct Entry {
  LinearSolverInfo info;
  Make make;
  const char* needs = "";  // what has to be installed for it
};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = {
      {{"auto", "mpcg+block-ic0 or ppcg+multigrid, by the iterations that the run took (default)"},
       make_auto},
      {{"mpcg", "modified conjugate gradient of Baraff & Witkin, 3x3 block-Jacobi"},
       [] { return make_pcg("mpcg", false, make_block_jacobi()); }},
      {{"mpcg+block-ic0", "the same with incomplete Cholesky on 3x3 blocks"},
       [] { return make_pcg("mpcg+block-ic0", false, make_block_ic0()); }},
      {{"ppcg", "prefiltered conjugate gradient of Tamstorf et al., 3x3 block-Jacobi"},
       [] { return make_pcg("ppcg", true, make_block_jacobi()); }},
      {{"ppcg+block-ic0", "the same with incomplete Cholesky on 3x3 blocks"},
       [] { return make_pcg("ppcg+block-ic0", true, make_block_ic0()); }},
      {{"ppcg+multigrid", "the same with smoothed aggregation: for large meshes"},
       [] { return make_pcg("ppcg+multigrid", true, make_multigrid()); }},
      {{"cholmod", "sparse LL^T of SuiteSparse"}, make_cholmod, "libsuitesparse-dev"},
      {{"sundials-pcg", "SUNLinSol_PCG of SUNDIALS, 3x3 block-Jacobi"}, sundials_pcg, "libsundials-dev"},
      {{"sundials-pcg+multigrid", "the same with smoothed aggregation"},
       sundials_multigrid,
       "libsundials-dev"},
      {{"petsc", "KSP CG of PETSc with its multigrid GAMG"},
       make_petsc,
       "petsc-dev, configure with -DDRAPE_PETSC=ON"},
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

std::string remark(const LinearReport& report) {
  if (report.shift == 0) return report.note;
  return "incomplete Cholesky broke down; it was built for A + " + std::to_string(report.shift) + " diag(A)" +
         (report.note.empty() ? "" : "; ") + report.note;
}

std::unique_ptr<LinearSolver> make_linear_solver(std::string_view name) {
  if (const std::string missing = missing_linear_solver(name); !missing.empty()) throw InputError(missing);
  std::string known;
  for (const Entry& entry : entries()) {
    if (!entry.make) continue;
    if (entry.info.name == name) return entry.make();
    known += (known.empty() ? "" : ", ") + std::string(entry.info.name);
  }
  throw InputError("linear solver '" + std::string(name) + "' is not in this build; it has: " + known);
}

std::vector<LinearSolverInfo> linear_solvers() {
  std::vector<LinearSolverInfo> infos;
  for (const Entry& entry : entries())
    if (entry.make) infos.push_back(entry.info);
  return infos;
}

std::string missing_linear_solver(std::string_view name) {
  for (const Entry& entry : entries())
    if (entry.info.name == name && !entry.make)
      return "linear solver '" + std::string(name) + "' is not in this build: install " + entry.needs +
             " and build again";
  return "";
}

}  // namespace drape
