// Particles that move within their clusters, where that takes them into a body that reacts
// (constraints/reacting_body.h): each is pushed out with its own mass m_i, and the body gets the opposite
// impulse, all of them found together (solver/forces/impulses.h). The body moves here as the impulses of all
// clusters have made it.
//   u = v_i - V - W x r,   K = 1/m_i + 1/M - [r] I^-1 [r]
//   velocity      n.u >= -gap/h, with friction
//   restitution   n.u >= 0 with friction, for those that would end the step inside: the rebound is that of the clusters
// What still ends inside by the way that its mean velocity has made is brought out by the next step.
// u, v_i, V [m/s], W [rad/s], m_i, M [kg], I [kg m^2], r, gap [m], h [s].
#pragma once

#include <vector>

#include "constraints/carriers.h"
#include "solver/forces/impulses.h"

namespace drape {

class InnerContacts {
 public:
  void reserve(std::size_t bodies, std::size_t points);
  void begin(const CarriedMotion& motion);
  // Contacts of one particle come after one another. gap [m] and mu as they count in the step; motion of the
  // body with the impulses of the clusters.
  void add(CarriedContact& contact, double gap, double mu, const ClusterMotion& body,
           const CarriedMotion& motion);
  // Moves the particles, and adds to the impulses of their contacts.
  void answer(const CarriedMotion& motion);

 private:
  struct Touch {
    CarriedContact* contact;
    double gap, mu;
    int particle, body;  // of the impulses
  };
  double depth(const Touch& touch, const CarriedMotion& motion) const;

  Impulses impulses_;
  std::vector<int> numbers_;  // of each body that reacts
  std::vector<Touch> touches_;
};

}  // namespace drape
