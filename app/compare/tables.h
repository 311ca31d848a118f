// A comparison as tables for people: the same on the screen and in compare.html.
#pragma once

#include "app/compare/comparison.h"

namespace drape {

struct ReportTable {
  std::string title;
  Names notes;  // below it
  Names header;
  std::vector<Names> rows;
};

Names headline(const Comparison& comparison);  // what was compared
std::vector<ReportTable> tables_of(const Comparison& comparison);
Names verdicts(const Comparison& comparison);  // "mpcg: agree", or all that it differs by; then the runs
std::string verdict_of(const IntegratorRow& run, const Comparison& comparison);
std::string line_of(const IntegratorRow& run, const Comparison& comparison);  // which run, and its verdict

std::string text_of(const Comparison& comparison);

}  // namespace drape
