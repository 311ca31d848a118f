// Compares linear solvers on the same systems: what each took, how far it is from the truth, and whether the
// tolerance explains the distance.
//   r = S (b - A dv)                       computed here; the solver's own value is not used
//   allowed = |g| (1.05 tolerance reference + |r_best|),   A g = S u  within the filter
//     u: direction of the difference to the most accurate solver, at the vertex where it is largest. Since
//     u . (dv_best - dv) = g . (r - r_best), a solve that meets the tolerance cannot differ more there, and
//     one that meets it exactly can differ as much: no sharper bound exists.
//   The verdict is `agree` when |r| <= 1.05 tolerance reference, (I - S) dv = z, and the difference is
//   allowed.
#pragma once

#include "app/compare/comparison.h"
#include "app/compare/recording_solver.h"
#include "app/simulation/simulation.h"

namespace drape::app {

// Solvers stop by residuals that they update by recurrences, which drift from the true residual.
inline constexpr double residual_slack = 1.05;
inline constexpr double finest_tolerance = 1e-12;  // round-off allows no smaller residual

double true_residual(const LinearSystem& system, const VecX& dv);         // N s
double constraint_violation(const LinearSystem& system, const VecX& dv);  // m/s
// The residual of both equations [N s]: a missed constraint of a particle i counts as the impulse
// (I - S) A_ii ((I - S) dv - z) that would bring the particle there.
double whole_residual(const LinearSystem& system, const VecX& dv);
double reference_impulse(const LinearSystem& system);  // N s; a residual is relative to this impulse

class SolverBench {
 public:
  // Makes the solvers and keeps them, so that the gain from what they reuse between steps is measured.
  // `where` stands before the step in a verdict.
  SolverBench(const std::vector<SolverChoice>& choices, double tolerance, int repeats,
              std::string where = "");

  // One row for each solver. Empty when the user interrupts.
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

}  // namespace drape::app
