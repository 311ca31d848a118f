// Makes the grid of a level set, and measures how far it is from the mesh.
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "mesh/base/errors.h"
#include "mesh/base/parallel.h"
#include "mesh/level_set/voxel_grid.h"
#include "mesh/triangles/topology.h"

namespace drape::internal {
namespace {

constexpr double half_diagonal = 0.8660254037844386;  // of a cube of side 1
constexpr double most_cells = 2e7, most_bricks = 4e6;
constexpr double float_error = 1e-6;  // relative, of distances held as floats

std::string metres(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g m", value);
  return text;
}

[[noreturn]] void too_large(double voxel, double factor) {
  throw InputError("a voxel of " + metres(voxel) + " makes too large a grid; choose one of at least " +
                   metres(voxel * factor));
}

// Calls f(c) for every triple c of numbers from 0, each below its entry of `sides`, slices of the first
// number in parallel.
template <class F>
void for_triples(const Index& sides, const F& f) {
  parallel_for(sides[0], false, [&](int i) {
    for (int j = 0; j < sides[1]; ++j)
      for (int k = 0; k < sides[2]; ++k) f(Index{i, j, k});
  });
}

// Calls f(b) for every b in [0, count), in parts that the threads take one at a time.
template <class F>
void for_bricks(int count, const F& f) {
  constexpr int together = 16;
  parallel_for((count + together - 1) / together, false, [&](int part) {
    for (int b = part * together; b < std::min(count, (part + 1) * together); ++b) f(b);
  });
}

}  // namespace

VoxelGrid empty_grid(double voxel, double band, const Eigen::AlignedBox3d& box) {
  VoxelGrid grid;
  grid.voxel = voxel;
  grid.band = band;
  grid.box = box;
  double count = 1;
  for (int k = 0; k < 3; ++k) {
    const double reach =
        band + (2 * VoxelGrid::brick + VoxelGrid::brick) * voxel;  // near bricks, and one cell beyond them
    const double low = std::floor((box.min()[k] - reach) / (voxel * VoxelGrid::cell)),
                 high = std::ceil((box.max()[k] + reach) / (voxel * VoxelGrid::cell));
    count *= high - low;
    if (!(std::abs(low) < 1e8 && std::abs(high) < 1e8 && count < 1e15)) too_large(voxel, 100);
    grid.first[k] = static_cast<int>(low) * VoxelGrid::cell;
    grid.cells[k] = static_cast<int>(high - low);
  }
  if (count > most_cells) too_large(voxel, std::cbrt(count / most_cells) * 1.05);
  return grid;
}

void find_near_bricks(VoxelGrid& grid, const Distance& distance) {
  constexpr int n = VoxelGrid::brick;
  grid.far.resize(grid.cell_slot({grid.cells[0] - 1, grid.cells[1] - 1, grid.cells[2] - 1}) + 1);
  for_triples(grid.cells, [&](const Index& c) {
    grid.far[grid.cell_slot(c)] = static_cast<float>(distance(grid.cell_centre(c)));
  });
  const double half_brick = n * half_diagonal * grid.voxel;
  const auto within = [&](double d, double further) {
    return std::abs(d) <= ((d < 0 ? grid.depth() : grid.band) + further) * (1 + float_error);
  };
  grid.bricks.assign(grid.far.size() * 8, VoxelGrid::none);
  for_triples({grid.side(0), grid.side(1), grid.side(2)}, [&](const Index& b) {
    const double at_cell = grid.far[grid.cell_slot({b[0] / 2, b[1] / 2, b[2] / 2})];
    if (!within(at_cell, 2 * half_brick)) return;  // the centres of its bricks are half a brick away
    Vec3 centre;
    for (int k = 0; k < 3; ++k) centre[k] = grid.voxel * (grid.first[k] + b[k] * n + 0.5 * (n - 1));
    if (within(distance(centre), half_brick)) grid.bricks[grid.brick_slot(b)] = 0;
  });
}

namespace {

// Numbers the near bricks first and their neighbours after them.
void number_bricks(VoxelGrid& grid) {
  grid.near_count = 0;
  for (std::int32_t& number : grid.bricks)
    if (number != VoxelGrid::none) number = grid.near_count++;
  if (grid.near_count > most_bricks) too_large(grid.voxel, std::sqrt(grid.near_count / most_bricks) * 1.05);
  grid.brick_count = grid.near_count;
  for (const Index& b : grid.places())
    for (int neighbour = 0; neighbour < 27; ++neighbour) {
      const Index other{b[0] + neighbour / 9 - 1, b[1] + neighbour / 3 % 3 - 1, b[2] + neighbour % 3 - 1};
      bool there = true;
      for (int k = 0; k < 3; ++k) there = there && other[k] >= 0 && other[k] < grid.side(k);
      if (!there) throw std::logic_error("a near brick at the border of its grid");
      std::int32_t& number = grid.bricks[grid.brick_slot(other)];
      if (number == VoxelGrid::none) number = grid.brick_count++;
    }
}

// Calls f(i, slot) for every triple i of numbers in [0, n).
template <class F>
void for_cube(int n, const F& f) {
  std::size_t slot = 0;
  for (Index i{}; i[0] < n; ++i[0])
    for (i[1] = 0; i[1] < n; ++i[1])
      for (i[2] = 0; i[2] < n; ++i[2]) f(i, slot++);
}

// The distances of a near brick are needed with two further nodes on every side.
constexpr int around = VoxelGrid::brick + 4;
using Around = std::array<float, around * around * around>;

void gather(const VoxelGrid& grid, const Index& b, Around& d) {
  constexpr int n = VoxelGrid::brick;
  std::array<const float*, 27> bricks;
  for_cube(3, [&](const Index& to, std::size_t slot) {
    const std::int32_t number = grid.brick_at({b[0] + to[0] - 1, b[1] + to[1] - 1, b[2] + to[2] - 1});
    bricks[slot] = &grid.nodes[static_cast<std::size_t>(number) * VoxelGrid::in_brick];
  });
  for_cube(around, [&](const Index& i, std::size_t slot) {
    int brick = 0, node = 0;
    for (int k = 0; k < 3; ++k) {
      brick = brick * 3 + (i[k] + n - 2) / n;
      node = node * n + (i[k] + n - 2) % n;
    }
    d[slot] = bricks[brick][node];
  });
}

float coefficient(const Around& d, const Index& i) {
  const std::size_t at = (i[0] * around + i[1]) * around + i[2];
  double excess = -6.0 * d[at];
  for (const std::size_t step : {around * around, around, 1})
    excess += static_cast<double>(d[at - step]) + d[at + step];
  return static_cast<float>(d[at] - excess / 8);
}

}  // namespace

void fill_bricks(VoxelGrid& grid, const NodeDistance& distance) {
  constexpr int n = VoxelGrid::brick;
  number_bricks(grid);
  const std::vector<Index> places = grid.places();
  grid.nodes.assign(places.size() * VoxelGrid::in_brick, 0.0F);
  for_bricks(grid.brick_count, [&](int b) {
    for_cube(n, [&](const Index& i, std::size_t slot) {
      if (grid.needed(places[b], i))
        grid.nodes[static_cast<std::size_t>(b) * VoxelGrid::in_brick + slot] =
            static_cast<float>(distance(grid.node(places[b], i)));
    });
  });
  grid.coefficients.assign(static_cast<std::size_t>(grid.near_count) * VoxelGrid::held_in_brick + 3, 0.0F);
  for_bricks(grid.near_count, [&](int b) {
    Around d;
    gather(grid, places[b], d);
    for_cube(VoxelGrid::held, [&](const Index& i, std::size_t slot) {
      grid.coefficients[static_cast<std::size_t>(b) * VoxelGrid::held_in_brick + slot] =
          coefficient(d, {i[0] + 1, i[1] + 1, i[2] + 1});
    });
  });
}

namespace {

// Points on a surface, spread evenly by area and the same in every run.
class SurfaceSampler {
 public:
  explicit SurfaceSampler(const TriangleMesh& mesh) : mesh_(mesh) {
    double sum = 0;
    for (const Triangle& t : mesh.triangles) up_to_.push_back(sum += triangle_area(mesh, t));
  }
  double number() { return static_cast<double>(engine_()) / 4294967296.0; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v(2 * number() - 1, 2 * number() - 1, 2 * number() - 1);
      if (v.squaredNorm() <= 1 && v.squaredNorm() > 1e-4) return v.normalized();
    }
  }
  Vec3 point() {
    const double at = number() * up_to_.back();
    const auto t =
        std::min(std::upper_bound(up_to_.begin(), up_to_.end(), at), up_to_.end() - 1) - up_to_.begin();
    const auto& [a, b, c] = mesh_.triangles[t];
    double u = number(), v = number();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3& x = mesh_.positions[a];
    return x + u * (mesh_.positions[b] - x) + v * (mesh_.positions[c] - x);
  }

