#include "app/compare/html.h"

#include <algorithm>
#include <cmath>

#include "app/base/markup.h"
#include "app/compare/tables.h"
#include "app/recording/scene_record.h"
#include "app/view/page_template.h"

namespace drape::app {
namespace {

// A solver looks the same in every plot.
int look_of(const Comparison& comparison, const std::string& solver) {
  const Names& all = comparison.solvers;
  return static_cast<int>(std::find(all.begin(), all.end(), solver) - all.begin());
}

// Residuals against iterations; a long history is thinned out, its ends kept.
Series convergence(const SolverRow& row) {
  constexpr std::size_t most = 200;
  Series series;
  series.name = row.solver;
  const std::size_t count = row.history.size(), stride = std::max<std::size_t>(1, count / most);
  for (std::size_t k = 0; k < count; ++k) {
    if (k % stride != 0 && k + 1 != count) continue;
    series.x.push_back(static_cast<double>(k));
    series.y.push_back(row.history[k]);
  }
  if (count < 2) {  // it gave no history: where it ended
    series.line = false;
    series.x = {static_cast<double>(row.report.iterations)};
    series.y = {row.residual};
  }
  series.every = std::max(1, static_cast<int>(series.x.size() / 8));
  return series;
}

// Of the iterative solvers: a direct one has no curve.
Plot convergence_plot(const Comparison& comparison, int vertices, int step) {
  Plot plot{"Convergence at step " + std::to_string(step) + ", " + std::to_string(vertices) + " vertices",
            "iterations",
            "relative residual",
            false,
            true,
            {}};
  double most = 1;
  for (const SolverRow& row : comparison.rows)
    if (row.vertices == vertices && row.step == step &&
        (row.report.iterations > 0 || row.history.size() > 1)) {
      plot.series.push_back(convergence(row));
      plot.series.back().look = look_of(comparison, row.solver);
      most = std::max(most, plot.series.back().x.back());
    }
  const double asked = comparison.tolerance;
  plot.series.push_back({"tolerance asked", {0, most}, {asked, asked}, true, 0, true});
  return plot;
}

// Something of the last compared step against the vertices of every size.
template <class Value>
Plot size_plot(const Comparison& comparison, const std::string& title, const std::string& label,
               Value value) {
  Plot plot{title, "vertices", label, true, true, {}};
  for (const std::string& solver : comparison.solvers) {
    Series series{solver, {}, {}};
    series.look = look_of(comparison, solver);
    for (const SolverRow& row : comparison.rows) {
      if (row.solver != solver || row.step != comparison.at.back()) continue;
      series.x.push_back(row.vertices);
      series.y.push_back(value(row));
    }
    if (std::any_of(series.y.begin(), series.y.end(), [](double y) { return y > 0; }))
      plot.series.push_back(std::move(series));
  }
  return plot;
}

// Of the runs with so many vertices.
Plot work_precision(const Comparison& comparison, int vertices) {
  Plot plot{"Work and precision: " + rounded(comparison.run_duration, 4) + " s of the scene, " +
                counted(vertices, "vertex"),
            "wall time, s",
            "largest distance from the reference, m",
            true,
            true,
            {}};
  Series others{"other linear solvers", {}, {}, false};
  for (const IntegratorRow& row : comparison.runs) {
    if (row.vertices != vertices || !row.max_distance || row.reference) continue;
    if (row.solver != comparison.reference_solver) {
      others.x.push_back(row.wall_ms / 1000);
      others.y.push_back(*row.max_distance);
      continue;
    }
    auto series = std::find_if(plot.series.begin(), plot.series.end(),
                               [&](const Series& s) { return s.name == row.integrator; });
    if (series == plot.series.end()) series = plot.series.insert(series, Series{row.integrator, {}, {}});
    series->x.push_back(row.wall_ms / 1000);
    series->y.push_back(*row.max_distance);
  }
  if (!others.x.empty()) plot.series.push_back(std::move(others));
  return plot;
}

std::string html_of(const ReportTable& table) {
  std::string text =
      "<div class=\"wide\"><table>\n<caption>" + escaped(table.title) + "</caption>\n<thead><tr>";
  for (const std::string& cell : table.header) text += "<th scope=\"col\">" + escaped(cell) + "</th>";
  text += "</tr></thead>\n<tbody>\n";
  for (const Names& row : table.rows) {
    text += "<tr><th scope=\"row\">" + escaped(row.front()) + "</th>";
    for (std::size_t c = 1; c < row.size(); ++c)
      text += (row[c] == "differ" || row[c] == "failed" ? "<td class=\"bad\">" : "<td>") + escaped(row[c]) +
              "</td>";
    text += "</tr>\n";
  }
  text += "</tbody>\n</table></div>\n";
  for (const std::string& note : table.notes) text += "<p class=\"note\">" + escaped(note) + "</p>\n";
  return text;
}

// Fabrics, pins, seams, friction, margins and settings.
std::string what_was_run(const Comparison& comparison) {
  std::string text;
  for (const SceneFact& fact : scene_facts(comparison.made_of))
    text += "<dt>" + escaped(fact.name) + "</dt><dd>" + escaped(fact.value) + "</dd>\n";
  return text.empty() ? "" : "<h2>What was run</h2>\n<dl>\n" + text + "</dl>\n";
}

constexpr const char* style = R"(:root { color-scheme: light dark }
body { font: 15px/1.5 system-ui, sans-serif; margin: 2em auto; max-width: 92em; padding: 0 1em;
       background: Canvas; color: CanvasText }
h1 { font-size: 1.4em } h2 { font-size: 1.15em; margin-top: 2em }
.wide { overflow-x: auto }
table { border-collapse: collapse; margin: 1em 0 .3em; font-variant-numeric: tabular-nums; font-size: .87em }
caption { text-align: left; font-weight: bold; padding: .3em 0; white-space: nowrap }
th, td { padding: .15em .7em; text-align: right; white-space: nowrap; border-bottom: 1px solid #8884 }
th:first-child { text-align: left; padding-left: 0 }
dt { font-weight: bold } dd { margin: 0 0 .3em }
.bad { font-weight: bold; text-decoration: underline }
.note { margin: .1em 0; font-size: .87em }
)";

bool visible(const Plot& plot, double x, double y) {
  return std::isfinite(x) && std::isfinite(y) && (!plot.log_x || x > 0) && (!plot.log_y || y > 0);
}

// Figures with their titles, and what the script fills them with.
std::string html_of(const std::vector<Plot>& plots) {
  if (plot_script().empty())
    return "<p class=\"note\">The plots are drawn by the code of drape view, and " +
           escaped(missing_viewer()) + ".</p>\n";
  std::string text = "<noscript><p>A script draws the plots, and the browser runs none.</p></noscript>\n";
  Json::List shown;
  for (const Plot& plot : plots) {
    Json json = json_of(plot);
    if (json.is_null()) {
      text += "<p>" + escaped(plot.title) + ": there is nothing to plot.</p>\n";
      continue;
    }
    shown.push_back(std::move(json));
  }
  text += "<div class=\"plots\">\n";
  for (const Json& json : shown)
    text +=
        "<figure><figcaption><strong>" + escaped(json["title"].text()) + "</strong></figcaption></figure>\n";
  return text + "</div>\n<script type=\"application/json\" id=\"drape-plots\">" + json_for_html(shown) +
         "</script>\n";
}

}  // namespace

Json json_of(const Plot& plot) {
  Json::List all;
  bool empty = true;
  for (std::size_t k = 0; k < plot.series.size(); ++k) {
    const Series& series = plot.series[k];
    Json::List x, y;
    for (std::size_t i = 0; i < series.x.size(); ++i)
      if (visible(plot, series.x[i], series.y[i])) x.emplace_back(series.x[i]), y.emplace_back(series.y[i]);
    empty = empty && x.empty();
    all.push_back(Json::Members{{"name", series.name},
                                {"x", std::move(x)},
                                {"y", std::move(y)},
                                {"line", series.line},
                                {"every", series.every},
                                {"dashed", series.dashed},
                                {"look", series.look < 0 ? static_cast<long>(k) : series.look}});
  }
  if (empty) return {};
  return Json::Members{{"title", plot.title}, {"x_label", plot.x_label}, {"y_label", plot.y_label},
                       {"log_x", plot.log_x}, {"log_y", plot.log_y},     {"series", std::move(all)}};
}

std::vector<Plot> plots_of(const Comparison& comparison) {
  std::vector<Plot> plots;
  if (!comparison.sizes.empty() && !comparison.rows.empty()) {
    plots.push_back(size_plot(comparison, "Time against vertices", "set-up and solve, ms",
                              [](const SolverRow& row) { return row.total_ms(); }));
    plots.push_back(size_plot(comparison, "Iterations against vertices", "iterations",
                              [](const SolverRow& row) { return row.report.iterations; }));
  }
  for (std::size_t k = 0; k < comparison.rows.size(); ++k) {
    const SolverRow& row = comparison.rows[k];
    if (k == 0 || row.step != comparison.rows[k - 1].step || row.vertices != comparison.rows[k - 1].vertices)
      plots.push_back(convergence_plot(comparison, row.vertices, row.step));
  }
  for (const int vertices : sizes_of_runs(comparison)) plots.push_back(work_precision(comparison, vertices));
  return plots;
}

std::string compare_html(const Comparison& comparison) {
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<meta http-equiv=\"Content-Security-Policy\" content=\"default-src "
      "'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:\">\n<title>drape "
      "compare: " +
      escaped(comparison.scene) + "</title>\n<style>\n" + std::string(plot_style()) + "\n" + style +
      "</style>\n</head>\n<body>\n<h1>drape compare: " + escaped(comparison.scene) + "</h1>\n";
  for (const std::string& line : headline(comparison)) text += "<p>" + escaped(line) + "</p>\n";
  text += "<h2>Verdicts</h2>\n<ul>\n";
  for (const std::string& line : verdicts(comparison)) text += "<li>" + escaped(line) + "</li>\n";
  text += "</ul>\n<h2>Plots</h2>\n" + html_of(plots_of(comparison)) + "<h2>Tables</h2>\n";
  for (const ReportTable& table : tables_of(comparison)) text += html_of(table);
  text += what_was_run(comparison);
  text += "<p>drape " DRAPE_VERSION "</p>\n";
  if (!plot_script().empty()) text += "<script>\n" + std::string(plot_script()) + "\n</script>\n";
  return text + "</body>\n</html>\n";
}

}  // namespace drape::app
