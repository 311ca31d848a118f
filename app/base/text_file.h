// Reads a whole text file into memory.
#pragma once

#include <filesystem>
#include <string>

namespace drape::app {

// Throws InputError "FILE: no such file" and the like when the file is missing, a directory, empty, binary,
// or cannot be read. `kind` stands in messages: "TOML".
std::string read_text(const std::filesystem::path& path, const std::string& kind);

// The extension of a name in lower case, such as ".obj".
std::string lower_extension(const std::filesystem::path& path);

}  // namespace drape::app
