// Pins and obstacles: what particles may do. Makes the filter of a step and changes only through the reaction
// of its solve.
//
// A step calls, in this order:
//   begin_step   finds the contacts of the predicted motion; the correction y and the targets stand
//   filter       S and z for a given velocity;  friction  the dampers and impulses of what slides
//   receive      takes the reaction r of a solve, for the bodies that it moves
//   react        the same: releases, sticks, slides; true when the step must be solved again
//   check_paths  takes the motion found: catches what would pass through a body; true as for react
//   move_bodies  when all these have come to a decision: true when a body that reacts moves otherwise than it
//                was taken to, and the step must be solved again
//   end_step     guards the final motion (nothing crosses a surface), commits the contacts
// A step that failed is abandoned by not calling end_step: the contacts of the last good step still stand.
#pragma once

#include <string_view>

#include "constraints/contact.h"
#include "constraints/face_contact.h"
#include "constraints/filter.h"
#include "constraints/moving_body.h"
#include "constraints/pins.h"
#include "constraints/response.h"

namespace drape {

struct ContactOptions {
  double recovery_speed = 0.25;  // m/s, at which a particle that starts inside a body is brought out
};

// What rubs on a sliding particle in this step: f = -D (v - v_b), and an impulse.
struct ContactFriction {
  int particle, body;
  Mat3 damping;        // N s/m
  Vec3 body_velocity;  // m/s
  Vec3 impulse;        // N s
};

// A pinned particle that is carried along.
struct MovingPin {
  int particle;
  int body;  // that carries it; -1: its own path
  int path;
  MovingBody::Mark mark;
};

struct ContactReport {
  int contacts = 0;
  int guarded = 0;        // particles stopped at a surface after the solve, outside the equations
  bool converged = true;  // the motion of bodies that react agrees with the impulses on them
  double deepest = 0;     // m, how far the deepest particle was inside a body when the step began
};

class Constraints {
 public:
  explicit Constraints(ContactOptions options = {}) : options_(options) {}

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
  // Those that react: their motion is the one that the impulses make, to this share of what the step changes.
  bool bodies_converged(double share = ReactingBody::well) const;
  const std::vector<int>& pinned() const { return pinned_; }  // ascending
  const std::vector<MovingPin>& moving_pins() const { return moving_pins_; }

  // x [m], v [m/s], masses [kg], t, h [s]. Without foresight only what touches already is found, and x -> x +
  // h v is not looked at: for motions that vibrate within a step.
  void begin_step(const VecX& x, const VecX& v, const std::vector<double>& masses, double t, double h,
                  bool foresight = true);
  void filter(const VecX& v, Filter& filter) const;
  const std::vector<ContactFriction>& friction();
  const VecX& correction() const { return correction_; }  // y [m]; empty without obstacles
  // What a solve gave, v [m/s] and r [N s]: the impulses on bodies that react, and the work [J] that moving
  // bodies and pins do on the particles.
  void receive(const VecX& v, const VecX& r);
  double work() const { return work_; }
  // The same v and r; impulses below `noise` [N s] are round-off of the solve.
  bool react(const VecX& v, const VecX& r, double noise);
  bool check_paths(const VecX& x_new);
  // The same motion, for the contacts of faces: true when other ones act, and their force has changed.
  bool react_faces(const VecX& x_new, const VecX& v_new) { return faces_.react(x_new, v_new); }
  bool move_bodies(double noise);  // N s, as for react
  // What faces did in a stage of an explicit step, which takes the force at x, v for so long [s].
  void count_face_impulse(double duration, const VecX& x, const VecX& v) {
    faces_.count_impulse(duration, x, v);
  }
  ContactReport end_step(VecX& x_new, VecX& v_new);

