// What the tests of the OBJ reader and writer share: small files, what stays in a round trip, measures.
#pragma once

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "mesh/obj/obj.h"
#include "mesh/triangles/topology.h"

namespace drape::test {

inline const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
inline const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

inline void require_same(const TriangleMesh& one, const TriangleMesh& two) {
  REQUIRE(one.positions == two.positions);
  REQUIRE(one.triangles == two.triangles);
  REQUIRE(one.groups.size() == two.groups.size());
  for (std::size_t g = 0; g < one.groups.size(); ++g) {
    REQUIRE(one.groups[g].name == two.groups[g].name);
    REQUIRE(one.groups[g].vertices == two.groups[g].vertices);
  }
  const ObjDocument &a = *one.document, &b = *two.document;
  REQUIRE(a.vertex_extras == b.vertex_extras);
  REQUIRE(a.texcoords == b.texcoords);
  REQUIRE(a.face_start == b.face_start);
  REQUIRE(a.statements == b.statements);
  REQUIRE(a.corners.size() == b.corners.size());
  for (std::size_t k = 0; k < a.corners.size(); ++k) {
    REQUIRE(a.corners[k].v == b.corners[k].v);
    REQUIRE(a.corners[k].vt == b.corners[k].vt);
    REQUIRE((a.corners[k].vn < 0) == (b.corners[k].vn < 0));
  }
}

inline void require_round_trip(const std::string& text) {
  const TriangleMesh first = parse_obj(text, "first.obj");
  const std::string written = format_obj(first, first.positions);
  const TriangleMesh second = parse_obj(written, "second.obj");
  require_same(first, second);
  REQUIRE(second.document->warnings.size() <= first.document->warnings.size());
  REQUIRE(format_obj(second, second.positions) == written);
}

inline std::vector<int> group(const TriangleMesh& mesh, const std::string& name) {
  for (const VertexGroup& g : mesh.groups) {
    if (g.name == name) return g.vertices;
  }
  return {};
}

inline double area_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) sum += triangle_area(mesh, t);
  return sum;
}

}  // namespace drape::test
