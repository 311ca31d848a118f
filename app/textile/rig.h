// A specimen in a testing machine: clamped, and brought to rest.
#pragma once

#include <functional>
#include <memory>

#include "app/textile/specimen.h"
#include "constraints/constraints.h"
#include "solver/assembly/cloth.h"
#include "solver/integrators/integrator.h"
#include "solver/system/system.h"

namespace drape::app {

// What a specimen is cut from, and how.
struct Cut {
  Fabric fabric;
  ClothModel model = ClothModel::woven;
  double angle = 0;  // rad, from the warp to the x axis of the specimen
};

class Rig {
 public:
  // Every vertex starts at start(x), where x [m] is its place in the specimen; the vertices in the clamps
  // stay there. Throws InputError when the model cannot be made of the fabric.
  Rig(const Specimen& specimen, const Cut& cut, const Vec3& gravity,
      const std::function<Vec3(const Vec3&)>& start);
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  void set_gravity(const Vec3& g) { system_.add(gravity(g)); }  // m/s^2
  // Takes a step of h seconds. False when it failed: the state is then as before.
  bool step(double h) { return integrator_->advance(state_, h).done; }
  // Steps of h seconds until nothing is faster than `speed` [m/s]. False when a step failed, or after `most`
  // steps.
  bool settle(double h, double speed, int most);

  // Brings a specimen that is loaded by its clamps alone to equilibrium: by steps so long that inertia does
  // not count.
  bool relax() { return settle(10, 1e-11, 400); }

  const State& state() const { return state_; }
  Vec3 place(int vertex) const { return state_.x.segment<3>(3 * vertex); }  // m
  Vec3 pull_on(const std::vector<int>& vertices) const;  // N, what a clamp has to hold against, summed up
  double stored_energy() const { return system_.elastic_energy(state_.x); }   // J
  double gravity_energy() const { return system_.gravity_energy(state_.x); }  // J
  double kinetic_energy() const { return system_.kinetic_energy(state_.v); }  // J

 private:
  System system_;
  Constraints constraints_;
  State state_;
  std::unique_ptr<Integrator> integrator_;
};

}  // namespace drape::app
