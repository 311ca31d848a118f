// A comparison as tables for people, the same on the screen and in compare.html.
#pragma once

#include "app/compare/comparison.h"

namespace drape::app {

struct ReportTable {
  std::string title;
  Names notes;  // printed below the table
  Names header;
  std::vector<Names> rows;
};

std::vector<int> sizes_of_runs(const Comparison& comparison);  // numbers of vertices, each once
Names headline(const Comparison& comparison);                  // says what was compared
std::vector<ReportTable> tables_of(const Comparison& comparison);
// One text for each solver, "mpcg: agree" or everything by which the solver differs; the runs follow after
// them.
Names verdicts(const Comparison& comparison);
std::string verdict_of(const IntegratorRow& run, const Comparison& comparison);
// A line that names the run and gives its verdict.
std::string line_of(const IntegratorRow& run, const Comparison& comparison);

std::string text_of(const Comparison& comparison);

}  // namespace drape::app
