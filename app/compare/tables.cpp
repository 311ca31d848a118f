#include "app/compare/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace drape::app {
namespace {

std::string optional_number(const std::optional<double>& value, int digits) {
  return value ? rounded(*value, digits) : "-";
}

std::string milliseconds(double ms) { return ms < 1000 ? rounded(ms, 3) : std::to_string(std::lround(ms)); }

std::string memory(const SolverRow& row) {
  return row.peak_bytes ? rounded(*row.peak_bytes / 1e6, 3) : "not measured";
}

Names row_of(const SolverRow& row) {
  const LinearReport& report = row.report;
  return {row.solver + (row.most_accurate ? " *" : ""),
          std::to_string(report.iterations),
          rounded(row.residual, 2),
          rounded(row.violation, 2),
          milliseconds(row.setup_ms),
          milliseconds(row.solve_ms),
          milliseconds(row.first_ms),
          std::to_string(report.analyses),
          memory(row),
          row.most_accurate ? "0" : rounded(row.difference, 2),
          optional_number(row.allowed, 2),
          std::string(name(report.reason)),
          row.agrees ? "agree" : "differ"};
}

// The rows of one step at one size stand together.
ReportTable table_of(std::vector<SolverRow>::const_iterator first,
                     std::vector<SolverRow>::const_iterator last) {
  ReportTable table;
  table.title = "step " + std::to_string(first->step) + " (" + rounded(first->time, 4) + " s), " +
                counted(first->vertices, "vertex") + ", " + std::to_string(first->constrained) +
                " constrained";
  table.header = {"solver",      "iterations", "residual", "constraints m/s", "set-up ms",
                  "solve ms",    "first ms",   "analyses", "peak MB",         "difference m/s",
                  "allowed m/s", "stopped",    "verdict"};
  for (auto row = first; row != last; ++row) {
    table.rows.push_back(row_of(*row));
    if (const std::string text = remark(row->report); !text.empty())
      table.notes.push_back(row->solver + ": " + text);
  }
  return table;
}

std::string name_of(const IntegratorRow& run, const Comparison& comparison) {
  return run.integrator + " at " + rounded(run.time_step, 4) + " s with " + run.solver +
         (comparison.sizes.empty() ? "" : ", " + counted(run.vertices, "vertex"));
}

// Of the runs with so many vertices.
ReportTable table_of_runs(const Comparison& comparison, int vertices) {
  ReportTable table;
  table.title = "integrators, " + rounded(comparison.run_duration, 4) + " s from the same start, " +
                counted(vertices, "vertex");
  table.header = {"integrator",     "time step s",  "solver", "steps",      "wall ms",
                  "iterations",     "distance m",   "rms m",  "same run m", "drift J",
                  "energy error J", "strain error", "state",  "differs by"};
  for (const IntegratorRow& row : comparison.runs) {
    if (row.vertices != vertices) continue;
    table.rows.push_back({row.integrator, rounded(row.time_step, 4), row.solver, std::to_string(row.steps),
                          milliseconds(row.wall_ms), std::to_string(row.linear_iterations),
                          optional_number(row.max_distance, 3), optional_number(row.rms_distance, 3),
                          optional_number(row.same_run_distance, 2), rounded(row.energy_drift, 3),
                          optional_number(row.energy_error, 3), optional_number(row.strain_error, 2),
                          row.failure.empty() ? "done" : "failed", std::string(name(row.differs_by))});
    const std::string who = name_of(row, comparison);
    if (row.reference) table.notes.push_back("the reference: " + who);
    if (row.steps_cut + row.steps_not_converged > 0)
      table.notes.push_back(who + ": " + counted(row.steps_cut, "step") + " taken in pieces, " +
                            std::to_string(row.steps_not_converged) + " not converged");
  }
  table.notes.push_back(
      "distance, rms: of the vertices at the end, from the reference; same run: the largest from the run "
      "that differs "
      "by the linear solver alone (" +
      comparison.reference_solver + ")");
  return table;
}

// What the cheapest run of each integrator costs whose largest strain is off the reference's by no more than
// this much.
ReportTable table_of_work(const Comparison& comparison, const std::vector<int>& sizes) {
  constexpr std::array<double, 6> errors = {0.1, 0.03, 0.01, 0.003, 0.001, 0.0003};
  ReportTable table;
  table.title = "wall ms of the cheapest run whose largest strain is off by at most";
  table.header = {"integrator", "vertices"};
  for (const double error : errors) table.header.push_back(rounded(100 * error, 2) + " %");
  Names integrators;
  for (const IntegratorRow& row : comparison.runs)
    if (std::find(integrators.begin(), integrators.end(), row.integrator) == integrators.end())
      integrators.push_back(row.integrator);
  for (const int vertices : sizes)
    for (const std::string& integrator : integrators) {
      Names cells = {integrator, std::to_string(vertices)};
      for (const double error : errors) {
        std::optional<double> least;
        for (const IntegratorRow& row : comparison.runs)
          if (row.vertices == vertices && row.integrator == integrator && !row.reference &&
              row.strain_error && std::abs(*row.strain_error) <= error)
            least = std::min(least.value_or(row.wall_ms), row.wall_ms);
        cells.push_back(least ? milliseconds(*least) : "-");
      }
      table.rows.push_back(std::move(cells));
    }
  table.notes.push_back(
      "strain: the largest of an edge at the end, l / L - 1; -: no run was as near, or it is the reference "
      "itself");
  return table;
}

ReportTable table_of_growth(const Comparison& comparison) {
  ReportTable table;
  table.title = "growth with the number of vertices n, fitted";
  table.header = {"solver", "time ~ n^", "iterations ~ n^"};
  for (const Growth& g : comparison.growth)
    table.rows.push_back({g.solver, rounded(g.time, 3), optional_number(g.iterations, 3)});
  return table;
}

// As wide as the widest cell of a column; the first column to the left, the others to the right.
std::string aligned(const ReportTable& table) {
  std::vector<std::size_t> width;
  for (const std::string& cell : table.header) width.push_back(cell.size());
  for (const Names& row : table.rows)
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  const auto line = [&](const Names& cells) {
    std::string text = " ";
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::string blanks(width[c] - cells[c].size(), ' ');
      text += c == 0 ? " " + cells[c] + blanks : "  " + blanks + cells[c];
    }
    return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
  };
  std::string text = table.title + "\n" + line(table.header);
  for (const Names& row : table.rows) text += line(row);
  for (const std::string& note : table.notes) text += "  " + note + "\n";
  return text + "\n";
}

}  // namespace

