// Incomplete Cholesky on 3x3 blocks without fill: P^-1 = L D L^T, where L has the blocks of A, those of the
// overlay among them, and is kept in float.
//   A_jk <- A_jk - A_ij^T D_i^-1 A_ik for every i < j <= k whose block (j, k) is in the pattern, D_i = A_ii;
//   L_ji = A_ij^T D_i^-1.                                                    [Meijerink & van der Vorst 1977]
// Rows are eliminated in chunks of which several go at the same time (elimination_order.h); the number of
// threads does not change a bit.
// Blocks of the overlay are stiff springs between far parts of the cloth, and what the factor leaves out of
// the fill between them would make it indefinite. So the diagonal block of a row gets a tenth of |A_jk|,
// summed over the overlay's blocks of the row. A contact gives a sign times a positive semidefinite block;
// where several contacts share a block, the sign of its trace is taken, and what that misses is left to the
// shift. What is held does not count here. Where a pivot is not positive all the same, the matrix is shifted
// to A + a diag(A), and a grows until the factor exists [Manteuffel 1980]; the report says so.
#include <atomic>
#include <vector>

#include "solver/linear/elimination_order.h"
#include "solver/linear/preconditioner.h"
#include "solver/linear/projected_block.h"
#include "solver/linear/row_sum.h"

namespace drape::internal {
namespace {

Mat3 narrow(const WideBlock& wide) {
  Mat3 b;
  wide.store(b.data());
  return b;
}

FourFloats times(const float* block, const FourFloats& x) {
  return floats(block) * x[0] + floats(block + 3) * x[1] + floats(block + 6) * x[2];
}

// The sums of the lanes of each vector, and a fourth number that means nothing.
FourFloats sums(const FourFloats& p, const FourFloats& q, const FourFloats& t) {
  const FourFloats pq = __builtin_shufflevector(p, q, 0, 4, 2, 6) + __builtin_shufflevector(p, q, 1, 5, 3, 7);
  const FourFloats tt = t + __builtin_shufflevector(t, t, 1, 0, 3, 2);
  return __builtin_shufflevector(pq, tt, 0, 1, 4, 5) + __builtin_shufflevector(pq, tt, 2, 3, 6, 7);
}

class BlockIc0 final : public Preconditioner {
 public:
  std::string_view name() const override { return "block-ic0"; }

  bool prepare(const BlockMatrix& A, const Filter& filter, LinearReport& report) override {
    if (pattern_ != A.pattern().serial()) shift_ = 0;
    pattern_ = A.pattern().serial();
    if (serial_ != A.serial()) {
      order_.build(A);
      ++report.analyses;
    }
    serial_ = A.serial();
    // A new matrix may need less than those before, but to try that with each would make many factors for
    // nothing. What is held or rubbed changes little.
    if (fill_ != A.fill() && ++shifted_ >= 8) lower_shift();
    fill_ = A.fill();
    return build(A, filter, report);
  }

  bool make_safer(const BlockMatrix& A, const Filter& filter, LinearReport& report) override {
    raise_shift();
    if (shift_ <= largest_shift) return build(A, filter, report);
    shift_ = 0;
    return false;
  }

  void apply(const VecX& r, VecX& s) override {
    const double size = r.cwiseAbs().maxCoeff();  // scales r so that floats neither vanish nor overflow
    if (size == 0) {
      s.setZero();
      return;
    }
    order_.for_chunks(false, [&](int begin, int end) {  // L y = r
      for (int j = begin; j < end; ++j) {
        const double* rj = r.data() + 3 * static_cast<std::ptrdiff_t>(order_.row(j));
        FourFloats sum = __builtin_convertvector((Four{rj[0], rj[1], rj[2], 0} / size), FourFloats);
        order_.below().in_column(j, [&](int i, int k) { sum -= times(lower(k), floats(y(i))); });
        set_y(j, sum);
      }
    });
    order_.for_chunks(true, [&](int begin, int end) {  // L^T s = D^-1 y
      for (int i = end - 1; i >= begin; --i) {
        const int first = order_.start(i);
        FourFloats p = {0, 0, 0, 0}, q = p, t = p;
        for (int k = order_.start(i + 1) - 1; k > first; --k) {  // the one that was solved last comes last
          const FourFloats yj = floats(y(order_.blocks()[k].column));
          p += floats(lower(k)) * yj;
          q += floats(lower(k) + 3) * yj;
          t += floats(lower(k) + 6) * yj;
        }
        set_y(i, times(lower(first), floats(y(i))) - sums(p, q, t));
        double* si = s.data() + 3 * static_cast<std::ptrdiff_t>(order_.row(i));
        for (int k = 0; k < 3; ++k) si[k] = size * static_cast<double>(y(i)[k]);
      }
    });
  }

 private:
  static constexpr double first_shift = 1e-3, largest_shift = 10, far_share = 0.1;

  void raise_shift() {
    shift_ = shift_ == 0 ? first_shift : 4 * shift_;
    shifted_ = 0;
  }
  void lower_shift() {
    shift_ = shift_ > first_shift ? shift_ / 4 : 0;
    shifted_ = 0;
  }

  bool build(const BlockMatrix& A, const Filter& filter, LinearReport& report) {
    const ProjectedBlocks projected(A, filter, entry_of_row_);
    const std::size_t blocks = order_.blocks().size();
    values_.resize(blocks);
    factors_.resize(blocks);
    lower_.resize(9 * blocks + 1);  // one more, so that the last column can be read four wide
    y_.resize(4 * static_cast<std::size_t>(A.rows()));
    while (!factorise(A, projected)) {
      raise_shift();
      if (shift_ > largest_shift) {
        shift_ = 0;
        return false;
      }
    }
    report.shift = shift_;
    return true;
  }

