// What pushes on particles. Const during a step, once it is bound to the matrix.
//   f = -dE/dx (+ damping),  K = -df/dx (positive semidefinite part),  D = -df/dv
// Vectors are in particle order, 3 a particle; the matrix is in row order (solver/matrix/block_matrix.h).
#pragma once

#include <string_view>
#include <vector>

#include "solver/matrix/block_matrix.h"

namespace drape {

// Of all relative motion, or along the connection only (solver/forces/damping.h).
enum class DampingKind { relative, axial };

// Which K stands in an implicit step.
enum class Stiffness {
  tangent,  // the positive semidefinite part of -df/dx here
  // Stiffer where a force falls off on the way to the rest length, so that a step does not overshoot it.
  chord,
  // Also what a slack connection will resist with once it is taut: slower, and never surprised.
  majorant,
};

// What a force is told before a step.
struct StepStart {
  double t, h;    // s
  const VecX& x;  // m, at t
  const VecX& v;  // m/s
};

class Force {
 public:
  virtual ~Force() = default;
  virtual std::string_view name() const = 0;
  // Of bodies in the way, and not of the cloth: what it stores is counted apart.
  virtual bool from_contact() const { return false; }

  // Which particles act on each other: the off-diagonal blocks that this force fills as long as it stands.
  virtual void list_pairs(std::vector<ParticlePair>& pairs) const = 0;
  // Whether it has stencils that come and go.
  virtual bool changes() const { return false; }
  // Finds those of a step; true when they are others than in the last one.
  virtual bool begin_step(const StepStart&) { return false; }
  // Their pairs, besides those of list_pairs.
  virtual void list_changing_pairs(std::vector<ParticlePair>&) const {}
  // Remembers where its blocks stand in matrices of this layout.
  virtual void bind(const BlockLayout& layout) = 0;

  // Pure functions of x and v, given the stencils of the step.
  virtual double energy(const VecX& x) const = 0;                                       // J
  virtual double dissipation(const VecX& /*x*/, const VecX& /*v*/) const { return 0; }  // v . D v / 2 [W]
  virtual void add_force(const VecX& x, const VecX& v, VecX& f) const = 0;              // f += force [N]
  // The two sides of an implicit step, linearised at (x, v):  A += c D + c^2 K,  b += c (f - K y).
  // c [s], y [m]: see solver/integrators/bdf.h.
  virtual void add_linearised(const VecX& x, const VecX& v, const VecX& y, double c, Stiffness stiffness,
                              BlockMatrix& A, VecX& b) const = 0;
};

}  // namespace drape
