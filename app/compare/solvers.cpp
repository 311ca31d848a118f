#include "app/compare/solvers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/base/interrupt.h"
#include "app/base/peak_memory.h"
#include "app/simulation/measure.h"
#include "mesh/base/stopwatch.h"

namespace drape::app {
namespace {

VecX residual_of(const LinearSystem& system, const VecX& dv) {
  VecX r(dv.size());
  system.A.multiply(dv, r);
  r = system.b - r;
  system.filter.apply(r);
  return r;
}

// The vertex where two solutions differ most.
int worst_row(const VecX& difference) {
  int worst = 0;
  for (int i = 1; i < difference.size() / 3; ++i)
    if (difference.segment<3>(3 * i).norm() > difference.segment<3>(3 * worst).norm()) worst = i;
  return worst;
}

// |g| of A g = S u with u at one row; empty when that cannot be solved.
std::optional<double> influence(LinearSolver& solver, const LinearSystem& system, int row, const Vec3& u) {
  Filter filter;
  for (const FilterEntry& e : system.filter.entries()) filter.constrain(e.particle, e.S, Vec3::Zero());
  VecX right = VecX::Zero(system.b.size()), g = right;
  right.segment<3>(3 * row) = u;
  filter.apply(right);
  if (right.isZero(0)) return 0.0;  // nothing may move there
  const LinearReport report = solver.solve(system.A, right, filter, LinearOptions{}, g);
  if (!g.allFinite() || !(report.residual < 1e-2)) return {};
  return g.norm();
}

// Each of the three things that a verdict asks for.
struct Fulfilled {
  bool residual, constraints, difference;
  bool all() const { return residual && constraints && difference; }
};

// What a row differs by, in words, the reasons first; `asked`: the relative residual that would have done.
std::string difference_text(const SolverRow& row, const std::string& where, double asked,
                            const Fulfilled& fulfilled) {
  const std::string start = "differ: " + where + "step " + std::to_string(row.step) + ", ";
  const std::string reason(name(row.report.reason));
  if (!row.failure.empty()) return start + "failed: " + row.failure;
  if (!row.finite) return start + "not finite numbers (" + reason + ")";
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (!fulfilled.residual)
    add("residual " + rounded(row.residual, 2) + ", asked " + rounded(asked, 2) +
        (row.report.reason == StopReason::converged ? "" : " (" + reason + ")"));
  if (!fulfilled.constraints) add("a constraint is missed by " + rounded(row.violation, 2) + " m/s");
  if (row.difference > 0)
    add((fulfilled.difference ? "the difference is largest at vertex " : "vertex ") +
        std::to_string(row.vertex) + " of cloth '" + row.cloth + "', by " + rounded(row.difference, 2) +
        " m/s (allowed " + (row.allowed ? rounded(*row.allowed, 2) + " m/s" : "not known") + ")");
  return start + text;
}

}  // namespace

double true_residual(const LinearSystem& system, const VecX& dv) { return residual_of(system, dv).norm(); }

// As the solvers take it (solver/linear/residual.h), but that round-off counts where nothing else acts.
double reference_impulse(const LinearSystem& system) {
  constexpr double round_off = 2e-15;
  VecX z = VecX::Zero(system.b.size());
  for (const FilterEntry& e : system.filter.entries()) z.segment<3>(3 * e.particle) = e.z;
  VecX Az(z.size());
  system.A.multiply(z, Az);
  const LinearOptions& options = system.options;
  const double whole = system.b.norm() + (system.b - Az).norm();
  const double least = options.tolerance > 0 ? round_off * whole / options.tolerance : 0;
  return std::max(std::min(std::max(residual_of(system, z).norm(), options.scale), options.most_scale),
                  least);
}

double constraint_violation(const LinearSystem& system, const VecX& dv) {
  double worst = 0;
  for (const FilterEntry& e : system.filter.entries()) {
    const Vec3 own = dv.segment<3>(3 * e.particle);
    const double violation = (own - e.S * own - e.z).norm();
    if (std::isnan(violation)) return violation;  // the worst
    worst = std::max(worst, violation);
  }
  return worst;
}

double whole_residual(const LinearSystem& system, const VecX& dv) {
  VecX r = residual_of(system, dv);
  for (const FilterEntry& e : system.filter.entries()) {
    const Vec3 own = dv.segment<3>(3 * e.particle);
    const Vec3 impulse = system.A.at(system.A.pattern().diagonal(e.particle)) * (own - e.S * own - e.z);
    r.segment<3>(3 * e.particle) += impulse - e.S * impulse;  // at right angles to what is there
  }
  return r.norm();
}

SolverBench::SolverBench(const std::vector<SolverChoice>& choices, double tolerance, int repeats,
                         std::string where)
    : tolerance_(tolerance), repeats_(repeats), where_(std::move(where)) {
  for (const SolverChoice& choice : choices)
    entries_.push_back({choice, make_linear_solver(choice.name), {}, 0, {}});
}

// The first call at this step: its result counts.
void SolverBench::solve_first(Entry& entry, const LinearSystem& system, LinearOptions options,
                              SolverRow& row) const {
  options.history = &row.history;
  entry.dv = system.guess;
  {
    const Stopwatch watch(row.first_ms);
    row.report = entry.solver->solve(system.A, system.b, system.filter, options, entry.dv);
  }
}

void SolverBench::time_repeats(Entry& entry, const LinearSystem& system, const LinearOptions& options,
                               SolverRow& row) const {
  std::vector<double> setup, solve;
  for (int k = 0; k < repeats_ && !interrupted(); ++k) {
    VecX dv = system.guess;
    double ms = 0;
    LinearReport report;
    {
      const Stopwatch watch(ms);
      report = entry.solver->solve(system.A, system.b, system.filter, options, dv);
    }
    setup.push_back(std::min(ms, report.setup_ms));
    solve.push_back(ms - setup.back());
  }
  row.setup_ms = distribution(setup).median;
  row.solve_ms = distribution(solve).median;
}

// The first call and the repeats, and the memory that the solver has taken so far: what rose now above what
// it had kept from the steps before, when other solvers had their turn.
void SolverBench::solve_all(Entry& entry, const LinearSystem& system, const LinearOptions& options,
                            SolverRow& row) const {
  const PeakMemory memory;
  solve_first(entry, system, options, row);
  row.finite = entry.dv.allFinite();
  if (row.finite) time_repeats(entry, system, options, row);
  if (const auto rise = memory.bytes())
    entry.peak_bytes = std::max(entry.peak_bytes.value_or(0), entry.kept_bytes + *rise);
  entry.kept_bytes += memory.kept().value_or(0);
}

SolverRow SolverBench::measure(Entry& entry, const LinearSystem& system, double reference) const {
  SolverRow row;
  row.solver = entry.choice.text;
  LinearOptions options = system.options;
  // The last solve of a step may have been asked for less, when contacts were still being looked for.
  options.tolerance = row.tolerance = entry.choice.tolerance.value_or(tolerance_);
  try {
    solve_all(entry, system, options, row);
  } catch (const std::exception& error) {  // such as not enough memory: the other solvers go on
    row.finite = false;
    row.failure = one_line(error.what());
  }
  row.peak_bytes = entry.peak_bytes;
  const double impulse = true_residual(system, entry.dv);
  row.residual = reference > 0 ? impulse / reference : impulse;
  row.violation = constraint_violation(system, entry.dv);
  return row;
}

std::vector<SolverRow> SolverBench::compare(const LinearSystem& system, int step,
                                            const Simulation& simulation) {
  const double reference = reference_impulse(system);
  std::vector<SolverRow> rows;
  for (Entry& entry : entries_) {
    if (interrupted()) return {};
    rows.push_back(measure(entry, system, reference));
    rows.back().vertices = simulation.state.particles();
    rows.back().step = step;
    rows.back().time = simulation.state.time;
    rows.back().constrained = static_cast<int>(system.filter.entries().size());
  }
  const auto better = [](const SolverRow& a, const SolverRow& b) {
    return a.finite != b.finite ? a.finite : a.residual < b.residual;
  };
  const auto best =
      static_cast<std::size_t>(std::min_element(rows.begin(), rows.end(), better) - rows.begin());
  rows[best].most_accurate = rows[best].finite;
  const std::unique_ptr<LinearSolver> judge = make_linear_solver(entries_[best].choice.name);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (interrupted()) return {};
    if (rows[k].finite && k != best)
      find_difference(rows[k], entries_[best].dv - entries_[k].dv, rows[best], system, reference, simulation,
                      *judge);
    pass_verdict(rows[k], rows[best].finite ? entries_[best].dv.lpNorm<Eigen::Infinity>() : 0);
  }
  return rows;
}

