// A 3x3 block of a sparse matrix in vectors, one for each column. Three of their four lanes count.
#pragma once

#include "solver/matrix/four.h"

namespace drape::internal {

// A block as it is kept.
struct FloatBlock {
  FourFloats column[3];

  template <class Scalar>
  explicit FloatBlock(const Scalar* b) : column{floats(b), floats(b + 3), floats(b + 6)} {}

  bool is_zero() const {
    const auto other = (column[0] != 0) | (column[1] != 0) | (column[2] != 0);
    return (other[0] | other[1] | other[2]) == 0;
  }
  FloatBlock transpose() const {
    const auto [a, b, c] = column;
    const FourFloats low = __builtin_shufflevector(a, b, 0, 4, 1, 5),
                     high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    FloatBlock result = *this;
    result.column[0] = __builtin_shufflevector(low, c, 0, 1, 4, 4);
    result.column[1] = __builtin_shufflevector(low, c, 2, 3, 5, 5);
    result.column[2] = __builtin_shufflevector(high, c, 0, 1, 6, 6);
    return result;
  }
  void store(float* to) const {  // writes one number more than nine
    for (int k = 0; k < 3; ++k) internal::store(column[k], to + 3 * k);
  }
};

// A block in which is calculated.
struct alignas(32) WideBlock {
  Four column[3] = {};

  void set(const double* b) {  // reads one number more than nine
    for (int k = 0; k < 3; ++k) column[k] = load(b + 3 * k);
  }
  void transpose() {
    const auto [a, b, c] = column;
    const Four low = __builtin_shufflevector(a, b, 0, 4, 2, 6),
               high = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    column[0] = __builtin_shufflevector(low, c, 0, 1, 4, 5);
    column[1] = __builtin_shufflevector(high, c, 0, 1, 5, 4);
    column[2] = __builtin_shufflevector(low, c, 2, 3, 6, 7);
  }
  template <class Scalar>
  void add(const Scalar* b) {
    for (int k = 0; k < 3; ++k) column[k] += load(b + 3 * k);
  }
  // What is lost of b where it is kept in floats.
  void add_lost(const double* b, const FloatBlock& kept) {
    for (int k = 0; k < 3; ++k) column[k] += load(b + 3 * k) - __builtin_convertvector(kept.column[k], Four);
  }
  void add_lost(const float*, const FloatBlock&) {}
  void add_product(const double* a, const WideBlock& b) {
    const Four a0 = load(a), a1 = load(a + 3), a2 = load(a + 6);
    for (int k = 0; k < 3; ++k) column[k] += a0 * b.column[k][0] + a1 * b.column[k][1] + a2 * b.column[k][2];
  }
  template <class A, class B>
  void add_product(const A* a, const B* b) {
    const Four a0 = load(a), a1 = load(a + 3), a2 = load(a + 6);
    for (int k = 0; k < 3; ++k) {
      const double b0 = b[3 * k], b1 = b[3 * k + 1], b2 = b[3 * k + 2];
      column[k] += a0 * b0 + a1 * b1 + a2 * b2;
    }
  }
  void store(double* to) const {
    for (int k = 0; k < 3; ++k)
      for (int r = 0; r < 3; ++r) to[3 * k + r] = column[k][r];
  }
  void store(float* to) const {  // writes one number more than nine
    for (int k = 0; k < 3; ++k) internal::store(narrow(column[k]), to + 3 * k);
  }
};

}  // namespace drape::internal
