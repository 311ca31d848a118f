#include <cmath>

#include "app/base/csv_text.h"
#include "app/base/json.h"
#include "app/stability/stability.h"

namespace drape::app {
namespace {

std::string theory_in_words(const std::optional<double>& theory) {
  if (!theory) return "implicit or adaptive: not looked at";
  if (*theory == 0) return "no step is short enough";
  return std::isfinite(*theory) ? "limit" : "no limit";
}

std::string theory_cell(const std::optional<double>& theory) {
  if (!theory) return "-";
  if (*theory == 0) return "none stable";
  return std::isfinite(*theory) ? rounded(*theory, 4) : "no limit";
}

std::string measured_cell(const StabilityRow& row, const StabilityOptions& options) {
  if (!row.largest) return "none down to " + rounded(options.shortest, 3);
  return row.limited ? rounded(*row.largest, 4) : "no limit up to " + rounded(*row.largest, 3);
}

std::optional<double> finite_theory(const StabilityRow& row) {
  return row.theory && *row.theory > 0 && std::isfinite(*row.theory) ? row.theory : std::nullopt;
}

std::string ratio_cell(const StabilityRow& row) {
  const auto theory = finite_theory(row);
  return theory && row.largest && row.limited ? rounded(*row.largest / *theory, 4) : "-";
}

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json::Members members_of(const StabilityRow& row) {
  return {{"integrator", row.integrator},
          {"contact", row.contact},
          {"largest_stable_step", optional_json(row.largest)},
          {"limited", row.limited},
          {"theory", optional_json(finite_theory(row))},
          {"theory_says", theory_in_words(row.theory)},
          {"steps_cut", row.steps_cut},
          {"runs", row.runs},
          {"failure", row.failure}};
}

}  // namespace

std::string stability_text(const StabilityTable& t) {
  std::string text = t.scene + ": the largest stable step, over " + rounded(t.options.time, 4) +
                     " s; stable: finite, and no more energy made than " + rounded(t.options.growth, 3) +
                     " times what was given\n";
  text += t.spectrum.modes.empty()
              ? "nothing vibrates at the start\n"
              : "highest frequency at the start " + rounded(t.spectrum.omega(), 5) + " 1/s, its damping " +
                    rounded(t.spectrum.modes.front().d, 4) + " 1/s" +
                    (t.spectrum.proportional ? "\n"
                                             : ", not proportional to the stiffness: theory is near only\n");
  std::vector<Names> rows = {{"integrator", "measured s", "theory s", "ratio", "contact", "cut"}};
  for (const StabilityRow& row : t.rows)
    rows.push_back({row.integrator, measured_cell(row, t.options), theory_cell(row.theory), ratio_cell(row),
                    row.contact, std::to_string(row.steps_cut)});
  std::vector<std::size_t> width(rows.front().size(), 0);
  for (const Names& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  for (const Names& row : rows) {
    std::string line = " ";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string blanks(width[c] - row[c].size(), ' ');
      line += c == 0 ? " " + row[c] + blanks : "  " + blanks + row[c];
    }
    text += line + "\n";
  }
  return text;
}

std::string stability_json(const StabilityTable& t) {
  Json::List rows;
  for (const StabilityRow& row : t.rows) rows.emplace_back(members_of(row));
  return json_text(
      Json::Members{{"drape_version", DRAPE_VERSION},
                    {"scene", t.scene},
                    {"time", t.options.time},
                    {"shake", t.options.shake},
                    {"growth", t.options.growth},
                    {"precision", t.options.precision},
                    {"longest", t.options.longest},
                    {"shortest", t.options.shortest},
                    {"highest_frequency", t.spectrum.modes.empty() ? Json() : Json(t.spectrum.omega())},
                    {"its_damping", t.spectrum.modes.empty() ? Json() : Json(t.spectrum.modes.front().d)},
                    {"proportional_damping", t.spectrum.proportional},
                    {"rows", std::move(rows)}});
}

std::string stability_csv(const StabilityTable& t) {
  std::string text = csv_header(members_of(StabilityRow()));
  for (const StabilityRow& row : t.rows) text += csv_line(members_of(row));
  return text;
}

}  // namespace drape::app
