#include "mesh/distance/surface_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <tuple>

#include "mesh/base/errors.h"
#include "mesh/distance/closest_on_triangle.h"
#include "mesh/triangles/normals.h"
#include "mesh/triangles/topology.h"

namespace drape::internal {
namespace {

constexpr double flat = 1e-13;  // largest height / longest edge of a triangle that has no area

// The triangles that have three different vertices, each one once, in the order of the mesh.
std::vector<Face> distinct_faces(const TriangleMesh& mesh, const std::vector<int>& weld) {
  std::vector<std::pair<Triangle, int>> keys;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    Triangle key;
    for (int k = 0; k < 3; ++k) key[k] = weld[mesh.triangles[t][k]];
    std::sort(key.begin(), key.end());
    if (key[0] != key[1] && key[1] != key[2]) keys.emplace_back(key, t);
  }
  std::sort(keys.begin(), keys.end());
  const auto same = [](const auto& p, const auto& q) { return p.first == q.first; };
  keys.erase(std::unique(keys.begin(), keys.end(), same), keys.end());
  std::vector<Face> faces;
  faces.reserve(keys.size());
  std::sort(keys.begin(), keys.end(), [](const auto& p, const auto& q) { return p.second < q.second; });
  for (const auto& [key, t] : keys) faces.push_back({mesh.triangles[t], {-1, -1, -1}});
  return faces;
}

void turn(Face& f) {
  std::swap(f.v[1], f.v[2]);
  std::swap(f.across[0], f.across[2]);
}

// Winds a joined surface one way, piece by piece, with the normals out of the positive volume. Returns false,
// with some faces turned, when the surface has one side only. `inside_out` is set when a piece had most of
// its faces wound with the normals inwards.
bool orient(std::vector<Face>& faces, const std::vector<Vec3>& positions, const Vec3& centre,
            bool& inside_out) {
  std::vector<char> seen(faces.size(), 0);
  std::vector<char> turned(faces.size(), 0);
  for (int seed = 0; seed < static_cast<int>(faces.size()); ++seed) {
    if (seen[seed]) continue;
    std::vector<int> piece{seed};
    seen[seed] = 1;
    double volume = 0;
    std::size_t turns = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const Face f = faces[piece[i]];
      volume +=
          (positions[f.v[0]] - centre).cross(positions[f.v[1]] - centre).dot(positions[f.v[2]] - centre);
      turns += turned[piece[i]];
      for (int k = 0; k < 3; ++k) {
        Face& g = faces[f.across[k]];
        const auto runs_along = [&](int m) { return g.v[m] == f.v[k] && g.v[next(m)] == f.v[next(k)]; };
        const bool against = !runs_along(0) && !runs_along(1) && !runs_along(2);
        if (!against && seen[f.across[k]]) return false;
        if (!against) turn(g), turned[f.across[k]] = 1;
        if (!seen[f.across[k]]) piece.push_back(f.across[k]), seen[f.across[k]] = 1;
      }
    }
    if (volume < 0)
      for (int f : piece) turn(faces[f]);
    if (volume < 0 ? 2 * turns < piece.size() : 2 * turns > piece.size()) inside_out = true;
  }
  return true;
}

}  // namespace

Eigen::AlignedBox3d box_of(const SurfaceFaces& surface, const std::vector<Vec3>& positions) {
  Eigen::AlignedBox3d box;
  for (int f = 0; f < surface.with_area; ++f)
    for (int v : surface.faces[f].v) box.extend(positions[v]);
  return box;
}

bool has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return twice_area_normal(a, b, c).norm() > flat * longest;
}

std::vector<FaceSide> sorted_sides(const std::vector<Face>& faces) {
  std::vector<FaceSide> sides;
  sides.reserve(3 * faces.size());
  for (int f = 0; f < static_cast<int>(faces.size()); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({faces[f].v[k], faces[f].v[next(k)]});
      sides.push_back({low, high, f, k});
    }
  std::sort(sides.begin(), sides.end(), [](const FaceSide& a, const FaceSide& b) {
    return std::tie(a.low, a.high, a.face, a.side) < std::tie(b.low, b.high, b.face, b.side);
  });
  return sides;
}

bool join(std::vector<Face>& faces) {
  for (Face& f : faces) f.across = {-1, -1, -1};
  const std::vector<FaceSide> sides = sorted_sides(faces);
  bool manifold = true;
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    const FaceSide& one = sides[i];
    for (j = i; j < sides.size() && sides[j].low == one.low && sides[j].high == one.high;) ++j;
    manifold = manifold && j - i == 2;
    if (j - i != 2) continue;
    const FaceSide& other = sides[i + 1];
    faces[one.face].across[one.side] = other.face;
    faces[other.face].across[other.side] = one.face;
  }
  return manifold;
}

SurfaceFaces surface_faces(const TriangleMesh& mesh) {
  for (const Triangle& t : mesh.triangles)
    for (const int v : t)
      if (!mesh.positions[static_cast<std::size_t>(v)].allFinite())
        throw InputError("vertex " + std::to_string(v) + " of the surface has no finite position");
  const std::vector<int> weld = welded(mesh.positions);
  SurfaceFaces surface;
  std::vector<Face>& faces = surface.faces = distinct_faces(mesh, weld);
  const auto flat_ones = std::stable_partition(faces.begin(), faces.end(), [&](const Face& f) {
    return has_area(mesh.positions[f.v[0]], mesh.positions[f.v[1]], mesh.positions[f.v[2]]);
  });
  surface.with_area = static_cast<int>(flat_ones - faces.begin());
  if (surface.with_area == 0) throw InputError("the surface has no triangle with an area");
  const Vec3 centre = box_of(surface, mesh.positions).center();
  for (bool weld_them : {false, true}) {
    if (surface.closed) break;
    if (weld_them)
      for (Face& f : faces)
        for (int& v : f.v) v = weld[v];
    if (!join(faces)) continue;
    std::vector<Face> wound = faces;
    bool reversed = false;
    surface.closed = orient(wound, mesh.positions, centre, reversed);
    if (surface.closed) faces = std::move(wound), surface.inside_out = reversed;
  }
  return surface;
}

}  // namespace drape::internal
