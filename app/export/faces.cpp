#include "app/export/faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <map>
#include <numeric>
#include <string>
#include <tuple>

#include "mesh/obj/obj.h"
#include "mesh/triangles/normals.h"
#include "mesh/triangles/topology.h"

namespace drape::app {
namespace {

// "0.5 1" of a vt line; a missing second number is 0.
Uv read_uv(std::string_view text) {
  const std::string line(text);
  Uv uv{};
  char* end = nullptr;
  uv[0] = std::strtod(line.c_str(), &end);
  uv[1] = std::strtod(end, nullptr);
  return uv;
}

Faces faces_of_document(const ObjDocument& document) {
  Faces faces;
  bool all = document.face_count() > 0;
  for (std::size_t f = 0; f < document.face_count(); ++f)
    faces.counts.push_back(static_cast<int>(document.face_start[f + 1] - document.face_start[f]));
  for (const ObjCorner& corner : document.corners) {
    faces.corners.push_back(corner.v);
    all = all && corner.vt >= 0;
  }
  if (!all) return faces;
  std::vector<Uv> entries;
  for (std::size_t i = 0; i < document.texcoords.size(); ++i)
    entries.push_back(read_uv(document.texcoords[i]));
  for (const ObjCorner& corner : document.corners) faces.uv.push_back(entries[corner.vt]);
  return faces;
}

// Which corner of its face each corner of a triangle is. Triangles follow their faces in order, at most
// corners - 2 for each; a face may have given none.
class TriangleCorners {
 public:
  explicit TriangleCorners(const Faces& faces) : faces_(faces) {}

  std::array<std::size_t, 3> next(const Triangle& triangle) {
    std::array<std::size_t, 3> found{};
    while (given_ + 2 >= count() || !find(triangle, found)) {
      start_ += static_cast<std::size_t>(count());
      ++face_;
      given_ = 0;
    }
    ++given_;
    return found;
  }

 private:
  int count() const { return faces_.counts.at(face_); }
  bool find(const Triangle& triangle, std::array<std::size_t, 3>& found) const {
    const auto begin = faces_.corners.begin() + static_cast<std::ptrdiff_t>(start_), end = begin + count();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = std::find(begin, end, triangle[k]);
      if (corner == end) return false;
      found[k] = static_cast<std::size_t>(corner - faces_.corners.begin());
    }
    return true;
  }

  const Faces& faces_;
  std::size_t face_ = 0, start_ = 0;
  int given_ = 0;  // triangles of this face so far
};

// A number for each corner of each triangle: corners at one vertex have the same where one gets from one
// triangle to the other over edges that are not hard.
std::vector<int> smooth_parts(const TriangleMesh& mesh, double crease) {
  std::vector<int> part;
  for (const Triangle& t : mesh.triangles) part.insert(part.end(), t.begin(), t.end());
  if (crease >= M_PI) return part;  // that of the vertex
  std::iota(part.begin(), part.end(), 0);
  const auto root = [&part](int corner) {
    while (part[corner] != corner) corner = part[corner];
    return corner;
  };
  const auto corner_at = [&mesh](int t, int v) {
    const Triangle& triangle = mesh.triangles[t];
    return 3 * t + static_cast<int>(std::find(triangle.begin(), triangle.end(), v) - triangle.begin());
  };
  const auto normal = [&mesh](int t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const auto x = [&mesh](int v) { return mesh.positions[v]; };
    return twice_area_normal(x(a), x(b), x(c));
  };
  for (const Hinge& hinge : hinges(mesh)) {
    const Vec3 one = normal(hinge.tc), other = normal(hinge.td);
    if (one.dot(other) < std::cos(crease) * one.norm() * other.norm()) continue;
    for (const int v : {hinge.a, hinge.b}) {
      const int first = root(corner_at(hinge.tc, v)), second = root(corner_at(hinge.td, v));
      part[std::max(first, second)] = std::min(first, second);
    }
  }
  for (int corner = 0; corner < static_cast<int>(part.size()); ++corner) part[corner] = root(corner);
  return part;
}

}  // namespace

