// What particles may do: pins, bodies in the way, and what touches them. A step begins with begin_step and
// goes on with the ContactStep that it gives (constraints/contact_step.h).
#pragma once

#include <string_view>

#include "constraints/face_contact.h"
#include "constraints/particle_contacts.h"
#include "constraints/pin_set.h"
#include "constraints/pins.h"

namespace drape {

struct ContactOptions {
  double recovery_speed = 0.25;  // m/s, at which a particle that starts inside a body is brought out
};

class ContactStep;

class Constraints {
 public:
  explicit Constraints(ContactOptions options = {}) : options_(options), contacts_(options.recovery_speed) {}

  void add(Obstacle obstacle);  // throws InputError
  void pin(int particle);       // stays where it is; twice is once
  void pin(const std::vector<int>& particles);
  // Are carried along, from where they are at time 0 (x [m], all particles): by a body, or by a motion of
  // their own. A particle is pinned once, in the way named first.
  void pin_to_body(const std::vector<int>& particles, int body, const VecX& x);
  void pin_along(const std::vector<int>& particles, const Motion& motion, const VecX& x);

  // Particles become one: particle i is number particle_of[i] from now on, and one of those is pinned if any
  // of its parts was, in the way of the lowest of them that was. Contacts are found anew; bodies stay as they
  // are.
  void merge(const std::vector<int>& particle_of);

  // The triangles of the cloth, so that corners and rims of bodies do not come through between the vertices.
  // They push by a force, which the system needs, too: solver/forces/face_contact_force.h.
  void add_faces(const std::vector<ClothFace>& faces) { faces_.add(faces); }
  const FaceContacts& faces() const { return faces_; }

  const std::vector<MovingBody>& bodies() const { return bodies_; }
  const std::vector<int>& pinned() const { return pins_.pinned(); }  // ascending
  const std::vector<MovingPin>& moving_pins() const { return pins_.moving(); }
  const std::vector<Contact>& contacts() const { return contacts_.contacts(); }  // of the last completed step

  double work() const { return step_.work; }  // J, that moving bodies and pins did in the last step
  // Begins the step from x [m], v [m/s] at t for h [s] and finds what touches. masses [kg].
  [[nodiscard]] ContactStep begin_step(const VecX& x, const VecX& v, const std::vector<double>& masses,
                                       double t, double h, Foresight foresight = Foresight::ahead);

  // How deep each particle is inside a body: 0 outside [m]. For the start and the end of a run.
  std::vector<double> penetration(const VecX& x) const;

 private:
  friend class ContactStep;
  void prepare(int particles, const std::vector<double>& masses);

  ContactOptions options_;
  std::vector<MovingBody> bodies_;
  PinSet pins_;
  ParticleContacts contacts_;
  FaceContacts faces_;
  StepMotion step_;  // of the step under way, and what is known from the last one
  VecX x_new_;       // scratch
};

}  // namespace drape
