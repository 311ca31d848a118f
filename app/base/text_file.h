// A whole text file in memory.
#pragma once

#include <filesystem>
#include <string>

namespace drape {

// `kind` stands in messages: "TOML". Throws InputError "FILE: no such file" when it is missing, a directory,
// empty, binary or cannot be read.
std::string read_text(const std::filesystem::path& path, const std::string& kind);

}  // namespace drape
