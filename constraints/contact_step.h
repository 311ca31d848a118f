// A step under way, as its constraints see it. Only Constraints::begin_step makes one. A solver asks what it
// has to respect (filter, friction, correction), solves, and tells what came out; the answer says whether the
// contacts are others now. What is not finished leaves the contacts of the last good step standing.
//   judge    what a solve gave, v [m/s] and the reaction r [N s]: bodies that react get their impulses; what
//            pulls is let go, what sticks or slides otherwise than it was taken to does so from now on, and
//            what would pass through a body is caught
//   move_bodies   when no contact changes any more: bodies that react move as the impulses make them, and
//            contacts, faces and pins go with them
//   finish   guards the final motion (nothing crosses a surface) and commits the contacts
// With Foresight::none only pins are held; a free motion is then changed by the response of the bodies.
// x [m], v [m/s], h [s].
#pragma once

#include <string_view>

#include "constraints/constraints.h"

namespace drape {

// What is different since the last solve.
struct ContactChange {
  bool grip = false;    // a contact was let go, sticks or slides
  bool caught = false;  // particles that were free touch now
  bool faces = false;   // other faces push: a force has changed
  bool any() const { return grip || caught || faces; }
};

class ContactStep {
 public:
  bool bodies() const { return !constraints_->bodies_.empty(); }
  bool holds_anything() const { return bodies() || !moving_pins().empty(); }

  void filter(const VecX& v, Filter& filter) const;  // S and z at the velocity v
  // The dampers and impulses of what slides.
  const std::vector<ContactFriction>& friction();
  const VecX& correction() const;                // y [m], added to the positions; empty without bodies
  const std::vector<Contact>& touching() const;  // those let go have no planes
  const std::vector<FaceContact>& touching_faces() const;
  const std::vector<MovingPin>& moving_pins() const { return constraints_->pins_.moving(); }

  // Bodies that react get the impulses of a solve, and the work of bodies and pins is counted.
  void receive(const VecX& v, const VecX& r);
  // The same v and r, and the motion x_new that they make; impulses below `noise` [N s] are round-off.
  ContactChange judge(const VecX& v, const VecX& r, const VecX& x_new, double noise);
  // True when a body that reacts moves otherwise than it was taken to, and the step must be solved again.
  bool move_bodies(double noise);
  // The bodies that react move as the impulses make them, to this share of what the step changes.
  bool bodies_agree(double share = ReactingBody::well) const;
  double work() const {
    return constraints_->step_.work;
  }  // J, that moving bodies and pins do on the particles

  // Without a filter for contacts: a free motion to x, v ends at x_new, v_new. pulled [N s]: what carries pins
  // did to them, besides bringing them to their velocity.
  void respond(ContactMode mode, const VecX& x, const VecX& v, const VecX& pulled, VecX& x_new, VecX& v_new,
               double noise);
  // What faces did in a stage of an explicit step, which takes the force at x, v for so long [s].
  void count_face_impulse(double duration, const VecX& x, const VecX& v);
  // Faces push otherwise at the end of an explicit step.
  void settle_faces(const VecX& x_new, const VecX& v_new);

  ContactReport finish(VecX& x_new, VecX& v_new);

 private:
  friend class Constraints;
  explicit ContactStep(Constraints& constraints) : constraints_(&constraints) {}

  void clear_impulses();
  void push(int body, int particle, const Vec3& v, const Vec3& body_velocity, const Vec3& impulse);
  void receive_faces(const VecX& v);
  void receive_pin(const MovingPin& pin, const Vec3& impulse);

  Constraints* constraints_;
};

}  // namespace drape
