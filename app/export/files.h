// The files of one export: all of them appear, or none.
//   Written beside their names as they are made, renamed when the last one is complete.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/base/atomic_file.h"
#include "app/base/words.h"

namespace drape {

class ExportFiles {
 public:
  // The names of all files that will be written into the folder, which is made when it is not there. Throws
  // InputError "out/sheet.mdd: is there already; --force replaces it", or where two of them are the same.
  // `run` is the folder that is read: what the run itself wrote there is never replaced.
  ExportFiles(std::filesystem::path folder, const Names& names, bool force, const std::filesystem::path& run);
  ~ExportFiles();  // without keep(): the folder is as it was
  ExportFiles(const ExportFiles&) = delete;
  ExportFiles& operator=(const ExportFiles&) = delete;

  // To be filled before the next one is asked for, or the export kept.
  AtomicFile& open(const std::string& name);
  void write(const std::string& name, std::string_view bytes) { open(name).write(bytes); }

  // The sequence is complete with these many: further ones, of a longer sequence before, are to go.
  void end_sequence(const std::string& name, std::size_t count, const std::string& ending);

  void keep();  // where it throws, the folder is as it was, too

 private:
  void make_folder();
  void set_aside(const std::filesystem::path& path);
  void put_back(std::size_t kept);

  std::filesystem::path folder_, run_;
  std::set<std::string> names_;
  bool force_;
  std::vector<std::filesystem::path> made_;  // folders, the outermost first
  std::vector<AtomicFile> files_;
  std::vector<std::filesystem::path> stale_;
  std::vector<std::pair<std::filesystem::path, std::filesystem::path>>
      aside_;  // replaced ones: where they are
  bool kept_ = false;
};

}  // namespace drape
