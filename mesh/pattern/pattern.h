// A sewing pattern: flat panels, their named curves, and which of these curves are sewn together. Lengths are
// in m.
//   A loop or a line is a chain of segments. A segment may have a name; consecutive segments with the same
//   name form one curve, PANEL.NAME. The corners between segments are vertices of every mesh.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mesh/pattern/curve.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct Chain {
  std::vector<Segment> segments;   // end to end; in a loop the last one ends where the first one starts
  std::vector<std::string> names;  // one for each segment; empty for a segment without a name
  std::string where;               // its place for messages: "skirt.svg:12: path 'front'"
};

double enclosed_area(const Chain& loop);  // m^2, positive when the loop is counter-clockwise

struct Panel {
  std::string name;
  Chain outline;
  std::vector<Chain> holes, lines;  // lines are open chains inside the panel; edges of the mesh lie on them
  // Direction of the warp; not zero. Texture coordinates are places in the panel, turned so that the warp
  // runs along v. Unset: along y, so that nothing is turned.
  std::optional<Vec2> grain = {};
};

// Outlines are taken counter-clockwise and holes clockwise, whichever way they were drawn. So two curves that
// are sewn together run in opposite directions: the start of `a` meets the end of `b`, unless `same_way` is
// set.
struct Seam {
  std::string a, b;  // PANEL.NAME
  bool same_way = false;
  std::string where;
};

struct Pattern {
  std::vector<Panel> panels;
  std::vector<Seam> seams;
  std::string where;  // the file, for messages
};

struct TriangulateOptions {
  double edge = 0;  // m, the longest edge allowed; 0 stands for 1/40 of the square root of the area
  double min_angle = 28 * 3.14159265358979323846 / 180;  // rad
  double tolerance = 0;  // m, distance from the drawn curves; 0 stands for edge / 50
};

struct SharpCorner {
  std::string panel;
  Vec2 at;       // m
  double angle;  // rad
};

struct SeamReport {
  std::string a, b;
  int pairs;                  // pairs of vertices that are sewn together
  double length_a, length_b;  // m, lengths of the curves
};

struct PanelReport {
  std::string name;
  int vertices, triangles;
  double area;            // m^2, sum of the triangles
  double smallest_angle;  // rad
};

struct PatternMesh {
  TriangleMesh mesh;                // its document has groups, texture coordinates, and the curves as lines
  double edge, tolerance;           // m, the values used
  double longest_edge;              // m
  double smallest_angle;            // rad
  double smallest_angle_elsewhere;  // rad, not counting the triangles at sharp corners
  int below;  // number of triangles with an angle below the bound that are not at a sharp corner
  std::vector<PanelReport> panels;
  std::vector<SeamReport> seams;
  std::vector<SharpCorner> sharp;  // corners of the drawing that are sharper than the bound
};

// Throws InputError when outlines cross or touch themselves or each other, when a panel has no area, when a
// name is missing or occurs twice, when the edge is so short that there would be too many triangles, or when
// the smallest angle asked for cannot be guaranteed.
PatternMesh triangulate(const Pattern& pattern, const TriangulateOptions& options);

}  // namespace drape
