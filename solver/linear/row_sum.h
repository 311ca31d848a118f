// One row of a sparse product while it is summed: which columns it has, and the sums of their blocks.
#pragma once

#include <vector>

#include "solver/linear/sparse_rows.h"

namespace drape::internal {

struct WideBlock {  // three of the four lanes count
  Four column[3] = {};

  template <class Scalar>
  void add(const Scalar* b) {
    for (int k = 0; k < 3; ++k) column[k] += load(b + 3 * k);
  }
  template <class A, class B>
  void add_product(const A* a, const B* b) {
    const Four a0 = load(a), a1 = load(a + 3), a2 = load(a + 6);
    for (int k = 0; k < 3; ++k) {
      const Four bk = load(b + 3 * k);
      column[k] += a0 * bk[0] + a1 * bk[1] + a2 * bk[2];
    }
  }
  template <class Scalar>
  void store(Scalar* to) const {
    for (int k = 0; k < 3; ++k)
      for (int r = 0; r < 3; ++r) to[3 * k + r] = static_cast<Scalar>(column[k][r]);
  }
};

class RowSum {
 public:
  explicit RowSum(int columns) : place_(static_cast<std::size_t>(columns), -1) {}

  WideBlock& at(int column) {
    int& place = place_[column];
    if (place < 0) {
      place = static_cast<int>(column_.size());
      column_.push_back(column);
      sum_.emplace_back();
    }
    return sum_[place];
  }

  // Calls f(column, sum) in the order in which the columns came; then the row is empty again.
  template <class F>
  void take(const F& f) {
    for (std::size_t k = 0; k < column_.size(); ++k) {
      f(column_[k], sum_[k]);
      place_[column_[k]] = -1;
    }
    column_.clear();
    sum_.clear();
  }

 private:
  std::vector<int> place_, column_;
  std::vector<WideBlock> sum_;
};

}  // namespace drape::internal
