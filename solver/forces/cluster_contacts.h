// Clusters (solver/forces/cluster.h) that meet bodies: where a particle of a cluster touches, the impulse acts on the whole
// cluster as on a rigid body (solver/forces/cluster_body.h). A particle in several clusters shares it among them by its shares.
//   u = sum_c s_c (v_c + w_c x r_c)     the velocity of the particle with its clusters,  s_c = w_i / m_i
//   K = sum_c s_c^2 (1/M_c 1 - [r_c] I_c^-1 [r_c]);   cluster c gets the impulse s_c J at the particle
// All impulses of a substep are found together, by sweeps over the touching particles (projected Gauss-Seidel):
//   velocity      n.(u - v_b) >= -gap/h, with friction
//   restitution   first the impact without friction, n.(u' - v_b) >= -e n.(u - v_b) for what approaches; then
//                 n.(u - v_b) >= 0 with friction, against what the forces do
//   friction      |J_T| <= mu J.n, and against the slip where that is reached                       [Coulomb]
// as constraints/response.h has it for a particle. What is left, such as particles that move within their cluster, is answered
// by particle. A body that reacts (constraints/reacting_body.h) takes part with its own K and the opposite impulses, so that
// J = (K_A + K_B)^-1 times what the relative velocity is to change by. A cluster with a particle that is held, or that a body carries, is no free body: its particles are on their own.
// J [N s], u, v_b, v [m/s], w [rad/s], K [1/kg], gap [m], h [s].
#pragma once

#include <vector>

#include "constraints/carriers.h"
#include "solver/forces/cluster_body.h"

namespace drape {

class ClusterContacts final : public Carriers {
 public:
  explicit ClusterContacts(const Clusters& clusters);  // keeps a reference
  ClusterContacts(const ClusterContacts&) = delete;
  ClusterContacts& operator=(const ClusterContacts&) = delete;

  bool carry(std::vector<CarriedContact>& met, const CarriedMotion& motion) override;

 private:
  struct Body {  // a cluster that is touched
    int cluster;
    ClusterBody body;
    ClusterMotion before, free;  // when the step begins, and at its end without bodies
    ClusterMotion impact, support;
  };
  struct Hold {  // of a touching particle in a cluster
    int body;
    double share;  // s
    Vec3 arm;      // m, r
  };
  struct Meeting {
    CarriedContact* contact;
    int first, last;                 // of its holds
    double give_along, give_across;  // 1/kg, n.(K_A + K_B) n, and at most across n
    double target;                   // m/s
    double mu;
    Vec3 lambda;  // N s
  };

  void find(std::vector<CarriedContact>& met, const CarriedMotion& motion);
  int body_of_cluster(int cluster, const CarriedMotion& motion);
  enum class Phase {
    before,
    impact,
    support
  };  // as it is when the step begins, in the impact, and at the end
  static ClusterMotion motion_in(Phase phase, const Body& body);
  ClusterMotion motion_in(Phase phase, std::size_t obstacle, const CarriedMotion& motion) const;
  Vec3 slip(Phase phase, const Meeting& meeting, const CarriedMotion& motion) const;
  void settle(Phase phase, const CarriedMotion& motion);
  double sweep(Phase phase, const CarriedMotion& motion);
  void push(Phase phase, const Meeting& meeting, const Vec3& impulse, const CarriedMotion& motion);
  void push_obstacle(Phase phase, const CarriedContact& contact, const Vec3& impulse,
                     const CarriedMotion& motion);
  double part_after_impact(const CarriedMotion& motion) const;
  void move(double part, const CarriedMotion& motion) const;

  const Clusters& clusters_;
  std::vector<int> number_;  // of each cluster in bodies_; unknown, or not_free
  std::vector<Body> bodies_;
  std::vector<Hold> holds_;
  std::vector<Meeting> meetings_;
  // What the impulses change of each body that reacts.
  std::vector<ClusterMotion> by_impact_, by_support_;
  static constexpr int unknown = -1, not_free = -2;
  std::vector<int> asked_;  // the clusters whose number is known
};

}  // namespace drape
