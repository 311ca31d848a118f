// The particles that are held: they stay where they are, or a body or a path of their own carries them along.
#pragma once

#include <vector>

#include "constraints/filter.h"
#include "constraints/moving_body.h"
#include "constraints/parting.h"
#include "constraints/step_motion.h"

namespace drape {

// A pinned particle that is carried along.
struct MovingPin {
  int particle;
  int body;  // number of the body that carries the particle; -1: its own path does
  int path;
  MovingBody::Mark mark;
};

class PinSet {
 public:
  void pin(const std::vector<int>& particles);
  void pin_to_body(const std::vector<int>& particles, const MovingBody& body, const VecX& x);
  void pin_along(const std::vector<int>& particles, const Motion& motion, const VecX& x, double t);
  void unpin(const std::vector<int>& particles);  // those that are not pinned are passed over
  // Particle i gets the number number[i]; where several pins become one, the pin of the lowest particle
  // stays.
  void renumber(const std::vector<int>& number);
  void part(const Parting& parting);  // copies of pinned particles are pinned in the same way

  const std::vector<int>& pinned() const { return pinned_; }  // ascending
  const std::vector<MovingPin>& moving() const { return moving_; }

  // Finds the velocities that bring the moving pins to where they are carried by the end of the step.
  void move(const std::vector<MovingBody>& bodies, const StepMotion& step);
  Vec3 velocity(int particle) const { return velocity_.segment<3>(3 * particle); }  // of a moving pin [m/s]
  // Every particle that is held gets its target: dv = velocity of the pin - v.
  void filter(const StepMotion& step, const VecX& v, Filter& filter) const;

 private:
  bool has(int particle) const;

  std::vector<int> pinned_;
  std::vector<MovingPin> moving_;
  std::vector<Motion> paths_;
  VecX velocity_;  // m/s; empty without moving pins
};

}  // namespace drape
