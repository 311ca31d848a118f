#include "solver/matrix/block_matrix.h"

#include <algorithm>
#include <cstring>

#include "mesh/base/parallel.h"
#include "solver/matrix/four.h"

namespace drape {

using namespace internal;

namespace {

// y[0..2] += the sums of the lanes of p, q, r. The fourth one of p and of q is zero, that of r is not read.
inline void add_sums(const Four& p, const Four& q, const Four& r, double* y) {
  const Four pq = __builtin_shufflevector(p, q, 0, 4, 2, 6) + __builtin_shufflevector(p, q, 1, 5, 3, 7);
  y[0] += pq[0] + pq[2];
  y[1] += pq[1] + pq[3];
  y[2] += (r[0] + r[1]) + r[2];
}

}  // namespace

BlockMatrix::BlockMatrix(std::shared_ptr<const BlockPattern> pattern,
                         std::shared_ptr<const BlockOverlay> overlay)
    : pattern_(std::move(pattern)),
      overlay_(overlay ? std::move(overlay) : std::make_shared<const BlockOverlay>()),
      values_(9 * static_cast<std::size_t>(pattern_->blocks() + overlay_->blocks()) + 3, 0.0) {}

void BlockMatrix::clear_overlay() {
  fill_ = next_pattern_serial();
  const auto base = 9 * static_cast<std::size_t>(pattern_->blocks());
  values_.resize(base + 9 * static_cast<std::size_t>(overlay_->blocks()) + 3);
  std::fill(values_.begin() + static_cast<std::ptrdiff_t>(base), values_.end(), 0.0);
  assembled_.clear();
  acting_end_.clear();
}

void BlockMatrix::leave_out_zeros() {
  acting_serial_ = overlay_->serial();
  acting_.resize(overlay_->entries().size());
  acting_end_.resize(static_cast<std::size_t>(overlay_->row_count()));
  for_chunks<Work::heavy>(overlay_->row_count(), [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      int& to = acting_end_[static_cast<std::size_t>(k)] = overlay_->row_begin(k);
      overlay_->in_row(k, [&](const BlockOverlay::Entry& e) {
        if (!at(e.slot).isZero(0)) acting_[static_cast<std::size_t>(to++)] = e;
      });
    }
  });
}

void BlockMatrix::keep() {
  kept_.resize(9 * static_cast<std::size_t>(pattern_->blocks()));
  for_chunks(pattern_->blocks(), [&](int begin, int end) {
    std::copy(block(begin), block(end), kept_.data() + 9 * static_cast<std::size_t>(begin));
  });
}

void BlockMatrix::take_kept() {
  clear_overlay();
  for_chunks(pattern_->blocks(), [&](int begin, int end) {
    const auto first = 9 * static_cast<std::size_t>(begin), last = 9 * static_cast<std::size_t>(end);
    std::copy(kept_.data() + first, kept_.data() + last, block(begin));
  });
}

void BlockMatrix::set_to_mass(const std::vector<double>& mass) {
  clear_overlay();
  const std::vector<int>& start = pattern_->row_start();
  for_chunks<Work::heavy>(rows(), [&](int begin, int end) {
    const auto first = 9 * static_cast<std::size_t>(start[begin]);
    const auto last = 9 * static_cast<std::size_t>(start[end]);
    std::memset(values_.data() + first, 0, (last - first) * sizeof(double));
    for (int r = begin; r < end; ++r)
      at(pattern_->diagonal(r)).diagonal().array() = mass[pattern_->particle_of()[r]];
  });
}

void BlockMatrix::set_diagonal_additions(std::span<const DiagonalBlock> additions) {
  for (const auto& [slot, block] : assembled_) at(slot) = block;
  assembled_.clear();
  assembled_.reserve(static_cast<std::size_t>(rows()));  // at the first call, so that no later call allocates
  for (const DiagonalBlock& addition : additions) {
    const int slot = pattern_->diagonal(addition.row);
    assembled_.emplace_back(slot, at(slot));
    at(slot) += addition.block;
  }
}

