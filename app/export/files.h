// The files of one export: either all of them appear, or none.
//   Each file is written under another name; all are renamed when the last one is complete.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/base/atomic_file.h"
#include "app/base/words.h"

namespace drape::app {

class ExportFiles {
 public:
  // `names` are all the files that will be written into the folder. The folder is made when it is not there.
  // Throws InputError "out/sheet.mdd: is there already; --force replaces it", or when two names are equal.
  // `run` is the folder of a run that is read, if any: what the run itself wrote there is never replaced.
  ExportFiles(std::filesystem::path folder, const Names& names, bool force, const std::filesystem::path& run);
  // Leaves the folder as it was when keep() was not called.
  ~ExportFiles();
  ExportFiles(const ExportFiles&) = delete;
  ExportFiles& operator=(const ExportFiles&) = delete;

  // The file to write into. It must be filled before the next one is opened or keep() is called.
  AtomicFile& open(const std::string& name);
  void write(const std::string& name, std::string_view bytes) { open(name).write(bytes); }

  // Says that the sequence has this many files. Further files, of a longer sequence before, will be removed.
  void end_sequence(const std::string& name, std::size_t count, const std::string& ending);

  void keep();  // gives all files their names; when it throws, the folder is as it was

 private:
  void make_folder();
  void set_aside(const std::filesystem::path& path);
  void put_back(std::size_t kept);

  std::filesystem::path folder_, run_;
  std::set<std::string> names_;
  bool force_;
  std::vector<std::filesystem::path> made_;  // new folders, the outermost first
  std::vector<AtomicFile> files_;
  std::vector<std::filesystem::path> stale_;
  std::vector<std::pair<std::filesystem::path, std::filesystem::path>>
      aside_;  // replaced files: their paths, and where they are kept meanwhile
  bool kept_ = false;
};

}  // namespace drape::app
