// Cloths, soft bodies, ropes, bodies and pins as one system that is stepped, while seams close and are merged.
//   Assembly all;                                  gravity and options of contact, the usual ones by default
//   all.add(...)                                   every cloth, soft body and rope
//   all.constraints->add(...), all.pin(...)        bodies and pins, in any order
//   all.use("implicit-euler", "auto")              makes the system, and may change the integrator later
//   all.advance(h)                                 steps, as often as you like
// Where two particles are merged their masses and momenta are added. Positions are averaged by mass, so that
// the centre of mass stays; a pinned particle stays where its first pin holds it. Then the system and the
// integrator are made anew.
//   Where a cloth tears (solver/assembly/tear_rule.h), a particle parts: its copies have its place and its velocity, and
// all of them together have its mass. Copies come after the particles of their cloth, so those of later parts get higher
// numbers; the system and the integrator are made anew here, too.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "solver/assembly/cloth.h"
#include "solver/forces/air.h"
#include "solver/integrators/integrator.h"

namespace drape {

using MakeIntegrator = std::function<std::unique_ptr<Integrator>(System&, Constraints&)>;

struct Assembly {
  // gravity [m/s^2]. Without air nothing slows the cloth; soft bodies and ropes do not feel it.
  explicit Assembly(const Vec3& gravity = {0, -9.81, 0}, ContactOptions contact = {},
                    std::optional<Air> air = {});

  std::vector<Cloth> cloths;  // cloths, soft bodies and ropes as they were added
  std::unique_ptr<System> system;
  std::unique_ptr<Constraints> constraints;
  std::unique_ptr<Integrator> integrator;  // refers to `system` and `constraints`
  State state;
  // The states from before particles became one or parted; they are kept because arrays may still look at them.
  std::vector<State> outgrown;
  // false: none of them is kept, because nothing looks at them.
  bool keep_outgrown = true;
  // Makes the integrator, at first and again whenever particles have become one or parted.
  MakeIntegrator make_integrator;
  // Energy that seams have given so far [J]: by their pull, and to the cloth when they are merged.
  double given = 0;

  // The reference is valid until the next part is added. These throw InputError when a mesh cannot be
  // simulated, when a fabric or a material makes no sense, or when use() was called before.
  Cloth& add(ClothPart part);
  Cloth& add(SoftPart part);
  Cloth& add(RopePart part);

  // Holds the particles that the rule selects of cloths[k] where they are. Throws InputError when it selects
  // nothing.
  void pin(const PinRule& rule, std::size_t k = 0);

  // How cloths[k] and cloths[l] rub on each other (k = l: one on itself), instead of by the friction of both. Throws
  // InputError when it is negative or not finite.
  void set_friction(std::size_t k, std::size_t l, double friction);

  // Makes the system at the first call, and steps with this integrator from then on. If there are bodies by
  // the first call, their corners and rims are kept from coming through triangles. Vertices of Cloth::at_one_place
  // become one particle then, and particles have other numbers: Cloth::embedding tells them.
  void use(MakeIntegrator make);
  void use(const std::string& integrator, const std::string& linear_solver, const StepOptions& options = {});

  // Takes one step of h [s]. Seams go on closing in it; those that have closed are merged after it, and what is
  // strained too far is torn.
  StepReport advance(double h);

  const Cloth& cloth_of(int particle) const;

 private:
  using Forces = std::vector<std::unique_ptr<Force>>;

  void meet(const Cloth& cloth, const SelfContactOptions& options, const std::vector<Triangle>& faces,
            const std::vector<std::optional<int>>& layers);
  void meet(const Cloth& rope, const RopeContact& options);
  Cloth& take(Cloth cloth, const std::vector<Vec3>& positions, const std::vector<double>& masses);
  // Adds the forces of a part, as far as it has been sewn, and notes its edges.
  void connect(Cloth& cloth, Forces& forces) const;
  void make_system(std::vector<double> masses, Forces forces);
  using Pairs = std::vector<std::pair<int, int>>;  // of vertices
  bool merge_closed_seams();
  // The vertices of each pair become one particle, for each cloth.
  void merge(const std::vector<Pairs>& pairs);
  void sew();
  int tear_cloths();  // returns how many edges it has cut
  void part_particles(const std::vector<std::vector<std::pair<int, int>>>& cuts);  // edges to cut, by cloth
  State merged_state(const std::vector<double>& masses, const std::vector<int>& number) const;

  Vec3 gravity_;
  std::optional<Air> air_;
  // These are in use until the system is made.
  std::vector<double> masses_;              // kg
  Forces forces_;                           // of all parts
  std::vector<ClothFace> faces_;            // of all parts
  std::vector<SelfFace> self_;              // of the cloths that meet cloth
  std::vector<SelfSegment> self_segments_;  // of the ropes that do
};

}  // namespace drape
