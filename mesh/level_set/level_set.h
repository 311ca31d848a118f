// Signed distance to a closed surface, kept on a grid that is made once: faster to evaluate than the distance
// to the triangles, and smooth.
//   phi(x)  quadratic B-spline fitted to the distances at the nodes of a regular grid (spacing `voxel`): C1
//   n(x)    its gradient, normalised; |grad phi| is within a few percent of 1 away from creases
// Near the surface (outside up to `band`, inside up to the greater of `band` and 10 voxels) the nodes hold
// the exact distance (mesh/distance/surface_distance.h), rounded to float. Farther away:
//   outside  the answer is a lower bound of the distance, and at least `band`
//   inside   the answer is a coarser spline with nodes every 8 voxels: accurate to some voxels, and its
//            gradient leads out
// Errors, with h the voxel: of third order in h where the surface is smooth, about h / 8 at edges. A part of
// the body that is thinner than h to 2 h has no inside in the grid.
//
// Level sets are kept in OpenVDB files (.vdb). A build without OpenVDB refuses such files, but still makes
// grids from meshes.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "mesh/distance/surface_distance.h"

namespace drape {

namespace internal {
struct VoxelGrid;  // mesh/level_set/voxel_grid.h
}

// How far the grid is from the mesh it was made of, measured at a fixed set of sample points in the band.
struct LevelSetError {
  double largest = 0, rms = 0;         // m
  Vec3 where = Vec3::Zero();           // the sample point with the largest error, m
  double vanished = 0;                 // fraction of the surface that bounds parts too thin for the grid
  Vec3 vanished_where = Vec3::Zero();  // one point of that fraction, m
};

struct LevelSetOptions {
  double voxel = 0;  // m; 0 stands for default_voxel(mesh)
  double band = 0;   // m; 3 voxels when it is less
};

class LevelSet {
 public:
  // Throws InputError when the mesh is not closed (the message lists its holes), when its size is not between
  // least_size and largest_size, or when the grid would be too large or so coarse that nothing of the body is
  // left. `name` stands in the messages.
  static LevelSet from_mesh(const TriangleMesh& mesh, const LevelSetOptions& options = {},
                            const std::string& name = "the mesh");

  // Reads a file that vdb() made, or the first level set of floats with cubic voxels in any other .vdb file.
  // What such a file does not hold is computed from its zero surface. All lengths are multiplied by `scale`.
  // Throws InputError.
  static LevelSet read(const std::filesystem::path& path, double scale = 1);
  // The bytes of a .vdb file of this level set, which must not have been moved. Throws InputError when the
  // build has no OpenVDB.
  std::string vdb() const;

  // The same grid at another place: x -> rotation x + translate, translate in m.
  LevelSet moved(const Mat3& rotation, const Vec3& translate) const;

  // May be called from several threads at once. The distance is NaN when x is not finite.
  SurfacePoint closest(const Vec3& x) const;

  double voxel() const;               // m
  double band() const;                // m
  Vec3 lower() const, upper() const;  // m, box of the surface before it was moved
  // The place of a point of the grid after the surface was moved [m].
  Vec3 to_world(const Vec3& x) const { return rotation_ * x + translate_; }
  long voxels() const;                         // number of nodes near the surface
  std::size_t bytes() const;                   // memory of the grid
  std::optional<LevelSetError> error() const;  // none for a .vdb file of another program

 private:
  explicit LevelSet(std::shared_ptr<const internal::VoxelGrid> grid) : grid_(std::move(grid)) {}

  std::shared_ptr<const internal::VoxelGrid> grid_;
  Mat3 rotation_ = Mat3::Identity();
  Vec3 translate_ = Vec3::Zero();
};

bool has_openvdb();  // whether this build reads and writes .vdb files

// The longest side of a body's box [m] must lie between these two. Other sizes come from a wrong unit, and
// are beyond what floats can hold accurately.
inline constexpr double least_size = 1e-6, largest_size = 1e6;
// Throws InputError unless the longest side of this box lies between those two; `name` stands in the message.
void check_size(const Eigen::AlignedBox3d& box, const std::string& name);

// Three quarters of the median edge, but at least 1/500 and at most 1/100 of the diagonal of the body's box
// [m].
double default_voxel(const TriangleMesh& mesh);

}  // namespace drape
