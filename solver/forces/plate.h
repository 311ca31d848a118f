// Bending without a clamp: a plate that knows no stretch, on any mesh of triangles.
//   E = 1/2 int (D_11 |x_uu|^2 + 2 D_12 x_uu . x_vv + D_22 |x_vv|^2 + 4 D_66 |x_uv|^2) du dv
// u and v [m] run along warp and weft of the rest shape, which is flat. Where cloth bends without stretching,
// |x_uu| is the curvature along u, so E is the bending energy; and E is quadratic in the positions
//                                     [Bergou et al. 2006; Wardetzky et al. 2007], so that its stiffness is constant:
//   E = 1/2 sum over pairs k_ij |x_i - x_j|^2
//
// The sum is that of Morley's element [Morley 1968]: x is quadratic in every triangle; besides its values at
// the corners it has one slope at the middle of each edge, the same in both triangles. The slope is no unknown
// here: it is what a quadratic function through the vertices around the edge has there. As every choice of the
// slope gives at least the energy of Morley's element, and this one gives just that energy wherever x is
// quadratic, constant curvature costs what it should in every direction and is in equilibrium away from borders;
// and no bending is free. (Where three rings of triangles have too few vertices for a quadratic function, as in a
// strip of one row, the slope is that between the two triangles.) At a border no moment is transmitted: the slope there is the one of least energy.
// D [N m], k [N/m].
//
// A plate may rest bent. In a triangle, E is 1/2 d . Z d, where the vectors d are how far the slopes of the edges are
// from its own (plate.cpp). Where it rests with slopes d_0 that is 1/2 (d - R d_0) . Z (d - R d_0): R turns with the
// triangle (solver/forces/plate_force.h). Against the energy above this adds a linear function of the positions in
// the triangle's own axes.
#pragma once

#include <vector>

#include "mesh/triangles/triangle_mesh.h"
#include "solver/forces/rest_corners.h"

namespace drape {

struct PlateStiffness {
  double warp, weft, cross, twist;  // D_11, D_22, D_12 and D_66 [N m]
};

struct PlatePair {
  int i, j;  // vertices, i < j
  double k;  // N/m; also negative
};

// A triangle that rests bent: its energy is that of the pairs + energy - sum_v x_v . R force_v.
struct BentTriangle {
  struct Pull {
    int vertex;
    Vec3 force;  // N, in the triangle's axes; their sum is zero
  };
  std::array<int, 3> corners;
  Eigen::Matrix<double, 3, 2> weights;  // of the slopes (solver/forces/rest_corners.h)
  std::vector<Pull> pulls;
  double energy;  // J
};

// One entry for each pair of vertices, sorted.
std::vector<PlatePair> summed(std::vector<PlatePair> pairs);

// A part of the energy, E = 1/2 sum_kl Z_kl d_k . d_l, with the vectors (d_0, d_1, d_2) = sum over shares of x_v weights^T.
// The parts together are the pairs; what rests bent is not among them.
struct PlatePart {
  struct Share {
    int vertex;
    Vec3 weights;  // 1/m; their sum over the shares is zero
  };
  std::vector<Share> shares;
  Mat3 stiffness = Mat3::Zero();  // Z [N m]
};

struct PlateEnergy {
  std::vector<PlatePair> pairs;    // sorted by (i, j)
  std::vector<PlatePart> parts;    // the same energy, triangle by triangle or hinge by hinge
  std::vector<BentTriangle> bent;  // empty where the plate rests flat
  // Sums over the pairs of |k| d [N] and of |k| d^2 [J], with d [m] the distance of the pair in the mesh: how large the
  // terms of the energy are that cancel where cloth is flat.
  double pull = 0, size = 0;
};
void measure_pairs(const TriangleMesh& mesh, PlateEnergy& energy);  // sets these two

// corners[t] are those of triangle t of the mesh, vertex by vertex; each triangle may have an origin of its
// own. rest_angle: the share of the mesh's own curvature with which the plate rests; 0 is flat, 1 the mesh as it is.
// Edges of more than two triangles and of slivers (height below 1e-4 of the longest edge) bend freely.
PlateEnergy plate_energy(const TriangleMesh& mesh, const std::vector<RestCorners>& corners,
                         const PlateStiffness& stiffness, double rest_angle = 0);

// The curvature of a triangle of the plate: (x_uu, x_vv, 2 x_uv) = sum over shares of x_v weights^T, with which its
// energy is A / 2 (D_11 |x_uu|^2 + ...).
struct PlateCurvature {
  struct Share {
    int vertex;
    Vec3 weights;  // 1/m^2
  };
  int number;  // of the triangle in the mesh
  std::array<int, 3> corners;
  Eigen::Matrix<double, 3, 2> slopes;  // weights of the slopes (solver/forces/rest_corners.h)
  double area;                         // m^2
  std::vector<Share> shares;           // the corners among them
};

// Of the triangles that bend, ascending.
std::vector<PlateCurvature> plate_curvatures(const TriangleMesh& mesh,
                                             const std::vector<RestCorners>& corners,
                                             const PlateStiffness& stiffness);

}  // namespace drape
