// What carries particles where they meet a body or each other: sets of them that are pushed as one, such as
// clusters that keep their shape (solver/forces/cluster_contacts.h). They are asked after
// ContactStep::respond has found what each particle meets by itself, and change the free motion of all that
// they carry; then the particles are looked at again, for what is left to each.
#pragma once

#include <vector>

#include "constraints/obstacle.h"
#include "constraints/response.h"
#include "constraints/self_contact.h"

namespace drape {

// A particle that meets a body.
struct CarriedContact {
  int particle, body;
  Vec3 normal;         // unit, out of the body
  double gap;          // m, to the surface offset by the margin when the step begins
  Vec3 body_velocity;  // m/s, in the step
  Friction friction;
  double restitution;
  bool taken = false;           // whether the carriers answer it
  Vec3 impulse = Vec3::Zero();  // N s, which they give to the particle, and the body gets the opposite
};

// How a body moves in the step without the impulses of carriers and of other bodies.
struct CarriedBody {
  bool reacts = false;           // else its velocity is that of each contact, whatever is given to it
  Vec3 centre = Vec3::Zero();    // m, of mass
  Vec3 velocity = Vec3::Zero();  // m/s, of the centre
  Vec3 spin = Vec3::Zero();      // rad/s
  Vec3 velocity_before = Vec3::Zero(), spin_before = Vec3::Zero();  // when the step begins
  double inverse_mass = 0;                                          // 1/kg
  Mat3 inverse_inertia = Mat3::Zero();                              // 1/(kg m^2)
};

// Where two bodies touch, of which one reacts at least (constraints/body_meeting.h).
struct BodyTouch {
  int a, b;
  Vec3 place;         // m
  Vec3 normal;        // from b to a
  Vec3 carried;       // m/s, what a body that does not react adds to the velocity of a against b
  double mu, target;  // -, m/s: that velocity along the normal is this at least
  Vec3 impulse;       // N s, on a, which the last step or round found
};

// The motion of the particles in the step as it would be without bodies; carriers change it.
struct CarriedMotion {
  ContactMode mode;
  double h;                           // s
  double recovery_speed;              // m/s, at which a particle comes out of a body at most
  const std::vector<char>& held;      // by particle
  const std::vector<double>& masses;  // kg
  const VecX& start;                  // m
  const std::vector<CarriedBody>& bodies;
  const std::vector<BodyTouch>& touches;
  VecX& before;  // m/s, when the step begins: an impact changes it
  VecX& x;       // m, at the end
  VecX& v;       // m/s, at the end
};

class Carriers {
 public:
  virtual ~Carriers() = default;
  // Marks the pairs of cloth that the carriers answer in the step in place of springs. held: by particle.
  virtual void take(std::vector<SelfContact>& pairs, const std::vector<char>& held) = 0;
  // Whether the particle moves as what carries it, and not by itself.
  virtual bool carries(int particle) const = 0;
  // Adds the impulses to what the particles meet, and to the pairs that were taken; true when there are any.
  virtual bool carry(std::vector<CarriedContact>& met, std::vector<SelfContact>& pairs,
                     const CarriedMotion& motion) = 0;
};

}  // namespace drape
