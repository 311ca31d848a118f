// Meshes made from numbers. They are deterministic, consistently wound, and have no document.
#pragma once

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

// A grid of nx x nz vertices over width x depth [m] in the plane y = 0, centred on the origin, numbered
// with x fastest, with normals up (+y). The diagonals of the cells alternate (union jack), so the sheet has
// no preferred diagonal.
TriangleMesh grid(int nx, int nz, double width, double depth);

// Rows of equilateral triangles with edges of length `edge` [m]: like grid, but every second row is shifted
// by half a cell.
TriangleMesh equilateral_sheet(int nx, int nz, double edge);

// Rings of vertices around a centre, in the plane y = 0, with normals up; radius in m.
TriangleMesh disc(int rings, double radius);

// A closed sphere of this radius [m]: an icosahedron, subdivided `subdivisions` times and projected, with
// normals outwards.
TriangleMesh sphere(int subdivisions, double radius);

// An open cylinder along y, centred, of `around` x `along` vertices, with normals outwards; radius and height
// in m.
TriangleMesh tube(int around, int along, double radius, double height);

// A closed box along the axes with these edge lengths [m], centred: eight vertices, normals outwards.
TriangleMesh box(const Vec3& size);

// The outline of a turned body: points (radius, height) [m].
using Outline = std::vector<Eigen::Vector2d>;

// Adds the points of an arc about `centre`, from one angle to another [rad, counted from the outwards radius
// upwards]. An end of the arc on the axis is set exactly on it. A first point that the outline ends with
// already is not repeated.
void add_arc(Outline& outline, const Eigen::Vector2d& centre, double radius, double from, double to,
             int pieces);

// A closed surface made by turning the outline about y, with `around` vertices in each ring. The outline,
// (radius, height) [m], begins and ends on the axis and has the outside on its right.
TriangleMesh turned(const Outline& outline, int around);

// A cylinder along y of this length [m], centred, between two half balls of this radius [m], with normals
// outwards. `around` is a multiple of 4.
TriangleMesh capsule(int around, double radius, double length);

// A hemispherical shell about the origin that opens upwards (+y), with this inner radius [m] and thickness
// [m] and a rounded rim; the normals point out of the material. `around` is a multiple of 4.
TriangleMesh bowl(int around, double radius, double thickness);

}  // namespace drape
