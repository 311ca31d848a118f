// A step under way, as the constraints see it. Only Constraints::begin_step makes one. A solver asks what it
// has to respect (filter, friction, correction), solves, and hands over the solution; the answer says whether
// the contacts have changed. A step that is not finished leaves the contacts of the last finished step as
// they are.
//   imbalance   says how wrong the contacts are that a solve assumed, from its v [m/s] and reaction r [N s]
//   react    changes them: a contact that pulls is let go, one that sticks or slides otherwise than assumed is
//            changed, and a particle that would pass through a body is caught
//   move_bodies   is called when no contact changes any more: bodies that react move as the impulses make
//                 them, and contacts, faces and pins go with them
//   finish   guards the final motion (no particle crosses a surface) and commits the contacts
// With Foresight::none only pins are held; respond() then changes a free motion by the response of the
// bodies.
// x [m], v [m/s], h [s].
#pragma once

#include <algorithm>
#include <string_view>

#include "constraints/constraints.h"

namespace drape {

// What has changed since the last solve.
struct ContactChange {
  bool grip = false;    // a contact was let go, or it changed between sticking and sliding
  bool caught = false;  // particles that were free touch a body
  bool faces = false;   // springs of faces, or of cloth on cloth, push otherwise: a force has changed
  bool rubs = false;    // faces rub less, so a damper has changed
  bool met = false;     // cloth meets cloth where no spring was, so a force has other stencils
  bool any() const { return grip || caught || faces || rubs || met; }
};

// How far the contacts are from agreeing with a solve.
struct ContactImbalance {
  // The norm of all impulses that are wrong [N s]: what pulls a particle towards a body, what would keep one
  // from passing through, and friction beyond what the coefficient allows.
  double wrong = 0;
  double borne = 0;  // the norm of the impulses of all contacts [N s]
  // What is wrong, as a share of the reference [N s] or of what the contacts bear, whichever is more.
  double relative_to(double reference) const {
    return wrong > 0 ? wrong / std::max({reference, borne, wrong}) : 0;
  }
};

class ContactStep {
 public:
  bool bodies() const { return !constraints_->bodies_.empty(); }
  bool meets_anything() const { return bodies() || constraints_->self_.any(); }
  // Whether springs between cloth and bodies depend on where the bodies go.
  bool springs_on_bodies() const { return !touching_faces().empty() || constraints_->self_.touches_bodies(); }
  // Whether a solve may have to be answered by other contacts.
  bool touches_anything() const { return bodies() || !constraints_->self_.touching().empty(); }
  bool holds_anything() const { return meets_anything() || !moving_pins().empty(); }

  void filter(const VecX& v, Filter& filter) const;  // S and z at the velocity v
  // The dampers and impulses of the contacts that slide.
  const std::vector<ContactFriction>& friction();
  const VecX& correction() const;                // y [m] is added to the positions; empty without bodies
  const std::vector<Contact>& touching() const;  // contacts that were let go have no planes
  const std::vector<FaceContact>& touching_faces() const;
  // Of cloth with cloth, and with the corners and edges of bodies.
  const std::vector<SelfContact>& touching_cloth() const { return constraints_->self_.touching(); }
  const std::vector<MovingPin>& moving_pins() const { return constraints_->pins_.moving(); }

  // The momentum that a particle takes up for 1 m/s when it is pushed alone, its neighbours staying behind
  // [kg]: at least its mass, which is taken where this is not called.
  void set_inertia(int particle, double inertia) { constraints_->step_.inertia[particle] = inertia; }
  // Gives the impulses of a solve, which takes the particles to x_new, to the bodies that react, and counts
  // the work of bodies and pins.
  void receive(const VecX& v, const VecX& r, const VecX& x_new);
  // How far the contacts are from agreeing with the same v and r, and with the motion x_new that they make.
  ContactImbalance imbalance(const VecX& v, const VecX& r, const VecX& x_new);
  // Changes the contacts to what the v, r and x_new of the last call of imbalance() ask for. An impulse
  // counts as round-off when it changes the velocity of its particle by less than `noise` [m/s]. curvature: d
  // . A d [J] of the way d from accepted_velocity() to v; 0: v is taken whole.
  ContactChange react(const VecX& v, const VecX& r, const VecX& x_new, double noise, double curvature = 0);
  // The velocity that the contacts of cloth with cloth were made for last in this step [m/s]; null when there
  // is none yet.
  const VecX* accepted_velocity() const { return constraints_->self_.accepted_velocity(); }
  // Finds where cloth would pass through cloth on the way to x_new, and no spring keeps it off yet.
  ContactChange meet(const VecX& x_new) {
    if (constraints_->step_.foresight != Foresight::ahead) return {};
    return {.met = constraints_->self_.meet(x_new)};
  }
  // Ends the rounds: the contacts stay as the solve with this v and r had them.
  void settle(const VecX& v, const VecX& r) {
    constraints_->contacts_.settle(constraints_->bodies_, constraints_->step_, v, r);
  }
  // True when a body that reacts does not move as was assumed: the step must then be solved again.
  bool move_bodies(double noise);
  // True when the bodies that react move as the impulses make them. `share` [-] is the difference allowed,
  // relative to what the step changes.
  bool bodies_agree(double share = ReactingBody::well) const;
  double work() const {
    return constraints_->step_.work;
  }  // work [J] that moving bodies and pins do on the particles

  // For a motion that was found without a filter for contacts: the free motion to x, v ends at x_new, v_new.
  // pulled [N s]: the impulse on each pin of what carries it, besides the one that brings it to its velocity.
  // carriers: of particles that are pushed as one; null: there are none.
  void respond(ContactMode mode, const VecX& x, const VecX& v, const VecX& pulled, Carriers* carriers,
               VecX& x_new, VecX& v_new, double noise);
  // Lets carriers take pairs of cloth, before the forces of the step are told of it.
  void let_take(Carriers& carriers) {
    carriers.take(constraints_->self_.touching(), constraints_->step_.held);
  }
  // How easily an impulse moves a pin [m/s per N s]: not at all, or, where a body that reacts carries it, at
  // most as the body gives way there.
  double mobility_of(const MovingPin& pin) const;
  // Counts what the faces did in a stage of an explicit step, which applies the force at x, v for this
  // duration [s].
  void count_face_impulse(double duration, const VecX& x, const VecX& v);
  // Updates which faces push, and how hard, to the end of an explicit step.
  void settle_faces(const VecX& x_new, const VecX& v_new);

  ContactReport finish(VecX& x_new, VecX& v_new);

 private:
  friend class Constraints;
  explicit ContactStep(Constraints& constraints) : constraints_(&constraints) {}

  void clear_impulses();
  void push(int body, int particle, const Vec3& v, const Vec3& body_velocity, const Vec3& impulse);
  void receive_faces(const VecX& v);
  void carry(ContactMode mode, const VecX& x, const VecX& v, Carriers& carriers, VecX& x_new, VecX& v_new);
  void see_bodies();
  void push_carried(const VecX& v, const VecX& x_new);
  void receive_pin(const MovingPin& pin, const Vec3& impulse);

  Constraints* constraints_;
};

}  // namespace drape
