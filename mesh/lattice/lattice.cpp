#include "mesh/lattice/lattice.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/base/errors.h"
#include "mesh/base/parallel.h"
#include "mesh/distance/surface_distance.h"
#include "mesh/lattice/solid.h"
#include "mesh/triangles/normals.h"
#include "mesh/triangles/topology.h"

namespace drape {
namespace {

using Cell = std::array<int, 3>;

// The number of the point p in a box of `count` points along x, y, z, numbered with x fastest.
std::size_t number(const Cell& p, const Cell& count) {
  return static_cast<std::size_t>(p[0]) +
         static_cast<std::size_t>(count[0]) *
             (static_cast<std::size_t>(p[1]) +
              static_cast<std::size_t>(count[1]) * static_cast<std::size_t>(p[2]));
}

template <class F>
void for_each_in(const Cell& begin, const Cell& end, const F& f) {
  for (int z = begin[2]; z < end[2]; ++z)
    for (int y = begin[1]; y < end[1]; ++y)
      for (int x = begin[0]; x < end[0]; ++x) f(Cell{x, y, z});
}

Cell corners(const Cell& cells) { return {cells[0] + 1, cells[1] + 1, cells[2] + 1}; }

bool is_filled(const Lattice& lattice, const Cell& c) {
  for (std::size_t a = 0; a < 3; ++a)
    if (c[a] < 0 || c[a] >= lattice.cells[a]) return false;
  return lattice.filled[number(c, lattice.cells)] != 0;
}

Vec3 place(const Lattice& lattice, const Cell& c) {
  return lattice.origin + lattice.spacing.cwiseProduct(Vec3(c[0], c[1], c[2]));
}

// The filled fraction of those cells that have both p and p + d among their corners.
double cells_round(const Lattice& lattice, const Cell& p, const Cell& d) {
  int possible = 0, there = 0;
  Cell first, last;
  for (std::size_t a = 0; a < 3; ++a) {
    first[a] = d[a] > 0 ? p[a] : p[a] - 1;
    last[a] = d[a] < 0 ? p[a] : p[a] + 1;
  }
  for_each_in(first, last, [&](const Cell& c) {
    ++possible;
    there += is_filled(lattice, c) ? 1 : 0;
  });
  return static_cast<double>(there) / possible;
}

void number_particles(Lattice& lattice) {
  const Cell count = corners(lattice.cells);
  lattice.particle.assign(number({0, 0, count[2]}, count), -1);
  const double eighth = lattice.spacing.prod() / 8;
  for_each_in({0, 0, 0}, count, [&](const Cell& p) {
    const double round = 8 * cells_round(lattice, p, {0, 0, 0});
    if (round == 0) return;
    lattice.particle[number(p, count)] = lattice.particle_count();
    lattice.positions.push_back(place(lattice, p));
    lattice.volumes.push_back(round * eighth);
  });
}

// Adds each pair from its end with the lower number.
void join_particles(Lattice& lattice) {
  const Cell count = corners(lattice.cells);
  for_each_in({0, 0, 0}, count, [&](const Cell& p) {
    const int i = lattice.particle[number(p, count)];
    if (i < 0) return;
    for_each_in({-1, -1, -1}, {2, 2, 2}, [&](const Cell& d) {
      if (d[2] < 0 || (d[2] == 0 && (d[1] < 0 || (d[1] == 0 && d[0] <= 0)))) return;
      const double cells = cells_round(lattice, p, d);
      if (cells == 0) return;
      const Cell q = {p[0] + d[0], p[1] + d[1], p[2] + d[2]};
      const bool along_edge = std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]) == 1;
      (along_edge ? lattice.structural : lattice.shear)
          .push_back({i, lattice.particle[number(q, count)], cells});
      if (!along_edge) return;
      const double further = cells_round(lattice, q, d);
      if (further > 0)
        lattice.bend.push_back({i, lattice.particle[number({q[0] + d[0], q[1] + d[1], q[2] + d[2]}, count)],
                                std::min(cells, further)});
    });
  });
}

// True when a triangle and a box round the origin share more than their rims, that is, when no axis separates
// them.
//                                     [Akenine-Moller 2001, Fast 3D triangle-box overlap testing]
bool overlap(const std::array<Vec3, 3>& t, const Vec3& half) {
  const auto separates = [&](const Vec3& axis) {
    const double a = axis.dot(t[0]), b = axis.dot(t[1]), c = axis.dot(t[2]);
    const double reach = half.dot(axis.cwiseAbs());
    return std::min({a, b, c}) >= reach || std::max({a, b, c}) <= -reach;
  };
  const Vec3 normal = twice_area_normal(t[0], t[1], t[2]);
  // A triangle that lies in a face of the box touches only the rim of the box.
  if (const double from = std::abs(normal.dot(t[0])), reach = half.dot(normal.cwiseAbs()); from > reach)
    return false;
  for (int k = 0; k < 3; ++k) {
    if (separates(Vec3::Unit(k))) return false;
    for (std::size_t e = 0; e < 3; ++e) {
      const Vec3 axis = Vec3::Unit(k).cross(t[(e + 1) % 3] - t[e]);
      if (axis.squaredNorm() > 0 && separates(axis)) return false;
    }
  }
  return true;
}