// Where the row is farthest from the most accurate one, and how far its tolerance lets it be there.
void SolverBench::find_difference(SolverRow& row, const VecX& difference, const SolverRow& best,
                                  const LinearSystem& system, double reference, const Simulation& simulation,
                                  LinearSolver& judge) const {
  const int worst = worst_row(difference);
  const Vec3 u = difference.segment<3>(3 * worst);
  if (u.isZero(0)) return;
  row.difference = u.norm();
  const int particle = system.A.pattern().particle_of()[worst];
  const Cloth& cloth = simulation.cloth_of(particle);
  row.vertex = cloth.embedding.vertex(particle);
  row.cloth = cloth.name;
  const double asked = residual_slack * std::max(tolerance_, finest_tolerance);
  const std::optional<double> g = influence(judge, system, worst, u / row.difference);
  const double roundoff = finest_tolerance * system.solution.lpNorm<Eigen::Infinity>();
  if (g) row.allowed = *g * reference * (asked + best.residual) + roundoff;
}

// largest: of the most accurate dv [m/s].
void SolverBench::pass_verdict(SolverRow& row, double largest) const {
  const double asked = std::max(tolerance_, finest_tolerance);
  const Fulfilled fulfilled = {row.residual <= residual_slack * asked,
                               row.violation <= finest_tolerance * (largest + 1),
                               !row.allowed || row.difference <= *row.allowed};
  row.agrees = row.finite && fulfilled.all();
  row.verdict = row.agrees ? "agree" : difference_text(row, where_, asked, fulfilled);
}

}  // namespace drape::app
