#include "app/export/files.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "mesh/obj.h"

namespace drape {
namespace {

namespace fs = std::filesystem;

// A run's own folder holds OBJ, CSV, JSON and caches that exports may not take the place of.
bool is_of_the_run(const fs::path& file, const fs::path& run) {
  const fs::path name = fs::weakly_canonical(file), folder = fs::weakly_canonical(run);
  const std::string ending = name.extension().string();
  const bool kind = ending == ".obj" || ending == ".csv";
  return kind && (name.parent_path() == folder ||
                  (name.parent_path().parent_path() == folder &&
                   (name.parent_path().filename() == "bodies" || name.parent_path().filename() == "frames")));
}

}  // namespace

std::string sequence_name(const std::string& name, std::size_t number, const std::string& ending) {
  char digits[24];
  std::snprintf(digits, sizeof digits, "_%04zu", number);
  return name + digits + ending;
}

ExportFiles::ExportFiles(fs::path folder, const Names& names, bool force, const fs::path& run)
    : folder_(std::move(folder)), run_(run), force_(force) {
  std::error_code error;
  if (fs::exists(folder_, error) && !fs::is_directory(folder_, error))
    throw InputError(folder_.string() + ": is a file; -o names a folder");
  for (const std::string& name : names) {
    const fs::path path = folder_ / name;
    if (!fs::exists(fs::symlink_status(path, error))) continue;
    if (is_of_the_run(path, run_))
      throw InputError(path.string() + ": is a file of the run itself; name another folder with -o");
    if (!force_) throw InputError(path.string() + ": is there already; --force replaces it");
    if (fs::is_directory(path, error)) throw InputError(path.string() + ": is a folder; remove it first");
  }
  make_folder();
}

void ExportFiles::make_folder() {
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path path = fs::absolute(folder_).lexically_normal(); !fs::exists(path, error);
       path = path.parent_path())
    if (path.has_filename()) missing.push_back(path);
  for (auto path = missing.rbegin(); path != missing.rend(); ++path) {
    if (!fs::create_directory(*path, error) && error) {
      for (auto made = made_.rbegin(); made != made_.rend(); ++made) fs::remove(*made);
      throw InputError(folder_.string() + ": cannot be made: " + error.message());
    }
    made_.push_back(*path);
  }
}

ExportFiles::~ExportFiles() {
  if (kept_) return;
  files_.clear();
  std::error_code ignored;  // a folder that somebody else has put something into stays
  for (auto path = made_.rbegin(); path != made_.rend(); ++path) fs::remove(*path, ignored);
}

AtomicFile& ExportFiles::open(const std::string& name) {
  if (!files_.empty()) files_.back().close();
  files_.emplace_back(folder_ / name);
  return files_.back();
}

void ExportFiles::end_sequence(const std::string& name, std::size_t count, const std::string& ending) {
  for (std::size_t number = count + 1;; ++number) {
    const fs::path path = folder_ / sequence_name(name, number, ending);
    if (!fs::is_regular_file(path) || is_of_the_run(path, run_)) return;
    stale_.push_back(path);
  }
}

void ExportFiles::keep() {
  if (!files_.empty()) files_.back().close();
  for (AtomicFile& file : files_) file.keep();
  std::error_code ignored;
  if (force_)
    for (const fs::path& path : stale_) fs::remove(path, ignored);
  kept_ = true;
}

}  // namespace drape