constexpr double slack = 1e-9;  // of a cell: a surface nearer than this to a face of a cell lies in it

int cell_along(double u, int cells) { return std::clamp(static_cast<int>(std::floor(u)), 0, cells - 1); }

void fill_along_surface(Lattice& lattice, const TriangleMesh& surface) {
  const Vec3 half = (0.5 - slack) * lattice.spacing;
  for (int counted : counted_triangles(surface)) {
    std::array<Vec3, 3> t;
    Eigen::AlignedBox3d box;
    for (std::size_t k = 0; k < 3; ++k) {
      t[k] = surface.positions[surface.triangles[counted][k]] - lattice.origin;
      box.extend(t[k]);
    }
    Cell first, end;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto k = static_cast<Eigen::Index>(a);
      first[a] = cell_along(box.min()[k] / lattice.spacing[k], lattice.cells[a]);
      end[a] = cell_along(box.max()[k] / lattice.spacing[k], lattice.cells[a]) + 1;
    }
    for_each_in(first, end, [&](const Cell& c) {
      char& filled = lattice.filled[number(c, lattice.cells)];
      if (filled) return;
      const Vec3 centre = lattice.spacing.cwiseProduct(Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5));
      filled = overlap({t[0] - centre, t[1] - centre, t[2] - centre}, half) ? 1 : 0;
    });
  }
}

void fill_inside(Lattice& lattice, const SurfaceDistance& surface) {
  parallel_for(lattice.cells[2], false, [&](int z) {
    for_each_in({0, 0, z}, {lattice.cells[0], lattice.cells[1], z + 1}, [&](const Cell& c) {
      char& filled = lattice.filled[number(c, lattice.cells)];
      if (!filled) filled = surface.closest(place(lattice, c) + 0.5 * lattice.spacing).distance < 0 ? 1 : 0;
    });
  });
}

// Puts a box of cells round a surface, which lies in the middle of the box.
void surround(Lattice& lattice, const TriangleMesh& surface, double spacing) {
  Eigen::AlignedBox3d box;
  for (int counted : counted_triangles(surface))
    for (int v : surface.triangles[counted]) box.extend(surface.positions[v]);
  lattice.spacing.setConstant(spacing);
  for (std::size_t a = 0; a < 3; ++a) {
    const auto k = static_cast<Eigen::Index>(a);
    const double whole = std::max(1.0, std::ceil(box.sizes()[k] / spacing - slack));
    if (!(whole < 1e9))
      throw InputError("a lattice of more than 1e9 cells along an axis; take a wider spacing");
    lattice.cells[a] = static_cast<int>(whole);
    lattice.origin[k] = 0.5 * (box.min()[k] + box.max()[k] - spacing * whole);
  }
}

// The cell that holds the place u, given in cells from the origin; when no filled cell holds it, the nearest
// one.
Cell cell_of(const Lattice& lattice, const Vec3& u) {
  for (int nudged = 0; nudged < 9; ++nudged) {  // u itself, then u towards the cells that share a face
    Vec3 to = u;
    for (int a = 0; a < 3 && nudged > 0; ++a) to[a] += ((nudged - 1) >> a & 1) ? slack : -slack;
    Cell c;
    for (std::size_t a = 0; a < 3; ++a) {
      const double whole = std::floor(to[static_cast<Eigen::Index>(a)]);
      c[a] = whole >= 0 && whole < lattice.cells[a] ? static_cast<int>(whole) : -1;
    }
    if (is_filled(lattice, c)) return c;
  }
  Cell nearest = {0, 0, 0};
  double least = std::numeric_limits<double>::infinity();
  for_each_in({0, 0, 0}, lattice.cells, [&](const Cell& c) {
    const Vec3 centre(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5);
    const double outside =
        lattice.spacing.cwiseProduct((u - centre).cwiseAbs().array().max(0.5).matrix()).norm();
    if (is_filled(lattice, c) && outside < least) least = outside, nearest = c;
  });
  return nearest;
}

}  // namespace

