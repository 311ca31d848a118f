// The matrix of an implicit step and its linear solver, with all vectors in particle order:
//   A = M + c D + c^2 K   at a point (x, v), with the dampers of friction on its diagonal.
#pragma once

#include <memory>

#include "solver/linear/linear_solver.h"
#include "solver/system/system.h"

namespace drape {

// The point at which forces are linearised.
struct Linearisation {
  const VecX& x;  // m
  const VecX& v;  // m/s
  const VecX& y;  // see solver/integrators/bdf.h [m]
  double c;       // s
  Stiffness stiffness;
};

class NewtonMatrix {
 public:
  NewtonMatrix(System& system, std::unique_ptr<LinearSolver> solver)
      : system_(system), solver_(std::move(solver)) {}

  // True when the system has another pattern than before: what has its size must then be made anew.
  bool follow_system();
  // Assembles A from these masses [kg], and adds c (f - K y) to b. What lasts, of all forces but those of
  // contact and those whose stencils come and go, is kept when `keep` is true.
  void assemble(const Linearisation& at, const std::vector<double>& masses, VecX& b, bool keep = false);
  // The same at the point at which it was kept, anew for those forces alone. b is set.
  void assemble_changing(const Linearisation& at, VecX& b);
  // Sets the blocks c D of what rubs on single particles, in place of those set before: particle(k) and
  // block(k) for every k < count.
  template <class Particle, class Block>
  void rub(std::size_t count, const Particle& particle, const Block& block);

  // Solves A dv = b within the filter; dv goes in as the guess.
  LinearReport solve(const VecX& b, const Filter& filter, const LinearOptions& options, VecX& dv);
  // Sets r = A dv - b of the last solve: the impulse with which the constraints hold the particles [N s].
  void reaction(VecX& r);

  double curvature(const VecX& v, const VecX& from);  // d . A d [J] with d = v - from [m/s]

  // What a particle that is pushed alone takes up for 1 m/s, a third of the trace of its block [kg].
  double inertia(int particle) const { return A_->at(A_->pattern().diagonal(row(particle))).trace() / 3; }

  const BlockMatrix& matrix() const { return *A_; }
  // The force with the largest stiffness at a particle, or one that is not finite there: to be named when a
  // solve failed at that particle. Overwrites the matrix.
  std::string stiffest_force(int particle, const Linearisation& at);

 private:
  void add(const Linearisation& at, bool changing, VecX& b);
  static void add_up_rows(std::vector<DiagonalBlock>& blocks);
  int row(int particle) const { return A_->pattern().row_of()[particle]; }

  System& system_;
  std::unique_ptr<LinearSolver> solver_;
  std::unique_ptr<BlockMatrix> A_;
  Filter filter_;                    // in row order
  std::vector<DiagonalBlock> rubs_;  // in row order
  VecX b_rows_, dv_rows_, r_rows_, d_rows_, Ad_rows_;
  VecX kept_b_;  // in particle order
};

template <class Particle, class Block>
void NewtonMatrix::rub(std::size_t count, const Particle& particle, const Block& block) {
  rubs_.clear();
  for (std::size_t k = 0; k < count; ++k) rubs_.push_back({row(particle(k)), block(k)});
  add_up_rows(rubs_);  // of particles that two bodies rub
  A_->set_diagonal_additions(rubs_);
}

}  // namespace drape
