#include <algorithm>
#include <cmath>

#include "app/base/words.h"
#include "app/textile/test_fabric.h"

namespace drape::app {
namespace {

struct Spread {
  double mean, deviation;  // the standard deviation of a sample; 0 of a single value
};

Spread spread(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (double value : values) mean += value / n;
  for (double value : values) squares += (value - mean) * (value - mean);
  return {mean, values.size() > 1 ? std::sqrt(squares / (n - 1)) : 0};
}

std::string cell(const std::optional<double>& value, const Unit& unit) {
  return value ? rounded(*value / unit.in_si, 4) : "";
}

std::string cell(const std::vector<double>& found, const Unit& unit) {
  const Spread s = spread(found);
  if (!std::isfinite(s.mean)) return "not found";
  std::string text = rounded(s.mean / unit.in_si, 4);
  if (found.size() > 1) text += " ± " + rounded(s.deviation / unit.in_si, 2);
  return text;
}

std::size_t letters(const std::string& utf8) {
  return static_cast<std::size_t>(
      std::count_if(utf8.begin(), utf8.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

}  // namespace

std::string fabric_text(const FabricTable& table) {
  const bool measured = std::any_of(table.rows.begin(), table.rows.end(),
                                    [](const FabricRow& row) { return row.measured.has_value(); });
  Names heading = {"test", "quantity", "unit", "asked"};
  if (measured) heading.emplace_back("measured");
  for (double edge : table.edges) heading.push_back(rounded(1000 * edge, 3) + " mm mesh");
  std::vector<Names> lines = {heading};
  for (const FabricRow& row : table.rows) {
    const Unit& unit = row.value.unit;
    Names line = {row.test, row.value.quantity, unit.name, cell(row.value.asked, unit)};
    if (measured) line.push_back(cell(row.measured, unit));
    for (const std::vector<double>& found : row.found) line.push_back(cell(found, unit));
    lines.push_back(line);
  }
  std::vector<std::size_t> width(heading.size(), 0);
  for (const Names& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c) width[c] = std::max(width[c], letters(line[c]));
  std::string text = table.fabric + ", model " + table.model + (table.hysteresis ? ", with hysteresis" : "") +
                     "\n",
              before;
  for (const Names& line : lines) {
    std::string one;
    for (std::size_t c = 0; c < line.size(); ++c) {
      const std::string word = c == 0 && line[0] == before ? "" : line[c];
      const std::string blanks(width[c] - letters(word), ' ');
      one.append("  ").append(c < 3 ? word : blanks).append(c < 3 ? blanks : word);
    }
    before = line[0];
    text += one.substr(0, one.find_last_not_of(' ') + 1) + "\n";
  }
  if (text.find("not found") != text.npos)
    text += "not found: the specimen did not come to rest, or the mesh is too coarse for the fabric\n";
  return text;
}

std::string fabric_json(const FabricTable& table) {
  Json::List rows;
  for (const FabricRow& row : table.rows) {
    Json::List results;
    for (std::size_t k = 0; k < row.found.size(); ++k) {
      const Spread s = spread(row.found[k]);
      results.emplace_back(Json::Members{
          {"mesh", table.edges[k]}, {"mean", s.mean}, {"deviation", s.deviation}, {"values", row.found[k]}});
    }
    rows.emplace_back(Json::Members{{"test", row.test},
                                    {"quantity", row.value.quantity},
                                    {"si_unit", row.value.unit.si},
                                    {"asked", optional_json(row.value.asked)},
                                    {"measured", optional_json(row.measured)},
                                    {"results", std::move(results)}});
  }
  return json_text(Json::Members{{"drape_version", DRAPE_VERSION},
                                 {"fabric", table.fabric},
                                 {"model", table.model},
                                 {"hysteresis", table.hysteresis},
                                 {"rows", std::move(rows)}});
}

}  // namespace drape::app
