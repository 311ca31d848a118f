// The slopes of a plate across its edges (solver/forces/plate.h): at the middle of each edge between two
// triangles, what a quadratic function through the vertices around the edge has there.
#pragma once

#include <optional>
#include <vector>

#include "mesh/triangles/topology.h"
#include "solver/forces/rest_corners.h"

namespace drape::internal {

// A linear function of what stands at the vertices, such as a slope: the sum of weight times value.
struct Functional {
  std::vector<int> vertices;
  std::vector<double> weights;

  void add(int vertex, double weight);
};

class PlateSlopes {
 public:
  // Keeps references to both. corners[t] are those of triangle t at rest, vertex by vertex.
  PlateSlopes(const TriangleMesh& mesh, const std::vector<RestCorners>& corners);

  // Hinges that join two triangles with area and are the only one of their edge; the others bend freely.
  const std::vector<Hinge>& hinges() const { return hinges_; }
  const std::vector<int>& hinges_of(int t) const { return around_[static_cast<std::size_t>(t)]; }

  const Triangle& triangle(int t) const { return mesh_.triangles[static_cast<std::size_t>(t)]; }
  const Eigen::Vector2d& at_rest(int t, int vertex) const {
    return corners_[static_cast<std::size_t>(t)][corner(t, vertex)];
  }
  bool bends(int t) const;                          // false of a sliver
  double height(int t, int a, int b, int c) const;  // m, of c above the edge from a to b

  // The slope at the middle of the hinge's edge, across it and into the triangle of c.
  Functional slope(const Hinge& hinge) const;
  // Adds `factor` times the slope of the linear function in the triangle, from the edge of the hinge inward.
  void add_inward(int t, const Hinge& hinge, double factor, Functional& slope) const;

 private:
  // How the corner across from an edge lies over it.
  struct Apex {
    double l, foot,
        height;  // m: the edge, and of the corner its foot from the middle of the edge and its height
  };
  // A triangle and where its corners are in the plane of an edge.
  struct Placed {
    int triangle;
    std::array<Eigen::Vector2d, 3> at;
  };

  std::size_t corner(int t, int vertex) const;
  Apex apex(int t, int a, int b, int c) const;
  void find_neighbours();
  Placed unfolded(const Hinge& hinge, const Placed& known) const;
  void grow(std::vector<Placed>& patch) const;
  std::optional<Functional> quadratic_slope(const std::vector<Placed>& patch, double unit) const;

  const TriangleMesh& mesh_;
  const std::vector<RestCorners>& corners_;
  std::vector<Hinge> hinges_;
  std::vector<std::vector<int>> around_;  // triangle -> its hinges
};

}  // namespace drape::internal
