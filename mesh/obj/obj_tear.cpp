#include "mesh/obj/obj_tear.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "mesh/obj/obj_groups.h"
#include "mesh/obj/obj_notes.h"
#include "mesh/obj/obj_scan.h"

namespace drape {
namespace {

// The number that the torn triangle t has for vertex v of the mesh; nothing when v is none of its corners.
std::optional<int> torn_vertex(const TriangleMesh& mesh, const TornTriangles& torn, std::size_t t, int v) {
  for (std::size_t k = 0; k < 3; ++k)
    if (mesh.triangles[t][k] == v) return torn.triangles[t][k];
  return std::nullopt;
}

// Lines of the document, moved to one side of the cuts.
class TornLines {
 public:
  TornLines(const TriangleMesh& mesh, const TornTriangles& torn) : mesh_(mesh), torn_(torn) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        sides_.push_back({mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3], t});
    std::sort(sides_.begin(), sides_.end());
  }

  // The statement as one or several 'l' lines: a new one begins where the next edge lies on another side of a
  // cut.
  std::vector<std::string> of(std::string_view statement) const {
    std::string_view rest = statement;
    internal::obj::next_word(rest);
    std::vector<std::string> lines;
    int end = -1,
        before = -1;  // the last vertex that was written, and the vertex of the mesh that it stands for
    std::string_view word_before;
    for (std::string_view word = internal::obj::next_word(rest); !word.empty();
         word = internal::obj::next_word(rest)) {
      const int v = vertex(word);
      if (before < 0) {
        end = v;
      } else {
        const auto [from, to] = ends(before, v, end);
        if (lines.empty() || from != end) lines.push_back("l" + renamed(word_before, from));
        lines.back() += renamed(word, to);
        end = to;
      }
      before = v, word_before = word;
    }
    if (lines.empty()) lines.emplace_back(statement);
    return lines;
  }

 private:
  using Side = std::tuple<int, int, std::size_t>;  // from, to, triangle

  static int vertex(std::string_view word) {
    int v = 0;
    std::from_chars(word.data(), word.data() + word.size(), v);
    return v - 1;
  }
  static std::string renamed(std::string_view word, int vertex) {
    return " " + std::to_string(vertex + 1) + std::string(word.substr(std::min(word.find('/'), word.size())));
  }
  const Side* side(int from, int to) const {
    const auto found = std::lower_bound(sides_.begin(), sides_.end(), Side{from, to, 0});
    const bool there = found != sides_.end() && std::get<0>(*found) == from && std::get<1>(*found) == to;
    return there ? &*found : nullptr;
  }
  // The vertices at the ends of the edge from u to v, on the side that the line goes with. Where no triangle
  // has this edge, the line goes on from `end` and to v itself.
  std::pair<int, int> ends(int u, int v, int end) const {
    const Side* found = side(u, v);
    if (!found) found = side(v, u);
    if (!found) return {end, v};
    const std::size_t t = std::get<2>(*found);
    return {*torn_vertex(mesh_, torn_, t, u), *torn_vertex(mesh_, torn_, t, v)};
  }

  const TriangleMesh& mesh_;
  const TornTriangles& torn_;
  std::vector<Side> sides_;
};

// The faces of the document with the vertices of the torn triangles.
class TornFaces {
 public:
  TornFaces(const TriangleMesh& mesh, const TornTriangles& torn) : mesh_(mesh), torn_(torn) {
    const std::vector<std::size_t> face = internal::faces_of_triangles(mesh);
    std::size_t next = 0;
    for (std::size_t f = 0; f < mesh.document->face_count(); ++f) {
      first_face_.push_back(start_.size() - 1);
      const std::size_t first = next;
      while (next < face.size() && face[next] == f) ++next;
      if (!add_whole(f, first, next))
        for (std::size_t t = first; t < next; ++t) add_triangle(f, t);
    }
    first_face_.push_back(start_.size() - 1);
  }

  void put_into(ObjDocument& document) const {
    document.corners = corners_;
    document.face_start = start_;
    for (ObjStatement& statement : document.statements)
      statement.before_face = first_face_[statement.before_face];
  }

