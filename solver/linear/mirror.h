// A sparse matrix is kept by rows; this finds its entries by columns: which row each stands in, and where.
//   With it a matrix of which only the upper triangle is stored is gone through whole, row by row.
#pragma once

#include <cstddef>
#include <vector>

namespace drape::internal {

struct Mirror {
  std::vector<int> start{0}, row, place;  // columns + 1; one an entry, rows ascending within a column

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
