// Where `drape compare` runs, and what it said and wrote at last.
#pragma once

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/view/page_template.h"
#include "tests/folder.h"

#include "tests/places.h"

namespace drape::test {

using namespace app;

using JsonValue = nlohmann::json;

inline const std::string scenes = source_dir() + "/data/scenes/";
inline const std::string on_ball = scenes + "sheet-on-ball.toml";

inline long count(const std::string& text, const std::string& what) {
  long found = 0;
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + what.size())) ++found;
  return found;
}

struct Desk : Folder {
  int run(const std::string& words, const std::string& before = "") {
    return said(drape("compare " + words, before));
  }
  int said(Outcome outcome) {
    out = std::move(outcome.out);
    err = std::move(outcome.err);
    return outcome.exit_code;
  }
  JsonValue json() const { return JsonValue::parse(content(path / "o/compare.json")); }

  std::string out, err;
};

// The cells of one line of CSV.
inline std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> all(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      all.emplace_back();
    else
      all.back() += c;
  }
  return all;
}

// compare.html has so many plots: a figure and data for each. Without the viewer it says what is missing.
inline void check_plots(const std::string& html, std::size_t plots) {
  if (plot_script().empty()) {
    CHECK(html.find(missing_viewer()) != std::string::npos);
    return;
  }
  CHECK(count(html, "<figure>") == static_cast<long>(plots));
  const std::string open = "<script type=\"application/json\" id=\"drape-plots\">";
  const std::size_t at = html.find(open) + open.size();
  CHECK(JsonValue::parse(html.substr(at, html.find("</script>", at) - at)).size() == plots);
}

// A CSV file holds what the rows of compare.json do.
inline void check_same_table(const std::string& text, const JsonValue& rows) {
  std::istringstream csv(text);
  std::string line;
  std::getline(csv, line);
  const std::vector<std::string> header = cells(line);
  for (const JsonValue& row : rows) {
    REQUIRE(std::getline(csv, line));
    const std::vector<std::string> found = cells(line);
    REQUIRE(found.size() == header.size());
    for (std::size_t k = 0; k < header.size(); ++k) {
      INFO(header[k]);
      REQUIRE(row.contains(header[k]));
      const JsonValue& value = row[header[k]];
      if (value.is_string()) CHECK(found[k] == value.get<std::string>());
      if (value.is_boolean()) CHECK(found[k] == (value.get<bool>() ? "1" : "0"));
      if (value.is_number()) CHECK(std::stod(found[k]) == Approx(value.get<double>()));
      if (value.is_null()) CHECK(found[k].empty());
    }
  }
  CHECK_FALSE(std::getline(csv, line));
}

}  // namespace drape::test
