// Clusters: sets of particles that keep their shape, each as if it were carried by a rigid body that fits it
// best.
//                                            [Mueller, Heidelberger, Teschner & Gross 2005]
//   c = sum w_i x_i / W,   A = sum w_i (x_i - c) b_i^T,   Q = the rotation nearest to A            [eq. 7]
//   g_i = c + Q b_i                                                                                [eq. 8]
//   E = k/2 sum w_i |x_i - g_i|^2,   dE/dx_i = k w_i (x_i - g_i)
// x_i [m]: where a particle is. b_i [m]: where it is at rest, from the centre of its cluster. g_i [m]: its
// goal. W = sum w_i. k [1/s^2], the same on every mesh: a particle that is off its goal is drawn back as if
// it swung with sqrt(k)
// [rad/s]. The gradient is exact, because c and Q minimise E themselves.
//
// Clusters may overlap. A particle of mass m_i in n_i clusters has the share w_i = m_i / n_i [kg] in each of
// them, and goes to the mean of its goals [the same, section 4.4; Rivers & James 2007, section 4.2]:
//   dx_i = alpha sum_c (w_i / m_i) (g_i - x_i) = alpha (mean of g_i - x_i)
// So each cluster by itself keeps momentum and angular momentum: sum w_i (g_i - x_i) = 0 as c is the centre
// of the shares, and sum w_i (x_i - c) x Q b_i = 0 as A Q^T is symmetric.
// alpha = k h^2 / (1 + k h^2) for a step h [s]. For clusters that do not overlap that is the step of implicit
// Euler, exactly: c and Q are the same before and after it.
//
// Viscosity resists the change of the shape and no rigid motion, with the time tau [s] of viscosity over
// stiffness: a Kelvin-Voigt solid, whose modes of the angular frequency omega [rad/s] die away with the rate
// omega^2 tau / 2 [1/s].
//   f_i = -k w_i (d_i + tau d_i'),   d_i = x_i - g_i,   d_i' = its rate of change as the cluster sees it, which turns
// In a step of implicit Euler that is a cluster with the stiffness k (1 + tau/h) whose shape at rest is part
// of the way to the
// shape that it has when the step begins:  b_i + s (Q_0^T (x_0,i - c_0) - b_i),  s = tau / (h + tau).
//
// The rotation is that of mesh/base/rotation.h: proper, and defined for flat, collinear and inverted sets.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mesh/base/rotation.h"

namespace drape {

struct ClusterMember {
  int particle;
  double mass;   // kg, of the particle
  double share;  // kg, w: mass over the number of clusters that the particle is in
  Vec3 rest;     // m, b: from the centre of the shares at rest
};

struct ClusterPose {
  Vec3 centre;                                   // m, c
  Quaternion rotation = Quaternion::Identity();  // Q

  Vec3 goal(const ClusterMember& member) const { return centre + rotation * member.rest; }
};

// c and Q of a cluster at positions x [m]; `last` is its rotation in the step before.
ClusterPose matched(std::span<const ClusterMember> cluster, const VecX& x, const Quaternion& last);

// E of one cluster [J], for k [1/s^2].
double energy(std::span<const ClusterMember> cluster, const ClusterPose& pose, const VecX& x, double k);

// alpha [-] of a step h [s] with the stiffness k [1/s^2]; 1 for an infinite k.
double goal_share(double k, double h);

// Moves the particles of one cluster by its share of the way to the goals: one relaxation of Gauss-Seidel.
void project(std::span<const ClusterMember> cluster, const ClusterPose& pose, double alpha, VecX& x);

class Clusters {
 public:
  struct Place {  // where a particle is a member
    int cluster;
    std::size_t member;
  };

  Clusters() = default;
  // sets[c]: the particles of cluster c. masses [kg] and rest positions [m] are those of all particles.
  // Throws InputError, after `name`, when a set has fewer than 3 particles, names a particle twice or one
  // that is not there, or has a particle without a positive mass.
  Clusters(const std::vector<std::vector<int>>& sets, const std::vector<double>& masses, const VecX& rest,
           const std::string& name);

  int count() const { return static_cast<int>(start_.size()) - 1; }
  std::span<const ClusterMember> operator[](int cluster) const {
    return {members_.data() + start_[cluster], start_[cluster + 1] - start_[cluster]};
  }

  // Where the particle is a member, by cluster; nowhere of one that is in no cluster.
  std::span<const Place> places_of(int particle) const {
    const auto i = static_cast<std::size_t>(particle);
    if (i + 1 >= places_start_.size()) return {};
    return {places_.data() + places_start_[i], places_start_[i + 1] - places_start_[i]};
  }
  const ClusterMember& member(const Place& place) const { return members_[place.member]; }

  // Brings `poses`, one per cluster, from the last step to positions x.
  void match(const VecX& x, std::vector<ClusterPose>& poses) const;
  // Takes the shapes at rest of `others`, of the same sets, and brings them the share s of the way to the
  // shapes at x and their poses there.
  void take_shapes(const Clusters& others, const std::vector<ClusterPose>& poses, double s, const VecX& x);
  // Moves all particles at once by alpha of the way to the mean of their goals. The same bits on any number
  // of threads.
  void project(const std::vector<ClusterPose>& poses, double alpha, VecX& x) const;

 private:
  void list_places(int particles);

  std::vector<std::size_t> start_ = {0};  // clusters + 1 entries into members_
  std::vector<ClusterMember> members_;
  std::vector<std::size_t> places_start_ = {0};  // particles + 1 entries into places_
  std::vector<Place> places_;                    // of each particle, by cluster
};

}  // namespace drape
