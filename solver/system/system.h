// Masses and forces: all that pushes. Const during a step.
//   f(x, v) = sum of the forces + m g;   E(x) = their energy;   particles of mass 0 stay where they are.
#pragma once

#include <memory>
#include <vector>

#include "solver/forces/force.h"
#include "solver/system/state.h"

namespace drape {

struct Gravity {
  Vec3 g = {0, -9.81, 0};  // m/s^2
};
inline Gravity gravity(const Vec3& g) { return {g}; }

class System {
 public:
  // kg, one per particle. Throws InputError when one is negative or not finite.
  explicit System(std::vector<double> masses);

  void add(std::unique_ptr<Force> force);
  void add(std::vector<std::unique_ptr<Force>> forces);
  void add(const Gravity& gravity) { gravity_ = gravity.g; }

  int particles() const { return static_cast<int>(masses_.size()); }
  const std::vector<double>& masses() const { return masses_; }
  const Vec3& gravity_acceleration() const { return gravity_; }
  const std::vector<std::unique_ptr<Force>>& forces() const { return forces_; }

  // The pattern of all forces together; built, and the forces bound to it, on the first call after a change.
  const std::shared_ptr<const BlockPattern>& bind();
  // Before a step: forces find the stencils that come and go, whose blocks make up the overlay.
  void begin_step(const StepStart& start);
  BlockMatrix matrix();  // of the pattern, and of the overlay as it will be in each step

  double elastic_energy(const VecX& x) const;     // J, a function of x alone
  double contact_energy(const VecX& x) const;     // J, of the contacts of the step, where the cloth gives way
  double stored_energy(const VecX& x) const;      // J, both
  double kinetic_energy(const VecX& v) const;     // J
  double gravity_energy(const VecX& x) const;     // J, zero at the origin
  double total_energy(const State& state) const;  // J: kinetic, stored and of gravity
  VecX force(const VecX& x, const VecX& v) const;  // N, gravity included

  // Which force first gives something that is not a finite number at (x, v); "gravity" and the like. Empty:
  // none does.
  std::string_view not_finite_force(const VecX& x, const VecX& v) const;

 private:
  void cover_changing();  // the overlay gets the blocks of the stencils that come and go

  std::vector<double> masses_;
  std::vector<std::unique_ptr<Force>> forces_;
  Vec3 gravity_ = Vec3::Zero();
  std::shared_ptr<const BlockPattern> pattern_;
  std::shared_ptr<BlockOverlay> overlay_;
  std::vector<ParticlePair> changing_;  // scratch of begin_step
};

}  // namespace drape
