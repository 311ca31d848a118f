// One linear system as files of the Matrix Market, which SciPy, Julia, MATLAB and most solvers read.
//   A, b, S, z                   S (A dv - b) = 0 and (I - S) dv = z
//   A-projected, b-projected     the system for y, which gives dv = S y + z
//   guess, dv                    the guess and the solution of the step
//   system.json         what each file is, and which system
//                                       [Boisvert, Pozo & Remington 1996, The Matrix Market exchange formats]
#pragma once

#include <filesystem>
#include <vector>

#include "app/base/atomic_file.h"
#include "app/base/json.h"
#include "app/compare/recording_solver.h"

namespace drape::app {

// Makes the folder and writes the files under other names; they appear when they are kept. `about` comes
// first in system.json. Throws InputError when something cannot be written.
std::vector<AtomicFile> write_system(const std::filesystem::path& folder, const LinearSystem& system,
                                     Json::Members about);

}  // namespace drape::app
