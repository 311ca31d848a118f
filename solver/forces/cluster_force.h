// Clusters (solver/forces/cluster.h) as a force: every particle is drawn to the mean of its goals.
//   E = sum over clusters k/2 sum w_i |x_i - g_i|^2,   f_i = k m_i (mean of g_i - x_i)
// The stiffness of a solid of Young's modulus Y [Pa] and density rho [kg/m^3] is k = 3 Y / (rho b2), b2 the
// mean of |b|^2 over the shares of all clusters [m^2]: what is strained by e in all directions alike then has
// the energy Y e^2 / 2 of each of them and volume. It is the modulus of the body on average, whatever the
// size of its clusters.
//
// The integrator "pbd" takes all clusters at once (solver/forces/substep.h): with x_free the places without
// what they have done so far, x = x_free + alpha (mean of the goals of x_free - x_free). Where clusters do
// not overlap that is the step of implicit Euler exactly. A matrix knows no rotations of whole clusters, so
// implicit integrators do not take this force.
#pragma once

#include <vector>

#include "solver/forces/cluster.h"
#include "solver/forces/projected_force.h"

namespace drape {

// k [1/s^2] of a solid with this modulus [Pa] and density [kg/m^3].
double cluster_stiffness(const Clusters& clusters, double young, double density);

class ClusterForce final : public ProjectedForce {
 public:
  // k [1/s^2], and the time tau of the viscosity [s]. The particles are those of the clusters.
  ClusterForce(Clusters clusters, double k, double viscosity = 0);

  std::string_view name() const override { return "clusters"; }
  double energy(const VecX& x) const override;
  void add_force(const VecX& x, const VecX& v, VecX& f) const override;
  void project(Substep& substep) override;
  const Clusters* clusters() const override { return &clusters_; }

 private:
  ClusterPose pose(int cluster, const VecX& x) const;
  void take_up_viscosity(const Substep& substep);

  Clusters clusters_;
  std::vector<double> masses_;      // kg, of the particles; 0 of one that is in no cluster
  double k_;                        // 1/s^2
  std::vector<ClusterPose> poses_;  // of the last substep
  VecX moved_;                      // by the clusters in this substep [m]
  double viscosity_;                // s
  Clusters viscous_;                // with the shapes that viscosity makes of those at rest in this substep
  std::vector<ClusterPose> start_;  // where the substep begins
  VecX x_free_, x_new_;             // scratch: without that, and with what it is to be
};

}  // namespace drape
