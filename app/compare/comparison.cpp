#include "app/compare/comparison.h"

#include <algorithm>
#include <cmath>

namespace drape::app {
namespace {

// a of y = c x^a, by least squares of the logarithms; empty when that cannot be told.
std::optional<double> exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!(y[k] > 0)) return {};
    mean_x += std::log(x[k]) / n;
    mean_y += std::log(y[k]) / n;
  }
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += (std::log(x[k]) - mean_x) * (std::log(x[k]) - mean_x);
    xy += (std::log(x[k]) - mean_x) * (std::log(y[k]) - mean_y);
  }
  if (!(xx > 0)) return {};
  return xy / xx;
}

}  // namespace

std::string_view name(DiffersBy cause) {
  switch (cause) {
    case DiffersBy::reference:
      return "reference";
    case DiffersBy::nothing:
      return "no difference";
    case DiffersBy::linear_algebra:
      return "linear algebra only";
    case DiffersBy::time_integration:
      return "time integration";
    case DiffersBy::not_known:
      return "not known";
  }
  return "";
}

bool Comparison::agree() const {
  return failure.empty() &&
         std::all_of(rows.begin(), rows.end(), [](const SolverRow& r) { return r.agrees; }) &&
         std::all_of(runs.begin(), runs.end(), [](const IntegratorRow& r) { return r.failure.empty(); });
}

std::vector<Growth> growth_of(const Comparison& comparison) {
  std::vector<Growth> all;
  for (const std::string& solver : comparison.solvers) {
    std::vector<double> vertices, ms, iterations;
    for (const SolverRow& row : comparison.rows) {
      if (row.solver != solver || row.step != comparison.at.back()) continue;
      vertices.push_back(row.vertices);
      ms.push_back(row.total_ms());
      iterations.push_back(row.report.iterations);
    }
    if (const auto time = exponent(vertices, ms))
      all.push_back({solver, *time, exponent(vertices, iterations)});
  }
  return all;
}

}  // namespace drape::app
