// What pushes on particles. Const once it is bound to the matrix pattern.
//   f = -dE/dx (+ damping),  K = -df/dx (positive semidefinite part),  D = -df/dv
// Vectors are in particle order, 3 a particle; the matrix is in row order (solver/matrix/block_matrix.h).
#pragma once

#include <string_view>
#include <vector>

#include "solver/matrix/block_matrix.h"

namespace drape {

enum class DampingKind {
  relative,
  axial
};  // of all relative motion, or along the connection only (solver/forces/damping.h)

// Which K stands in an implicit step.
enum class Stiffness {
  tangent,  // the positive semidefinite part of -df/dx here
  chord,  // stiffer where a force falls off on the way to the rest length, so that a step does not overshoot
          // it
  majorant,  // also what a slack connection will resist with once it is taut: slower, and never surprised
};

class Force {
 public:
  virtual ~Force() = default;
  virtual std::string_view name() const = 0;

  // Which particles act on each other: the off-diagonal blocks this force fills.
  virtual void list_pairs(std::vector<ParticlePair>& pairs) const = 0;
  // Remembers where its blocks stand in matrices of this pattern.
  virtual void bind(const BlockPattern& pattern) = 0;

  virtual double energy(const VecX& x) const = 0;                                       // J
  virtual double dissipation(const VecX& /*x*/, const VecX& /*v*/) const { return 0; }  // v . D v / 2 [W]
  virtual void add_force(const VecX& x, const VecX& v, VecX& f) const = 0;              // f += force [N]
  // The two sides of an implicit step, linearised at (x, v):  A += c D + c^2 K,  b += c (f - K y).
  // c [s], y [m]: see solver/integrators/bdf.h.
  virtual void add_linearised(const VecX& x, const VecX& v, const VecX& y, double c, Stiffness stiffness,
                              BlockMatrix& A, VecX& b) const = 0;
};

}  // namespace drape
