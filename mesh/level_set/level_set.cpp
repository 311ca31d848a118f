#include "mesh/level_set/level_set.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "mesh/base/errors.h"
#include "mesh/level_set/vdb_file.h"
#include "mesh/level_set/voxel_grid.h"
#include "mesh/obj/examine.h"
#include "mesh/triangles/extent.h"
#include "mesh/triangles/topology.h"

namespace drape {

using namespace internal;

namespace {

constexpr double least_band = 3;  // voxels

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", std::abs(value) < 1e-5 ? 0.0 : value);
  return text;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string described(const Hole& hole) {
  std::string text = std::to_string(hole.edges) + " edges, " + short_number(hole.circumference) +
                     " m round, " + short_number(hole.width) + " m across, about (";
  for (int k = 0; k < 3; ++k) text += (k ? ", " : "") + short_number(hole.centre[k]);
  return text + ")";
}

[[noreturn]] void refuse_open(const TriangleMesh& mesh, const std::string& name) {
  constexpr std::size_t shown = 3;
  const std::vector<Hole> all = holes(mesh);
  std::string text = name + ": a level set needs a closed body, and this one ";
  if (all.empty())
    throw InputError(
        text +
        "has edges with more than two triangles, or one side only; repair it in your modeller (make "
        "it manifold), or use shape = \"mesh\"");
  text += all.size() == 1 ? "has a hole: " : "has " + std::to_string(all.size()) + " holes, the largest: ";
  for (std::size_t k = 0; k < std::min(shown, all.size()); ++k) text += (k ? "; " : "") + described(all[k]);
  throw InputError(text + (all.size() == 1 ? "; close it" : "; close them") +
                   " in your modeller, or use shape = \"mesh\", which takes it as a thick surface");
}

[[noreturn]] void refuse_voxel(double voxel, const Vec3& size) {
  std::string sides = number(size[0]) + " x " + number(size[1]) + " x " + number(size[2]) + " m";
  throw InputError("a voxel of " + number(voxel) + " m is too coarse for a body of " + sides +
                   ": nothing of it would be left; choose one of at most a quarter of its thickness");
}

}  // namespace

void check_size(const Eigen::AlignedBox3d& box, const std::string& name) {
  const double size = box.sizes().maxCoeff();
  if (size >= least_size && size <= largest_size) return;
  throw InputError(name + ": the body is " + number(size) + " m long; a level set is made of " +
                   number(least_size) + " m to " + number(largest_size) + " m: change the scale");
}

double default_voxel(const TriangleMesh& mesh) {
  const MeshReport report = examine(mesh);
  const double size = report.box().diagonal().norm();
  return std::clamp(0.75 * report.median_edge, size / 500, size / 100);
}

LevelSet LevelSet::from_mesh(const TriangleMesh& mesh, const LevelSetOptions& options,
                             const std::string& name) {
  const SurfaceDistance surface(mesh);
  if (!surface.closed()) refuse_open(mesh, name);
  const Eigen::AlignedBox3d box = box_of(mesh.positions, mesh.triangles);
  check_size(box, name);
  const double voxel = options.voxel > 0 ? options.voxel : default_voxel(mesh);
  const double band = std::max(options.band, least_band * voxel);
  try {
    if (!(voxel < box.sizes().maxCoeff())) refuse_voxel(voxel, box.sizes());
    auto grid = std::make_shared<VoxelGrid>(empty_grid(voxel, band, box));
    find_near_bricks(*grid, [&](const Vec3& x) { return surface.closest(x).distance; });
    fill_bricks(*grid,
                [&](const Index& i) { return surface.closest(voxel * Vec3(i[0], i[1], i[2])).distance; });
    grid->error = measure_error(*grid, surface);
    if (grid->error->vanished >= 1) refuse_voxel(voxel, box.sizes());
    return LevelSet(std::move(grid));
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  }
}

LevelSet LevelSet::read(const std::filesystem::path& path, double scale) {
  VdbFile file = read_vdb(path, scale);
  check_size(file.grid.box, path.string());
  return LevelSet(std::make_shared<const VoxelGrid>(std::move(file.grid)))
      .moved(Mat3::Identity(), file.origin);
}

std::string LevelSet::vdb() const {
  if (!rotation_.isIdentity(0) || !translate_.isZero(0))
    throw std::logic_error("a level set is written where it was made");
  return format_vdb(*grid_);
}

LevelSet LevelSet::moved(const Mat3& rotation, const Vec3& translate) const {
  LevelSet other = *this;
  other.rotation_ = rotation * rotation_;
  other.translate_ = rotation * translate_ + translate;
  return other;
}

SurfacePoint LevelSet::closest(const Vec3& x) const {
  const SurfacePoint there = grid_->closest(rotation_.transpose() * (x - translate_));
  return {there.distance, rotation_ * there.normal};
}

double LevelSet::voxel() const { return grid_->voxel; }
double LevelSet::band() const { return grid_->band; }
Vec3 LevelSet::lower() const { return grid_->box.min(); }
Vec3 LevelSet::upper() const { return grid_->box.max(); }
std::optional<LevelSetError> LevelSet::error() const { return grid_->error; }

long LevelSet::voxels() const { return static_cast<long>(grid_->near_count) * VoxelGrid::in_brick; }

std::size_t LevelSet::bytes() const {
  const VoxelGrid& g = *grid_;
  return sizeof g + g.bricks.size() * sizeof(std::int32_t) +
         (g.far.size() + g.nodes.size() + g.coefficients.size()) * sizeof(float);
}

bool has_openvdb() { return reads_openvdb(); }

}  // namespace drape
