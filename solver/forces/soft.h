// The springs of a soft body: those of a lattice of particles (mesh/lattice/lattice.h), of three kinds. [SB]
//   LinearSpring  structural, shear and bend springs, each kind with its own k [N/m]
//   damping       along every spring, or of all relative motion (PairDamping)
// In place of the three stiffnesses, Young's modulus E [Pa] (`young`) can be given. It makes an isotropic
// solid with Poisson's ratio 1/4, the only one that springs between points can have (Cauchy's relation). The
// cells are cubes of edge a [m], and the stiffness of a spring is multiplied by the filled fraction of the
// cells around it:
//   k_structural = 22/35 E a,   k_shear = 6/35 E a,   k_bend = 0
//   They follow from C_ijkl = 1/V sum k l^2 t_i t_j t_k t_l:  C11 = (k_s + 10/3 k_h) / a,
//   C12 = C44 = 7/3 k_h / a  (k_s structural, k_h shear), and the condition of isotropy C11 = 3 C12.
// So a lattice of any shape has exactly this modulus under an affine strain.
#pragma once

#include <memory>
#include <optional>

#include "mesh/lattice/lattice.h"
#include "solver/forces/force.h"

namespace drape {

struct SoftMaterial {
  double density = 300;                        // kg/m^3: an eighth of each cell to each of its corners
  std::optional<double> mass = {};             // kg, of the whole body; replaces density
  bool equal_masses = false;                   // gives all particles the same mass, as in [SB]
  std::optional<double> young = 20e3;          // Pa, Young's modulus; replaces the three below
  double structural = 0, shear = 0, bend = 0;  // N/m, of every spring
  double damping = 0;                          // N s/m, of every spring
  DampingKind damping_kind = DampingKind::axial;
  double viscosity =
      0;  // s, viscosity over stiffness, of clusters (solver/forces/cluster.h), which have no springs
};

// Throws InputError, which names the field, when a value is negative, not finite, or zero where it may not
// be.
void check(const SoftMaterial& material);

// The masses of the particles [kg]. `volume` [m^3] is the volume of the body, which carries the whole mass;
// unset, it is the volume of the cells.
std::vector<double> masses(const Lattice& lattice, const SoftMaterial& material,
                           std::optional<double> volume = {});

struct SoftSpring {
  int i, j;  // particles of the system
  double L;  // m
  double k;  // N/m
};
// These springs, and their damping as the material has it.
std::vector<std::unique_ptr<Force>> forces_of(const std::vector<SoftSpring>& springs,
                                              const SoftMaterial& material);

// The springs and the damping of a body whose particle 0 is the particle `first_particle` of the system.
std::vector<std::unique_ptr<Force>> soft_body(const Lattice& lattice, const SoftMaterial& material,
                                              int first_particle = 0);

}  // namespace drape
