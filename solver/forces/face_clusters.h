// Cloth whose faces are clusters (solver/forces/cluster.h): each triangle keeps its shape, in place of
// springs that stretch. Its corners are drawn to where a rigid triangle would have them that fits best:
//   g_i = c + R b_i,   F = sum x_i w_i^T,   E = A Y/2 |F - R|^2,   R = the polar factor of F (3x2, R^T R = 1)
// x_i [m]: the corners, c: their centre. b_i [m]: the corners at rest, in the plane of the triangle, from
// their centre. w_i [1/m]: the slopes of the linear functions that are 1 at a corner and 0 at the others, so
// that F takes b_i to x_i - c and is R where all are at their goals. A [m^2]: the area at rest. Y [N/m]: the
// stiffness of the fabric per width.
//
// How far the corners are off their goals is measured by the strain of the triangle, not by the sum of
// squares of Mueller et al. 2005, for the sake of what Y means: with the principal strains e_1, e_2 [-],
//   E / A = Y/2 (e_1^2 + e_2^2)
// on every triangle and in every direction. That is a membrane of Poisson's ratio 0: a strip that is pulled
// by T [N/m] is strained by T/Y, and what is strained by e in all directions has the energy Y e^2 per area.
// (Springs along the edges have Poisson's ratio 1/3, and 3/2 Y e^2 there.) For a triangle of equal edges it
// is the sum of squares, kappa/2 sum |x_i - g_i|^2 with kappa = 2 Y A / sum |b_i|^2; with that sum a right
// triangle of equal legs would have 7/8 Y along its legs, 3/2 Y along its longest edge and 1/2 Y across it.
// Unlike springs that only stretch, a cluster resists being compressed as well.
//
// In a substep of "pbd" (solver/forces/substep.h) one face by itself is solved exactly, pinned corners and
// unequal masses
// included: the x and R that make  sum m_i |x_i - y_i|^2 / 2 h^2 + E  least are
//   S = (h^2 sum w_i w_i^T / m_i + 1 / (A Y))^-1,   G = sum y_i w_i^T,   R = the polar factor of G S
//   x_i = y_i + h^2/m_i (R - G) S w_i
// y_i [m]: where the corners would be without this face. So each face keeps momentum and angular momentum,
// and the faces taken in turn, many times over, come to the step of implicit Euler.
// Viscosity, with the time tau [s] of viscosity over stiffness: in a substep Y becomes Y (1 + tau/h), and the
// shape at rest goes to B = 1 + tau / (h + tau) (R_0^T F_0 - 1), part of the way to the shape F_0 at its
// start: R B takes the place of R.
//
// A face on a line has no plane: its R then has the axis of the line, and any other across it. A face without
// area at rest holds nothing. m_i [kg], h [s].
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "mesh/triangles/triangle_mesh.h"
#include "solver/forces/colours.h"
#include "solver/forces/fabric.h"
#include "solver/forces/plate_friction.h"
#include "solver/forces/projected_force.h"
#include "solver/forces/rest_corners.h"

namespace drape {

struct FaceCluster {
  std::array<int, 3> particles;
  Eigen::Matrix<double, 3, 2> slopes;  // 1/m, w_i in a row each
  double stiffness;                    // N m, A Y
};

// One for each triangle that counts and has an area at rest; stretch: Y [N/m]. Triangle k of the mesh rests
// as triangle k of `rest`. Vertex 0 is the particle `first_particle`.
std::vector<FaceCluster> face_clusters(const TriangleMesh& mesh, const TriangleMesh& rest, double stretch,
                                       int first_particle = 0);

class FaceClusterForce final : public ProjectedForce {
 public:
  // viscosity [s]: tau of solver/forces/cluster.h.
  explicit FaceClusterForce(std::vector<FaceCluster> faces, double viscosity = 0);

  std::string_view name() const override { return "clusters"; }
  double energy(const VecX& x) const override;
  void add_force(const VecX& x, const VecX& v, VecX& f) const override;
  void begin_substep(int particles) override;
  void project(Substep& substep) override;

 private:
  // h (R - G) S: what the face has pushed so far [N s m]; a corner gets w_i times that.
  using Pull = Eigen::Matrix<double, 3, 2>;
  void relax(const FaceCluster& face, Substep& substep, Pull& pull) const;

  std::vector<FaceCluster> faces_;  // colour by colour, once they are coloured
  double viscosity_;                // s
  Colours colours_;
  bool coloured_ = false;
  std::vector<Pull> pulls_;  // of each face in this substep
};

// The forces of a cloth of springs (solver/forces/noh_jung.h) with clusters in place of those that stretch.
// Damping acts along edges and diagonals as it does there. Throws InputError when the fabric gives what is of
// springs that stretch.
std::vector<std::unique_ptr<Force>> clustered_noh_jung(const TriangleMesh& mesh, const TriangleMesh& rest,
                                                       const Fabric& fabric, int first_particle = 0);
// The same of a woven cloth (solver/forces/woven.h): it bends as that does. In its plane it has the mean
// stiffness of warp and weft, and the viscosity of stretch; shear, Poisson's ratio and compression have no
// part in it.
std::vector<std::unique_ptr<Force>> clustered_woven(const TriangleMesh& mesh, const TriangleMesh& rest,
                                                    const Fabric& fabric, const std::vector<Vec3>& warp,
                                                    int first_particle = 0,
                                                    std::shared_ptr<BendMemory> memory = nullptr);

}  // namespace drape
