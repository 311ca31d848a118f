// The quadratic B-spline of a level set, and the answers in places that have no near brick.
//   phi(x) = sum_ijk w_i(s) w_j(t) w_k(u) c_ijk,  i, j, k in {-1, 0, 1} about the nearest node, s, t, u in
//   [-1/2, 1/2]: w = ((1/2 - s)^2 / 2, 3/4 - s^2, (1/2 + s)^2 / 2)
//   c = d - (sum of the six neighbours' d - 6 d) / 8,  d the distances at the nodes
// The spline is exact for quadratic functions. With c = d it would smooth, and be twice as far off
// (README.md).
#include "mesh/level_set/voxel_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace drape::internal {
namespace {

// Four floats of a row as doubles; the last of them is not used.
typedef double Four __attribute__((vector_size(32), aligned(8)));

inline Four load(const float* p) {
  typedef float FourFloats __attribute__((vector_size(16), aligned(4)));
  return __builtin_convertvector(*reinterpret_cast<const FourFloats*>(p), Four);
}

struct Weights {
  double w[3], d[3];  // weights of the value and of its slope
  explicit Weights(double t)
      : w{0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)},
        d{t - 0.5, -2 * t, t + 0.5} {}
};

struct Jet {
  double value;
  Vec3 gradient;  // per voxel
};

// The spline over 27 nodes; `corner` is the lowest of them.
Jet spline(const float* corner, const Weights& x, const Weights& y, const Weights& z) {
  Four value{}, along_x{}, along_y{};
  for (int i = 0; i < 3; ++i) {
    const float* const plane = corner + i * VoxelGrid::held * VoxelGrid::held;
    const Four a = load(plane), b = load(plane + VoxelGrid::held), c = load(plane + 2 * VoxelGrid::held);
    const Four sum = y.w[0] * a + y.w[1] * b + y.w[2] * c;
    value += x.w[i] * sum;
    along_x += x.d[i] * sum;
    along_y += x.w[i] * (y.d[0] * a + y.d[1] * b + y.d[2] * c);
  }
  const auto across = [](const Four& row, const double* w) {
    return row[0] * w[0] + row[1] * w[1] + row[2] * w[2];
  };
  return {across(value, z.w), {across(along_x, z.w), across(along_y, z.w), across(value, z.d)}};
}

Vec3 unit(const Vec3& gradient) {
  const double squared = gradient.squaredNorm();
  return squared > 1e-20 ? Vec3(gradient / std::sqrt(squared)) : Vec3(Vec3::UnitY());
}

// The spline over the centres of the cells; beyond the outermost cells their values are repeated.
Jet coarse(const VoxelGrid& grid, const Vec3& in_cells) {
  Index at;
  for (int k = 0; k < 3; ++k) at[k] = static_cast<int>(std::floor(in_cells[k]));
  const Weights x(in_cells[0] - at[0] - 0.5), y(in_cells[1] - at[1] - 0.5), z(in_cells[2] - at[2] - 0.5);
  Jet sum{0, Vec3::Zero()};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) {
        Index c{at[0] + i - 1, at[1] + j - 1, at[2] + k - 1};
        for (int m = 0; m < 3; ++m) c[m] = std::clamp(c[m], 0, grid.cells[m] - 1);
        const double d = grid.far[grid.cell_slot(c)];
        sum.value += x.w[i] * y.w[j] * z.w[k] * d;
        sum.gradient +=
            d * Vec3(x.d[i] * y.w[j] * z.w[k], x.w[i] * y.d[j] * z.w[k], x.w[i] * y.w[j] * z.d[k]);
      }
  return sum;
}

}  // namespace

Vec3 VoxelGrid::cell_centre(const Index& c) const {
  Vec3 centre;
  for (int k = 0; k < 3; ++k) centre[k] = voxel * (first[k] + c[k] * cell + 0.5 * (cell - 1));
  return centre;
}

std::int32_t VoxelGrid::brick_at(const Index& b) const {
  for (int k = 0; k < 3; ++k)
    if (b[k] < 0 || b[k] >= side(k)) return none;
  return bricks[brick_slot(b)];
}

Index VoxelGrid::node(const Index& b, const Index& i) const {
  Index at;
  for (int k = 0; k < 3; ++k) at[k] = first[k] + b[k] * brick + i[k];
  return at;
}

