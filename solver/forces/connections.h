// The connections that join the particles of a cloth, as plain numbers. A model makes these numbers from a
// mesh (solver/forces/noh_jung.h, solver/forces/choi_ko.h), and forces are made from them. The ends i, j are
// vertices of the mesh.
//   stretch  TensionSpring                                        k [N/m], L [m]
//   bend     BucklingSpring                                       k_b [N m^2], c_b [N/m], L [m]
//   damping  PairDamping along both kinds                         k_d [N s/m], of the fabric
//
// The clamp c_b of the bend connections makes their response continuous but removes bending rigidity below a
// curvature kappa; c_b kappa^2 is a constant of the connection. By default c_b is chosen so that kappa is at
// most a tenth of the curvature that the fabric takes under its own weight,
//   limp_curvature = 0.1 / c,  c = (B / (sigma g))^(1/3) the bending length of the fabric,
// but c_b is kept between k_s and stiffest_clamp k_s: a stiffer clamp would cost more than the rigidity is
// worth. (limp_below says when a mesh is so fine that the lost rigidity shows.)
#pragma once

#include <memory>
#include <vector>

#include "solver/forces/fabric.h"
#include "solver/forces/force.h"

namespace drape {

struct StretchConnection {
  int i, j;
  double L;  // m
  double k;  // N/m
};

struct BendConnection {
  int i, j;
  double L;         // m
  double k_b;       // N m^2
  double clamp_k2;  // N/m/m^2: c_b times the square of the curvature below which it goes limp
  double B;         // N m: the bending rigidity that k_b amounts to here
};

struct Connections {
  std::vector<StretchConnection> stretch;
  std::vector<BendConnection> bend;
};

// Divides every mass m_i by w_i = max_k N_k / N_i, where N_i is the number of particles to which i is
// connected. This gives exactly Noh & Jung's weighted forces (eq. 1-3), as a symmetric system.
std::vector<double> neighbour_weighted(std::vector<double> masses, const Connections& connections);

// The curvature 0.1 / c [1/m] for a bending rigidity [N m] and an area density [kg/m^2] under g = 9.81 m/s^2.
double limp_curvature(double bend, double area_density);

inline constexpr double stiffest_clamp = 10;  // times k_s

// Makes the forces. Vertex v is the particle first_particle + v of the system. Connections without stiffness
// give no force.
std::vector<std::unique_ptr<Force>> forces_of(const Connections& connections, const Fabric& fabric,
                                              int first_particle = 0);

// The curvature [1/m] below which the clamp makes this cloth limp: the median over the bend connections, or 0
// when there are none.
double limp_below(const Connections& connections, const Fabric& fabric);

}  // namespace drape
