#include "constraints/convex_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

namespace drape::internal {
namespace {

constexpr double flatness = 1e-6;  // of the size of the mesh
constexpr double straight = 1e-9;  // the sine of an angle below which a side does not turn

// Whether the way from a over b to c turns to the left by more than `least`, a sine.
bool turns_left(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, double least) {
  const Eigen::Vector2d first = b - a, then = c - b;
  return first[0] * then[1] - first[1] * then[0] > least * first.norm() * then.norm();
}

// The corners of the polygon that holds all of these points, counterclockwise about the normal.       [Andrew 1979]
std::vector<int> outline(const TriangleMesh& mesh, std::vector<int> points, const Vec3& normal) {
  const Vec3 t = normal.unitOrthogonal(), s = normal.cross(t);
  const auto at = [&](int v) {
    const Vec3& x = mesh.positions[static_cast<std::size_t>(v)];
    return Eigen::Vector2d(x.dot(t), x.dot(s));
  };
  std::ranges::sort(points, [&](int a, int b) {
    const Eigen::Vector2d p = at(a), q = at(b);
    return p[0] != q[0] ? p[0] < q[0] : p[1] < q[1];
  });
  std::vector<int> polygon;
  // From the first point to the last on one side, and back on the other.
  const auto go = [&](auto begin, auto end) {
    const std::size_t from = polygon.size();
    for (auto v = begin; v != end; ++v) {
      while (polygon.size() > from + 1 &&
             !turns_left(at(polygon[polygon.size() - 2]), at(polygon.back()), at(*v), 0))
        polygon.pop_back();
      polygon.push_back(*v);
    }
    polygon.pop_back();  // the way on begins with it
  };
  go(points.begin(), points.end());
  go(points.rbegin(), points.rend());
  // What lies along a side turns by rounding alone.
  for (std::size_t k = 0; k < polygon.size() && polygon.size() > 3;) {
    const std::size_t n = polygon.size();
    if (turns_left(at(polygon[(k + n - 1) % n]), at(polygon[k]), at(polygon[(k + 1) % n]), straight))
      ++k;
    else
      polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(k));
  }
  return polygon;
}

struct FlatSide {
  Vec3 normal;
  double offset;  // m
};

// The mean plane of the triangles that lie about as the first of these does. One of them alone would not say
// where the far end of the side is.
FlatSide mean_plane(const TriangleMesh& mesh, const std::vector<Vec3>& across,
                    const std::vector<std::size_t>& of, double near) {
  const auto corner = [&](std::size_t k) -> const Vec3& { return mesh.positions[mesh.triangles[k][0]]; };
  const Vec3 n = across[of.front()].normalized();
  const double offset = n.dot(corner(of.front()));
  Vec3 normals = Vec3::Zero(), places = Vec3::Zero();
  double areas = 0;
  for (const std::size_t k : of) {
    const double area = across[k].norm();
    if (across[k].dot(n) < (1 - 1e-6) * area || std::abs(n.dot(corner(k)) - offset) > near) continue;
    const Triangle& t = mesh.triangles[k];
    normals += across[k];
    places += area / 3 * (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]);
    areas += area;
  }
  const Vec3 mean = normals.normalized();
  return {mean, mean.dot(places) / areas};
}

}  // namespace

std::vector<ConvexFace> convex_faces(const TriangleMesh& mesh) {
  const auto count = mesh.triangles.size();
  Eigen::AlignedBox3d box;
  for (const Vec3& x : mesh.positions) box.extend(x);
  const double tolerance = flatness * box.diagonal().norm();
  std::vector<Vec3> across(count);  // twice the area along the normal
  for (std::size_t k = 0; k < count; ++k) {
    const Triangle& t = mesh.triangles[k];
    const Vec3& p = mesh.positions[t[0]];
    across[k] = (mesh.positions[t[1]] - p).cross(mesh.positions[t[2]] - p);
  }
  // The largest triangle that is left says where the next plane is, because its normal is known best.
  std::vector<std::size_t> left(count);
  std::iota(left.begin(), left.end(), 0);
  std::ranges::stable_sort(
      left, [&](std::size_t a, std::size_t b) { return across[a].squaredNorm() > across[b].squaredNorm(); });
  std::vector<ConvexFace> faces;
  while (!left.empty() && across[left.front()].norm() > tolerance * tolerance) {
    const FlatSide side = mean_plane(mesh, across, left, 100 * tolerance);
    const double middle = side.offset;
    ConvexFace face{side.normal, middle, {}};
    std::vector<int> points;
    const std::size_t before = left.size();
    std::erase_if(left, [&](std::size_t k) {
      const auto height = [&](int v) { return face.normal.dot(mesh.positions[v]) - middle; };
      const Triangle& t = mesh.triangles[k];
      if (across[k].dot(face.normal) < 0 ||
          std::ranges::any_of(t, [&](int v) { return std::abs(height(v)) > tolerance; }))
        return false;
      for (const int v : t) {
        points.push_back(v);
        face.offset = std::max(face.offset, middle + height(v));
      }
      return true;
    });
    if (left.size() == before) {  // bent by more than the tolerance: its largest triangle alone
      const Triangle& t = mesh.triangles[left.front()];
      face.normal = across[left.front()].normalized();
      face.offset = face.normal.dot(mesh.positions[t[0]]);
      points.assign(t.begin(), t.end());
      left.erase(left.begin());
    }
    face.corners = outline(mesh, std::move(points), face.normal);
    if (face.corners.size() >= 3) faces.push_back(std::move(face));
  }
  return faces;
}

}  // namespace drape::internal
