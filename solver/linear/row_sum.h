// One row of a sparse product while it is summed: which columns it has, and the sums of their blocks.
#pragma once

#include <vector>

#include "solver/linear/wide_block.h"

namespace drape::internal {

class RowSum {
 public:
  // There may be one at a time in each thread, because they share what they write into.
  explicit RowSum(int columns) : scratch_(of_thread()) {
    if (scratch_.place.size() < static_cast<std::size_t>(columns)) scratch_.place.resize(columns, -1);
    place_ = scratch_.place.data();
    look();
  }
  ~RowSum() { clear(); }
  RowSum(const RowSum&) = delete;
  RowSum& operator=(const RowSum&) = delete;

  WideBlock& at(int column) {
    int place = place_[column];
    if (place < 0) {
      if (count_ == room_) grow();
      place = place_[column] = count_;
      column_[count_++] = column;
    }
    return sum_[place];
  }

  // Calls f(column, sum) in the order in which the columns came; then the row is empty again.
  template <class F>
  void take(const F& f) {
    for (int k = 0; k < count_; ++k) f(column_[k], sum_[k]);
    clear();
  }

  void clear() {
    for (int k = 0; k < count_; ++k) {
      place_[column_[k]] = -1;
      for (Four& c : sum_[k].column) c = Four{0, 0, 0, 0};
    }
    count_ = 0;
  }

 private:
  struct Scratch {
    std::vector<int> place, column;  // column -> place in the sum, -1: none; and back
    std::vector<WideBlock> sum;      // zero where no column is
  };
  static Scratch& of_thread() {
    thread_local Scratch scratch;
    return scratch;
  }
  [[gnu::noinline]] void grow() {
    scratch_.column.resize(2 * scratch_.sum.size() + 16);
    look();  // even if the next line throws
    scratch_.sum.resize(scratch_.column.size());
    look();
  }
  void look() {
    column_ = scratch_.column.data();
    sum_ = scratch_.sum.data();
    room_ = static_cast<int>(scratch_.sum.size());
  }

  Scratch& scratch_;
  int *place_, *column_;
  WideBlock* sum_;
  int count_ = 0, room_;
};

}  // namespace drape::internal
