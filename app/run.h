// Runs a simulation from its start to its end: steps, frames, messages, output files.
#pragma once

#include "app/output.h"

namespace drape {

struct RunOptions {
  std::filesystem::path out;
  Frames frames = Frames::pc2;
  bool quiet = false;
};

// Exit code: 0 done, 1 the computation failed, 130 interrupted. Throws InputError.
int run(const Scene& scene, const RunOptions& options);

}  // namespace drape
