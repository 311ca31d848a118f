#include "mesh/obj/obj_groups.h"

#include <algorithm>

#include "mesh/obj/obj_notes.h"
#include "mesh/obj/obj_scan.h"

namespace drape::internal {
namespace {

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

// For every face whether it stands under the name.
std::vector<char> faces_under(const ObjDocument& document, const std::string& name) {
  obj::Groups groups;
  for (const ObjStatement& statement : document.statements) {
    std::string_view rest = statement.text;
    const std::string_view keyword = obj::next_word(rest);
    if (keyword == "g" || keyword == "o")
      groups.read(keyword, rest.substr(0, obj::comment_start(rest)), statement.before_face);
  }
  return groups.faces_under(name, document.face_count());
}

std::vector<int> triangles_between(const TriangleMesh& mesh, const std::string& name) {
  std::vector<char> inside(mesh.positions.size(), 0);
  for (const VertexGroup& group : mesh.groups)
    if (group.name == name)
      for (int v : group.vertices) inside[static_cast<std::size_t>(v)] = 1;
  std::vector<int> found;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle& corners = mesh.triangles[static_cast<std::size_t>(t)];
    if (std::all_of(corners.begin(), corners.end(),
                    [&](int v) { return inside[static_cast<std::size_t>(v)] != 0; }))
      found.push_back(t);
  }
  return found;
}

}  // namespace

std::vector<std::size_t> faces_of_triangles(const TriangleMesh& mesh) {
  const ObjDocument& document = *mesh.document;
  std::vector<std::size_t> faces;
  faces.reserve(mesh.triangles.size());
  for (std::size_t f = 0; f < document.face_count(); ++f) {
    const ObjCorner* const corners = document.corners.data() + document.face_start[f];
    const std::size_t count = document.face_start[f + 1] - document.face_start[f];
    faces.insert(faces.end(), triangles_of(mesh.triangles, faces.size(), corners, count), f);
  }
  return faces;
}

std::vector<int> triangles_of_group(const TriangleMesh& mesh, const std::string& name) {
  if (!mesh.document) return triangles_between(mesh, name);
  const std::vector<char> under = faces_under(*mesh.document, name);
  const std::vector<std::size_t> faces = faces_of_triangles(mesh);
  std::vector<int> found;
  for (std::size_t t = 0; t < faces.size(); ++t)
    if (under[faces[t]]) found.push_back(static_cast<int>(t));
  return found;
}

}  // namespace drape::internal
