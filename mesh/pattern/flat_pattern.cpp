#include "mesh/pattern/flat_pattern.h"

#include <algorithm>

#include "mesh/obj/obj.h"
#include "mesh/obj/obj_scan.h"
#include "mesh/triangles/topology.h"

namespace drape {

using namespace internal;

namespace {

[[noreturn]] void fail(std::size_t face, const std::string& what) {
  throw InputError("rest = \"uv\": face " + std::to_string(face + 1) + " of the file " + what);
}

std::vector<Vec3> texture_points(const ObjDocument& document, double scale) {
  std::vector<Vec3> points(document.texcoords.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    std::string_view rest = document.texcoords[k];
    points[k] = Vec3::Zero();
    for (int c = 0; c < 2; ++c)
      if (obj::parse_number(obj::next_word(rest), points[k][c]) != obj::Number::good)
        throw InputError("rest = \"uv\": texture coordinate " + std::to_string(k + 1) + " of the file (vt " +
                         std::string(document.texcoords[k]) + ") is not two numbers");
    points[k] *= scale;
  }
  return points;
}

// How many triangles the reader made of a face: two fewer than it has corners, and fewer still where corners
// repeat.
std::size_t triangles_of(const std::vector<Triangle>& triangles, std::size_t first, const ObjCorner* corners,
                         std::size_t count) {
  const auto has = [&](int v) {
    return std::any_of(corners, corners + count, [&](const ObjCorner& c) { return c.v == v; });
  };
  std::size_t made = 0;
  while (made + 2 < count && first + made < triangles.size() &&
         std::all_of(triangles[first + made].begin(), triangles[first + made].end(), has))
    ++made;
  return made;
}

}  // namespace

TriangleMesh flat_pattern(const TriangleMesh& mesh, double scale) {
  if (!mesh.document || mesh.document->texcoords.empty())
    throw InputError(
        "rest = \"uv\": the file has no texture coordinates ('vt' lines): there is no flat pattern in it");
  const ObjDocument& document = *mesh.document;
  TriangleMesh flat;
  flat.positions = texture_points(document, scale);
  flat.triangles.reserve(mesh.triangles.size());
  for (std::size_t f = 0; f < document.face_count(); ++f) {
    const ObjCorner* const corners = document.corners.data() + document.face_start[f];
    const std::size_t count = document.face_start[f + 1] - document.face_start[f];
    const std::size_t first = flat.triangles.size();
    for (std::size_t made = triangles_of(mesh.triangles, first, corners, count); made > 0; --made) {
      const Triangle& t = mesh.triangles[flat.triangles.size()];
      Triangle uv;
      for (std::size_t k = 0; k < 3; ++k) {
        uv[k] = std::find_if(corners, corners + count, [&](const ObjCorner& c) { return c.v == t[k]; })->vt;
        if (uv[k] < 0) fail(f, "has a corner without a texture coordinate");
      }
      if (triangle_area(flat, uv) == 0 && triangle_area(mesh, t) > 0)
        fail(f, "has no area in its texture coordinates: it would shrink to nothing");
      flat.triangles.push_back(uv);
    }
  }
  return flat;
}

}  // namespace drape
