// The files of one export: all of them appear, or none.
//   Written beside their names as they are made, renamed when the last one is complete.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/atomic_file.h"
#include "app/words.h"

namespace drape {

// "sheet_0007.ply": the seventh of a sequence.
std::string sequence_name(const std::string& name, std::size_t number, const std::string& ending);

class ExportFiles {
 public:
  // The names of all files that will be written into the folder, which is made when it is not there. Throws
  // InputError "out/sheet.mdd: is there already; --force replaces it". `run` is the folder that is read:
  // what the run itself wrote there is never replaced.
  ExportFiles(std::filesystem::path folder, const Names& names, bool force, const std::filesystem::path& run);
  ~ExportFiles();  // without keep(): the folder is as it was
  ExportFiles(const ExportFiles&) = delete;
  ExportFiles& operator=(const ExportFiles&) = delete;

  // To be filled before the next one is asked for, or the export kept.
  AtomicFile& open(const std::string& name);
  void write(const std::string& name, std::string_view bytes) { open(name).write(bytes); }

  // The sequence is complete with these many: further ones, of a longer sequence before, are to go.
  void end_sequence(const std::string& name, std::size_t count, const std::string& ending);

  void keep();

 private:
  void make_folder();

  std::filesystem::path folder_, run_;
  bool force_;
  std::vector<std::filesystem::path> made_;  // folders, the outermost first
  std::vector<AtomicFile> files_;
  std::vector<std::filesystem::path> stale_;
  bool kept_ = false;
};

}  // namespace drape