std::vector<int> sizes_of_runs(const Comparison& comparison) {
  std::vector<int> sizes;
  for (const IntegratorRow& row : comparison.runs)
    if (std::find(sizes.begin(), sizes.end(), row.vertices) == sizes.end()) sizes.push_back(row.vertices);
  return sizes;
}

Names headline(const Comparison& c) {
  Names lines = {c.scene + ": " + c.integrator + ", " + rounded(c.time_step, 4) +
                 " s a step; the path is of " + c.reference_solver + ", tolerance " +
                 rounded(c.tolerance, 3) + "; " + counted(c.threads, "thread")};
  lines.push_back(
      "times: median of " + counted(c.repeats, "repeat") +
      " on the same system, the first call apart; *: the most accurate, the others' difference is "
      "from it");
  if (!c.failure.empty()) lines.push_back("failed: " + c.failure);
  return lines;
}

std::vector<ReportTable> tables_of(const Comparison& comparison) {
  std::vector<ReportTable> tables;
  for (auto first = comparison.rows.begin(); first != comparison.rows.end();) {
    const auto last = std::find_if(first, comparison.rows.end(), [&](const SolverRow& row) {
      return row.step != first->step || row.vertices != first->vertices;
    });
    tables.push_back(table_of(first, last));
    first = last;
  }
  if (!comparison.growth.empty()) tables.push_back(table_of_growth(comparison));
  if (comparison.runs.empty()) return tables;
  const std::vector<int> sizes = sizes_of_runs(comparison);
  for (const int vertices : sizes) tables.push_back(table_of_runs(comparison, vertices));
  tables.push_back(table_of_work(comparison, sizes));
  return tables;
}

namespace {

Names verdicts_of_solvers(const Comparison& comparison) {
  Names lines;
  for (const std::string& solver : comparison.solvers) {
    bool agrees = true, known = false;
    for (const SolverRow& row : comparison.rows) {
      if (row.solver != solver) continue;
      known = true;
      if (!row.agrees) lines.push_back(solver + ": " + row.verdict);
      agrees = agrees && row.agrees;
    }
    if (agrees && known) lines.push_back(solver + ": agree");
  }
  return lines;
}

Names verdicts_of_runs(const Comparison& comparison) {
  Names lines;
  for (const IntegratorRow& run : comparison.runs) lines.push_back(line_of(run, comparison));
  return lines;
}

}  // namespace

Names verdicts(const Comparison& comparison) {
  Names lines = verdicts_of_solvers(comparison);
  for (std::string& line : verdicts_of_runs(comparison)) lines.push_back(std::move(line));
  return lines;
}

std::string verdict_of(const IntegratorRow& run, const Comparison& comparison) {
  if (!run.failure.empty()) return "failed after " + rounded(run.end, 4) + " s: " + run.failure;
  if (run.reference) return "the reference";
  if (run.solver != comparison.reference_solver) {
    const std::string same_run = " the same run with " + comparison.reference_solver;
    if (run.differs_by == DiffersBy::nothing) return "no difference from" + same_run;
    if (!run.same_run_distance) return "differs by linear algebra only from" + same_run + ", which failed";
    return "differs by linear algebra only: " + rounded(*run.same_run_distance, 2) + " m from" + same_run;
  }
  const auto reference = std::find_if(
      comparison.runs.begin(), comparison.runs.end(),
      [&](const IntegratorRow& other) { return other.reference && other.vertices == run.vertices; });
  if (reference == comparison.runs.end() || !run.max_distance) return "there is no reference to differ from";
  const std::string from = " from the reference (" + name_of(*reference, comparison) + ")";
  if (run.differs_by == DiffersBy::nothing) return "no difference" + from;
  return "differs by time integration: " + rounded(*run.max_distance, 2) + " m" + from;
}

std::string line_of(const IntegratorRow& run, const Comparison& comparison) {
  return name_of(run, comparison) + ": " + verdict_of(run, comparison);
}

std::string text_of(const Comparison& comparison) {
  std::string text;
  for (const std::string& line : headline(comparison)) text += line + "\n";
  text += "\n";
  for (const ReportTable& table : tables_of(comparison)) text += aligned(table);
  text += "solvers, given the same systems: what differs is linear algebra only\n";
  for (const std::string& line : verdicts_of_solvers(comparison)) text += line + "\n";
  if (!comparison.runs.empty()) text += "\nintegrators\n";
  for (const std::string& line : verdicts_of_runs(comparison)) text += line + "\n";
  return text;
}

}  // namespace drape::app
