#include "mesh/pattern/flat_pattern.h"

#include <algorithm>

#include "mesh/obj/obj.h"
#include "mesh/obj/obj_groups.h"
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

// A triangle of the pattern is this much thinner than that of the mesh at most.
constexpr double thinnest = 1e-3;

// Area over the square of the longest edge: 0 where the corners are in a line, but for the rounding of their
// coordinates.
double shape(const TriangleMesh& mesh, const Triangle& t) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, (mesh.positions[static_cast<std::size_t>(t[k])] -
                                 mesh.positions[static_cast<std::size_t>(t[(k + 1) % 3])])
                                    .squaredNorm());
  const double area = triangle_area(mesh, t);
  return area > 1e-9 * longest ? area / longest : 0;
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
  const std::vector<std::size_t> faces = faces_of_triangles(mesh);
  for (std::size_t number = 0; number < faces.size(); ++number) {
    const std::size_t f = faces[number];
    const ObjCorner *const corners = document.corners.data() + document.face_start[f],
                           *const end = document.corners.data() + document.face_start[f + 1];
    const Triangle& t = mesh.triangles[number];
    Triangle uv;
    for (std::size_t k = 0; k < 3; ++k) {
      uv[k] = std::find_if(corners, end, [&](const ObjCorner& c) { return c.v == t[k]; })->vt;
      if (uv[k] < 0) fail(f, "has a corner without a texture coordinate");
    }
    if (const double of_mesh = shape(mesh, t); of_mesh > 0 && shape(flat, uv) < thinnest * of_mesh)
      fail(f, "has no area in its texture coordinates, or hardly any: it would shrink to nothing");
    flat.triangles.push_back(uv);
  }
  return flat;
}

}  // namespace drape
