// Writes compare.json, compare.csv (solvers), compare-integrators.csv and compare.html: all of them or none.
#pragma once

#include <vector>

#include "app/compare/comparison.h"

namespace drape {

std::string compare_json(const Comparison& comparison);
std::string compare_csv(const Comparison& comparison);  // one row for each solver and system
// One row for each run; no rows without --integrators.
std::string integrators_csv(const Comparison& comparison);

class CompareFiles {
 public:
  // Makes the folder and tries to write into it; throws InputError.
  explicit CompareFiles(std::filesystem::path folder);
  void write(const Comparison& comparison);
  const std::vector<std::filesystem::path>& written() const { return written_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> written_;
};

}  // namespace drape
