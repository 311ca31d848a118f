// `drape stability`: the largest stable step of each integrator in a scene, beside what theory says of it.
#pragma once

#include "app/run/common_options.h"
#include "app/stability/search.h"

namespace drape {

// As the command line gives them; empty: not given.
struct StabilityWords {
  std::string time, integrators, shake, growth, precision, longest, shortest;
};

// Exit code: 0 done; 130 interrupted, and nothing is written. Throws InputError.
int stability(const std::filesystem::path& scene, const StabilityWords& words, const CommonOptions& common);

struct StabilityTable {
  std::string scene;
  StabilityOptions options;
  Spectrum spectrum;
  std::vector<StabilityRow> rows;
};

std::string stability_text(const StabilityTable& table);  // for people
std::string stability_json(const StabilityTable& table);
std::string stability_csv(const StabilityTable& table);

}  // namespace drape
