// The force of a plate (solver/forces/plate.h): the pairs, whose stiffness is constant, and what of its rest
// shape is bent.
//   E = 1/2 sum_pairs k |x_i - x_j|^2 + sum over bent triangles (E_0 - sum_v x_v . R c_v)
// R are the axes of the triangle as it turns (solver/forces/triangle_frame.h); c_v [N], in these axes, is the
// force on vertex v by which the triangle's rest curvature acts, and E_0 [J] its energy when laid flat. As
// the axes turn with the cloth, E is the same wherever the cloth is moved to; it is zero in the rest shape.
//
// K is that of the pairs, which is positive semidefinite: how the bent triangles' forces change with x is
// left out of the matrix. On the right side it is not: their force is taken at x + y, where an undisturbed
// step ends, so that bent cloth that spins is not slowed.
// The viscosity is D = T K of the pairs, with a time T [s].
#pragma once

#include "solver/forces/chunk_schedule.h"
#include "solver/forces/force.h"
#include "solver/forces/plate.h"
#include "solver/forces/plate_parts.h"

namespace drape {

class PlateForce final : public Force {
 public:
  // Vertex 0 of the plate is the particle `first_particle`. time: T [s].
  PlateForce(const PlateEnergy& plate, double time, int first_particle = 0);

  std::string_view name() const override { return "bend"; }
  void list_pairs(std::vector<ParticlePair>& pairs) const override;
  void bind(const BlockLayout& layout) override;
  double energy(const VecX& x) const override;
  double energy_noise(const VecX& x) const override;
  double dissipation(const VecX& x, const VecX& v) const override;
  void add_force(const VecX& x, const VecX& v, VecX& f) const override;
  void add_linearised(const VecX& x, const VecX& v, const VecX& y, double c, Stiffness stiffness,
                      BlockMatrix& A, VecX& b) const override;
  bool projects() const override { return true; }
  void begin_substep(int particles) override { parts_.colour(particles); }
  void project(Substep& substep) override;

 private:
  struct Pair {
    int i, j;
    double k;  // N/m
    int slot;  // of the block (i, j), which is the same transposed
  };
  struct Diagonal {
    int slot;
    double k;  // N/m, the sum over the particle's pairs
  };

  template <class At>
  void add_pairs(const At& at, VecX& f) const;
  template <class At>
  void add_bent(const At& at, double factor, VecX& f) const;

  double time_;         // s
  double pull_, size_;  // N, J: of the terms of the energy (PlateEnergy)
  std::vector<Pair> pairs_;
  std::vector<Diagonal> diagonal_;
  std::vector<BentTriangle> bent_;
  ChunkSchedule schedule_, diagonal_schedule_;
  PlateParts parts_;              // of the integrator "pbd", as is the rest
  VecX bent_impulse_, bent_now_;  // on each particle, of the bent triangles [N s]
};

}  // namespace drape
