#include "app/compare/files.h"

#include "app/base/csv_text.h"
#include "app/base/json.h"
#include "app/compare/html.h"
#include "app/compare/system_files.h"
#include "app/compare/tables.h"
#include "app/recording/output.h"

namespace drape::app {
namespace {

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

// One row, keys as in compare.csv.
Json::Members members_of(const SolverRow& row) {
  const LinearReport& report = row.report;
  return {{"vertices", row.vertices},
          {"step", row.step},
          {"time", row.time},
          {"constrained", row.constrained},
          {"solver", row.solver},
          {"tolerance", row.tolerance},
          {"iterations", report.iterations},
          {"residual", row.residual},
          {"reported_residual", report.residual},
          {"constraint_violation", row.violation},
          {"setup_ms", row.setup_ms},
          {"solve_ms", row.solve_ms},
          {"total_ms", row.total_ms()},
          {"first_ms", row.first_ms},
          {"first_setup_ms", report.setup_ms},
          {"analyses", report.analyses},
          {"peak_memory_bytes", optional_json(row.peak_bytes)},
          {"difference", row.difference},
          {"allowed", optional_json(row.allowed)},
          {"cloth", row.cloth},
          {"vertex", row.vertex < 0 ? Json() : Json(row.vertex)},
          {"most_accurate", row.most_accurate},
          {"stopped", name(report.reason)},
          {"agrees", row.agrees},
          {"verdict", row.verdict},
          {"note", remark(report)}};
}

// One run, keys as in compare-integrators.csv.
Json::Members members_of(const IntegratorRow& row, const Comparison& comparison) {
  return Json::Members{{"integrator", row.integrator},
                       {"time_step", row.time_step},
                       {"solver", row.solver},
                       {"done", row.failure.empty()},
                       {"failure", row.failure},
                       {"end", row.end},
                       {"steps", row.steps},
                       {"steps_cut", row.steps_cut},
                       {"steps_not_converged", row.steps_not_converged},
                       {"linear_iterations", row.linear_iterations},
                       {"wall_ms", row.wall_ms},
                       {"max_distance", optional_json(row.max_distance)},
                       {"rms_distance", optional_json(row.rms_distance)},
                       {"energy_drift", row.energy_drift},
                       {"energy_error", optional_json(row.energy_error)},
                       {"same_run_distance", optional_json(row.same_run_distance)},
                       {"reference", row.reference},
                       {"differs_by", name(row.differs_by)},
                       {"inner_steps", row.inner_steps},
                       {"inner_rejected", row.inner_rejected},
                       {"strain", optional_json(row.strain)},
                       {"strain_error", optional_json(row.strain_error)},
                       {"vertices", row.vertices},
                       {"verdict", verdict_of(row, comparison)}};
}

}  // namespace

std::string compare_json(const Comparison& c) {
  Json::List rows, runs, growth;
  for (const SolverRow& row : c.rows) {
    Json::Members members = members_of(row);
    members.emplace_back("history", row.history);
    rows.emplace_back(std::move(members));
  }
  for (const IntegratorRow& run : c.runs) runs.emplace_back(members_of(run, c));
  for (const Growth& g : c.growth)
    growth.emplace_back(Json::Members{{"solver", g.solver},
                                      {"time_exponent", g.time},
                                      {"iterations_exponent", optional_json(g.iterations)}});
  Json::Members json = {{"drape_version", DRAPE_VERSION},
                        {"scene", c.scene},
                        {"integrator", c.integrator},
                        {"linear_solver", c.reference_solver},
                        {"time_step", c.time_step},
                        {"time_step_asked", c.time_step_asked},
                        {"tolerance", c.tolerance},
                        {"threads", c.threads},
                        {"steps", c.steps},
                        {"at", c.at},
                        {"repeats", c.repeats},
                        {"sizes", c.sizes},
                        {"solvers", c.solvers},
                        {"agree", c.agree()},
                        {"verdicts", verdicts(c)},
                        {"failure", c.failure.empty() ? Json() : Json(c.failure)},
                        {"rows", std::move(rows)},
                        {"growth", std::move(growth)},
                        {"systems", c.systems},
                        {"run_duration", c.runs.empty() ? Json() : Json(c.run_duration)},
                        {"runs", std::move(runs)}};
  json.insert(json.end(), c.made_of.begin(), c.made_of.end());
  return json_text(json);
}

std::string compare_csv(const Comparison& comparison) {
  std::string text = csv_header(members_of(SolverRow()));
  for (const SolverRow& row : comparison.rows) text += csv_line(members_of(row));
  return text;
}

std::string integrators_csv(const Comparison& comparison) {
  std::string text = csv_header(members_of(IntegratorRow(), comparison));
  for (const IntegratorRow& run : comparison.runs) text += csv_line(members_of(run, comparison));
  return text;
}

CompareFiles::CompareFiles(std::filesystem::path folder, bool with_systems) : folder_(std::move(folder)) {
  make_output_folder(folder_, {"compare.json", "compare.csv", "compare-integrators.csv", "compare.html"});
  if (with_systems) make_output_folder(folder_ / "systems");
}

std::string CompareFiles::save(const LinearSystem& system, const Comparison& comparison, int step,
                               double time) {
  const std::string name = "systems/" +
                           (comparison.sizes.empty() ? "" : std::to_string(system.A.rows()) + "-vertices-") +
                           "step-" + std::to_string(step);
  for (AtomicFile& file : write_system(folder_ / name, system,
                                       {{"drape_version", DRAPE_VERSION},
                                        {"scene", comparison.scene},
                                        {"integrator", comparison.integrator},
                                        {"linear_solver", comparison.reference_solver},
                                        {"step", step},
                                        {"time", time},
                                        {"time_step", comparison.time_step}}))
    systems_.push_back(std::move(file));
  return name;
}

void CompareFiles::write(const Comparison& comparison) {
  std::vector<AtomicFile> files;
  const auto add = [&](const char* name, const std::string& text) {
    files.emplace_back(folder_ / name).write(text);
    files.back().close();
  };
  add("compare.json", compare_json(comparison));
  add("compare.csv", compare_csv(comparison));
  add("compare-integrators.csv", integrators_csv(comparison));
  add("compare.html", compare_html(comparison));
  for (AtomicFile& file : files) {
    file.keep();
    written_.push_back(file.path());
  }
  for (AtomicFile& file : systems_) file.keep();
  systems_.clear();
  for (const std::string& name : comparison.systems) written_.push_back(folder_ / name);
}

}  // namespace drape::app