  const float* y(int i) const { return y_.data() + 4 * static_cast<std::ptrdiff_t>(i); }
  void set_y(int i, FourFloats v) {
    v[3] = 0;
    *reinterpret_cast<FourFloats*>(y_.data() + 4 * static_cast<std::ptrdiff_t>(i)) = v;
  }
  const float* lower(int k) const { return lower_.data() + 9 * static_cast<std::ptrdiff_t>(k); }

  // False when a pivot is not positive.
  bool factorise(const BlockMatrix& A, const ProjectedBlocks& projected) {
    std::atomic<bool> sound = true;
    order_.for_chunks(false, [&](int begin, int end) {
      for (int j = begin; j < end && sound; ++j)
        if (!factorise_row(j, A, projected)) sound = false;
    });
    return sound;
  }

  bool factorise_row(int j, const BlockMatrix& A, const ProjectedBlocks& projected) {
    const int first = order_.start(j), end = order_.start(j + 1);
    for (int k = first; k < end; ++k) {
      const EliminationOrder::Block& block = order_.blocks()[k];
      const int row = order_.row(j), column = order_.row(block.column);
      double held[10];
      held[9] = 0;  // is read, but means nothing
      const double* b = A.block(block.slot);
      if (!projected.free(row) || !projected.free(column)) {
        Eigen::Map<Mat3>{held} = block.turned ? projected.block(block.slot, column, row)
                                              : projected.block(block.slot, row, column);
        b = held;
      }
      values_[k].set(b);
      if (block.turned) values_[k].transpose();
    }
    const Mat3 original = narrow(values_[first]);
    for (int e = 0; e < 3; ++e) values_[first].column[e][e] *= 1 + shift_;
    if (!A.overlay().empty()) add_far(j, A);
    for (int k = first; k < end; ++k) {
      Four c0 = values_[k].column[0], c1 = values_[k].column[1], c2 = values_[k].column[2];
      for (const EliminationOrder::Update& u : order_.updates(j, k)) {
        const Four *factor = factors_[u.factor].column, *from = values_[u.from].column;
        const Four f0 = factor[0], f1 = factor[1], f2 = factor[2];
        c0 -= f0 * from[0][0] + f1 * from[0][1] + f2 * from[0][2];
        c1 -= f0 * from[1][0] + f1 * from[1][1] + f2 * from[1][2];
        c2 -= f0 * from[2][0] + f1 * from[2][1] + f2 * from[2][2];
      }
      values_[k] = {c0, c1, c2};
    }
    // A pivot that has lost nearly all of its size is no better than a negative one.
    constexpr double least = 1e-3;
    const Mat3 pivot = narrow(values_[first]);
    if (!positive_definite(pivot) || pivot.determinant() < least * least * least * original.determinant())
      return false;
    double inverse[10] = {};  // read four wide
    Eigen::Map<Mat3>{inverse} = pivot.inverse();
    factors_[first].set(inverse);
    store(first);
    for (int k = first + 1; k < end; ++k) {
      WideBlock turned = values_[k];
      turned.transpose();
      const Four* t = turned.column;
      for (int c = 0; c < 3; ++c)
        factors_[k].column[c] = t[0] * inverse[3 * c] + t[1] * inverse[3 * c + 1] + t[2] * inverse[3 * c + 2];
      store(k);
    }
    return true;
  }

  // Adds the share of the overlay's blocks to the diagonal of row j.
  void add_far(int j, const BlockMatrix& A) {
    Mat3 sum = Mat3::Zero();
    order_.far().in_column(j, [&](int, int k) {
      const auto block = A.at(order_.blocks()[k].slot);
      sum += block.trace() < 0 ? Mat3(-block) : Mat3(block);
    });
    sum = 0.5 * far_share * (sum + sum.transpose()).eval();
    WideBlock& diagonal = values_[order_.start(j)];
    for (int c = 0; c < 3; ++c) diagonal.column[c] += Four{sum(0, c), sum(1, c), sum(2, c), 0};
  }

  // Keeps a factor in float. Its last column is not written four wide, because the next number may belong to
  // a chunk that another thread is writing.
  void store(int k) {
    float* to = lower_.data() + 9 * static_cast<std::ptrdiff_t>(k);
    for (int c = 0; c < 2; ++c) internal::store(internal::narrow(factors_[k].column[c]), to + 3 * c);
    for (int r = 0; r < 3; ++r) to[6 + r] = static_cast<float>(factors_[k].column[2][r]);
  }

  std::uint64_t pattern_ = 0, serial_ = 0, fill_ = 0;  // of the base, of the whole matrix, and of its numbers
  EliminationOrder order_;
  double shift_ = 0;
  int shifted_ = 0;                // for how many matrices the shift has stood
  std::vector<int> entry_of_row_;  // scratch of ProjectedBlocks
  // Scratch of the factorisation: A_jk; D_j^-1, and L_kj beside the diagonal.
  std::vector<WideBlock> values_, factors_;
  std::vector<float> lower_;  // D_j^-1, and L_kj beside the diagonal
  std::vector<float> y_;      // four a row, the fourth is zero
};

}  // namespace

std::unique_ptr<Preconditioner> make_block_ic0() { return std::make_unique<BlockIc0>(); }

}  // namespace drape::internal
