// The meshes of generate.h. Positions are symmetric about the origin to the last bit where the shape is.
#include "mesh/generate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "mesh/obj.h"
#include "mesh/topology.h"

namespace drape {

namespace {

constexpr double kTurn = 2 * 3.14159265358979323846;  // rad

void require(bool good, const std::string& what) {
  if (!good) throw InputError(what);
}

// From -size/2 to size/2 in count - 1 equal steps.
double spread(int i, int count, double size) { return size * (2 * i - (count - 1)) / (2.0 * (count - 1)); }

// Two triangles of the quad p q r s, cut from p to r or from q to s.
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

// Every triangle into four; the new vertices, one per edge, come after the old ones in the order of the
// edges.
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

}  // namespace drape
