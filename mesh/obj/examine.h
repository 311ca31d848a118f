// Examines a mesh before it is simulated: counts, size, and defects with their places. A defect is a
//   refusal   nothing can be simulated: no triangle has an area, or a position is not finite
//   warning   the mesh will be simulated; the message says how
//   note      there is nothing to worry about
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"

namespace drape {

enum class Severity { note, warning, refusal };

struct Defect {
  Severity severity;
  std::string what;           // one line: what it is, how many there are, and what will be done or what to do
  std::vector<int> vertices;  // those concerned, from 0, ascending; the printed line names the first few
};

struct MeshReport {
  int vertices = 0, triangles = 0, faces = 0, edges = 0, diagonals = 0, boundary_loops = 0;
  int pieces = 0;                                   // connected parts that have triangles
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();  // m, box of the vertices that belong to a triangle
  double area = 0;                                  // m^2
  double shortest_edge = 0, median_edge = 0, longest_edge = 0;  // m
  double smallest_angle = 0;                                    // rad
  bool closed = false;  // true when every edge has exactly two triangles, wound consistently
  std::vector<Defect> defects;

  bool refused() const;  // true when one of the defects is a refusal
  Eigen::AlignedBox3d box() const { return {lower, upper}; }
};

// Vertices at exactly the same place are no defect of a mesh that will be welded, nor are those that will be
// sewn together.
MeshReport examine(const TriangleMesh& mesh, bool will_be_welded = false, const std::vector<int>& sewn = {});

std::string format(const Defect& defect);  // "warning: 3 vertices ... (vertices 4, 9 and 11)"

}  // namespace drape
