// A force that has no matrix: its elements change positions, as the integrator "pbd" asks them to
// (solver/forces/substep.h), and explicit integrators take what it pushes with. Implicit integrators do not
// take it.
#pragma once

#include "solver/forces/force.h"

namespace drape {

class ProjectedForce : public Force {
 public:
  bool only_projects() const final { return true; }
  bool projects() const final { return true; }
  void list_pairs(std::vector<ParticlePair>&) const final {}
  void bind(const BlockLayout&) final {}
  void add_linearised(const VecX&, const VecX&, const VecX&, double, Stiffness, BlockMatrix&,
                      VecX&) const final {}
};

}  // namespace drape
