#include "solver/linear/aggregation.h"

#include <Eigen/LU>

namespace drape {
namespace {

constexpr int none = -1, alone = -2;

// Whether each block couples strongly; the diagonal counts as strong.
std::vector<char> strong_couplings(const BlockCsr& A, double theta) {
  const int n = A.rows();
  std::vector<double> size(static_cast<std::size_t>(n), 0.0);  // |A_ii|
  for (int i = 0; i < n; ++i)
    for (int k = A.begin(i); k < A.end(i); ++k)
      if (A.at(k) == i) size[static_cast<std::size_t>(i)] = A[k].norm();
  std::vector<char> strong(A.column.size());
  for_chunks(n, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      for (int k = A.begin(i); k < A.end(i); ++k) {
        const double both = size[static_cast<std::size_t>(i)] * size[static_cast<std::size_t>(A.at(k))];
        strong[static_cast<std::size_t>(k)] = A.at(k) == i || A[k].squaredNorm() > theta * theta * both;
      }
  });
  return strong;
}

// vertex -> aggregate; `alone` for those that take no part. Returns how many aggregates there are.
int aggregate(const BlockCsr& A, const std::vector<char>& strong, std::vector<int>& of) {
  const int n = A.rows();
  int count = 0;
  const auto each_strong = [&](int i, const auto& f) {
    for (int k = A.begin(i); k < A.end(i); ++k)
      if (const int j = A.at(k);
          j != i && strong[static_cast<std::size_t>(k)] && of[static_cast<std::size_t>(j)] != alone)
        f(j, k);
  };
  // What is coupled to nothing strongly is solved by the smoother alone.
  for (int i = 0; i < n; ++i) {
    bool coupled = false;
    for (int k = A.begin(i); k < A.end(i); ++k)
      coupled = coupled || (A.at(k) != i && strong[static_cast<std::size_t>(k)]);
    if (!coupled) of[static_cast<std::size_t>(i)] = alone;
  }
  // A vertex none of whose neighbours is taken begins an aggregate with all of them.
  for (int i = 0; i < n; ++i) {
    if (of[static_cast<std::size_t>(i)] != none) continue;
    bool untouched = true;
    each_strong(i, [&](int j, int) { untouched = untouched && of[static_cast<std::size_t>(j)] == none; });
    if (!untouched) continue;
    of[static_cast<std::size_t>(i)] = count;
    each_strong(i, [&](int j, int) { of[static_cast<std::size_t>(j)] = count; });
    ++count;
  }
  // The others join the aggregate they are coupled to most strongly.
  const std::vector<int> before = of;
  for (int i = 0; i < n; ++i) {
    if (of[static_cast<std::size_t>(i)] != none) continue;
    double most = 0;
    each_strong(i, [&](int j, int k) {
      if (before[static_cast<std::size_t>(j)] < 0 || A[k].squaredNorm() <= most) return;
      most = A[k].squaredNorm();
      of[static_cast<std::size_t>(i)] = before[static_cast<std::size_t>(j)];
    });
  }
  // What is left forms aggregates with its own kind.
  for (int i = 0; i < n; ++i) {
    if (of[static_cast<std::size_t>(i)] != none) continue;
    of[static_cast<std::size_t>(i)] = count;
    each_strong(i, [&](int j, int) {
      if (of[static_cast<std::size_t>(j)] == none) of[static_cast<std::size_t>(j)] = count;
    });
    ++count;
  }
  return count;
}

}  // namespace

BlockCsr smoothed_aggregation(const BlockCsr& A, double theta, const std::function<Mat3(int)>& tentative) {
  const int n = A.rows();
  std::vector<Mat3> T(static_cast<std::size_t>(n));
  std::vector<int> of(static_cast<std::size_t>(n), none);
  for (int i = 0; i < n; ++i) {
    T[static_cast<std::size_t>(i)] = tentative(i);
    if (T[static_cast<std::size_t>(i)].isZero(0)) of[static_cast<std::size_t>(i)] = alone;
  }
  const std::vector<char> strong = strong_couplings(A, theta);
  const int aggregates = aggregate(A, strong, of);
  constexpr double omega = 2.0 / 3;
  return build_rows(n, aggregates, [&](int i, BlockCsr& part) {
    if (of[static_cast<std::size_t>(i)] < 0) return;
    Mat3 D = Mat3::Zero();  // the diagonal block of A_F
    for (int k = A.begin(i); k < A.end(i); ++k)
      if (A.at(k) == i || !strong[static_cast<std::size_t>(k)]) D += A[k];
    const Mat3 inverse = omega * D.inverse();
    const auto first = part.column.size();
    const auto add = [&](int aggregate, const Mat3& block) {
      std::size_t k = first;
      while (k < part.column.size() && part.column[k] < aggregate) ++k;
      if (k == part.column.size() || part.column[k] != aggregate) {
        part.column.insert(part.column.begin() + static_cast<std::ptrdiff_t>(k), aggregate);
        part.block.insert(part.block.begin() + static_cast<std::ptrdiff_t>(k), Mat3::Zero());
      }
      part.block[k] += block;
    };
    add(of[static_cast<std::size_t>(i)], (1 - omega) * T[static_cast<std::size_t>(i)]);
    for (int k = A.begin(i); k < A.end(i); ++k)
      if (const int j = A.at(k);
          j != i && strong[static_cast<std::size_t>(k)] && of[static_cast<std::size_t>(j)] >= 0)
        add(of[static_cast<std::size_t>(j)], -(inverse * A[k] * T[static_cast<std::size_t>(j)]));
  });
}

}  // namespace drape
