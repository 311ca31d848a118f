// The air around a cloth, and its wind. On a triangle of area A, with the unit normal n, whose middle moves
// against the air at w = v - wind,
//   f = -rho A / 2 (C_n |w_n| w_n n + C_t |w_t| w_t),   w_n = w . n,   w_t = w - w_n n
// a third of it on each corner. So a flat sheet that falls broadside comes to v = sqrt(2 sigma g / (rho
// C_n)), whatever its mesh.
// The force is -dP/dv of P = rho A / 6 (C_n |w_n|^3 + C_t |w_t|^3), which is convex: D = dP^2/dv^2 is
// positive semidefinite as it stands. A and n are those of the step (StepStart::ahead) and stay in it.
// rho [kg/m^3]; C_n, C_t without unit; wind [m/s]; A [m^2].
#pragma once

#include <memory>

#include "mesh/triangles/triangle_mesh.h"
#include "solver/forces/force.h"

namespace drape {

struct Air {
  Vec3 wind = Vec3::Zero();  // m/s
  double density = 1.2;      // kg/m^3
  double drag = 1.2;         // C_n, of a plate square to the wind
  double skin_friction = 0;  // C_t, of both sides together
};

// Throws InputError, which names the field, when a value is negative or not finite.
void check(const Air& air);

// Of the triangles of a mesh; vertex 0 is the particle `first_particle` of the system.
std::unique_ptr<Force> air_drag(const TriangleMesh& mesh, const Air& air, int first_particle = 0);

// Of a regular grid of quads (mesh/obj/quad_grid.h): each is the mean of its two cuts into triangles. So the
// corners of a flat quad feel as much as each other, as they weigh as much as each other (choi_ko_mass).
std::unique_ptr<Force> air_drag_of_quads(const TriangleMesh& mesh, const Air& air, int first_particle = 0);

}  // namespace drape
