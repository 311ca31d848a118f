// The modified preconditioned conjugate gradient.                              [Baraff & Witkin 1998,
// section 5.3]
//   Start dv_0 = S guess + z and the symmetric convergence test of [Ascher & Boxerman 2003]; preconditioner:
//   the inverses of the 3x3 diagonal blocks of the projected matrix S A S + I - S.
#pragma once

#include "solver/linear_solver.h"

namespace drape {

class Mpcg final : public LinearSolver {
 public:
  std::string_view name() const override { return "mpcg"; }
  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override;

 private:
  void resize(Eigen::Index n);
  bool invert_diagonal(const BlockMatrix& A, const Filter& filter);

  VecX r_, d_, q_, s_;
  std::vector<double> inverse_;  // symmetric 3x3 blocks, 6 numbers a row of A
};

}  // namespace drape
