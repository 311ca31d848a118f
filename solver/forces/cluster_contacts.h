// Clusters (solver/forces/cluster.h) that meet bodies, each other, cloth and ropes: where a particle of a
// cluster touches, the impulse acts on the whole cluster as on a rigid body (solver/forces/cluster_body.h). A
// particle in several clusters shares it among them by its shares. All impulses of a substep, of all
// clusters, are found together (solver/forces/impulses.h).
//   particle on a body    u = sum_c s_c (v_c + w_c x r_c) - v_b,   s_c = w_i / m_i
//   pair of cloth         u = sum_k w_k sum_c s_kc (v_c + w_c x r_kc)    with the w_k of constraints/self_contact.h
// Cluster c gets s_c J, or sum_k w_k s_kc J, there; where both sides of a pair are of clusters, in the middle
// between them, so that friction turns nothing that it should not. A particle of a pair that is in no free
// cluster is a body of its own, which does not turn: K then has w_k^2 / m_k. What it meets of other bodies is
// answered here as well.
//   velocity      n.u >= -gap/h, with friction
//   restitution   first the impact without friction, n.u' >= -e n.u for what approaches a body; then n.u >= 0 with friction,
//                 against what the forces do. Pairs have e = 0: n.u >= -gap/h, with friction, in both.
//   friction      |J_T| <= mu J.n, and against the slip where that is reached                       [Coulomb]
//   recovery      what begins too deep is brought out with the recovery speed at most, and gets no velocity from it, but by bodies
//                 in the mode `velocity`, as its particles do
// as constraints/response.h has it for a particle. What is left, such as particles that move within their
// cluster, is answered by particle: of bodies by that, of pairs by the push w_k / m_k along the normal.
//
// A body that reacts (constraints/reacting_body.h) takes part with its own K and gets the opposite impulses.
// Where such bodies touch each other and obstacles (constraints/body_meeting.h), those impulses are found in
// the same sweeps. What particles that move within their cluster meet of such a body is answered here, too
// (solver/forces/inner_contacts.h). A cluster with a particle that is held, or that a body carries, is no
// free body: its particles are on their own. So are pairs with no free cluster, and those with one on both
// sides: springs answer them.
// J [N s], u, v, v_b [m/s], w [rad/s], K [1/kg], r, gap [m], h [s].
#pragma once

#include <utility>
#include <vector>

#include "constraints/carriers.h"
#include "solver/forces/impulses.h"
#include "solver/forces/inner_contacts.h"

namespace drape {

class ClusterContacts final : public Carriers {
 public:
  // All clusters of a system. Keeps references to their members.
  explicit ClusterContacts(const std::vector<const Clusters*>& clusters);

  void take(std::vector<SelfContact>& pairs, const std::vector<char>& held) override;
  bool carries(int particle) const override { return is_carried(particle); }
  bool carry(std::vector<CarriedContact>& met, std::vector<SelfContact>& pairs,
             const CarriedMotion& motion) override;

  void forget();  // the impulses from which the next ones would begin
  bool any() const { return !clusters_.empty(); }
  bool takes_pairs() const { return taken_ > 0; }  // in this step
  // How far the impulses of the last carry() are from settled, relative to the largest velocity there.
  double unsettled() const { return unsettled_; }

 private:
  struct Place {  // of a particle in a cluster
    int cluster;
    double share;  // s
  };
  struct Carried {          // what a body of the impulses is
    int cluster, particle;  // one of them, else none; both none: an obstacle that reacts
    Vec3 centre;            // m
    double part,
        pushed;  // of the step that is left after its impacts, as a sum over these [N s], and what they sum to
  };
  struct Touch {  // what a point of the impulses is: one of the three
    CarriedContact* contact;
    SelfContact* pair;
    const BodyTouch* bodies;
    double gap;  // m
    double mu;   // -
  };
  static constexpr int none = -1;

  std::span<const Place> places_of(int particle) const;
  bool is_carried(int particle) const;
  bool is_taken(const SelfContact& pair, const std::vector<char>& held) const;
  void find(std::vector<CarriedContact>& met, std::vector<SelfContact>& pairs, const CarriedMotion& motion);
  int number_of(int key, const CarriedMotion& motion);
  void hold(int particle, double weight, const Vec3& place, const CarriedMotion& motion);
  void hold_pair(const SelfContact& pair, const CarriedMotion& motion);
  void hold_obstacle(int body, double side, const Vec3& place, const CarriedMotion& motion);
  void find_bodies(const CarriedMotion& motion);
  void remember();
  void find_friction();
  void set_targets(Phase phase, const CarriedMotion& motion);
  void settle(Phase phase, const CarriedMotion& motion);
  void bring_out(const CarriedMotion& motion);
  void take_impulses(double h);
  void find_parts(const CarriedMotion& motion);
  void move(const CarriedMotion& motion) const;
  void meet_by_particle(const CarriedMotion& motion);
  void part_particles(const CarriedMotion& motion) const;

  std::vector<std::span<const ClusterMember>> clusters_;
  std::vector<std::size_t> places_start_;  // particles + 1 entries into places_
  std::vector<Place> places_;              // of each particle
  std::vector<char> free_;                 // by cluster
  int taken_ = 0;
  double unsettled_ = 0;
  // The number of each cluster, and of each particle after those, among the bodies; and of each obstacle.
  std::vector<int> numbers_, obstacles_;
  std::vector<int> numbered_;  // what has one
  Impulses impulses_;
  InnerContacts inner_;
  std::vector<Carried> carried_;  // by body of the impulses
  std::vector<Touch> touches_;    // by point of the impulses
  // The impulses of the support found last [N s], sorted, from which the next ones are looked for.
  std::vector<std::pair<Encounter, Vec3>> last_of_pairs_;
  std::vector<std::pair<std::pair<int, int>, Vec3>> last_of_contacts_;  // of the particle and the body
};

}  // namespace drape
