// Patterns for the tests of triangulation, as TOML with lengths in cm, and what a mesh of one must be.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "app/pattern/pattern_read.h"
#include "mesh/obj/obj.h"
#include "mesh/pattern/pattern.h"
#include "mesh/triangles/topology.h"

namespace drape::test {

using namespace app;

constexpr double kDegree = std::numbers::pi / 180;

struct PatternCase {
  std::string name, text;
  double edge;       // m
  double area;       // m^2, of the exact drawing
  double perimeter;  // m, at least: what a deviation by the tolerance may change the area by
};

inline Pattern cm_pattern(const std::string& text) {
  return parse_toml_pattern("unit = \"1 cm\"\n" + text, "test.toml");
}

inline std::string star(int points, double inner, double outer) {
  std::string text = "[[panel]]\nname = \"star\"\noutline = [";
  for (int i = 0; i < 2 * points; ++i) {
    const double a = std::numbers::pi * i / points, r = i % 2 == 0 ? outer : inner;
    text += "[" + std::to_string(r * std::cos(a)) + ", " + std::to_string(r * std::sin(a)) + "],";
  }
  return text + "]\n";
}

inline std::vector<PatternCase> pattern_cases() {
  const double pi = std::numbers::pi;
  const std::string disc = "outline = [[10, 0], {arc = 10}, [-10, 0], {arc = 10}]\n";
  const double star_area = 1e-4 * 7 * 3 * 20 * std::sin(pi / 7);
  return {
      {"square", "[[panel]]\nname = \"square\"\noutline = [[0, 0], [20, 0], [20, 20], [0, 20]]\n", 0.02, 0.04,
       0.8},
      {"clockwise square",
       "[[panel]]\nname = \"s\"\noutline = [[0, 0], [0, 20], [20, 20], [20, 0], [0, 0]]\n", 0.013, 0.04, 0.8},
      {"disc", "[[panel]]\nname = \"disc\"\n" + disc, 0.02, 1e-4 * pi * 100, 0.63},
      {"annulus",
       "[[panel]]\nname = \"ring\"\n" + disc + "holes = [[[4, 0], {arc = 4}, [-4, 0], {arc = 4}]]\n", 0.02,
       1e-4 * pi * 84, 0.9},
      {"star", star(7, 3, 20), 0.015, star_area, 3},
      {"needles", star(5, 1, 20), 0.02, 1e-4 * 5 * 20 * std::sin(pi / 5), 2.5},
      {"dart",
       "[[panel]]\nname = \"dart\"\noutline = [[0, 0], [9, 0], [10, 12], [11, 0], [20, 0], [20, 20], [0, "
       "20]]\n"
       "sides = [\"-\", \"a\", \"b\", \"-\", \"-\", \"-\", \"-\"]\n[[seam]]\ncurves = [\"dart.a\", "
       "\"dart.b\"]\n",
       0.02, 1e-4 * (400 - 12), 1.2},
      {"dart as a hole with a line",
       "[[panel]]\nname = \"dart\"\noutline = [[0, 0], [20, 0], [20, 20], [0, 20]]\n"
       "holes = [[[10, 4], [10.7, 9], [10, 14], [9.3, 9]]]\n"
       "[[panel.line]]\nname = \"fold\"\npoints = [[2, 0], [2, 20]]\n"
       "[[panel.line]]\nname = \"grain\"\npoints = [[15, 5], {bezier = [[17, 10]]}, [15, 15]]\n",
       0.02, 1e-4 * (400 - 7), 1.2},
      {"L", "[[panel]]\nname = \"L\"\noutline = [[0, 0], [20, 0], [20, 5], [5, 5], [5, 20], [0, 20]]\n", 0.02,
       1e-4 * 175, 0.8},
      {"narrow strip", "[[panel]]\nname = \"strip\"\noutline = [[0, 0], [40, 0], [40, 0.4], [0, 0.4]]\n",
       0.02, 1e-4 * 16, 0.81},
      {"two panels, gathered",
       "[[panel]]\nname = \"a\"\noutline = [[0, 0], [20, 0], [20, 10], [0, 10]]\nsides = [\"-\", \"r\", "
       "\"top\", \"l\"]\n"
       "[[panel]]\nname = \"b\"\noutline = [[0, 15], [12, 15], {bezier = [[14, 20]]}, [12, 25], [0, 25]]\n"
       "sides = [\"low\", \"low\", \"-\", \"-\"]\n"
       "[[seam]]\ncurves = [\"a.top\", \"b.low\"]\n[[seam]]\ncurves = [\"a.l\", \"a.r\"]\nsame_way = true\n",
       0.015, 1e-4 * (200 + 120 + 20.0 / 3), 1.1},
  };
}

inline const std::vector<int>& curve(const std::vector<Polyline>& curves, const std::string& name) {
  for (const Polyline& c : curves)
    if (c.name == name) return c.vertices;
  throw std::runtime_error("no curve " + name);
}

// Fractions of the length of a curve at which its vertices are, and the length at the end.
inline std::vector<double> fractions(const TriangleMesh& mesh, const std::vector<int>& vertices) {
  std::vector<double> sums = {0};
  for (std::size_t i = 1; i < vertices.size(); ++i)
    sums.push_back(sums.back() + (mesh.positions[vertices[i]] - mesh.positions[vertices[i - 1]]).norm());
  for (double& s : sums) s /= sums.back();
  return sums;
}

}  // namespace drape::test
