// The particles that touch bodies, in one step and from step to step: which they are, how they hold (stick,
// slide, are let go), and what filter and friction a solve gets from them. constraints/contact.h has the
// equations.
//   particle_contacts.cpp   where contacts are found: at the start, along the way, and by the guard
//   grip.cpp                how they hold after each solve: friction is decided there
//   nips.cpp                where two bodies pinch a particle
//   respond.cpp             the response of constraints/response.h, for explicit methods
// The scratch memory is kept from step to step, so that no step allocates.
#pragma once

#include <array>
#include <vector>

#include "constraints/filter.h"
#include "constraints/moving_body.h"
#include "constraints/nip.h"
#include "constraints/response.h"
#include "constraints/step_motion.h"

namespace drape {

// What friction does to a sliding particle in this step: the force f = -D (v - v_b), and an impulse. Together
// they are Coulomb's law, linearised.
struct ContactFriction {
  int particle, body;
  Mat3 damping;        // N s/m
  Vec3 body_velocity;  // m/s
  Vec3 impulse;        // N s
  Mat3 along;          // the projector onto the directions along the surface
  double most;         // mu N [N s], which the law gives at any slip
};

struct ContactReport {
  int contacts = 0;
  int guarded = 0;        // particles that were stopped at a surface after the solve, outside the equations
  bool converged = true;  // the motion of bodies that react agrees with the impulses on them
  double deepest = 0;     // how deep the deepest particle was inside a body when the step began [m]
  int self_contacts = 0;  // pairs of cloth and cloth that push each other
  int self_guarded = 0;   // particles that were pushed or stopped so that no cloth passes through cloth
  int self_held = 0;      // of these, particles that were pushed, and not stopped
  int stood_still = 0;    // particles of pieces that the guard left where they began
  int tangled = 0;        // particles where cloth passes through cloth
  // Particles that a body could not be kept off, or that two bodies, or two sides of one, hold between them.
  int pinched = 0;
  int body_contacts = 0;    // points at which bodies press on each other
  double body_overlap = 0;  // how deep bodies were inside each other when the step began [m]
};

// An impulse of a body on a particle, see constraints/response.h.
struct ContactResponse {
  int particle, body;
  Vec3 impulse;        // N s, on the particle
  Vec3 place;          // m
  Vec3 body_velocity;  // m/s
  double approach;     // m/s
  Vec3 normal;         // of the plane, out of the body
  double gap;          // m, when the step begins
};

class ParticleContacts {
 public:
  using Bodies = std::vector<MovingBody>;

  explicit ParticleContacts(double recovery_speed) : recovery_speed_(recovery_speed) {}

  bool prepared(int particles, std::size_t bodies) const {
    return clearance_.size() == static_cast<std::size_t>(particles) * bodies;
  }
  void prepare(int particles, std::size_t bodies);  // forgets all, for other particles or bodies
  void look_again();                                // the particles were moved from outside
  void open();                                      // begins a step without contacts

  // Finds the nips among the particles that touched when the last step ended (constraints/nip.h).
  void find_nips(const Bodies& bodies, const StepMotion& step);
  std::vector<Nip>& nips() { return nips_; }

  // Finds the particles that touch a body in the predicted motion.
  void find(const Bodies& bodies, const StepMotion& step);
  // Looks for the particles that would pass in the motion x_new through a body of which they know nothing
  // yet.
  void look_on_path(const Bodies& bodies, const StepMotion& step, const VecX& x_new);
  // How wrong the contacts are as a solve assumed them, which gave v [m/s], the motion x_new and the reaction
  // r [N s]: the norm of the impulses that should not be, those of particles found on the path among them [N
  // s].
  double imbalance(const Bodies& bodies, const StepMotion& step, const VecX& v, const VecX& r,
                   const VecX& x_new);
  // Takes in those that were found on the path of a solve with the reaction r; true when there are any.
  bool catch_on_path(const Bodies& bodies, const StepMotion& step, const VecX& r, const VecX& x_new);
  // Changes contacts to what such a solve asks for. An impulse counts as round-off when it changes the
  // velocity of its particle by less than `noise` [m/s]. True when a contact is let go or caught again, or
  // sticks or slides otherwise than the solve assumed.
  bool react(const Bodies& bodies, const StepMotion& step, const VecX& v, const VecX& r, const VecX& x_new,
             double noise);
  // Takes over what bears on each contact from a solve with which the contacts agree.
  void settle(const Bodies& bodies, const StepMotion& step, const VecX& v, const VecX& r);
  // Updates the contacts when the bodies do not move as was assumed.
  void follow(const Bodies& bodies, const StepMotion& step);

  // Takes the place of find and react: a free motion to x, v ends at x_new, v_new after the response of the
  // bodies.
  void respond(ContactMode mode, const Bodies& bodies, const StepMotion& step, const VecX& x, const VecX& v,
               VecX& x_new, VecX& v_new);
  // The same for a motion that carriers have changed: what touched stays known as touching.
  void respond_again(ContactMode mode, const Bodies& bodies, const StepMotion& step, const VecX& x,
                     const VecX& v, VecX& x_new, VecX& v_new);
  double recovery_speed() const { return recovery_speed_; }  // m/s
  template <class F>  // f(response) for every one, in the order of the particles
  void each_response(const F& f) const {
    for (const auto& responses : responses_)
      for (const ContactResponse& response : responses) f(response);
  }

