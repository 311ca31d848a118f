#include "solver/linear/projected.h"

#include "solver/linear/residual.h"

namespace drape {

using namespace internal;

void ProjectedSystem::build_pattern(const BlockMatrix& A) {
  const int n = 3 * A.rows();
  matrix_.resize(n, n);
  int* outer = matrix_.outerIndexPtr();
  std::vector<int> inner;
  inner.reserve(static_cast<std::size_t>(A.pattern().blocks() + A.overlay().blocks()) * 9);
  for (int j = 0; j < A.rows(); ++j)  // the matrix is symmetric: row j of blocks is column j of blocks
    for (int c = 0; c < 3; ++c) {
      outer[3 * j + c] = static_cast<int>(inner.size());
      A.each(j, [&](int column, int) {
        for (int r = 0; r < 3; ++r)
          if (const int row = 3 * column + r; row >= 3 * j + c) inner.push_back(row);
      });
    }
  outer[n] = static_cast<int>(inner.size());
  matrix_.resizeNonZeros(static_cast<Eigen::Index>(inner.size()));
  std::copy(inner.begin(), inner.end(), matrix_.innerIndexPtr());
  serial_ = A.serial();
}

void ProjectedSystem::project(const BlockMatrix& A, const VecX& b, const Filter& filter,
                              const LinearOptions& options) {
  if (serial_ != A.serial()) build_pattern(A);
  right_.resize(b.size());
  z_.resize(b.size());
  reference_ = reference_impulse(A, b, filter, options, z_, right_);  // leaves S (b - A z) in right_

  constrained_.assign(static_cast<std::size_t>(A.rows()), -1);
  for (std::size_t e = 0; e < filter.entries().size(); ++e)
    constrained_[filter.entries()[e].particle] = static_cast<int>(e);
  const auto S_of = [&](int row) -> const FilterEntry* {
    const int e = constrained_[row];
    return e < 0 ? nullptr : &filter.entries()[e];
  };
  double* value = matrix_.valuePtr();
  for (int j = 0; j < A.rows(); ++j) {
    const FilterEntry* fj = S_of(j);
    int above = 0;  // how many numbers of the column stand above this block
    A.each(j, [&](int i, int slot) {
      const FilterEntry* fi = S_of(i);
      Mat3 block = A.at(slot).transpose();  // block (j, i) of a symmetric matrix, turned to (i, j)
      if (fi) block = fi->S * block;
      if (fj) block = block * fj->S;
      if (fi && i == j) block += Mat3::Identity() - fi->S;
      // Column c starts c entries lower, because its part above the diagonal is not stored.
      for (int c = 0; c < 3; ++c)
        for (int r = (i == j ? c : 0); r < 3; ++r)
          value[static_cast<std::ptrdiff_t>(matrix_.outerIndexPtr()[3 * j + c]) + above + r - c] =
              block(r, c);
      above += 3;
    });
  }
}

}  // namespace drape