  // Without a filter for contacts, only for pins: in the place of begin_step, and of all from friction on to
  // check_paths. A free motion to x [m], v [m/s] ends at x_new, v_new after the response of the bodies
  // (constraints/response.h); bodies that react get the other side of it. pulled [N s]: what carries pins did
  // to them, besides bringing them to their velocity.
  void begin_response(const VecX& x, const VecX& v, const std::vector<double>& masses, double t, double h);
  void respond(ContactMode mode, const VecX& x, const VecX& v, const VecX& pulled, VecX& x_new, VecX& v_new,
               double noise);

  // Of the step under way, and after it; those released in it have no planes.
  const std::vector<Contact>& touching() const { return trial_; }
  const std::vector<Contact>& contacts() const { return committed_; }  // of the last completed step

  // How deep each particle is inside a body: 0 outside [m]. For the start and the end of a run.
  std::vector<double> penetration(const VecX& x) const;

 private:
  bool held(int particle) const { return held_[static_cast<std::size_t>(particle)] != 0; }
  struct Response {
    int body;
    Vec3 impulse;        // N s, on the particle
    Vec3 place;          // m
    Vec3 body_velocity;  // m/s
    double approach;     // m/s
  };
  void respond(ContactMode mode, int particle, std::size_t chunk, VecX& x_new, VecX& v_new);
  bool respond(ContactMode mode, int body, std::size_t chunk, StepVelocities& step, Contact& contact);
  void take_responses(const VecX& v_new, const VecX& pulled);
  void push(int body, int particle, const Vec3& v, const Vec3& body_velocity, const Vec3& impulse);
  void receive_faces(const VecX& v);
  void receive_pin(const MovingPin& pin, const Vec3& impulse);
  void open_step(const VecX& x, const VecX& v, const std::vector<double>& masses, double t, double h);
  void prepare(int particles, const std::vector<double>& masses);
  void look_for_contact(int particle, std::vector<Contact>& found, double& deepest);
  void look_along_path(int particle, const Vec3& x_new, std::vector<Contact>& found);
  void start_grip(Contact& contact, const Contact* before) const;
  std::array<double, 3> normal_speeds(const Contact& contact) const;  // m/s, at the end of the step
  double arrival_impulse(const Contact& contact) const;
  bool update_grip(Contact& contact, const VecX& v, const Vec3& r, double noise) const;
  void guard(int particle, VecX& x_new, VecX& v_new, int& guarded);
  void take_found();
  double& clearance(int body, int particle) {
    return clearance_[static_cast<std::size_t>(body) * held_.size() + static_cast<std::size_t>(particle)];
  }
  const MovingBody& body_of(const Contact& contact) const {
    return bodies_[static_cast<std::size_t>(contact.plane[0].obstacle)];
  }
  const Friction& friction_of(const Contact& contact) const { return body_of(contact).obstacle().friction; }
  void move_pins();

  ContactOptions options_;
  std::vector<MovingBody> bodies_;
  std::vector<int> pinned_;
  std::vector<MovingPin> moving_pins_;
  std::vector<Motion> paths_;  // of pins
  FaceContacts faces_;

  // Scratch of the step under way.
  double t_ = 0, h_ = 0;  // s
  bool foresight_ = true;
  double work_ = 0;             // J
  bool two_way_ = false;        // a body reacts
  double last_h_ = 0;           // s, of the last completed step
  std::vector<double> masses_;  // kg
  VecX x_, v_, x_new_, correction_;
  VecX x_end_;                   // m, of the last completed step
  VecX pin_velocity_;            // m/s; empty without moving pins
  std::vector<char> held_;       // pinned, or without mass
  std::vector<int> contact_of_;  // particle -> place in trial_, -1: none
  std::vector<double>
      clearance_;  // body, particle -> a distance within which no surface was when last looked [m]
  std::vector<Contact> trial_, committed_;
  std::vector<int> committed_of_;  // particle -> place in committed_, -1: none
  std::vector<ContactFriction> friction_;
  std::vector<std::vector<Contact>> found_;       // by chunk of particles
  std::vector<std::vector<Response>> responses_;  // by chunk of particles
  std::vector<double> deepest_;                   // by chunk of particles [m]
  std::vector<int> guarded_;                      // by chunk of particles
};

}  // namespace drape
