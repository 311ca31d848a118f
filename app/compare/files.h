// compare.json, compare.csv (solvers), compare-integrators.csv and compare.html: all or none.
#pragma once

#include <vector>

#include "app/compare/comparison.h"

namespace drape {

std::string compare_json(const Comparison& comparison);
std::string compare_csv(const Comparison& comparison);      // a row for each solver and system
std::string integrators_csv(const Comparison& comparison);  // a row for each run; none without --integrators

class CompareFiles {
 public:
  explicit CompareFiles(std::filesystem::path folder);  // makes the folder and tries it; throws InputError
  void write(const Comparison& comparison);
  const std::vector<std::filesystem::path>& written() const { return written_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> written_;
};

}  // namespace drape
