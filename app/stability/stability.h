// `drape stability`: the largest stable step of each integrator in a scene, beside the limit in theory.
#pragma once

#include "app/run/common_options.h"
#include "app/stability/search.h"

namespace drape::app {

// As on the command line; empty when not given.
struct StabilityWords {
  std::string time, integrators, shake, growth, precision, longest, shortest;
};

// Returns the exit code: 0 done; 130 interrupted, with nothing written. Throws InputError.
int stability(const std::filesystem::path& scene, const StabilityWords& words, const CommonOptions& common);

struct StabilityTable {
  std::string scene;
  StabilityOptions options;
  Spectrum spectrum;
  std::vector<StabilityRow> rows;
};

std::string stability_text(const StabilityTable& table);  // for people to read
std::string stability_json(const StabilityTable& table);
std::string stability_csv(const StabilityTable& table);

}  // namespace drape::app
