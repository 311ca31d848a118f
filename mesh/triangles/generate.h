// Meshes made from numbers: deterministic, consistently wound, without a document.
#pragma once

#include "mesh/triangles/triangle_mesh.h"

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

// Edge lengths [m], along the axes, centred: eight vertices, closed, normals out.
TriangleMesh box(const Vec3& size);

// Turned about y, `around` vertices in each ring, closed. The outline, (radius, height) [m], begins and ends
// on the axis and has the outside on its right.
TriangleMesh turned(const std::vector<Eigen::Vector2d>& outline, int around);

// A cylinder along y, centred, of this length [m] between two half balls; normals out. `around` is a multiple
// of 4.
TriangleMesh capsule(int around, double radius, double length);

// A hemispherical shell about the origin that opens upwards (+y), of this inner radius [m], with a rounded
// rim; normals out of the material. `around` is a multiple of 4.
TriangleMesh bowl(int around, double radius, double thickness);

}  // namespace drape
