// Normals of triangles and polygons, and the sums of them that are normals of vertices.
//   triangle  (b - a) x (c - a): as long as twice the area   [m^2]
//   polygon   N = 1/2 sum_i x_i x x_(i+1), Newell's: as long as the area   [m^2]
//   vertex    a sum over the corners of faces that meet there. Each caller chooses which corners count, and
//             how much, because the sums serve different ends:
//               mesh/obj/obj_write.cpp         Newell's, of the corners that shared a vn entry of the file
//               solver/assembly                by area, of all faces: vertex_normals()
//               app/export/faces.cpp           by area, of faces joined by edges that are not hard
//               app/picture/normals.cpp        by the angle at the corner, of faces that lean little away
//               mesh/distance/surface_pose.h   by the angle, of all faces: the sign tells inside from outside
//             (The page of `drape view` also sums by area, in the browser: app/view/web/src/normals.js.)
// A triangle without an area has the normal 0.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "mesh/base/vectors.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape {

inline Vec3 twice_area_normal(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - a); }

// The normal of the polygon with these corners (vertex numbers).
Vec3 newell_normal(const std::vector<Vec3>& positions, const int* corners, int count);

// Unit normals of the vertices, by area; 0 where no triangle has one.
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh);

// The angle [rad] between two directions of any length; it is also accurate where they are nearly parallel.
inline double angle_between(const Vec3& p, const Vec3& q) { return std::atan2(p.cross(q).norm(), p.dot(q)); }

}  // namespace drape
