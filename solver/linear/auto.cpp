// Takes incomplete Cholesky or multigrid, whichever costs less in the run as it goes.
//   Costs are counted, never timed, so that the same input gives the same bits. Their unit is one iteration
// with block-ic0; the prices were measured (docs/design.md) on sheets of 4 k and 10 k vertices and on a skirt
// of 4.7 k, without contact of cloth with cloth: the overlay, and what block-ic0 lists anew for it, is not
// counted. A factor that breaks down is counted once.
//   What is compared is the cost of all systems of one assembled matrix, because contacts ask for several
// short solves with it, for which the levels of multigrid do not pay.
//   A solver begins with block-ic0, or with multigrid where its first matrix has 20 000 rows; where that
// fails before block-ic0 was used, block-ic0 goes on. Multigrid has the next matrix on trial where a solve
// costs more than one with multigrid usually does, and goes on when the matrix cost less than one costs with
// block-ic0 on average; and the other way round. After a trial the other method waits for 8 matrices, and for
// twice as many after each that it loses, up to 64; block-ic0 for four times as many, up to 256, where it was
// given up. The other method waits for 2 only where a matrix now costs 1.25 times what it cost with it when
// it was last used, as when cloth arrives at a body; and one that was never tried does not wait where a
// matrix costs twice what it usually does with multigrid. While block-ic0 is cheap, multigrid has no trial.
// Matrices whose solves take no iteration, as in free fall, tell nothing of a method, and are not in its
// average.
//   Where a matrix costs 1.5 times what one did with multigrid, and four times what one usually does,
// block-ic0 is given up in the middle of a solve: on trial, where a matrix costs 1.25 times what one did with
// multigrid. Multigrid solves that system anew, and those that follow.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "solver/linear/linear_solver.h"
#include "solver/linear/pcg.h"

namespace drape::internal {
namespace {

struct Price {  // in iterations with block-ic0
  double iteration, system, levels;
};
constexpr Price ic0_price = {1, 8, 0};

// The time of an iteration with block-ic0 grows with the number of blocks, that of one with multigrid grows less.
Price multigrid_price(const BlockMatrix& A) {
  const double blocks_of_row = static_cast<double>(A.pattern().blocks()) / A.rows();
  return {1 + 14 / blocks_of_row, 6, 19};
}

class Auto final : public LinearSolver {
 public:
  std::string_view name() const override { return "auto"; }

  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    if (fill_ == 0) begin_run(A.rows());
    if (fill_ != A.fill()) begin_matrix();
    fill_ = A.fill();
    multigrid_price_ = multigrid_price(A);
    LinearReport report;
    if (now_ == ic0) {
      guess_ = dv;
      report = solve_by(ic0, A, b, filter, within_budget(options), dv);
      if (report.reason != StopReason::iteration_limit || report.iterations == options.max_iterations)
        return counted(report);
      give_up();
      dv = guess_;
    }
    return counted(after(report, solve_by(now_, A, b, filter, options, dv)));
  }

 private:
  enum Method { ic0, multigrid };
  static constexpr int shortest_wait = 8, longest_wait = 64, fewest_iterations = 40, large = 20000;

  LinearReport solve_by(Method method, const BlockMatrix& A, const VecX& b, const Filter& filter,
                        const LinearOptions& options, VecX& dv) {
    LinearReport report = solver_[method]->solve(A, b, filter, options, dv);
    const Price& price = method == ic0 ? ic0_price : multigrid_price_;
    cost_ += price.iteration * report.iterations + price.system + price.levels * report.analyses;
    report.method = names[method];
    return report;
  }

  LinearReport counted(const LinearReport& report) {
    ++solves_;
    idle_ = idle_ && report.iterations == 0;
    failed_ = failed_ || report.reason != StopReason::converged;
    return report;
  }

  // The report of a solve that another had given up before.
  static LinearReport after(const LinearReport& before, LinearReport report) {
    report.iterations += before.iterations;
    report.analyses += before.analyses;
    report.setup_ms += before.setup_ms;
    report.solve_ms += before.solve_ms;
    return report;
  }

