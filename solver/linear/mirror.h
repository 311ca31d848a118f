// Finds the entries of a sparse matrix, which is kept by rows, by columns: in which row each stands, and
// where in it.
//   With it a matrix of which only the upper triangle is stored can be gone through in whole rows.
#pragma once

#include <cstddef>
#include <vector>

namespace drape::internal {

struct Mirror {
  // `start` has columns + 1 numbers; `row` and `place` have one for every entry, rows ascending within a
  // column.
  std::vector<int> start{0}, row, place;

  // each(row, f(column, place)) calls f for every entry of the row.
  template <class Each>
  void build(int rows, int columns, const Each& each) {
    start.assign(static_cast<std::size_t>(columns) + 1, 0);
    for (int r = 0; r < rows; ++r) each(r, [&](int c, int) { ++start[c + 1]; });
    for (std::size_t c = 0; c < static_cast<std::size_t>(columns); ++c) start[c + 1] += start[c];
    row.resize(static_cast<std::size_t>(start.back()));
    place.resize(row.size());
    std::vector<int> next(start.begin(), start.end() - 1);
    for (int r = 0; r < rows; ++r)
      each(r, [&](int c, int p) {
        const auto to = static_cast<std::size_t>(next[c]++);
        row[to] = r;
        place[to] = p;
      });
  }

  template <class F>  // f(row, place)
  void in_column(int column, const F& f) const {
    for (int k = start[column]; k < start[column + 1]; ++k) f(row[k], place[k]);
  }
};

}  // namespace drape::internal
