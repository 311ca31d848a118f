#include "solver/forces/choi_ko.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "mesh/base/errors.h"

namespace drape {
namespace {

// The rest position [m] of every vertex of the mesh.
std::vector<Vec3> rest_positions(const TriangleMesh& mesh, const TriangleMesh& rest) {
  std::vector<Vec3> positions = mesh.positions;
  std::vector<char> known(positions.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(mesh.triangles[t][k]);
      const Vec3& here = rest.positions[rest.triangles[t][k]];
      if (known[v] && (positions[v] - here).norm() > 1e-9 * (1 + here.norm()))
        throw InputError("vertex " + std::to_string(v) +
                         " has several places in the rest shape; choi-ko needs a grid in one piece");
      positions[v] = here;
      known[v] = 1;
    }
  return positions;
}

// A cell at rest: a is the mean length of its sides 0-1 and 2-3, b that of its other two sides.
struct Cell {
  double a, b;  // m
};

class RestGrid {
 public:
  RestGrid(const TriangleMesh& mesh, const TriangleMesh& rest)
      : grid(quad_grid(mesh)), x_(rest_positions(mesh, rest)) {
    for (const QuadGrid::Quad& q : grid.quads)
      cells_.push_back(
          {0.5 * (length(q[0], q[1]) + length(q[2], q[3])), 0.5 * (length(q[1], q[2]) + length(q[3], q[0]))});
  }

  double length(int i, int j) const { return (x_[i] - x_[j]).norm(); }
  double area(const QuadGrid::Quad& q) const {  // m^2, of its two triangles
    const auto at = [&](int k) { return x_[q[k]]; };
    return 0.5 * ((at(1) - at(0)).cross(at(2) - at(0)).norm() + (at(2) - at(0)).cross(at(3) - at(0)).norm());
  }
  const Cell& cell(int quad) const { return cells_[quad]; }
  // The extents of the cell: a along its side i j, b across it.
  Cell along(int quad, int i, int j) const {
    const QuadGrid::Quad& q = grid.quads[quad];
    const auto is_side = [&](std::size_t s) {
      return std::minmax(q[s], q[(s + 1) % 4]) == std::minmax(i, j);
    };
    const Cell& c = cell(quad);
    return is_side(0) || is_side(2) ? c : Cell{c.b, c.a};
  }

  const QuadGrid grid;

 private:
  std::vector<Vec3> x_;
  std::vector<Cell> cells_;
};

std::vector<StretchConnection> stretch_connections(const RestGrid& rest, const Fabric& fabric) {
  std::map<std::pair<int, int>, double> k;
  const double Y = mean_stretch(fabric);
  for (std::size_t n = 0; n < rest.grid.quads.size(); ++n) {
    const QuadGrid::Quad& q = rest.grid.quads[n];
    const auto [a, b] = rest.cell(static_cast<int>(n));
    const double sides[2] = {0.5 * Y * std::max(0.0, 9.0 / 8 * b / a - 3.0 / 8 * a / b),
                             0.5 * Y * std::max(0.0, 9.0 / 8 * a / b - 3.0 / 8 * b / a)};
    for (std::size_t s = 0; s < 4; ++s) k[std::minmax(q[s], q[(s + 1) % 4])] += sides[s % 2];
    for (std::size_t s = 0; s < 2; ++s)
      k[std::minmax(q[s], q[s + 2])] += 3.0 / 16 * Y * (a * a + b * b) / (a * b);
  }
  std::vector<StretchConnection> out;
  out.reserve(k.size());
  for (const auto& [pair, stiffness] : k)
    out.push_back({pair.first, pair.second, rest.length(pair.first, pair.second),
                   fabric.stretch_spring.value_or(stiffness)});
  return out;
}

// The k_b that a connection over the links h1, h2 [m], which bends a strip of this width [m], has for a
// rigidity of 1.
double per_rigidity(double width, double h1, double h2, double L) {
  return width * L * L * L / (6 * h1 * h2 * (h1 + h2));
}

void add_bends(const RestGrid& rest, const Fabric& fabric, bool diagonal, std::vector<BendConnection>& out) {
  for (const QuadGrid::Straight& s : diagonal ? rest.grid.diagonals : rest.grid.rows) {
    const double h1 = rest.length(s.a, s.m), h2 = rest.length(s.m, s.c), L = rest.length(s.a, s.c);
    const Cell one = diagonal ? rest.cell(s.quad_a) : rest.along(s.quad_a, s.a, s.m),
               two = diagonal ? rest.cell(s.quad_c) : rest.along(s.quad_c, s.m, s.c);
    const double a = 0.5 * (one.a + two.a), b = 0.5 * (one.b + two.b), d2 = a * a + b * b;
    if (!(h1 > 0 && h2 > 0 && L > 0 && a > 0 && b > 0)) continue;
    // A row counts half of its width on either side; a line of diagonals has its whole width at once.
    const double width = diagonal ? a * b / std::sqrt(d2) : 0.5 * b;
    const double share = diagonal ? d2 * d2 / (6 * a * a * b * b) : std::max(0.0, 1 - a * a / (3 * b * b));
    const double unit = per_rigidity(width, h1, h2, L);
    const double k_b = fabric.bend_spring.value_or(mean_bend(fabric) * share * unit);
    const double clamp_k2 = 96 * k_b / (L * h1 * h2 * (h1 + h2) * (h1 + h2));
    const double B = share > 0 ? k_b / (unit * share) : mean_bend(fabric);
    if (!out.empty() && out.back().i == s.a && out.back().j == s.c) {  // the other side of the row
      BendConnection& whole = out.back();
      whole.B = fabric.bend_spring ? 1 / (1 / whole.B + 1 / B) : B;
      if (fabric.bend_spring) continue;
      whole.k_b += k_b;
      whole.clamp_k2 += clamp_k2;
    } else {
      out.push_back({s.a, s.c, L, k_b, clamp_k2, B});
    }
  }
}

}  // namespace

Connections choi_ko_connections(const TriangleMesh& mesh, const TriangleMesh& rest, const Fabric& fabric) {
  check(fabric);
  const RestGrid grid(mesh, rest);
  Connections connections{stretch_connections(grid, fabric), {}};
  add_bends(grid, fabric, false, connections.bend);
  add_bends(grid, fabric, true, connections.bend);
  return connections;
}

std::vector<double> choi_ko_mass(const TriangleMesh& mesh, const TriangleMesh& rest, double area_density) {
  const RestGrid grid(mesh, rest);
  std::vector<double> areas(mesh.positions.size(), 0.0);
  for (const QuadGrid::Quad& q : grid.grid.quads)
    for (int v : q) areas[v] += 0.25 * grid.area(q);
  return mass_of_areas(std::move(areas), mesh, area_density);
}

std::vector<std::unique_ptr<Force>> choi_ko(const TriangleMesh& mesh, const Fabric& fabric,
                                            int first_particle) {
  return forces_of(choi_ko_connections(mesh, mesh, fabric), fabric, first_particle);
}

double longest_cell(const TriangleMesh& mesh, const TriangleMesh& rest) {
  const RestGrid grid(mesh, rest);
  double longest = 1;
  for (int q = 0; q < static_cast<int>(grid.grid.quads.size()); ++q) {
    const auto [low, high] = std::minmax(grid.cell(q).a, grid.cell(q).b);
    longest = std::max(longest, high / low);
  }
  return longest;
}

}  // namespace drape
