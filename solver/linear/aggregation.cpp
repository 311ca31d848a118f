#include "solver/linear/aggregation.h"

#include <cmath>

#include "solver/linear/row_sum.h"

namespace drape::internal {
namespace {

constexpr int none = -1, alone = -2;

template <class Scalar>
float squared_norm(const Scalar* block) {
  const Four a = load(block), b = load(block + 3), c = load(block + 6), sum = a * a + b * b + c * c;
  return static_cast<float>(sum[0] + sum[1] + sum[2]);
}

}  // namespace

void Aggregation::find_strong(const Smoother& A, double theta, const ProjectedBlocks* projected) {
  least_.resize(static_cast<std::size_t>(A.rows()));
  for_chunks<Work::heavy>(A.rows(), [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      least_[i] = static_cast<float>(theta * std::sqrt(static_cast<double>(squared_norm(A.diagonal(i)))));
  });
  strong_.build(A.rows(), 16, [&](int i, SparseRows<1>::Chunk& chunk) {
    if (projected && projected->locked(i)) return;
    A.each_other(i, [&](int j, const float* block) {
      const float size = squared_norm(block);
      *chunk.add_if(size > least_[i] * least_[j], j) = size;
    });
  });
}

// Fills of_, which is `alone` for vertices that take no part. Returns how many aggregates there are.
int Aggregation::aggregate() {
  const int n = strong_.rows();
  of_.assign(static_cast<std::size_t>(n), none);
  int count = 0;
  const auto each_strong = [&](int i, const auto& f) {
    const SparseRows<1>::Row row = strong_[i];
    for (int k = 0; k < row.count; ++k)
      if (int& other = of_[row.column[k]]; other != alone) f(other, k);
  };
  // A vertex that is strongly coupled to nothing is left to the smoother.
  for (int i = 0; i < n; ++i)
    if (strong_[i].count == 0) of_[i] = alone;
  // A vertex none of whose neighbours is taken begins an aggregate with all of them.
  for (int i = 0; i < n; ++i) {
    if (of_[i] != none) continue;
    bool untouched = true;
    each_strong(i, [&](int& other, int) { untouched = untouched && other == none; });
    if (!untouched) continue;
    of_[i] = count;
    each_strong(i, [&](int& other, int) { other = count; });
    ++count;
  }
  // The others join the aggregate to which they are coupled most strongly.
  begun_ = of_;
  for (int i = 0; i < n; ++i) {
    if (of_[i] != none) continue;
    float most = 0;
    const SparseRows<1>::Row row = strong_[i];
    for (int k = 0; k < row.count; ++k) {
      const int other = begun_[row.column[k]];
      if (other < 0 || *row[k] <= most) continue;
      most = *row[k];
      of_[i] = other;
    }
  }
  // The vertices that are left form aggregates with each other.
  for (int i = 0; i < n; ++i) {
    if (of_[i] != none) continue;
    of_[i] = count;
    each_strong(i, [&](int& other, int) {
      if (other == none) other = count;
    });
    ++count;
  }
  return count;
}

int Aggregation::make_prolongation(const Smoother& A, double theta, const ProjectedBlocks* projected,
                                   BlockRows& P) {
  find_strong(A, theta, projected);
  const int aggregates = aggregate();
  const auto free = [&](int i) { return !projected || projected->free(i); };
  constexpr double omega = 2.0 / 3;
  P.resize(A.rows());
  for_chunks<Work::heavy>(A.rows(), [&](int begin, int end) {
    RowSum sum(aggregates);
    BlockRows::Chunk& chunk = P.open(begin, 4);
    for (int i = begin; i < end; ++i) {
      const int own = of_[i];
      if (own >= 0) {
        sum.at(own);
        WideBlock D;  // the diagonal block of A_F
        D.add(A.diagonal(i));
        const SparseRows<1>::Row strong = strong_[i];
        int next = 0;  // of the strong ones, which come in the same order
        A.each_other(i, [&](int j, const float* block) {
          const int other = of_[j];
          if (next == strong.count || strong.column[next] != j) return D.add(block);
          ++next;
          if (other < 0) return;
          if (free(j)) return sum.at(other).add(block);
          double S[10] = {};  // read four wide
          Eigen::Map<Mat3>{S} = projected->S(j);
          sum.at(other).add_product(block, S);
        });
        Mat3 filtered;
        D.store(filtered.data());
        // Weak couplings that push may leave a diagonal block that is not positive definite; they are left
        // out then.
        if (!positive_definite(filtered)) filtered = Eigen::Map<const Mat3>(A.diagonal(i));
        double inverse[10] = {};  // read four wide
        Eigen::Map<Mat3>{inverse} = -omega * filtered.inverse();
        sum.take([&](int column, const WideBlock& block) {
          WideBlock smoothed;
          smoothed.add_product(inverse, block);
          if (column == own) {
            const Mat3 S = projected ? projected->S(i) : Mat3::Identity();
            for (int k = 0; k < 3; ++k)
              smoothed.column[k] += (1 - omega) * Four{S(0, k), S(1, k), S(2, k), 0};
          }
          smoothed.store(chunk.add(column));
        });
      }
      chunk.end_row();
    }
  });
  return aggregates;
}

}  // namespace drape::internal
