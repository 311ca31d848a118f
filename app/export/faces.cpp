#include "app/export/faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>

#include "mesh/obj.h"

namespace drape {
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
  for (const ObjCorner& corner : document.corners)
    faces.uv.push_back(entries[static_cast<std::size_t>(corner.vt)]);
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

}  // namespace

Faces faces_of(const TriangleMesh& mesh) {
  if (mesh.document) return faces_of_document(*mesh.document);
  Faces faces;
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

Corners split_by_uv(const TriangleMesh& mesh, const Faces& faces) {
  Corners split;
  for (int v = 0; v < mesh.vertex_count(); ++v) split.origin.push_back(v);
  split.triangles = mesh.triangles;
  if (faces.uv.empty()) return split;
  split.uv.resize(split.origin.size(), Uv{});
  std::vector<bool> known(split.origin.size(), false);
  std::map<std::pair<int, Uv>, int> doubles;
  TriangleCorners corners(faces);
  for (Triangle& triangle : split.triangles) {
    const std::array<std::size_t, 3> corner = corners.next(triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(triangle[k]);
      const Uv& uv = faces.uv[corner[k]];
      if (!known[v]) split.uv[v] = uv;
      known[v] = true;
      if (split.uv[v] == uv) continue;
      const auto [place, is_new] =
          doubles.try_emplace({triangle[k], uv}, static_cast<int>(split.origin.size()));
      if (is_new) {
        split.origin.push_back(triangle[k]);
        split.uv.push_back(uv);
      }
      triangle[k] = place->second;
    }
  }
  return split;
}

std::vector<Vec3> vertex_normals(const std::vector<Triangle>& triangles, const std::vector<Vec3>& positions) {
  std::vector<Vec3> normals(positions.size(), Vec3::Zero());
  for (const Triangle& t : triangles) {
    const Vec3 &a = positions[static_cast<std::size_t>(t[0])], &b = positions[static_cast<std::size_t>(t[1])],
               &c = positions[static_cast<std::size_t>(t[2])];
    const Vec3 area = (b - a).cross(c - a);
    for (const int v : t) normals[static_cast<std::size_t>(v)] += area;
  }
  for (Vec3& n : normals) {
    const double length = n.norm();
    n = length > 0 ? Vec3(n / length) : Vec3(0, 1, 0);
  }
  return normals;
}

}  // namespace drape
