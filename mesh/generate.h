// Meshes made from numbers: deterministic, consistently wound, without a document.
#pragma once

#include "mesh/triangle_mesh.h"

namespace drape {

// nx x nz vertices over width x depth [m] in the plane y = 0, centred on the origin, x fastest, normals up
// (+y); the diagonals of the cells alternate (union jack), so that the sheet has no preferred diagonal.
TriangleMesh grid(int nx, int nz, double width, double depth);

// Rows of equilateral triangles: as grid, every second row shifted by half a cell; edge length `edge` [m].
TriangleMesh equilateral_sheet(int nx, int nz, double edge);

// Rings of vertices around a centre, radius [m], in the plane y = 0, normals up.
TriangleMesh disc(int rings, double radius);

// Icosahedron subdivided `subdivisions` times and projected to the radius [m], closed, normals out.
TriangleMesh sphere(int subdivisions, double radius);

// Open cylinder along y, centred, `around` x `along` vertices, normals out.
TriangleMesh tube(int around, int along, double radius, double height);

}  // namespace drape