  // Corrects the motion after the solve, outside the equations: no particle that was outside a body ends
  // inside or behind it, and none that was inside ends deeper.
  void guard(const Bodies& bodies, const StepMotion& step, VecX& x_new, VecX& v_new, ContactReport& report);
  void commit();
  // Particle i gets the number number[i]; what was committed is shown under the new numbers, and forgotten by
  // the next prepare().
  void renumber(const std::vector<int>& number);

  // S and z of the particles that touch; the dampers and impulses of those that slide.
  void filter(const StepMotion& step, const VecX& v, Filter& filter) const;
  const std::vector<ContactFriction>& make_friction(const Bodies& bodies, const StepMotion& step);
  const std::vector<ContactFriction>& friction() const { return friction_; }  // as it was made last
  const VecX& correction() const { return correction_; }                      // y [m]; empty without bodies

  const std::vector<Contact>& touching() const { return trial_; }  // contacts that were let go have no planes
  const std::vector<Contact>& contacts() const { return committed_; }

 private:
  void look_for(int particle, const Bodies& bodies, const StepMotion& step, std::vector<Contact>& found,
                double& deepest);
  void look_at(const MovingBody& body, const StepMotion& step, bool touched, const Contact* before,
               Contact& contact, double& deepest);
  void look_along(int particle, const Bodies& bodies, const StepMotion& step, const Contact* known,
                  const Vec3& x_new, std::vector<Contact>& found);
  void take_found(double h);
  bool hold_also(const StepMotion& step, const Vec3& r, Contact& contact, const Contact& met);
  void begin_anew(const StepMotion& step, Contact& contact) const;
  void start_grip(const Bodies& bodies, const StepMotion& step, Contact& contact,
                  const Contact* before) const;
  Vec3 mean_velocity(const StepMotion& step, int particle, const VecX& x_new) const;
  double sticking(const Contact& contact, const Friction& mu) const;
  const Nip* nip_of(int particle) const;
  void add_nip(const Bodies& bodies, const StepMotion& step, const Contact& contact, int first, int second);
  int leader_of(const Bodies& bodies, int a, int b, const Contact* before) const;
  void clamp_between(const Bodies& bodies, const StepMotion& step, const Contact* before,
                     Contact& contact) const;
  void look_into_fold(const MovingBody& body, const StepMotion& step, const ContactPlane& near,
                      const ContactPlane& far, const Contact* before, Contact& contact) const;
  void rub_in_nips(const Bodies& bodies, const StepMotion& step);
  // What presses the particle against each plane, with what the bodies press where it is in a nip; and the
  // sum of it [N s].
  std::array<double, 3> presses(const Contact& contact, const Vec3& r) const;
  double pressed(const Contact& contact, const Vec3& r) const;
  void catch_grip(const Bodies& bodies, const StepMotion& step, Contact& contact, const Vec3& v) const;
  double wrong_normal(const StepMotion& step, const Contact& contact, const Vec3& v, const Vec3& r) const;
  double wrong_friction(const Bodies& bodies, const StepMotion& step, const Contact& contact, const Vec3& v,
                        const Vec3& r) const;
  bool catch_again(const StepMotion& step, Contact& contact, const Vec3& v, const Vec3& r,
                   double noise) const;
  bool update_grip(const Bodies& bodies, const StepMotion& step, Contact& contact, const Vec3& v,
                   const Vec3& r, double noise) const;
  bool update_friction(const Bodies& bodies, const StepMotion& step, Contact& contact, const Vec3& v,
                       const Vec3& r, double noise) const;
  void guard(int particle, const Bodies& bodies, const StepMotion& step, VecX& x_new, VecX& v_new,
             int& guarded);
  void respond(ContactMode mode, int particle, const Bodies& bodies, const StepMotion& step,
               std::size_t chunk, VecX& x_new, VecX& v_new);
  bool respond(ContactMode mode, const MovingBody& body, const StepMotion& step, std::size_t chunk,
               StepVelocities& velocities, Contact& contact);
  double clearance(int body, int particle) const {
    return clearance_[static_cast<std::size_t>(body) * particles_ + static_cast<std::size_t>(particle)];
  }
  double& clearance(int body, int particle) {
    return clearance_[static_cast<std::size_t>(body) * particles_ + static_cast<std::size_t>(particle)];
  }

  double recovery_speed_;  // m/s
  std::size_t particles_ = 0;
  std::vector<Contact> trial_, committed_;      // contacts of the step under way; of the last completed one
  std::vector<Contact> first_, all_;            // scratch of respond_again
  std::vector<int> held_by_;                    // by body: particles that it alone holds, of the last step
  std::vector<int> contact_of_, committed_of_;  // particle -> its place in those; -1: none
  std::vector<Nip> nips_;
  std::vector<int> nip_of_;  // particle -> its place in nips_; -1: none
  // By body and particle: a distance within which there was no surface of the body [m].
  std::vector<double> clearance_;
  VecX correction_;       // m
  double unsettled_ = 0;  // root mean square of the wrong impulses along the normals, of the last solve [N s]
  std::vector<ContactFriction> friction_;
  // By chunk of particles, so that threads do not share them.
  std::vector<std::vector<Contact>> found_;
  std::vector<std::vector<ContactResponse>> responses_;
  std::vector<double> deepest_;  // m
  std::vector<int> guarded_;
};

}  // namespace drape
