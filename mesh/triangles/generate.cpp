// Makes the meshes of generate.h. Positions are symmetric about the origin to the last bit where the shape
// is.
#include "mesh/triangles/generate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "mesh/base/errors.h"
#include "mesh/triangles/topology.h"

namespace drape {

namespace {

constexpr double kTurn = 2 * 3.14159265358979323846;  // rad

void require(bool good, const std::string& what) {
  if (!good) throw InputError(what);
}

// The i-th of `count` numbers from -size/2 to size/2 in equal steps.
double spread(int i, int count, double size) { return size * (2 * i - (count - 1)) / (2.0 * (count - 1)); }

// Adds the two triangles of the quad p q r s, which is cut from p to r or from q to s.
void add_quad(TriangleMesh& mesh, int p, int q, int r, int s, bool along_pr) {
  if (along_pr) {
    mesh.triangles.push_back({p, q, r});
    mesh.triangles.push_back({p, r, s});
  } else {
    mesh.triangles.push_back({p, q, s});
    mesh.triangles.push_back({q, r, s});
  }
}

TriangleMesh icosahedron() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh;
  mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return mesh;
}

// Divides every triangle into four. The new vertices, one for each edge, come after the old ones in the order
// of the edges.
TriangleMesh subdivide(const TriangleMesh& coarse) {
  const std::vector<Edge> all = edges(coarse);
  TriangleMesh fine;
  fine.positions = coarse.positions;
  for (const Edge& e : all) fine.positions.push_back((coarse.positions[e.a] + coarse.positions[e.b]) / 2);
  const auto middle = [&](int p, int q) {
    const std::pair<int, int> wanted = std::minmax(p, q);
    const auto found =
        std::lower_bound(all.begin(), all.end(), wanted,
                         [](const Edge& e, const std::pair<int, int>& w) { return std::pair(e.a, e.b) < w; });
    return coarse.vertex_count() + static_cast<int>(found - all.begin());
  };
  for (const Triangle& t : coarse.triangles) {
    const int p = middle(t[0], t[1]), q = middle(t[1], t[2]), r = middle(t[2], t[0]);
    fine.triangles.insert(fine.triangles.end(), {{t[0], p, r}, {p, t[1], q}, {r, q, t[2]}, {p, q, r}});
  }
  return fine;
}

}  // namespace

TriangleMesh grid(int nx, int nz, double width, double depth) {
  require(nx >= 2 && nz >= 2, "a grid needs at least 2 x 2 vertices");
  require(width > 0 && depth > 0, "a grid needs a width and a depth above 0");
  TriangleMesh mesh;
  for (int k = 0; k < nz; ++k) {
    for (int i = 0; i < nx; ++i) mesh.positions.push_back({spread(i, nx, width), 0, spread(k, nz, depth)});
  }
  for (int k = 0; k + 1 < nz; ++k) {
    for (int i = 0; i + 1 < nx; ++i) {
      const int p = k * nx + i;
      add_quad(mesh, p, p + nx, p + nx + 1, p + 1, (i + k) % 2 == 0);
    }
  }
  return mesh;
}

TriangleMesh equilateral_sheet(int nx, int nz, double edge) {
  require(nx >= 2 && nz >= 2, "an equilateral sheet needs at least 2 x 2 vertices");
  require(edge > 0, "an equilateral sheet needs an edge length above 0");
  const double row = edge * std::sqrt(3.0) / 2;
  TriangleMesh mesh;
  for (int k = 0; k < nz; ++k) {
    for (int i = 0; i < nx; ++i) {
      const double shift = (k % 2 == 0 ? -0.25 : 0.25) * edge;
      mesh.positions.push_back({spread(i, nx, edge * (nx - 1)) + shift, 0, spread(k, nz, row * (nz - 1))});
    }
  }
  for (int k = 0; k + 1 < nz; ++k) {
    for (int i = 0; i + 1 < nx; ++i) {
      const int p = k * nx + i;
      add_quad(mesh, p, p + nx, p + nx + 1, p + 1, k % 2 == 1);
    }
  }
  return mesh;
}

TriangleMesh disc(int rings, double radius) {
  require(rings >= 1, "a disc needs at least 1 ring");
  require(radius > 0, "a disc needs a radius above 0");
  TriangleMesh mesh;
  mesh.positions.push_back(Vec3::Zero());
  for (int ring = 1; ring <= rings; ++ring) {  // 6 vertices per ring number
    for (int j = 0; j < 6 * ring; ++j) {
      const double angle = kTurn * j / (6 * ring), r = radius * ring / rings;
      mesh.positions.push_back({r * std::cos(angle), 0, -r * std::sin(angle)});
    }
  }
  const auto at = [](int ring, int j) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + j % (6 * ring); };
  for (int ring = 1; ring <= rings; ++ring) {
    for (int sixth = 0; sixth < 6; ++sixth) {
      for (int j = 0; j < ring; ++j) {
        const int inner = sixth * (ring - 1) + j, outer = sixth * ring + j;
        mesh.triangles.push_back({at(ring - 1, inner), at(ring, outer), at(ring, outer + 1)});
        if (j + 1 < ring)
          mesh.triangles.push_back({at(ring - 1, inner), at(ring, outer + 1), at(ring - 1, inner + 1)});
      }
    }
  }
  return mesh;
}

