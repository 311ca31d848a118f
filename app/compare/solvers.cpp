#include "app/compare/solvers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/interrupt.h"
#include "app/measure.h"
#include "app/peak_memory.h"
#include "solver/stopwatch.h"

namespace drape {
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
std::optional<double> influence(const std::string& solver, const LinearSystem& system, int row, const Vec3& u) {
  Filter filter;
  for (const FilterEntry& e : system.filter.entries()) filter.constrain(e.particle, e.S, Vec3::Zero());
  VecX right = VecX::Zero(system.b.size()), g = right;
  right.segment<3>(3 * row) = u;
  LinearOptions options;
  options.tolerance = 1e-6;
  filter.apply(right);
  if (right.isZero(0)) return 0.0;  // nothing may move there
  const LinearReport report = make_linear_solver(solver)->solve(system.A, right, filter, options, g);
  if (!g.allFinite() || !(report.residual < 1e-2)) return {};
  return g.norm();
}

std::string first_words(const SolverRow& row, const std::string& where) {
  return "differ: " + where + "step " + std::to_string(row.step);
}

}  // namespace

double true_residual(const LinearSystem& system, const VecX& dv) { return residual_of(system, dv).norm(); }

double reference_impulse(const LinearSystem& system) {
  VecX z = VecX::Zero(system.b.size());
  for (const FilterEntry& e : system.filter.entries()) z.segment<3>(3 * e.particle) = e.z;
  return std::max(residual_of(system, z).norm(), system.options.scale);
}

double constraint_violation(const LinearSystem& system, const VecX& dv) {
  double worst = 0;
  for (const FilterEntry& e : system.filter.entries()) {
    const Vec3 own = dv.segment<3>(3 * e.particle);
    const double violation = (own - e.S * own - e.z).norm();
    if (!(violation <= worst)) worst = violation;  // not a number counts as worst
  }
  return worst;
}

SolverBench::SolverBench(const std::vector<SolverChoice>& choices, double tolerance, int repeats,
                         std::string where)
    : tolerance_(tolerance), repeats_(repeats), where_(std::move(where)) {
  for (const SolverChoice& choice : choices)
    entries_.push_back({choice, make_linear_solver(choice.name), true, {}});
}

SolverRow SolverBench::measure(Entry& entry, const LinearSystem& system, double reference) const {
  SolverRow row;
  row.solver = entry.choice.text;
  LinearOptions options = system.options;
  // The last solve of a step may have been asked for less, when contacts were still being looked for.
  options.tolerance = row.tolerance = entry.choice.tolerance.value_or(tolerance_);
  options.history = &row.history;
  entry.dv = system.guess;
  {
    std::optional<PeakMemory> memory;
    if (entry.fresh) memory.emplace();
    {
      const Stopwatch watch(row.first_ms);
      row.report = entry.solver->solve(system.A, system.b, system.filter, options, entry.dv);
    }
    row.first_solve = entry.fresh;
    if (memory) row.peak_bytes = memory->bytes();
    entry.fresh = false;
  }
  row.finite = entry.dv.allFinite();
  const double impulse = true_residual(system, entry.dv);
  row.residual = reference > 0 ? impulse / reference : impulse;
  row.violation = constraint_violation(system, entry.dv);

  options.history = nullptr;
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
  return row;
}

std::vector<SolverRow> SolverBench::compare(const LinearSystem& system, int step, const Simulation& simulation) {
  const double reference = drape::reference_impulse(system);
  std::vector<SolverRow> rows;
  for (Entry& entry : entries_) {
    if (interrupted()) return {};
    rows.push_back(measure(entry, system, reference));
    rows.back().vertices = simulation.state.particles();
    rows.back().step = step;
    rows.back().time = simulation.state.time;
    rows.back().constrained = static_cast<int>(system.filter.entries().size());
  }
  const auto worse = [](const SolverRow& a, const SolverRow& b) {
    return a.finite != b.finite ? a.finite : a.residual < b.residual;
  };
  const auto best = static_cast<std::size_t>(std::min_element(rows.begin(), rows.end(), worse) - rows.begin());
  rows[best].most_accurate = true;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (interrupted()) return {};
    judge(rows[k], entries_[k], rows[best], entries_[best], system, reference, simulation);
  }
  return rows;
}

void SolverBench::judge(SolverRow& row, const Entry& entry, const SolverRow& best, const Entry& best_entry,
                        const LinearSystem& system, double reference, const Simulation& simulation) const {
  if (!row.finite) {
    row.verdict = first_words(row, where_) + ", not finite numbers (" + std::string(name(row.report.reason)) + ")";
    return;
  }
  const double asked = std::max(tolerance_, finest_tolerance);
  const VecX difference = best_entry.dv - entry.dv;
  const int worst = worst_row(difference);
  const Vec3 u = difference.segment<3>(3 * worst);
  row.difference = u.norm();
  const int particle = system.A.pattern().particle_of()[static_cast<std::size_t>(worst)];
  const Cloth& cloth = simulation.cloth_of(particle);
  row.vertex = particle - cloth.first_particle;
  row.cloth = cloth.name;
  const double largest = best_entry.dv.lpNorm<Eigen::Infinity>();
  if (row.difference > 0) {
    const std::optional<double> g = influence(best_entry.choice.name, system, worst, u / row.difference);
    if (g) row.allowed = *g * reference * (residual_slack * asked + best.residual) + 1e-12 * largest;
  }
  const bool solved = row.residual <= residual_slack * asked;
  const bool held = row.violation <= 1e-12 * (largest + 1);
  const bool explained = row.difference == 0 || !row.allowed || row.difference <= *row.allowed;
  row.agrees = solved && held && explained;
  row.verdict = "agree";
  if (row.agrees) return;
  row.verdict = first_words(row, where_);
  if (row.difference > 0)
    row.verdict += ", vertex " + std::to_string(row.vertex) + " of cloth '" + row.cloth + "', by " +
                   rounded(row.difference, 2) + " m/s (allowed " +
                   (row.allowed ? rounded(*row.allowed, 2) + " m/s" : "not known") + ")";
  if (!solved) row.verdict += "; residual " + rounded(row.residual, 2) + ", asked " + rounded(asked, 2);
  if (!solved && row.report.reason != StopReason::converged)
    row.verdict += " (" + std::string(name(row.report.reason)) + ")";
  if (!held) row.verdict += "; a constraint is missed by " + rounded(row.violation, 2) + " m/s";
}

}  // namespace drape
