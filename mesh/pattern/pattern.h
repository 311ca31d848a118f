// A sewing pattern: flat panels, their named curves, and which of these are sewn together.  [m]
//   A loop or a line is a chain of segments, each with a name or none. Consecutive segments of one name are
//   one curve, PANEL.NAME; the corners between segments are vertices of every mesh.
#pragma once

#include <string>
#include <vector>

#include "mesh/pattern/curve.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct Chain {
  std::vector<Segment> segments;   // end to end; of a loop the last ends where the first starts
  std::vector<std::string> names;  // one for each segment, empty: none
  std::string where;               // stands in messages: "skirt.svg:12: path 'front'"
};

double enclosed_area(const Chain& loop);  // m^2, positive counter-clockwise

struct Panel {
  std::string name;
  Chain outline;
  std::vector<Chain> holes, lines;  // lines are open, inside the panel: edges of the mesh lie on them
};

// Outlines are taken counter-clockwise and holes clockwise, however they were drawn. Along a seam two such
// curves run opposite ways: the start of `a` meets the end of `b`, unless `same_way`.
struct Seam {
  std::string a, b;  // PANEL.NAME
  bool same_way = false;
  std::string where;
};

struct Pattern {
  std::vector<Panel> panels;
  std::vector<Seam> seams;
  std::string where;  // the file
};

struct TriangulateOptions {
  double edge = 0;  // m, no edge is longer; 0: 1/40 of the square root of the area
  double min_angle = 28 * 3.14159265358979323846 / 180;  // rad
  double tolerance = 0;                                  // m, of curves; 0: edge / 50
};

struct SharpCorner {
  std::string panel;
  Vec2 at;       // m
  double angle;  // rad
};

struct SeamReport {
  std::string a, b;
  int pairs;                  // of vertices
  double length_a, length_b;  // m, of the curves
};

struct PanelReport {
  std::string name;
  int vertices, triangles;
  double area;            // m^2, of the triangles
  double smallest_angle;  // rad
};

struct PatternMesh {
  TriangleMesh mesh;                // with a document: groups, uv, curves as lines
  double edge, tolerance;           // m, as used
  double longest_edge;              // m
  double smallest_angle;            // rad
  double smallest_angle_elsewhere;  // rad, without the triangles at sharp corners
  int below;                        // triangles below the bound that are not at a sharp corner
  std::vector<PanelReport> panels;
  std::vector<SeamReport> seams;
  std::vector<SharpCorner> sharp;  // corners of the drawing that are sharper than the bound
};

// Throws InputError: outlines that cross or touch themselves or each other, no area, names that are not
// there or there twice, an edge too short for memory, an angle that cannot be promised.
PatternMesh triangulate(const Pattern& pattern, const TriangulateOptions& options);

}  // namespace drape