Lattice box_lattice(const std::array<int, 3>& particles, const Vec3& spacing) {
  Lattice lattice;
  lattice.spacing = spacing;
  for (std::size_t a = 0; a < 3; ++a) {
    if (particles[a] < 2)
      throw InputError("a lattice of " + std::to_string(particles[a]) +
                       " particles along an axis: it has no cells; take at least 2");
    lattice.cells[a] = particles[a] - 1;
    const auto k = static_cast<Eigen::Index>(a);
    lattice.origin[k] = -0.5 * spacing[k] * lattice.cells[a];
  }
  lattice.filled.assign(number({0, 0, lattice.cells[2]}, lattice.cells), 1);
  number_particles(lattice);
  join_particles(lattice);
  return lattice;
}

Lattice filled_lattice(const TriangleMesh& surface, double spacing, const std::string& name) {
  const SurfaceDistance distance(surface);
  if (!distance.closed())
    throw InputError(name + ": the mesh is not closed: it has no inside to fill with particles; close it");
  Lattice lattice;
  surround(lattice, surface, spacing);
  lattice.filled.assign(number({0, 0, lattice.cells[2]}, lattice.cells), 0);
  fill_along_surface(lattice, surface);
  fill_inside(lattice, distance);
  number_particles(lattice);
  join_particles(lattice);
  return lattice;
}

LatticeSize lattice_size(const TriangleMesh& surface, double spacing) {
  Lattice box;
  surround(box, surface, spacing);
  double area = 0, corner_count = 1;
  for (int counted : counted_triangles(surface)) area += triangle_area(surface, surface.triangles[counted]);
  for (int cells : box.cells) corner_count *= cells + 1.0;
  const double inside = solid_of(surface).volume / (spacing * spacing * spacing);
  return {std::min(corner_count, inside + 1.5 * area / (spacing * spacing)), corner_count};
}

TriangleMesh surface_of(const Lattice& lattice, std::vector<int>& particles) {
  const Cell count = corners(lattice.cells);
  std::vector<Triangle> triangles;
  for_each_in({0, 0, 0}, lattice.cells, [&](const Cell& c) {
    if (!is_filled(lattice, c)) return;
    for (std::size_t a = 0; a < 3; ++a)
      for (int side = 0; side < 2; ++side) {
        Cell beyond = c;
        beyond[a] += side == 0 ? -1 : 1;
        if (is_filled(lattice, beyond)) continue;
        const auto corner = [&](int u, int v) {
          Cell p = c;
          p[a] += side;
          p[(a + 1) % 3] += u;
          p[(a + 2) % 3] += v;
          return lattice.particle[number(p, count)];
        };
        const int odd = (c[0] + c[1] + c[2]) % 2;  // diagonals alternate, so that none is preferred
        std::array<int, 4> q = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
        if (side == 0) std::swap(q[1], q[3]);
        const std::size_t s = odd ? 1 : 0;
        triangles.push_back({q[s], q[s + 1], q[s + 2]});
        triangles.push_back({q[s], q[s + 2], q[(s + 3) % 4]});
      }
  });
  std::vector<int> vertex(lattice.positions.size(), -1);
  for (const Triangle& t : triangles)
    for (int p : t) vertex[p] = 0;
  TriangleMesh mesh;
  particles.clear();
  for (std::size_t p = 0; p < vertex.size(); ++p) {
    if (vertex[p] < 0) continue;
    vertex[p] = static_cast<int>(particles.size());
    particles.push_back(static_cast<int>(p));
    mesh.positions.push_back(lattice.positions[p]);
  }
  for (Triangle& t : triangles)
    for (int& p : t) p = vertex[p];
  mesh.triangles = std::move(triangles);
  return mesh;
}

Embedding embedding_in(const Lattice& lattice, const std::vector<Vec3>& points, int first) {
  const Cell count = corners(lattice.cells);
  Embedding embedding;
  std::vector<Embedding::Share> shares;
  for (const Vec3& x : points) {
    const Vec3 u = (x - lattice.origin).cwiseQuotient(lattice.spacing);
    const Cell c = cell_of(lattice, u);
    shares.clear();
    for_each_in({0, 0, 0}, {2, 2, 2}, [&](const Cell& d) {
      double weight = 1;
      for (std::size_t a = 0; a < 3; ++a) {
        const double t = u[static_cast<Eigen::Index>(a)] - c[a];
        weight *= d[a] ? t : 1 - t;
      }
      const Cell p = {c[0] + d[0], c[1] + d[1], c[2] + d[2]};
      if (weight != 0) shares.push_back({first + lattice.particle[number(p, count)], weight});
    });
    embedding.add_vertex(shares);
  }
  return embedding;
}

}  // namespace drape
