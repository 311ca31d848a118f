// A body in the cloth's way: a shape that may move and that rubs.
//   friction  Coulomb's coefficients [-]: static holds up to mu_s N, kinetic rubs with mu_k N
//   margin    the cloth comes to rest this far outside the surface [m]: vertices stop at the offset surface
//   phi = margin, so that
//             the straight edges between them stay clear of a curved body
//   velocity  of the body at a point [m/s]; bodies stand still for now, contact already asks
#pragma once

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

  Vec3 velocity_at(const Vec3& /*point*/) const { return Vec3::Zero(); }
};

// Throws InputError when the shape, a coefficient of friction or the margin makes no sense.
void check(const Obstacle& obstacle);

}  // namespace drape