Faces faces_of(const TriangleMesh& mesh) {
  Faces faces;
  if (mesh.document && mesh.triangles.empty()) {
    for (const Polyline& line : polylines(mesh)) faces.line = line.vertices;
    return faces;
  }
  if (mesh.document) return faces_of_document(*mesh.document);
  faces.counts.assign(mesh.triangles.size(), 3);
  for (const Triangle& t : mesh.triangles) faces.corners.insert(faces.corners.end(), t.begin(), t.end());
  return faces;
}

std::vector<Uv> uv_by_vertex(const Faces& faces, std::size_t vertices) {
  if (faces.uv.empty()) return {};
  std::vector<Uv> uv(vertices, Uv{});
  std::vector<bool> known(vertices, false);
  for (std::size_t c = 0; c < faces.corners.size(); ++c) {
    const auto v = static_cast<std::size_t>(faces.corners[c]);
    if (known[v] && uv[v] != faces.uv[c]) return {};
    uv[v] = faces.uv[c];
    known[v] = true;
  }
  return uv;
}

Corners split_corners(const TriangleMesh& mesh, const Faces& faces, double crease) {
  Corners split;
  for (int v = 0; v < mesh.vertex_count(); ++v) split.origin.push_back(v);
  split.triangles = mesh.triangles;
  const std::vector<int> normal_of = smooth_parts(mesh, crease);
  split.normals = mesh.vertex_count();
  if (!faces.uv.empty()) split.uv.resize(split.size(), Uv{});
  split.normal.assign(split.size(), -1);  // not known yet
  std::map<int, int> numbers;  // of the normals of smooth_parts: a vertex's first is its own number
  std::map<std::tuple<int, int, Uv>, int> doubles;
  TriangleCorners corners(faces);
  for (std::size_t t = 0; t < split.triangles.size(); ++t) {
    Triangle& triangle = split.triangles[t];
    std::array<std::size_t, 3> corner{};
    if (!faces.uv.empty()) corner = corners.next(triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(triangle[k]);
      const Uv uv = faces.uv.empty() ? Uv{} : faces.uv[corner[k]];
      const bool is_first = split.normal[v] < 0;
      const auto [normal, is_new_normal] =
          numbers.try_emplace(normal_of[3 * t + k], is_first ? triangle[k] : split.normals);
      if (is_new_normal && !is_first) ++split.normals;
      if (is_first) {
        split.normal[v] = normal->second;
        if (!split.uv.empty()) split.uv[v] = uv;
      }
      if (split.normal[v] == normal->second && (split.uv.empty() || split.uv[v] == uv)) continue;
      const auto [place, is_new] =
          doubles.try_emplace({triangle[k], normal->second, uv}, static_cast<int>(split.size()));
      if (is_new) {
        split.origin.push_back(triangle[k]);
        split.normal.push_back(normal->second);
        if (!split.uv.empty()) split.uv.push_back(uv);
      }
      triangle[k] = place->second;
    }
  }
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if (split.normal[v] < 0) split.normal[v] = static_cast<int>(v);
  return split;
}

std::vector<Vec3> normals_of(const Corners& corners, const std::vector<Vec3>& positions) {
  const auto at = [](const auto& list, int i) -> const auto& { return list[i]; };
  std::vector<Vec3> sums(static_cast<std::size_t>(corners.normals), Vec3::Zero());
  for (const Triangle& t : corners.triangles) {
    const Vec3 normal =
        twice_area_normal(at(positions, at(corners.origin, t[0])), at(positions, at(corners.origin, t[1])),
                          at(positions, at(corners.origin, t[2])));
    for (const int v : t) sums[at(corners.normal, v)] += normal;
  }
  std::vector<Vec3> normals;
  for (const int number : corners.normal) {
    const Vec3& sum = at(sums, number);
    const double length = sum.norm();
    normals.push_back(length > 0 ? Vec3(sum / length) : Vec3(0, 1, 0));
  }
  return normals;
}

}  // namespace drape::app
