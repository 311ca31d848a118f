// The triangles of a surface, made ready for signed distances: each triangle occurs once, is joined to its
// neighbours, and is wound like them. Unclean input is mended. Triangles with a repeated vertex and second
// copies of a triangle are dropped. Triangles of zero area stay in the topology, because they close cracks,
// and stand after the others. A surface that is open as numbered is tried again with vertices of exactly
// equal position made one, as uv seams need.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape::internal {

struct Face {
  Triangle v;
  Triangle across;  // the face beyond edge v[k] v[k+1]; -1 when there is none or several
};

struct SurfaceFaces {
  std::vector<Face> faces;  // in the mesh's order; faces without an area come last, from with_area on
  int with_area = 0;
  bool closed = false;      // every edge has two faces, and the surface has two sides
  bool inside_out = false;  // closed, but a piece was wound with most of its normals inwards
};

// A side of a face, from v[side] to the next corner.
struct FaceSide {
  int low, high;  // its vertices
  int face, side;
};

// All sides, by their vertices, and those of one edge by their faces.
std::vector<FaceSide> sorted_sides(const std::vector<Face>& faces);

// Fills `across` of every face, whichever way the two are wound. Returns true when every edge has exactly two
// faces.
bool join(std::vector<Face>& faces);

// Throws InputError when no triangle has an area.
SurfaceFaces surface_faces(const TriangleMesh& mesh);

// The box of the triangles that have an area [m].
Eigen::AlignedBox3d box_of(const SurfaceFaces& surface, const std::vector<Vec3>& positions);

// Whether a triangle of these corners has an area beyond rounding.
bool has_area(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace drape::internal
