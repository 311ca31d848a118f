// Incomplete Cholesky on 3x3 blocks without fill: P^-1 = L D L^T, where L has the pattern of A and is kept in
// float.
//   A_jk <- A_jk - A_ij^T D_i^-1 A_ik for every i < j <= k whose block (j, k) is in the pattern, D_i = A_ii;
//   L_ji = A_ij^T D_i^-1.                                                    [Meijerink & van der Vorst 1977]
// Where a pivot is not positive, the matrix is shifted to A + a diag(A), and a grows until the factor exists
// [Manteuffel 1980]; the report says so. Block rows of A's upper triangle take the place of the columns of L.

#include "solver/linear/preconditioner.h"
#include "solver/linear/projected_block.h"

namespace drape::internal {
namespace {

using Mat3f = Eigen::Matrix3f;
using Vec3f = Eigen::Vector3f;

class BlockIc0 final : public Preconditioner {
 public:
  std::string_view name() const override { return "block-ic0"; }

  bool prepare(const BlockMatrix& A, const Filter& filter, LinearReport& report) override {
    if (serial_ != A.pattern().serial()) shift_ = 0;
    serial_ = A.pattern().serial();
    pattern_ = &A.pattern();
    shift_ = shift_ > first_shift ? shift_ / 4 : 0;  // the matrix of the last step needed four times this
    return build(A, filter, report);
  }

  bool make_safer(const BlockMatrix& A, const Filter& filter, LinearReport& report) override {
    raise_shift();
    if (shift_ <= largest_shift) return build(A, filter, report);
    shift_ = 0;
    return false;
  }

  void apply(const VecX& r, VecX& s) override {
    const std::vector<int>&start = pattern_->row_start(), &column = pattern_->column();
    const int rows = pattern_->rows();
    const double size = r.cwiseAbs().maxCoeff();  // scales r so that floats neither vanish nor overflow
    if (size == 0) return s.setZero(), void();
    y_ = (r / size).cast<float>();
    for (int i = 0; i < rows; ++i) {  // solves L y = r column by column; y <- D^-1 y as soon as it is known
      const Vec3f yi = y_.segment<3>(3 * i);
      for (int k = first(start, i) + 1; k < first(start, i + 1); ++k)
        y_.segment<3>(3 * column[k]).noalias() -= at(k).transpose() * yi;
      y_.segment<3>(3 * i).noalias() = at(first(start, i)) * yi;
    }
    for (int i = rows - 1; i >= 0; --i) {  // solves L^T s = y
      Vec3f sum = y_.segment<3>(3 * i);
      for (int k = first(start, i) + 1; k < first(start, i + 1); ++k)
        sum.noalias() -= at(k) * y_.segment<3>(3 * column[k]);
      y_.segment<3>(3 * i) = sum;
    }
    s = size * y_.cast<double>();
  }

 private:
  static constexpr double first_shift = 1e-3, largest_shift = 10;

  void raise_shift() { shift_ = shift_ == 0 ? first_shift : 4 * shift_; }

  bool build(const BlockMatrix& A, const Filter& filter, LinearReport& report) {
    const ProjectedBlocks projected(A, filter);
    while (!factorise(A, projected, shift_)) {
      raise_shift();
      if (shift_ > largest_shift) {
        shift_ = 0;
        return false;
      }
    }
    if (shift_ > 0)
      report.note =
          "incomplete Cholesky broke down; it was built for A + " + std::to_string(shift_) + " diag(A)";
    lower_.resize(values_.size());
    for (std::size_t s = 0; s < values_.size(); ++s) lower_[s] = values_[s].cast<float>();
    y_.resize(3 * static_cast<Eigen::Index>(A.rows()));
    return true;
  }

  static int first(const std::vector<int>& start, int row) { return start[row]; }
  const Mat3f& at(int slot) const { return lower_[slot]; }
  Mat3& value(int slot) { return values_[slot]; }

  // Leaves D_i^-1 on the diagonal and D_i^-1 A_ij beside it. False when a pivot is not positive.
  bool factorise(const BlockMatrix& A, const ProjectedBlocks& projected, double shift) {
    const std::vector<int>&start = pattern_->row_start(), &column = pattern_->column();
    values_.resize(static_cast<std::size_t>(pattern_->blocks()));
    for (int i = 0; i < A.rows(); ++i) {
      for (int k = first(start, i); k < first(start, i + 1); ++k) value(k) = projected.block(k, i, column[k]);
      value(first(start, i)).diagonal() *= 1 + shift;
    }
    for (int i = 0; i < A.rows(); ++i) {
      const int begin = first(start, i), end = first(start, i + 1);
      // A pivot that has lost nearly all of its size is no better than a negative one.
      constexpr double least = 1e-3;
      const Mat3 original = projected.block(begin, i, i);
      if (!positive_definite(value(begin)) ||
          value(begin).determinant() < least * least * least * original.determinant())
        return false;
      value(begin) = value(begin).inverse().eval();
      for (int k = begin + 1; k < end; ++k) eliminate(value(begin), k, end, column);
      for (int k = begin + 1; k < end; ++k) value(k) = (value(begin) * value(k)).eval();
    }
    return true;
  }

  // Subtracts A_ij^T D_i^-1 A_il from row j = column[k] of the matrix, for every l >= j of row i. Both rows
  // ascend.
  void eliminate(const Mat3& inverse, int k, int end, const std::vector<int>& column) {
    const int j = column[k];
    const Mat3 factor = value(k).transpose() * inverse;
    int slot = pattern_->diagonal(j);
    const int last = first(pattern_->row_start(), j + 1);
    for (int l = k; l < end; ++l) {
      const int target = column[l];
      while (slot < last && column[slot] < target) ++slot;
      if (slot == last) return;
      if (column[slot] == target) value(slot).noalias() -= factor * value(l);
    }
  }

  const BlockPattern* pattern_ = nullptr;
  std::uint64_t serial_ = 0;
  double shift_ = 0;
  std::vector<Mat3> values_;  // scratch of the factorisation, by slot
  std::vector<Mat3f> lower_;
  Eigen::VectorXf y_;
};

}  // namespace

std::unique_ptr<Preconditioner> make_block_ic0() { return std::make_unique<BlockIc0>(); }

}  // namespace drape::internal
