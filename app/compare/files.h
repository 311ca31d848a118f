// Writes compare.json, compare.csv (solvers), compare-integrators.csv, compare.html and the systems that are
// saved: all of them or none.
#pragma once

#include <vector>

#include "app/base/atomic_file.h"
#include "app/compare/comparison.h"
#include "app/compare/recording_solver.h"

namespace drape::app {

std::string compare_json(const Comparison& comparison);
std::string compare_csv(const Comparison& comparison);  // one row for each solver and system
// One row for each run; no rows without --integrators.
std::string integrators_csv(const Comparison& comparison);

class CompareFiles {
 public:
  // Makes the folder, and the one for systems, and tries to write into them; throws InputError.
  explicit CompareFiles(std::filesystem::path folder, bool with_systems = false);
  // Saves the system of a step, with its place in the comparison, and returns the name of its folder in
  // systems/.
  std::string save(const LinearSystem& system, const Comparison& comparison, int step, double time);
  void write(const Comparison& comparison);
  const std::vector<std::filesystem::path>& written() const { return written_; }

 private:
  std::filesystem::path folder_;
  std::vector<AtomicFile> systems_;
  std::vector<std::filesystem::path> written_;
};

}  // namespace drape::app
