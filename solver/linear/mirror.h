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
    start.assign(static_cast<std::size_t>(columns) + 2, 0);
    for (int r = 0; r < rows; ++r) each(r, [&](int c, int) { ++start[c + 2]; });
    for (std::size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
    row.resize(static_cast<std::size_t>(start.back()));
    place.resize(row.size());
    for (int r = 0; r < rows; ++r)
      each(r, [&](int c, int p) {
        const auto to =
            static_cast<std::size_t>(start[c + 1]++);  // where column c goes on, in the end its end
        row[to] = r;
        place[to] = p;
      });
    start.pop_back();
  }

  template <class F>  // f(row, place)
  void in_column(int column, const F& f) const {
    for (int k = start[column]; k < start[column + 1]; ++k) f(row[k], place[k]);
  }
};

}  // namespace drape::internal
