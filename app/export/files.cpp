#include "app/export/files.h"

#include <unistd.h>

#include "app/recording/run_files.h"
#include "mesh/base/errors.h"

namespace drape::app {

namespace fs = std::filesystem;

ExportFiles::ExportFiles(fs::path folder, const Names& names, bool force, const fs::path& run)
    : folder_(std::move(folder)), run_(run), force_(force) {
  std::error_code error;
  if (fs::exists(folder_, error) && !fs::is_directory(folder_, error))
    throw InputError(folder_.string() + ": is a file; a folder is needed");
  for (const std::string& name : names) {
    const fs::path path = folder_ / name;
    if (!names_.insert(name).second)
      throw InputError(
          path.string() +
          ": two files of this export would have this name, since a shape of the run has the name "
          "of another's frames; rename one of them in the scene, or export to gltf or usda");
    spare_run(path, run_);
    if (!fs::exists(fs::symlink_status(path, error))) continue;
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
    const std::string file = numbered(name, number, ending);
    const fs::path path = folder_ / file;
    if (names_.contains(file) || !fs::is_regular_file(path) || is_of_run(path, run_)) return;
    stale_.push_back(path);
  }
}

// A link is no copy and is gone in a moment; where there are none, the file itself goes.
void ExportFiles::set_aside(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(path, error)) || fs::is_directory(path, error)) return;
  fs::path beside = path;
  beside.replace_filename("." + path.filename().string() + "." + std::to_string(getpid()) + ".old");
  fs::create_hard_link(path, beside, error);
  if (error) fs::rename(path, beside, error);
  if (error) throw InputError(path.string() + ": cannot be replaced: " + error.message());
  aside_.emplace_back(path, beside);
}

void ExportFiles::put_back(std::size_t kept) {
  std::error_code ignored;
  for (std::size_t k = 0; k < kept; ++k) fs::remove(files_[k].path(), ignored);
  for (const auto& [path, beside] : aside_) {
    fs::rename(beside, path, ignored);
    fs::remove(beside, ignored);  // renaming a link onto its own file does nothing
  }
  aside_.clear();
}

void ExportFiles::keep() {
  if (!files_.empty()) files_.back().close();
  std::size_t kept = 0;
  try {
    for (AtomicFile& file : files_) {
      set_aside(file.path());
      file.keep();
      ++kept;
    }
  } catch (const InputError&) {
    put_back(kept);
    throw;
  }
  std::error_code ignored;
  for (const auto& [path, beside] : aside_) fs::remove(beside, ignored);
  if (force_)
    for (const fs::path& path : stale_) fs::remove(path, ignored);
  kept_ = true;
}

}  // namespace drape::app
