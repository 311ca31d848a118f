// What particles may do: some are pinned, bodies are in the way of others, and some touch those bodies. A
// step begins with Constraints::begin_step and goes on with the ContactStep that this returns
// (constraints/contact_step.h).
#pragma once

#include <string_view>
#include <utility>

#include "constraints/body_meeting.h"
#include "constraints/carriers.h"
#include "constraints/face_contact.h"
#include "constraints/particle_contacts.h"
#include "constraints/parting.h"
#include "constraints/pin_set.h"
#include "constraints/pins.h"
#include "constraints/self_contact.h"

namespace drape {

struct ContactOptions {
  double recovery_speed = 0.25;  // speed [m/s] at which a particle that starts inside a body is brought out
};

class ContactStep;

class Constraints {
 public:
  explicit Constraints(ContactOptions options = {}) : options_(options), contacts_(options.recovery_speed) {}

  void add(Obstacle obstacle);  // throws InputError
  void pin(int particle);       // holds the particle where it is; pinning it twice is pinning it once
  void pin(const std::vector<int>& particles);
  // These particles are carried along from where they are now (x [m] has the places of all particles): by a
  // body, or by a motion of their own. t [s]: the time now. A particle is pinned once, in the way that is
  // named first.
  void pin_to_body(const std::vector<int>& particles, int body, const VecX& x);
  void pin_along(const std::vector<int>& particles, const Motion& motion, const VecX& x, double t = 0);

  // These are free from the next step on, with the velocity that they have; those that are not pinned are
  // passed over.
  void unpin(const std::vector<int>& particles);

  // Between steps: puts the bodies whose motion is prescribed where they are at the time t [s], as a step
  // that ends then does.
  void stand_at(double t);

  // The particle is the middle of something that is as thick as a ball of this radius [m], such as a rope: it
  // rests at the radius and the margin outside of a body. A particle of a cloth has the radius 0. Throws
  // InputError when the radius is negative or not finite.
  void set_radius(int particle, double radius);
  double radius_of(int particle) const { return step_.radius_of(particle); }

  // Several particles become one: particle i gets the number particle_of[i]. The new particle is pinned if
  // any of its parts was, in the way of the lowest-numbered part that was pinned. Contacts are found anew;
  // bodies stay as they are. The new particle has the largest radius of its parts.
  void merge(const std::vector<int>& particle_of);
  // Particles part. A copy is pinned in the way of its original, and has its radius. Contacts are found anew.
  void part(const Parting& parting);

  // Adds the triangles of the cloth, so that corners and rims of bodies do not come through between the
  // vertices. The triangles are pushed by a force, which the System needs, too:
  // solver/forces/face_contact_force.h.
  void add_faces(const std::vector<ClothFace>& faces) { faces_.add(faces); }
  const FaceContacts& faces() const { return faces_; }
  // Adds triangles of the cloth that meet each other. They are pushed by a force, which the System needs,
  // too: solver/forces/self_contact_force.h.
  void add_self_faces(const std::vector<SelfFace>& faces) { self_.add(faces); }
  void add_self_segments(const std::vector<SelfSegment>& segments) { self_.add(segments); }  // of ropes
  void set_self_friction(const SelfFriction& pair) { self_.set_friction(pair); }
  // These pairs are being sewn together, in place of those named before.
  void sew(const std::vector<SewnPair>& pairs) { self_.sew(pairs); }
  const SelfContacts& self() const { return self_; }

  const std::vector<MovingBody>& bodies() const { return bodies_; }
  const std::vector<int>& pinned() const { return pins_.pinned(); }  // ascending
  const std::vector<MovingPin>& moving_pins() const { return pins_.moving(); }
  const std::vector<Contact>& contacts() const { return contacts_.contacts(); }  // of the last completed step

  double work() const { return step_.work; }  // of moving bodies and pins in the last step [J]
  // Begins the step of length h [s] from x [m] and v [m/s] at time t [s], and finds what touches.
  // masses [kg]. springs: between cloth and cloth (constraints/self_contact.h).
  [[nodiscard]] ContactStep begin_step(const VecX& x, const VecX& v, const std::vector<double>& masses,
                                       double t, double h, Foresight foresight = Foresight::ahead,
                                       const SelfSprings& springs = {});

  // For a step that is taken in parts: go_back() takes the bodies back to where they were at the last keep().
  void keep();
  void go_back();

  // How deep each particle, or the ball of its radius, is inside a body [m]; 0 where it is outside. Meant for
  // the start and the end of a run.
  std::vector<double> penetration(const VecX& x) const;
  // Pairs of bodies, one of which reacts at least, that start inside each other by more than `margin` [m].
  std::vector<BodyMeeting::Overlap> overlapping_bodies(double margin) {
    return meeting_.overlaps(bodies_, margin);
  }

 private:
  friend class ContactStep;
  void prepare(int particles, const std::vector<double>& masses);

  ContactOptions options_;
  std::vector<MovingBody> bodies_;
  PinSet pins_;
  ParticleContacts contacts_;
  FaceContacts faces_;
  SelfContacts self_;
  BodyMeeting meeting_;
  StepMotion step_;  // the step under way, and what is known from the last one
  VecX x_new_;       // scratch
  // Of carriers: what they took in the last response, the bodies as they see them, and what these got from
  // them, as an impulse
  // [N s] and its moment [N m s]: in the last response, before the first one what they are expected to get, and in the last
  // completed step, also as of the last keep().
  std::vector<CarriedContact> carried_;
  std::vector<CarriedBody> carried_bodies_;
  std::vector<BodyTouch> carried_touches_;  // where these touch each other
  std::vector<std::pair<Vec3, Vec3>> carried_by_, last_carried_by_, kept_carried_by_;
  VecX carried_x_, carried_v_, carried_before_;  // scratch: the motion as carriers change it
};

}  // namespace drape
