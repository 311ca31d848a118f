// Cloths, soft bodies, bodies and pins as one system that is stepped, while seams close and are merged.
//   Assembly all;                                  gravity and the way of contact, by default the usual ones
//   all.add(...)                                   every cloth and soft body
//   all.constraints->add(...), all.pin(...)        bodies and pins, in any order
//   all.use("implicit-euler", "mpcg+block-ic0")    makes the system, and may change the integrator later
//   all.advance(h)                                 steps, as often as you like
// Merging two particles adds their masses and momenta; positions are averaged by mass, so that the centre of mass
// stays, and what is pinned stays where its first pin holds it. Then system and integrator are made anew.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "solver/assembly/cloth.h"
#include "solver/integrators/integrator.h"

namespace drape {

using MakeIntegrator = std::function<std::unique_ptr<Integrator>(System&, Constraints&)>;

struct Assembly {
  explicit Assembly(const Vec3& gravity = {0, -9.81, 0}, ContactOptions contact = {});  // m/s^2

  std::vector<Cloth> cloths;  // cloths and soft bodies as they were added
  std::unique_ptr<System> system;
  std::unique_ptr<Constraints> constraints;
  std::unique_ptr<Integrator> integrator;  // refers to the two above
  State state;
  std::vector<State> outgrown;     // as it was when particles became one: arrays may look at it still
  MakeIntegrator make_integrator;  // makes the integrator, now and again when particles have become one
  double given = 0;  // J, by seams so far: their pull, and what the cloth gets when they are merged

  // The reference is good until the next one is added. Throw InputError when a mesh cannot be simulated, a
  // fabric or a material is none, or use() was called already.
  Cloth& add(ClothPart part);
  Cloth& add(SoftPart part);

  // Holds what the rule selects of cloths[k] where it is. Throws InputError when that is nothing.
  void pin(const PinRule& rule, std::size_t k = 0);

  // Makes the system when it is called first, and takes this integrator from now on. Corners and rims of bodies
  // are kept off the inside of triangles when there are bodies by then.
  void use(MakeIntegrator make);
  void use(const std::string& integrator, const std::string& linear_solver, const StepOptions& options = {});

  // One step, h [s]. Seams go on closing; those that have closed are merged after it.
  StepReport advance(double h);

  const Cloth& cloth_of(int particle) const;

 private:
  using Forces = std::vector<std::unique_ptr<Force>>;

  Cloth& take(Cloth cloth, const std::vector<Vec3>& positions, const std::vector<double>& masses);
  // Adds the forces of a part as it is sewn by now, and notes its edges.
  void connect(Cloth& cloth, Forces& forces) const;
  void connect(Cloth& cloth, const Connections& connections, Forces& forces) const;
  void make_system(std::vector<double> masses, Forces forces);
  bool merge_closed_seams();
  State merged_state(const std::vector<double>& masses, const std::vector<int>& number) const;

  Vec3 gravity_;
  // Until the system is made.
  std::vector<double> masses_;    // kg
  Forces forces_;                 // of all parts
  std::vector<ClothFace> faces_;  // of all parts
};

}  // namespace drape
