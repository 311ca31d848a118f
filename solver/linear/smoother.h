// Symmetric block Gauss-Seidel in float: one pass over the matrix on the way down, residual included, and one
// on the way up.                                                             [Briggs, Henson & McCormick
// 2000]
//   A = L + D + U:   down from x = 0:  (L + D) x = r,  r - A x = -U x;      up:  (D + U) x_new = r - L x
// Rows are cut into chunks at least as long as the bandwidth and numbered anew: first all even chunks, then
// all odd ones. Those of one kind do not touch each other, so they are swept side by side, and the sweep up
// is the adjoint of the sweep down, whatever the number of threads.
#pragma once

#include "solver/linear/float_csr.h"

namespace drape {

class Smoother {
 public:
  explicit Smoother(const BlockCsr& A);

  int rows() const { return static_cast<int>(old_of_.size()); }
  int new_of(int row) const { return new_of_[static_cast<std::size_t>(row)]; }  // row of A -> row here
  int old_of(int row) const { return old_of_[static_cast<std::size_t>(row)]; }

  void down(const VecXf& r, VecXf& x, VecXf& residual) const;
  void up(const VecXf& r, VecXf& x) const;

 private:
  template <class F>
  void for_rows_of(bool odd, const F& f) const;  // f(begin, end) for every chunk of that kind
  void solve_diagonal(int row, FourFloats right, float* x) const;

  std::vector<int> new_of_, old_of_, even_, odd_;  // where the chunks of each kind begin, and end
  FloatCsr lower_, upper_;
  std::vector<float> inverse_;  // D^-1: 9 a row, and 1 more
};

}  // namespace drape
