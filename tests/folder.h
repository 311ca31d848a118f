// A folder of its own for a test, what is in its files, and the program run there.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/places.h"

namespace drape::test {

inline std::string content(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// How a command ended (-1: by a signal) and what it said.
struct Outcome {
  int exit_code;
  std::string out, err;
};

// Empty at first, gone with everything in it at the end.
struct Folder {
  std::filesystem::path path;

  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "drape-test-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder " + name);
    path = name;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }

  std::set<std::string> files(const std::string& below = ".") const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path / below))
      names.insert(entry.path().filename().string());
    return names;
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name, std::ios::binary) << text;
  }

  // A line of the shell in this folder; leaves nothing of its own there.
  Outcome shell(const std::string& line) const {
    const std::string out = (path / ".out").string(), err = (path / ".err").string();
    const int status =
        std::system(("cd '" + path.string() + "' && { " + line + "; } >.out 2>.err </dev/null").c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(err)};
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return outcome;
  }

  // `drape WORDS`; before: shell words in front of the program.
  Outcome drape(const std::string& words, const std::string& before = "") const {
    return shell(before + " '" + program() + "' " + words);
  }
};

}  // namespace drape::test
