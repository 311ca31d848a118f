// Several linear solvers on the same systems: what each took, how far it is from the truth, and whether the
// tolerance explains it.
//   r = S (b - A dv)                       computed here, not the solver's word
//   allowed = |g| (1.05 tolerance reference + |r_best|),   A g = S u  within the filter
//     u: direction of the difference from the most accurate solver at the vertex where it is largest. As
//     u . (dv_best - dv) = g . (r - r_best), no solve that meets the tolerance can differ there by more, and
//     one that meets it exactly can: it is the sharpest bound there is.
//   A verdict is `agree` when |r| <= 1.05 tolerance reference, (I - S) dv = z, and the difference is allowed.
#pragma once

#include "app/compare/comparison.h"
#include "app/compare/recording_solver.h"
#include "app/simulation/simulation.h"

namespace drape {

inline constexpr double residual_slack = 1.05;     // solvers stop by recurrences, which drift
inline constexpr double finest_tolerance = 1e-12;  // what round-off lets a residual reach

double true_residual(const LinearSystem& system, const VecX& dv);         // N s
double constraint_violation(const LinearSystem& system, const VecX& dv);  // m/s
double reference_impulse(const LinearSystem& system);  // N s, what a residual is relative to

class SolverBench {
 public:
  // The solvers are made here and kept, so that what they reuse from step to step shows. where: stands
  // in a verdict before the step.
  SolverBench(const std::vector<SolverChoice>& choices, double tolerance, int repeats,
              std::string where = "");

  // A row for every solver. Empty when the user interrupts.
  std::vector<SolverRow> compare(const LinearSystem& system, int step, const Simulation& simulation);

 private:
  struct Entry {
    SolverChoice choice;
    std::unique_ptr<LinearSolver> solver;
    VecX dv;
    double kept_bytes = 0;             // of all its solves
    std::optional<double> peak_bytes;  // of its set-up and all its solves
  };
  SolverRow measure(Entry& entry, const LinearSystem& system, double reference) const;
  void solve_all(Entry& entry, const LinearSystem& system, const LinearOptions& options,
                 SolverRow& row) const;
  void solve_first(Entry& entry, const LinearSystem& system, LinearOptions options, SolverRow& row) const;
  void time_repeats(Entry& entry, const LinearSystem& system, const LinearOptions& options,
                    SolverRow& row) const;
  void find_difference(SolverRow& row, const VecX& difference, const SolverRow& best,
                       const LinearSystem& system, double reference, const Simulation& simulation,
                       LinearSolver& judge) const;
  void pass_verdict(SolverRow& row, double largest) const;

  std::vector<Entry> entries_;
  double tolerance_;
  int repeats_;
  std::string where_;
};

}  // namespace drape
