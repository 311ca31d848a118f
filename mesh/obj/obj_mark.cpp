#include "mesh/obj/obj_mark.h"

#include "mesh/obj/obj_groups.h"
#include "mesh/obj/obj_notes.h"
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

// The 'g' line that holds where faces are read in order.
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
    if (keyword == "o" && since_ != statement.before_face) text_ = none();
    return keyword == "o";
  }
  static std::string none() { return "g " + std::string(internal::obj::no_group); }

 private:
  std::string text_ = none();
  std::size_t since_ = 0;  // the face before which it stands
};

// The statement without this name, if it is a 'g' line that has it.
ObjStatement without(ObjStatement statement, const std::string& name) {
  std::string_view rest = statement.text;
  if (internal::obj::next_word(rest) != "g") return statement;
  rest = rest.substr(0, internal::obj::comment_start(rest));
  std::string others = "g";
  bool has = false;
  for (std::string_view word = internal::obj::next_word(rest); !word.empty();
       word = internal::obj::next_word(rest)) {
    has = has || word == name;
    if (word != name) (others += ' ') += word;
  }
  if (has) statement.text = others == "g" ? GroupLine::none() : others;
  return statement;
}

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
  std::vector<ObjStatement> as_read = std::move(document.statements);
  for (ObjStatement& statement : as_read) statement = without(std::move(statement), name);
  document.statements.clear();
  GroupLine outside;
  std::size_t next = 0;
  for (std::size_t f = 0; f < in.size(); ++f) {
    const bool was_in = f > 0 && in[f - 1];
    const bool other = next < as_read.size() && as_read[next].before_face == f;
    if (was_in && (other || !in[f])) document.statements.push_back({f, outside.text()});
    for (; next < as_read.size() && as_read[next].before_face == f; ++next) {
      document.statements.push_back(as_read[next]);
      if (outside.read(as_read[next]) && was_in) document.statements.push_back({f, outside.text()});
    }
    if (in[f] && (other || !was_in)) document.statements.push_back({f, "g " + name});
  }
  return document;
}

}  // namespace drape
