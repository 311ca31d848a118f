// The masses, and the forces that push them. A System is constant during a step.
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
  // masses: one per particle [kg]. Throws InputError when one is negative or not finite.
  explicit System(std::vector<double> masses);

  void add(std::unique_ptr<Force> force);
  void add(std::vector<std::unique_ptr<Force>> forces);
  void add(const Gravity& gravity);  // throws InputError when it is not finite

  int particles() const { return static_cast<int>(masses_.size()); }
  const std::vector<double>& masses() const { return masses_; }
  const Vec3& gravity_acceleration() const { return gravity_; }
  const std::vector<std::unique_ptr<Force>>& forces() const { return forces_; }
  bool goes_slack() const;  // whether any of the forces does

  // Returns the pattern of all forces together. On the first call after a change it builds the pattern and
  // binds the forces to it.
  const std::shared_ptr<const BlockPattern>& bind();
  // To be called before a step: forces find the stencils that come and go, whose blocks make up the overlay.
  void begin_step(const StepStart& start);
  void find_contacts(const StepStart& start);  // the same for forces of contact only, within a step
  void end_step(const VecX& x);                // to be called when a step has ended at x
  // A step that fails half-way goes back to what the forces knew of the past when they kept it.
  void keep();
  void go_back();
  BlockMatrix matrix();  // has the pattern, and the overlay as it is in each step

  double elastic_energy(const VecX& x) const;      // a function of x alone [J]
  double contact_energy(const VecX& x) const;      // of the step's contacts in which the cloth gives way [J]
  double stored_energy(const VecX& x) const;       // elastic and contact energy [J]
  double kinetic_energy(const VecX& v) const;      // J
  double gravity_energy(const VecX& x) const;      // zero at the origin [J]
  double total_energy(const State& state) const;   // kinetic and stored energy and that of gravity [J]
  VecX force(const VecX& x, const VecX& v) const;  // gravity included [N]
  double given_power(const VecX& x,
                     const VecX& v) const;  // by what is outside of the system, such as wind [W]

  // The name of the first force, or "gravity", that is not finite at (x, v); empty when all are finite.
  std::string_view not_finite_force(const VecX& x, const VecX& v) const;

 private:
  template <class Which>
  void find_stencils(const StepStart& start, const Which& which);
  void cover_changing();  // gives the overlay the blocks of the stencils that come and go

  std::vector<double> masses_;
  std::vector<std::unique_ptr<Force>> forces_;
  Vec3 gravity_ = Vec3::Zero();
  std::shared_ptr<const BlockPattern> pattern_;
  std::shared_ptr<BlockOverlay> overlay_;
  std::vector<ParticlePair> changing_;  // scratch of begin_step
};

}  // namespace drape
