#include "app/scene/level_set_cache.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <vector>

#include "app/base/atomic_file.h"
#include "mesh/base/errors.h"
#include "mesh/base/hash.h"

namespace drape::app {
namespace {

namespace fs = std::filesystem;

constexpr int version = 1;  // of what a kept file holds; another one for every change of it

void add_file(Fnv1a& hash, const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> block(1 << 16);
  do {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    hash.add(block.data(), static_cast<std::size_t>(file.gcount()));
  } while (file);
}

fs::path kept_path(const LevelSetRequest& request, const LevelSetOptions& options) {
  Fnv1a hash;
  hash.add(&version, sizeof version);
  hash.add_all(std::array{request.scale, options.voxel, options.band});
  add_file(hash, request.mesh);
  fs::path path = request.mesh;
  return path.replace_filename(request.mesh.stem().string() + "." + hash.text() + ".vdb");
}

void keep(const LevelSet& level_set, const fs::path& path, Names& messages) {
  try {
    AtomicFile file(path);
    file.write(level_set.vdb());
    file.keep();
  } catch (const InputError& error) {
    messages.push_back("note: the level set is made anew in every run, because it cannot be kept: " +
                       std::string(error.what()));
  }
}

std::string place(const Vec3& x) {
  return "(" + rounded(x[0], 3) + ", " + rounded(x[1], 3) + ", " + rounded(x[2], 3) + ")";
}

}  // namespace

LevelSet cached_level_set(const TriangleMesh& mesh, const LevelSetRequest& request, Names& messages) {
  LevelSetOptions options;
  options.voxel = request.voxel > 0 ? request.voxel : default_voxel(mesh);
  options.band = std::max(3 * options.voxel, request.margin + options.voxel);
  const std::string name = request.mesh.string();
  if (!has_openvdb()) return LevelSet::from_mesh(mesh, options, name);
  const fs::path path = kept_path(request, options);
  if (std::error_code ignored; fs::exists(path, ignored)) {
    try {
      return LevelSet::read(path);
    } catch (const InputError& error) {
      messages.push_back("note: the level set that was kept is made anew: " + std::string(error.what()));
    }
  }
  LevelSet made = LevelSet::from_mesh(mesh, options, name);
  if (request.keep) keep(made, path, messages);
  return made;
}

std::string described(const LevelSet& level_set) {
  const double h = level_set.voxel();
  std::string text = "voxels of " + rounded(1000 * h, 3) + " mm (" + std::to_string(level_set.voxels()) +
                     ", " + rounded(static_cast<double>(level_set.bytes()) / 1e6, 3) + " MB), ";
  const auto error = level_set.error();
  if (!error) return text + "error not known";
  return text + "off by at most " + rounded(error->largest / h, 2) + " voxels (" +
         rounded(1000 * error->largest, 2) + " mm), rms " + rounded(error->rms / h, 2);
}

void warn_of_error(const LevelSet& level_set, const std::string& name, Names& messages) {
  const auto error = level_set.error();
  if (!error) return;
  const double h = level_set.voxel();
  const std::string advice = "; choose a voxel of " + rounded(500 * h, 2) + " mm";
  if (error->largest > 0.5 * h)
    messages.push_back("warning: " + name + ": the level set is up to " + rounded(error->largest / h, 2) +
                       " voxels (" + rounded(1000 * error->largest, 2) + " mm) off the mesh, at " +
                       place(error->where) + advice);
  if (error->vanished > 0)
    messages.push_back((error->vanished < 0.01 ? "note: " : "warning: ") + name + ": " +
                       rounded(100 * error->vanished, 2) +
                       " % of the surface bounds parts thinner than two voxels, which vanish, such as at " +
                       place(error->vanished_where) + advice);
}

}  // namespace drape::app
