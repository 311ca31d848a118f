// A body in the cloth's way: a shape that may move and that rubs.
//   friction  Coulomb's coefficients [-]: static friction holds up to mu_s N, kinetic friction rubs with
//             mu_k N
//   margin    how far outside the surface the cloth comes to rest [m]: vertices stop at phi = margin, so that
//             the straight edges between them stay clear of a curved body
//   motion    where the body is at each time; the shape is given in the body's own frame, which is the
//             world's where nothing moves
//   restitution  which part of the normal velocity an impact gives back [-]; for the cloth only the contact mode
//                "restitution" uses it (constraints/response.h), for other bodies it always counts
//   rigid     the body's mass, when it falls and is pushed by the cloth (constraints/reacting_body.h) and by other bodies
//             (constraints/body_meeting.h)
#pragma once

#include <optional>

#include "constraints/motion.h"
#include "constraints/reacting_body.h"
#include "constraints/shape.h"

namespace drape {

struct Friction {
  double statics = 0.3;  // mu_s
  double kinetic = 0.3;  // mu_k <= mu_s
  Friction() = default;
  Friction(double mu) : statics(mu), kinetic(mu) {}  // NOLINT: one number for both is what most users mean
  Friction(double mu_s, double mu_k) : statics(mu_s), kinetic(mu_k) {}
};

struct Obstacle {
  Shape shape;
  Friction friction = {};
  double margin = 2e-3;  // m
  Motion motion = {};
  double restitution = 0;  // k_r, 0 to 1
  // When set, the body reacts to the cloth; its motion then gives only where it starts.
  std::optional<RigidBody> rigid = {};
};

// Throws InputError when the shape, a coefficient of friction or the margin makes no sense.
void check(const Obstacle& obstacle);

}  // namespace drape
