// Which files of an output folder are the run's own, and how those of a sequence are named.
//   run.json, steps.csv, bodies.csv, NAME.obj, NAME.pc2, and all in bodies/, fields/ and frames/: nothing
//   that is made of a run may take their places, or stand where a reader of the run would take it for one of
//   them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace drape {

bool is_of_run(const std::filesystem::path& file, const std::filesystem::path& run);

// Throws InputError "out/run.json: is a name of the run's own files; ...".
// For whatever is written beside them.
void spare_run(const std::filesystem::path& file, const std::filesystem::path& run);

// "sheet_0007.ply": the seventh of a sequence; they count from 1.
std::string numbered(std::string_view name, std::size_t number, std::string_view ending);

}  // namespace drape
