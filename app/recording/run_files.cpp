#include "app/recording/run_files.h"

#include <cstdio>

#include "mesh/base/errors.h"

namespace drape::app {

namespace fs = std::filesystem;

// The folder may be named by other words or through a link; the file itself, if a link, is what is replaced.
bool is_of_run(const fs::path& file, const fs::path& run) {
  if (run.empty()) return false;
  const fs::path folder = fs::weakly_canonical(fs::absolute(file).parent_path()), name = file.filename();
  const fs::path root = fs::absolute(run);
  for (const char* below : {"bodies", "fields", "frames"})
    if (folder == fs::weakly_canonical(root / below)) return true;
  if (folder != fs::weakly_canonical(root / ".")) return false;
  const fs::path ending = name.extension();
  return name == "run.json" || name == "steps.csv" || name == "bodies.csv" || ending == ".obj" ||
         ending == ".pc2";
}

void spare_run(const fs::path& file, const fs::path& run) {
  if (is_of_run(file, run))
    throw InputError(file.string() +
                     ": is a name of the run's own files, which are not replaced; choose another place");
}

std::string numbered(std::string_view name, std::size_t number, std::string_view ending) {
  char digits[24];
  std::snprintf(digits, sizeof digits, "_%04zu", number);
  return std::string(name) + digits + std::string(ending);
}

}  // namespace drape::app