void BlockMatrix::multiply(const VecX& x, VecX& y) const {
  multiply_base(x, y);
  add_overlay(x, y);
}

// Each row gathers its own blocks: first those of columns before it, which are stored as their transposes.
void BlockMatrix::add_overlay(const VecX& x, VecX& y) const {
  const bool all = acting_end_.empty() || acting_serial_ != overlay_->serial();
  const BlockOverlay::Entry* const entries = all ? overlay_->entries().data() : acting_.data();
  for_chunks<Work::heavy>(overlay_->row_count(), [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const BlockOverlay::Entry* e = entries + overlay_->row_begin(k);
      const BlockOverlay::Entry* const last =
          entries + (all ? overlay_->row_begin(k + 1) : acting_end_[static_cast<std::size_t>(k)]);
      double turned[3] = {0, 0, 0};
      for (; e < last && e->transposed; ++e) {
        const double *a = block(e->slot), *xj = x.data() + 3 * static_cast<std::ptrdiff_t>(e->column);
        const Four masked = {xj[0], xj[1], xj[2], 0};
        add_sums(load(a) * masked, load(a + 3) * masked, load(a + 6) * masked, turned);
      }
      Four sum = {0, 0, 0, 0};
      for (; e < last; ++e) {
        const double *a = block(e->slot), *xj = x.data() + 3 * static_cast<std::ptrdiff_t>(e->column);
        sum += load(a) * xj[0] + load(a + 3) * xj[1] + load(a + 6) * xj[2];
      }
      double* out = y.data() + 3 * static_cast<std::ptrdiff_t>(overlay_->row(k));
      for (int c = 0; c < 3; ++c) out[c] += sum[c] + turned[c];
    }
  });
}

// Row r of the upper triangle gives y_r += A_rj x_j and, as the block (j, r), y_j += A_rj^T x_r.
void BlockMatrix::multiply_base(const VecX& x, VecX& y) const {
  constexpr std::ptrdiff_t ahead = 9 * 128;  // in doubles; the processor's own prefetch stops at every page
  const int *start = pattern_->row_start().data(), *columns = pattern_->column().data();
  const int chunk_rows = pattern_->chunk_rows(), chunks = pattern_->chunks();
  const auto first_row = [&](int chunk) { return std::min(chunk * chunk_rows, rows()); };
  even_then_odd(chunks, rows() < serial_below(Work::heavy), [&](int chunk) {
    const int begin = first_row(chunk), end = first_row(chunk + 1);
    if (chunk % 2 == 0) y.segment(3 * begin, 3 * (first_row(chunk + 2) - begin)).setZero();
    const double *a = block(start[begin]), *from = x.data();
    double* to = y.data();  // read once: through y it would be read again after every number written
    for (int r = begin; r < end; ++r) {
      const double* xr = from + 3 * static_cast<std::ptrdiff_t>(r);
      const Four masked = {xr[0], xr[1], xr[2], 0};
      Four sum = load(a) * xr[0], sum1 = load(a + 3) * xr[1],
           sum2 = load(a + 6) * xr[2];  // lane 3 is never used
      a += 9;
      const int* const last = columns + start[r + 1];
      for (const int* column = columns + start[r] + 1; column < last; ++column, a += 9) {
        __builtin_prefetch(a + ahead);
        const auto j = 3 * static_cast<std::ptrdiff_t>(*column);
        const double* xj = from + j;
        const Four c0 = load(a), c1 = load(a + 3), c2 = load(a + 6);
        sum += c0 * xj[0];
        sum1 += c1 * xj[1];
        sum2 += c2 * xj[2];
        add_sums(c0 * masked, c1 * masked, c2 * masked, to + j);
      }
      sum += sum1 + sum2;
      double* out = to + 3 * static_cast<std::ptrdiff_t>(r);
      out[0] += sum[0];
      out[1] += sum[1];
      out[2] += sum[2];
    }
  });
}

}  // namespace drape
