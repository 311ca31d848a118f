#include "mesh/obj/obj_mark.h"

#include "mesh/obj/obj_groups.h"
#include "mesh/obj/obj_scan.h"

namespace drape {
namespace {

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
    const std::string_view keyword = internal::obj::next_word(rest);
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

ObjDocument with_group(const TriangleMesh& mesh, const std::vector<int>& triangles, const std::string& name) {
  ObjDocument document = mesh.document ? *mesh.document : document_of_triangles(mesh);
  std::vector<char> in(document.face_count() + 1, 0);  // a last face that is none ends the last group
  if (mesh.document) {
    const std::vector<std::size_t> faces = internal::faces_of_triangles(mesh);
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

}  // namespace drape
