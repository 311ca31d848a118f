#include <atomic>

#include "mesh/base/parallel.h"
#include "solver/linear/preconditioner.h"
#include "solver/linear/projected_block.h"

namespace drape::internal {
namespace {

class BlockJacobi final : public Preconditioner {
 public:
  std::string_view name() const override { return "block-jacobi"; }

  bool prepare(const BlockMatrix& A, const Filter& filter, LinearReport&) override {
    inverse_.resize(6 * static_cast<std::size_t>(A.rows()));
    std::atomic<bool> definite{true};
    const std::vector<FilterEntry>& entries = filter.entries();
    for_chunks<Work::heavy>(A.rows(), [&](int begin, int end) {
      auto e = std::lower_bound(entries.begin(), entries.end(), begin,
                                [](const FilterEntry& f, int row) { return f.particle < row; });
      for (int r = begin; r < end; ++r) {
        Mat3 block = A.at(A.pattern().diagonal(r));
        if (e != entries.end() && e->particle == r) {  // the preconditioner knows the constraints
          block = e->S * block * e->S + Mat3::Identity() - e->S;
          ++e;
        }
        if (!positive_definite(block)) definite = false;
        const Mat3 inverse = block.inverse();
        double* p = inverse_.data() + 6 * static_cast<std::size_t>(r);
        p[0] = inverse(0, 0), p[1] = inverse(1, 1), p[2] = inverse(2, 2);
        p[3] = inverse(1, 0), p[4] = inverse(2, 0), p[5] = inverse(2, 1);
      }
    });
    return definite;
  }

  void apply(const VecX& r, VecX& s) override {
    for_chunks<Work::heavy>(static_cast<int>(r.size() / 3), [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const double* p = inverse_.data() + 6 * static_cast<std::size_t>(i);
        const double* ri = r.data() + 3 * static_cast<std::ptrdiff_t>(i);
        double* si = s.data() + 3 * static_cast<std::ptrdiff_t>(i);
        si[0] = p[0] * ri[0] + p[3] * ri[1] + p[4] * ri[2];
        si[1] = p[3] * ri[0] + p[1] * ri[1] + p[5] * ri[2];
        si[2] = p[4] * ri[0] + p[5] * ri[1] + p[2] * ri[2];
      }
    });
  }

 private:
  std::vector<double> inverse_;  // symmetric 3x3 blocks, 6 numbers a row of A
};

}  // namespace

std::unique_ptr<Preconditioner> make_block_jacobi() { return std::make_unique<BlockJacobi>(); }

std::unique_ptr<Preconditioner> make_preconditioner(std::string_view name) {
  if (name == "block-jacobi") return make_block_jacobi();
  if (name == "block-ic0") return make_block_ic0();
  if (name == "multigrid") return make_multigrid();
  return nullptr;
}

}  // namespace drape::internal
