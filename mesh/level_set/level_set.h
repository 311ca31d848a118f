// Signed distance to a closed surface, from a grid made once: quicker to ask than the triangles, and as
// smooth.
//   phi(x)  quadratic B-spline fitted to the distances at the nodes of a regular grid (spacing `voxel`): C1
//   n(x)    its gradient, normalised; |grad phi| is within a few percent of 1 away from creases
// Nodes within `band` outside the surface and 10 voxels inside hold the exact distance, in float
// (mesh/distance/surface_distance.h). Beyond them:
//   outside  a lower bound of the distance that is at least `band`
//   inside   a coarser spline, with nodes every 8 voxels: good to some voxels, and a way out
// Errors, with h the voxel: third order in h where the surface is smooth, about h / 8 at edges; what is
// thinner than h to 2 h has no inside any more.
//
// Files are OpenVDB's (.vdb); without OpenVDB they are refused, grids of meshes are not.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "mesh/distance/surface_distance.h"

namespace drape {

struct VoxelGrid;  // mesh/level_set/voxel_grid.h, internal

// How far the grid is from the mesh it was made of, at sample points in the band (a fixed set).
struct LevelSetError {
  double largest = 0, rms = 0;  // m
  Vec3 where = Vec3::Zero();    // of the largest
  double vanished = 0;          // share of the surface that bounds parts too thin for the grid
  Vec3 vanished_where = Vec3::Zero();
};

struct LevelSetOptions {
  double voxel = 0;  // m; 0: default_voxel(mesh)
  double band = 0;   // m, at least 3 voxels
};

class LevelSet {
 public:
  // Throws InputError when the mesh is not closed (with its holes), its size is none of a body, or the grid
  // would be too large or so coarse that nothing is left. `name` stands in messages.
  static LevelSet from_mesh(const TriangleMesh& mesh, const LevelSetOptions& options = {},
                            const std::string& name = "the mesh");

  // A file of ours, or any level set of uniform voxels (float; the first such grid). What a file does not
  // hold is made from its zero surface. All lengths are multiplied by `scale`. Throws InputError.
  static LevelSet read(const std::filesystem::path& path, double scale = 1);
  // What a .vdb file of it holds; not of a moved one. Throws InputError without OpenVDB.
  std::string vdb() const;

  // x -> rotation x + translate: the same grid at another place.
  LevelSet moved(const Mat3& rotation, const Vec3& translate) const;

  SurfacePoint closest(const Vec3& x) const;  // safe to call from several threads; NaN where x is not finite

  double voxel() const;
  double band() const;
  Vec3 lower() const, upper() const;           // m, box of the surface, before it was moved
  long voxels() const;                         // nodes near the surface
  std::size_t bytes() const;                   // of memory
  std::optional<LevelSetError> error() const;  // unknown for a file of somebody else's

 private:
  explicit LevelSet(std::shared_ptr<const VoxelGrid> grid) : grid_(std::move(grid)) {}

  std::shared_ptr<const VoxelGrid> grid_;
  Mat3 rotation_ = Mat3::Identity();
  Vec3 translate_ = Vec3::Zero();
};

bool has_openvdb();  // whether this build reads and writes .vdb files

// Of a body, the longest side of its box [m]: what lies outside is a wrong unit, and too much for floats.
inline constexpr double least_size = 1e-6, largest_size = 1e6;
// Throws InputError unless the body with this box is of such a size.
void check_size(const Eigen::AlignedBox3d& box, const std::string& name);

// Three quarters of the median edge, between 1/500 and 1/100 of the size (the box's diagonal). [m]
double default_voxel(const TriangleMesh& mesh);

}  // namespace drape
