// The names of the files that belong to the run itself, and the names of the files of a sequence.
//   run.json, steps.csv, bodies.csv, NAME.obj, NAME.pc2, and all in bodies/, fields/ and frames/ belong to
//   the run. Nothing that is made from a run may replace them, or have a name that a reader takes for one of
//   them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace drape::app {

// True when the file would have such a name in the output folder `run`.
bool is_of_run(const std::filesystem::path& file, const std::filesystem::path& run);

// Throws InputError "out/run.json: is a name of the run's own files; ..." in that case. Whatever writes files
// made from a run calls it.
void spare_run(const std::filesystem::path& file, const std::filesystem::path& run);

// The file name "sheet_0007.ply" of the seventh in a sequence; numbers count from 1.
std::string numbered(std::string_view name, std::size_t number, std::string_view ending);

}  // namespace drape::app
