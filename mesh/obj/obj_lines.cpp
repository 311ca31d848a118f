// The named lines of an OBJ file: curves of a sewing pattern, seams and the like. See obj.h.
#include <charconv>

#include "mesh/obj/obj.h"
#include "mesh/obj/obj_notes.h"
#include "mesh/obj/obj_scan.h"

namespace drape {

using namespace internal;

std::vector<Polyline> polylines(const TriangleMesh& mesh) {
  std::vector<Polyline> lines;
  if (!mesh.document) return lines;
  std::string group, object;
  for (const ObjStatement& statement : mesh.document->statements) {
    std::string_view rest = statement.text;
    const std::string_view keyword = obj::next_word(rest);
    if (keyword == "g" || keyword == "o") {
      rest = obj::trim(rest.substr(0, obj::comment_start(rest)));
      if (keyword == "o") object = rest;
      group = keyword == "g" && rest != obj::no_group ? obj::next_word(rest) : std::string_view();
    }
    if (keyword != "l") continue;
    Polyline line{group.empty() ? object : group, {}};
    for (std::string_view word = obj::next_word(rest); !word.empty(); word = obj::next_word(rest)) {
      int v = 0;  // the reader has checked and written this number; "v/vt" stops at the slash
      std::from_chars(word.data(), word.data() + word.size(), v);
      line.vertices.push_back(v - 1);
    }
    const bool goes_on = !lines.empty() && lines.back().name == line.name && !line.vertices.empty() &&
                         !lines.back().vertices.empty() &&
                         lines.back().vertices.back() == line.vertices.front();
    if (goes_on) {
      lines.back().vertices.insert(lines.back().vertices.end(), line.vertices.begin() + 1,
                                   line.vertices.end());
    } else {
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

TriangleMesh line_mesh(const std::vector<Vec3>& points, const std::string& name) {
  TriangleMesh mesh;
  mesh.positions = points;
  ObjDocument document;
  document.face_start.push_back(0);
  std::string line = "l";
  for (std::size_t k = 1; k <= points.size(); ++k) (line += ' ') += std::to_string(k);
  document.statements.push_back({0, "o " + name});
  document.statements.push_back({0, std::move(line)});
  mesh.document = std::make_shared<const ObjDocument>(std::move(document));
  return mesh;
}

}  // namespace drape