// The coefficients of a near brick and the distances that make them reach two nodes beyond it. So a node is
// needed only by its own brick and by those neighbours that lie on the node's side of the middle of its
// brick.
bool VoxelGrid::needed(const Index& b, const Index& i) const {
  for (int sides = 0; sides < 8; ++sides) {
    Index other = b;
    for (int k = 0; k < 3; ++k)
      if (sides >> k & 1) other[k] += i[k] < brick / 2 ? -1 : 1;
    const std::int32_t number = brick_at(other);
    if (number != none && number < near_count) return true;
  }
  return false;
}

std::vector<Index> VoxelGrid::places() const {
  std::vector<Index> all(static_cast<std::size_t>(brick_count));
  for (Index b{}; b[0] < side(0); ++b[0])
    for (b[1] = 0; b[1] < side(1); ++b[1])
      for (b[2] = 0; b[2] < side(2); ++b[2])
        if (const std::int32_t number = bricks[brick_slot(b)]; number != none) all[number] = b;
  return all;
}

SurfacePoint VoxelGrid::closest(const Vec3& x) const {
  const double per_node = 1 / voxel;
  const double p = x[0] * per_node - first[0] + 0.5, q = x[1] * per_node - first[1] + 0.5,
               r = x[2] * per_node - first[2] + 0.5;
  if (!(p >= 0 && q >= 0 && r >= 0 && p < cells[0] * cell && q < cells[1] * cell && r < cells[2] * cell))
    return far_away(x);
  const int i = static_cast<int>(p), j = static_cast<int>(q), k = static_cast<int>(r);
  const std::int32_t number = bricks[brick_slot({i / brick, j / brick, k / brick})];
  if (static_cast<std::uint32_t>(number) >= static_cast<std::uint32_t>(near_count)) return beyond(x);
  const int at = ((i % brick) * held + j % brick) * held + k % brick;  // of the lowest of the 27
  const float* const corner = &coefficients[static_cast<std::size_t>(number) * held_in_brick + at];
  const Jet jet = spline(corner, Weights(p - i - 0.5), Weights(q - j - 0.5), Weights(r - k - 0.5));
  // Beyond the band half a voxel is taken off, because the spline may be too high by that much.
  const double distance = jet.value > band ? std::max(band, jet.value - 0.5 * voxel) : jet.value;
  return {distance, unit(jet.gradient)};
}

Index VoxelGrid::cell_of(const Vec3& x) const {
  Index c;
  for (int k = 0; k < 3; ++k)
    c[k] = std::clamp(static_cast<int>((x[k] / voxel - first[k] + 0.5) / cell), 0, cells[k] - 1);
  return c;
}

// A lower bound outside the surface: the distance changes no faster than 1 per metre from the centre of the
// cell. The value at the centre is reduced a little to allow for rounding.
double VoxelGrid::bound(const Index& c, const Vec3& x) const {
  return std::max(far[cell_slot(c)] * (1 - 1e-6) - (x - cell_centre(c)).norm(), band);
}

// The answer within the grid, where there is no near brick.
SurfacePoint VoxelGrid::beyond(const Vec3& x) const {
  const Index c = cell_of(x);
  if (far[cell_slot(c)] < 0) {
    const Jet jet =
        coarse(*this, (x / voxel - Vec3(first[0], first[1], first[2]) + Vec3::Constant(0.5)) / cell);
    return {std::min(jet.value, -depth()), unit(jet.gradient)};
  }
  Vec3 rise;
  for (int k = 0; k < 3; ++k) {
    Index before = c, after = c;
    before[k] = std::max(c[k] - 1, 0), after[k] = std::min(c[k] + 1, cells[k] - 1);
    rise[k] = static_cast<double>(far[cell_slot(after)]) - far[cell_slot(before)];
  }
  return {bound(c, x), unit(rise)};
}

// The answer for a point x outside the box of the grid. Let y be the point of the box nearest to x: the
// surface lies within the box, so the angle at y is obtuse and phi(x)^2 >= |x - y|^2 + phi(y)^2. The normal
// points away from the surface's box.
SurfacePoint VoxelGrid::far_away(const Vec3& x) const {
  if (!x.allFinite()) return {std::numeric_limits<double>::quiet_NaN(), Vec3::UnitY()};
  Vec3 y;
  for (int k = 0; k < 3; ++k)
    y[k] = std::clamp(x[k], voxel * (first[k] - 0.5), voxel * (first[k] + cells[k] * cell - 0.5));
  const double d = bound(cell_of(y), y);
  return {std::sqrt((x - y).squaredNorm() + d * d), unit(x - x.cwiseMax(box.min()).cwiseMin(box.max()))};
}

}  // namespace drape::internal
