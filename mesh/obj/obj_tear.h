// A mesh that is cut along some of its edges (mesh/triangles/tear.h), with its OBJ document: what is written
// then has the new borders.
//   Polygons stay whole unless a cut goes through them or ends in them so that a corner of theirs falls to
//   two vertices; those become their triangles. (Who reads the file cuts the whole ones into triangles anew,
//   perhaps along other diagonals.) Texture coordinates, materials and groups stay with the faces; the groups
//   of a mesh without a document take in the copies of their vertices.
//   A named line ('l') along a cut stays with one of the two sides: with the triangles on its left, seen from
//   the side to which the normals point, or where its edge has none there, with those on its right. Where a
//   cut crosses the line it ends, and begins again on the other side under the same name. Points ('p') stay
//   with the vertex that keeps its number.
#pragma once

#include "mesh/obj/obj.h"
#include "mesh/triangles/tear.h"

namespace drape {

struct TornMesh {
  TriangleMesh mesh;         // the copies of vertices come after the others
  std::vector<int> copy_of;  // the last copy_of.size() vertices are copies of these
};

TornMesh torn_mesh(const TriangleMesh& mesh, TornTriangles torn);
// Throws InputError when a cut is no edge of the mesh.
TornMesh tear(const TriangleMesh& mesh, const std::vector<CutEdge>& cuts);

}  // namespace drape