 private:
  // Adds face f, of the triangles [first, last), as it is. Does nothing and returns false where one of its
  // corners would be two vertices.
  bool add_whole(std::size_t f, std::size_t first, std::size_t last) {
    const ObjDocument& document = *mesh_.document;
    const std::size_t before = corners_.size();
    for (std::size_t k = document.face_start[f]; k < document.face_start[f + 1]; ++k) {
      ObjCorner corner = document.corners[k];
      std::optional<int> vertex;
      for (std::size_t t = first; t < last; ++t) {
        const std::optional<int> here = torn_vertex(mesh_, torn_, t, corner.v);
        if (here && vertex && *here != *vertex) {
          corners_.resize(before);
          return false;
        }
        if (here) vertex = here;
      }
      corner.v = vertex.value_or(corner.v);
      corners_.push_back(corner);
    }
    start_.push_back(corners_.size());
    return true;
  }

  void add_triangle(std::size_t f, std::size_t t) {
    const ObjDocument& document = *mesh_.document;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto has = [&](const ObjCorner& c) { return c.v == mesh_.triangles[t][k]; };
      const auto begin = document.corners.begin() + static_cast<std::ptrdiff_t>(document.face_start[f]);
      ObjCorner corner = *std::find_if(begin, document.corners.end(), has);
      corner.v = torn_.triangles[t][k];
      corners_.push_back(corner);
    }
    start_.push_back(corners_.size());
  }

  const TriangleMesh& mesh_;
  const TornTriangles& torn_;
  std::vector<ObjCorner> corners_;
  std::vector<std::size_t> start_ = {0};
  std::vector<std::size_t> first_face_;  // of the faces that a face of the document has become
};

ObjDocument torn_document(const TriangleMesh& mesh, const TornTriangles& torn) {
  ObjDocument document = *mesh.document;
  if (!document.vertex_extras.empty())
    for (const int v : torn.copy_of) document.vertex_extras.push_back(std::string(document.vertex_extras[v]));
  TornFaces(mesh, torn).put_into(document);
  const TornLines lines(mesh, torn);
  std::vector<ObjStatement> statements = std::exchange(document.statements, {});
  for (ObjStatement& statement : statements) {
    std::string_view rest = statement.text;
    if (internal::obj::next_word(rest) != "l") {
      document.statements.push_back(std::move(statement));
      continue;
    }
    for (std::string& line : lines.of(statement.text))
      document.statements.push_back({statement.before_face, std::move(line), statement.before_vertices});
  }
  return document;
}

// The groups of the mesh, by the faces and lines of its torn document where that has them.
std::vector<VertexGroup> torn_groups(const TriangleMesh& mesh, const TriangleMesh& torn,
                                     const std::vector<int>& copy_of) {
  std::vector<VertexGroup> of_document;
  if (torn.document) {
    internal::obj::Groups read;
    for (const ObjStatement& statement : torn.document->statements) {
      std::string_view rest = statement.text;
      const std::string_view keyword = internal::obj::next_word(rest);
      if (keyword == "g" || keyword == "o")
        read.read(keyword, rest.substr(0, internal::obj::comment_start(rest)), statement.before_face);
    }
    of_document = read.collect(*torn.document, polylines(torn), torn.vertex_count());
  }
  std::vector<VertexGroup> groups = mesh.groups;
  for (VertexGroup& group : groups) {
    const auto same = [&](const VertexGroup& other) { return other.name == group.name; };
    const auto found = std::find_if(of_document.begin(), of_document.end(), same);
    if (found != of_document.end()) {
      group.vertices = found->vertices;
      continue;
    }
    const std::vector<int> before = group.vertices;
    for (std::size_t k = 0; k < copy_of.size(); ++k)
      if (std::binary_search(before.begin(), before.end(), copy_of[k]))
        group.vertices.push_back(mesh.vertex_count() + static_cast<int>(k));
  }
  return groups;
}

}  // namespace

TornMesh tear(const TriangleMesh& mesh, const std::vector<CutEdge>& cuts) {
  return torn_mesh(mesh, torn_triangles(mesh, cuts));
}

TornMesh torn_mesh(const TriangleMesh& mesh, TornTriangles torn) {
  if (torn.copy_of.empty()) return {mesh, {}};
  TornMesh result{mesh, torn.copy_of};
  for (const int v : torn.copy_of) result.mesh.positions.push_back(mesh.positions[v]);
  if (mesh.document) result.mesh.document = std::make_shared<const ObjDocument>(torn_document(mesh, torn));
  result.mesh.triangles = std::move(torn.triangles);
  result.mesh.groups = torn_groups(mesh, result.mesh, torn.copy_of);
  return result;
}

}  // namespace drape
