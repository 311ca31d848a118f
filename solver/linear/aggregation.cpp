#include "solver/linear/aggregation.h"

#include <cmath>

#include "solver/linear/row_sum.h"

namespace drape::internal {
namespace {

constexpr int none = -1, alone = -2;

using Graph = SparseRows<1>;  // the strong neighbours of every vertex, and how strongly they are coupled

template <class Scalar>
float squared_norm(const Scalar* block) {
  const Four a = load(block), b = load(block + 3), c = load(block + 6), sum = a * a + b * b + c * c;
  return static_cast<float>(sum[0] + sum[1] + sum[2]);
}

class Strength {
 public:
  Strength(const Smoother& A, double theta) : least_(static_cast<std::size_t>(A.rows())) {
    for_chunks(A.rows(), [&](int begin, int end) {
      for (int i = begin; i < end; ++i)
        least_[i] = static_cast<float>(theta * std::sqrt(static_cast<double>(squared_norm(A.diagonal(i)))));
    });
  }
  bool operator()(int i, int j, float size) const { return size > least_[i] * least_[j]; }

 private:
  std::vector<float> least_;  // theta |A_ii|
};

// Fills `of`, which maps vertex -> aggregate, or `alone` for vertices that take no part. Returns how many
// aggregates there are.
int aggregate(const Graph& strong, std::vector<int>& of) {
  const int n = strong.rows();
  int count = 0;
  const auto each_strong = [&](int i, const auto& f) {
    const Graph::Row row = strong[i];
    for (int k = 0; k < row.count; ++k)
      if (int& other = of[row.column[k]]; other != alone) f(other, k);
  };
  // A vertex that is strongly coupled to nothing is left to the smoother.
  for (int i = 0; i < n; ++i)
    if (strong[i].count == 0) of[i] = alone;
  // A vertex none of whose neighbours is taken begins an aggregate with all of them.
  for (int i = 0; i < n; ++i) {
    if (of[i] != none) continue;
    bool untouched = true;
    each_strong(i, [&](int& other, int) { untouched = untouched && other == none; });
    if (!untouched) continue;
    of[i] = count;
    each_strong(i, [&](int& other, int) { other = count; });
    ++count;
  }
  // The others join the aggregate to which they are coupled most strongly.
  const std::vector<int> before = of;
  for (int i = 0; i < n; ++i) {
    if (of[i] != none) continue;
    float most = 0;
    const Graph::Row row = strong[i];
    for (int k = 0; k < row.count; ++k) {
      const int other = before[row.column[k]];
      if (other < 0 || *row[k] <= most) continue;
      most = *row[k];
      of[i] = other;
    }
  }
  // The vertices that are left form aggregates with each other.
  for (int i = 0; i < n; ++i) {
    if (of[i] != none) continue;
    of[i] = count;
    each_strong(i, [&](int& other, int) {
      if (other == none) other = count;
    });
    ++count;
  }
  return count;
}

}  // namespace

int smoothed_aggregation(const Smoother& A, double theta, const ProjectedBlocks* projected, BlockRows& P) {
  const int n = A.rows();
  const auto locked = [&](int i) { return projected && projected->locked(i); };
  const auto free = [&](int i) { return !projected || projected->free(i); };
  const Strength strongly(A, theta);
  Graph strong;
  strong.build(n, 16, [&](int i, Graph::Chunk& chunk) {
    if (locked(i)) return;
    A.each_other(i, [&](int j, const float* block) {
      const float size = squared_norm(block);
      if (strongly(i, j, size)) *chunk.add(j) = size;
    });
  });
  std::vector<int> of(static_cast<std::size_t>(n), none);
  const int aggregates = aggregate(strong, of);

  constexpr double omega = 2.0 / 3;
  P.resize(n);
  for_chunks(n, [&](int begin, int end) {
    RowSum sum(aggregates);
    BlockRows::Chunk& chunk = P.open(begin, 4 * chunk_size);
    for (int i = begin; i < end; ++i) {
      const int own = of[i];
      if (own >= 0) {
        sum.at(own);
        WideBlock D;  // the diagonal block of A_F
        D.add(A.diagonal(i));
        A.each_other(i, [&](int j, const float* block) {
          const int other = of[j];
          if (!strongly(i, j, squared_norm(block))) {
            D.add(block);
          } else if (other >= 0) {
            if (free(j)) {
              sum.at(other).add(block);
            } else {
              double S[10] = {};  // read four wide
              Eigen::Map<Mat3>{S} = projected->S(j);
              sum.at(other).add_product(block, S);
            }
          }
        });
        Mat3 filtered, product;
        D.store(filtered.data());
        // Weak couplings that push may leave a diagonal block that is not positive definite; they are left
        // out then.
        if (!positive_definite(filtered)) filtered = Eigen::Map<const Mat3>(A.diagonal(i));
        const Mat3 inverse = -omega * filtered.inverse();
        sum.take([&](int column, const WideBlock& block) {
          block.store(product.data());
          Mat3 smoothed = inverse * product;
          if (column == own) smoothed += (1 - omega) * (projected ? projected->S(i) : Mat3::Identity());
          Eigen::Map<Eigen::Matrix3f>(chunk.add(column)) = smoothed.cast<float>();
        });
      }
      chunk.end_row();
    }
    chunk.close();
  });
  return aggregates;
}

}  // namespace drape::internal