 private:
  const TriangleMesh& mesh_;
  std::vector<double> up_to_;  // m^2, area of the triangles up to each
  std::mt19937 engine_{1};
};

}  // namespace

// Half of the samples lie in the band, at any distance. The other half lie on the surface; for these the
// inside is looked for, too: a way inwards of up to a voxel and a half must meet it.
LevelSetError measure_error(const VoxelGrid& grid, const SurfaceDistance& surface) {
  constexpr int samples = 20000;
  SurfaceSampler sampler(surface.mesh());
  LevelSetError error;
  double squares = 0;
  int vanished = 0;
  for (int i = 0; i < samples; ++i) {
    const Vec3 on = sampler.point();
    const bool in_band = i % 2 == 0;
    const Vec3 x = in_band ? Vec3(on + grid.band * sampler.number() * sampler.direction()) : on;
    const SurfacePoint exact = surface.closest(x);
    const double off = std::abs(grid.closest(x).distance - exact.distance);
    squares += off * off;
    if (off > error.largest) error.largest = off, error.where = x;
    if (in_band) continue;
    bool met = false;
    for (double depth : {0.5, 1.0, 1.5})
      met = met || grid.closest(on - depth * grid.voxel * exact.normal).distance < 0;
    if (!met && vanished++ == 0) error.vanished_where = on;
  }
  error.rms = std::sqrt(squares / samples);
  error.vanished = 2.0 * vanished / samples;
  return error;
}

}  // namespace drape::internal