  // The options with the most iterations that block-ic0 may take in the next solve.
  LinearOptions within_budget(LinearOptions options) const {
    if (std::isinf(usual_[multigrid])) return options;  // it failed
    const double enough = 1.25 * usual_[multigrid];     // for a trial to be lost
    const double most = on_trial_ ? enough : std::max(1.5 * usual_[multigrid], 4 * usual_multigrid(1));
    const int budget = std::max(fewest_iterations, static_cast<int>(std::min(most - cost_, 1e6)));
    if (options.max_iterations == 0 || budget < options.max_iterations) options.max_iterations = budget;
    return options;
  }

  // Multigrid goes on where block-ic0 took more than its budget.
  void give_up() {
    usual_[ic0] = std::max(usual_[ic0], 2 * cost_);  // it would have cost more; nobody knows how much
    wait_ = on_trial_ ? std::clamp(4 * wait_, shortest_wait, 4 * longest_wait) : shortest_wait;
    waited_ = 0;
    on_trial_ = false;
    now_ = multigrid;
    cost_ = 0;
    solves_ = 0;
  }

  void begin_run(int rows) {
    if (rows < large) return;
    now_ = multigrid;
    wait_ = shortest_wait;
  }

  void begin_matrix() {
    if (solves_ > 0) decide();
    cost_ = 0;
    solves_ = 0;
    failed_ = false;
    idle_ = true;
  }

  void decide() {
    double &own = usual_[now_], &others = usual_[other()];
    if (on_trial_) {
      on_trial_ = false;
      waited_ = 0;
      own = failed_ ? std::numeric_limits<double>::infinity() : cost_;
      if (own < others) {
        wait_ = shortest_wait;
      } else {
        now_ = other();
        wait_ = std::clamp(2 * wait_, shortest_wait, std::max(wait_, longest_wait));
      }
      return;
    }
    if (failed_ && now_ == multigrid && others == 0) {
      own = std::numeric_limits<double>::infinity();
      now_ = ic0;
      return;
    }
    if (failed_ || idle_) return;  // what it cost says nothing
    own = own > 0 ? 0.7 * own + 0.3 * cost_ : cost_;
    ++waited_;
    const double usual = usual_multigrid(solves_);
    if (now_ == ic0 && cost_ <= usual) return;
    const bool dear = others > 0 ? own > 1.25 * others && waited_ >= 2 : own > 2 * usual;
    if (!dear && waited_ < wait_) return;
    on_trial_ = true;
    now_ = other();
  }

  // What one matrix usually costs with multigrid: 12 iterations a solve.
  double usual_multigrid(int solves) const {
    return solves * (12 * multigrid_price_.iteration + multigrid_price_.system) + multigrid_price_.levels;
  }

  Method other() const { return now_ == ic0 ? multigrid : ic0; }

  static constexpr std::array<std::string_view, 2> names = {"mpcg+block-ic0", "ppcg+multigrid"};
  std::array<std::unique_ptr<LinearSolver>, 2> solver_ = {
      make_pcg(std::string(names[ic0]), false, make_block_ic0()),
      make_pcg(std::string(names[multigrid]), true, make_multigrid())};
  Price multigrid_price_ = {};  // with this matrix
  Method now_ = ic0;
  bool on_trial_ = false;
  int wait_ = 0, waited_ = 0;  // matrices until the next trial, and since the last
  // Costs in iterations with block-ic0: of the matrix so far, and of one on average, by method, when that was last
  // used; 0: it was not used yet.
  double cost_ = 0;
  std::array<double, 2> usual_ = {};
  VecX guess_;
  int solves_ = 0;       // with this matrix
  bool failed_ = false;  // a solve with this matrix did not converge
  bool idle_ = true;     // no solve with this matrix took an iteration
  std::uint64_t fill_ = 0;
};

}  // namespace

std::unique_ptr<LinearSolver> make_auto() { return std::make_unique<Auto>(); }

}  // namespace drape::internal