TriangleMesh sphere(int subdivisions, double radius) {
  require(subdivisions >= 0 && subdivisions <= 12, "a sphere needs 0 to 12 subdivisions");
  require(radius > 0, "a sphere needs a radius above 0");
  TriangleMesh mesh = icosahedron();
  for (int level = 0; level <= subdivisions; ++level) {
    if (level > 0) mesh = subdivide(mesh);
    for (Vec3& x : mesh.positions) x.normalize();
  }
  for (Vec3& x : mesh.positions) x *= radius;
  return mesh;
}

TriangleMesh tube(int around, int along, double radius, double height) {
  require(around >= 3 && along >= 2, "a tube needs at least 3 vertices around and 2 along");
  require(radius > 0 && height > 0, "a tube needs a radius and a height above 0");
  TriangleMesh mesh;
  for (int k = 0; k < along; ++k) {
    for (int i = 0; i < around; ++i) {
      const double angle = kTurn * i / around;
      mesh.positions.push_back(
          {radius * std::cos(angle), spread(k, along, height), -radius * std::sin(angle)});
    }
  }
  for (int k = 0; k + 1 < along; ++k) {
    for (int i = 0; i < around; ++i) {
      const int p = k * around + i, q = k * around + (i + 1) % around;
      add_quad(mesh, p, q, q + around, p + around, (i + k) % 2 == 0);
    }
  }
  return mesh;
}

TriangleMesh box(const Vec3& size) {
  require(size.minCoeff() > 0, "a box needs edges above 0");
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.positions.emplace_back(spread(corner & 1, 2, size[0]), spread(corner >> 1 & 1, 2, size[1]),
                                spread(corner >> 2, 2, size[2]));
  constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                               {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& f : faces) add_quad(mesh, f[0], f[1], f[2], f[3], true);
  return mesh;
}

void add_arc(Outline& outline, const Eigen::Vector2d& centre, double radius, double from, double to,
             int pieces) {
  for (int k = 0; k <= pieces; ++k) {
    const double angle = from + (to - from) * k / pieces;
    Eigen::Vector2d point = centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    if (point[0] < 1e-9 * radius) point[0] = 0;
    const bool repeated = !outline.empty() && (point - outline.back()).norm() < 1e-9 * radius;
    if (!repeated) outline.push_back(point);
  }
}

TriangleMesh turned(const Outline& outline, int around) {
  require(around >= 3 && outline.size() >= 3, "a turned body needs an outline of 3 points and 3 around");
  require(outline.front()[0] == 0 && outline.back()[0] == 0, "an outline begins and ends on the axis");
  const int rings = static_cast<int>(outline.size()) - 2;
  TriangleMesh mesh;
  for (int ring = 0; ring < rings; ++ring) {
    const Eigen::Vector2d& point = outline[ring + 1];
    require(point[0] > 0, "an outline meets the axis at its ends only");
    for (int i = 0; i < around; ++i) {
      const double angle = kTurn * i / around;
      mesh.positions.emplace_back(point[0] * std::cos(angle), point[1], -point[0] * std::sin(angle));
    }
  }
  const int first = rings * around, last = first + 1, top = (rings - 1) * around;
  mesh.positions.emplace_back(0, outline.front()[1], 0);
  mesh.positions.emplace_back(0, outline.back()[1], 0);
  for (int i = 0; i < around; ++i) {
    const int next = (i + 1) % around;
    mesh.triangles.push_back({first, next, i});
    for (int ring = 0; ring + 1 < rings; ++ring) {
      const int p = ring * around + i, q = ring * around + next;
      add_quad(mesh, p, q, q + around, p + around, (i + ring) % 2 == 0);
    }
    mesh.triangles.push_back({top + i, top + next, last});
  }
  return mesh;
}

TriangleMesh capsule(int around, double radius, double length) {
  require(around >= 4 && around % 4 == 0, "a capsule needs a multiple of 4 vertices around");
  require(radius > 0 && length >= 0, "a capsule needs a radius above 0 and a length");
  Outline outline;
  add_arc(outline, {0, -length / 2}, radius, -kTurn / 4, 0, around / 4);
  // Rings on the cylinder keep its cells from being needles; their number is bounded.
  const double cells = length / (radius * kTurn / around);
  const int pieces = static_cast<int>(std::clamp(std::ceil(cells / 8), 1.0, 256.0));
  for (int k = 1; k < pieces; ++k) outline.emplace_back(radius, spread(k, pieces + 1, length));
  add_arc(outline, {0, length / 2}, radius, 0, kTurn / 4, around / 4);
  return turned(outline, around);
}

TriangleMesh bowl(int around, double radius, double thickness) {
  require(around >= 4 && around % 4 == 0, "a bowl needs a multiple of 4 vertices around");
  require(radius > 0 && thickness > 0, "a bowl needs a radius and a thickness above 0");
  constexpr int round_the_rim = 16;
  Outline outline;
  add_arc(outline, {0, 0}, radius + thickness, -kTurn / 4, 0, around / 4);
  add_arc(outline, {radius + thickness / 2, 0}, thickness / 2, 0, kTurn / 2, round_the_rim);
  add_arc(outline, {0, 0}, radius, 0, -kTurn / 4, around / 4);
  return turned(outline, around);
}

}  // namespace drape
