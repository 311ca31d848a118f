// The grid of a level set: sparse bricks of distances near the surface, and a coarse lattice everywhere.
//   node i       stands at voxel * i
//   brick        4 x 4 x 4 nodes
//   cell         2 x 2 x 2 bricks; `far` is the signed distance at its centre
//   near brick   a brick in which a point may be within `band` of the surface, or less than depth() inside.
//                It has the coefficients of its spline, and one layer more on every side, so that the 27
//                coefficients that a point needs lie in one place
//   other brick  is held only where its distances make a coefficient of a near brick
// In all arrays z runs fastest.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "mesh/level_set/level_set.h"

namespace drape::internal {

using Index = std::array<int, 3>;

struct VoxelGrid {
  static constexpr int brick = 4, in_brick = brick * brick * brick;
  static constexpr int held = brick + 2, held_in_brick = held * held * held;
  static constexpr int cell = 2 * brick;
  static constexpr std::int32_t none = -1;

  double voxel = 0, band = 0;  // m
  Eigen::AlignedBox3d box;     // m, of the surface
  Index first{};               // the node at the lower corner
  Index cells{};
  std::vector<float> far;            // m, for every cell
  std::vector<std::int32_t> bricks;  // the number of each brick, or none; near bricks come first
  int near_count = 0, brick_count = 0;
  std::vector<float> nodes;  // m, distances, in_brick for each brick; 0 if not needed
  // Spline coefficients [m], held_in_brick for each near brick, and a few more at the end, so that four
  // numbers can be read at once anywhere.
  std::vector<float> coefficients;
  std::optional<LevelSetError> error;

  double depth() const { return std::max(band, 10 * voxel); }  // m
  int side(int k) const { return cells[k] * cell / brick; }    // bricks along an axis
  std::size_t brick_slot(const Index& b) const {
    return (static_cast<std::size_t>(b[0]) * side(1) + b[1]) * side(2) + b[2];
  }
  std::size_t cell_slot(const Index& c) const {
    return (static_cast<std::size_t>(c[0]) * cells[1] + c[1]) * cells[2] + c[2];
  }
  std::int32_t brick_at(const Index& b) const;  // none also for bricks beyond the grid
  Vec3 cell_centre(const Index& c) const;
  Index node(const Index& b, const Index& i) const;   // i counts from 0 within the brick
  bool needed(const Index& b, const Index& i) const;  // whether the node's distance makes a coefficient
  // The places of the bricks that are held, in the order of their numbers.
  std::vector<Index> places() const;

  Index cell_of(const Vec3& x) const;
  double bound(const Index& cell_there, const Vec3& x) const;
  SurfacePoint closest(const Vec3& x) const;
  SurfacePoint beyond(const Vec3& x) const;
  SurfacePoint far_away(const Vec3& x) const;
};

using Distance = std::function<double(const Vec3&)>;       // signed [m]
using NodeDistance = std::function<double(const Index&)>;  // of a node [m]

// An empty grid about a surface. Throws InputError when it would be too large.
VoxelGrid empty_grid(double voxel, double band, const Eigen::AlignedBox3d& box);
// Fills `far` and marks the near bricks (with 0).
void find_near_bricks(VoxelGrid& grid, const Distance& distance);
// Numbers the bricks and fills them, in parallel.
void fill_bricks(VoxelGrid& grid, const NodeDistance& distance);

LevelSetError measure_error(const VoxelGrid& grid, const SurfaceDistance& surface);

}  // namespace drape::internal
