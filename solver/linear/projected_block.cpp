#include "solver/linear/projected_block.h"

namespace drape {

BlockCsr whole(const BlockMatrix& A, const ProjectedBlocks& projected) {
  const std::vector<int>&start = A.pattern().row_start(), &column = A.pattern().column();
  const auto in_row = [&](int r) { return start[static_cast<std::size_t>(r) + 1]; };
  // Below the diagonal the transposes of what stands above it: slots by column, ascending rows.
  std::vector<int> first(static_cast<std::size_t>(A.rows()) + 1, 0), row_of, slot_of;
  for (int r = 0; r < A.rows(); ++r)
    for (int s = A.pattern().diagonal(r) + 1; s < in_row(r); ++s)
      ++first[static_cast<std::size_t>(column[static_cast<std::size_t>(s)]) + 1];
  for (std::size_t r = 0; r < static_cast<std::size_t>(A.rows()); ++r) first[r + 1] += first[r];
  row_of.resize(static_cast<std::size_t>(first.back()));
  slot_of.resize(row_of.size());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (int r = 0; r < A.rows(); ++r)
    for (int s = A.pattern().diagonal(r) + 1; s < in_row(r); ++s) {
      const auto place =
          static_cast<std::size_t>(next[static_cast<std::size_t>(column[static_cast<std::size_t>(s)])]++);
      row_of[place] = r;
      slot_of[place] = s;
    }
  return build_rows(A.rows(), A.rows(), [&](int r, BlockCsr& part) {
    for (int k = first[static_cast<std::size_t>(r)]; k < first[static_cast<std::size_t>(r) + 1]; ++k) {
      const int c = row_of[static_cast<std::size_t>(k)];
      part.column.push_back(c);
      part.block.push_back(projected.block(slot_of[static_cast<std::size_t>(k)], c, r).transpose());
    }
    for (int s = A.pattern().diagonal(r); s < in_row(r); ++s) {
      const int c = column[static_cast<std::size_t>(s)];
      part.column.push_back(c);
      part.block.push_back(projected.block(s, r, c));
    }
  });
}

}  // namespace drape
