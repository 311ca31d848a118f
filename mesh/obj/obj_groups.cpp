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

ObjDocument document_of_triangles(const TriangleMesh& mesh) {
  ObjDocument document;
  document.face_start.push_back(0);
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) document.corners.push_back({v});
    document.face_start.push_back(document.corners.size());
  }
  return document;
}

// The 'g' line that holds where faces are read in order. "default" is the format's own name for no group.
class GroupLine {
 public:
  const std::string& text() const { return text_; }
  // True for an 'o' line, which ends a group unless that begins there, too.
  bool read(const ObjStatement& statement) {
    std::string_view rest = statement.text;
    const std::string_view keyword = obj::next_word(rest);
    if (keyword == "g") {
      text_ = statement.text;
      since_ = statement.before_face;
    }
    if (keyword == "o" && since_ != statement.before_face) text_ = none;
    return keyword == "o";
  }

 private:
  static constexpr const char* none = "g default";
  std::string text_ = none;
  std::size_t since_ = 0;  // the face before which it stands
};

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

ObjDocument with_group(const TriangleMesh& mesh, const std::vector<int>& triangles, const std::string& name) {
  ObjDocument document = mesh.document ? *mesh.document : document_of_triangles(mesh);
  std::vector<char> in(document.face_count() + 1, 0);  // a last face that is none ends the last group
  if (mesh.document) {
    const std::vector<std::size_t> faces = faces_of_triangles(mesh);
    for (const int t : triangles) in[faces[t]] = 1;
  } else {
    for (const int t : triangles) in[t] = 1;
  }
  const std::vector<ObjStatement> as_read = std::move(document.statements);
  document.statements.clear();
  GroupLine outside;
  std::size_t next = 0;
  for (std::size_t f = 0; f < in.size(); ++f) {
    const bool was_in = f > 0 && in[f - 1];
    if (was_in && !in[f]) document.statements.push_back({f, outside.text()});
    bool other = !was_in;  // whether another line than ours holds before the face
    for (; next < as_read.size() && as_read[next].before_face == f; ++next) {
      document.statements.push_back(as_read[next]);
      if (outside.read(as_read[next]) && was_in) document.statements.push_back({f, outside.text()});
      other = true;
    }
    if (in[f] && other) document.statements.push_back({f, "g " + name});
  }
  return document;
}

}  // namespace drape::internal
