// A garment's mesh before it is sewn: its panels are placed in space, and its lines say what is sewn to what.
//   A panel is a group of the mesh's vertices, flat in the plane z = 0. The middle of its box is brought to
//   the origin. With `wrap` the plane is then wrapped round the y axis, x -> (r sin(x/r), y, r cos(x/r)) with
//   the radius r = wrap + z. At last x -> rotation x + translate.                                        [m]
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/obj/obj.h"
#include "mesh/pattern/pattern.h"

namespace drape {

struct PanelPlace {
  std::string group;                // of the mesh
  std::optional<double> wrap = {};  // m, the radius of the cylinder; unset: it stays flat
  Mat3 rotation = Mat3::Identity();
  Vec3 translate = Vec3::Zero();  // m
  std::string where = {};         // stands in messages: "scene.toml:12"
};

// Moves the vertices of these panels; all others stay. Returns how wide each panel was along x [m]. Throws
// InputError when the mesh has no such group, the group is a line, or two panels share a vertex.
std::vector<double> place_panels(TriangleMesh& mesh, const std::vector<PanelPlace>& panels);

// The seams that the mesh declares in comments of its file, as triangulate() and `drape triangulate` write
// them: "# seam A B", or "# seam A B same" where both lines run the same way.
std::vector<Seam> declared_seams(const TriangleMesh& mesh);

// The vertices of a seam's two lines, pair by pair along the seam; where the lines meet, the two vertices of
// a pair are the same. Throws InputError when a line is missing or in several pieces, or when the two lines
// have different numbers of vertices.
std::vector<std::pair<int, int>> seam_pairs(const std::vector<Polyline>& lines, const Seam& seam);

}  // namespace drape
