// Which blocks a matrix has. The pattern is built once, from which particles act on each other.
//   Rows are renumbered by reverse Cuthill-McKee for locality [Cuthill & McKee 1969]; row_of() maps particle
//   -> row. Of the symmetric matrix the upper triangle is stored, with the diagonal block first in its row: a
//   block (i, j) also stands for its transpose (j, i). Rows are cut into chunks at least as long as the
//   bandwidth: an element, and a row of the product, then touches only the chunk of its lowest row and the
//   next one. All even chunks can be processed at the same time, then all odd ones, without locks and in an
//   order that does not depend on the number of threads.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/base/vectors.h"

namespace drape {

struct ParticlePair {
  int i, j;
};

class BlockPattern {
 public:
  static constexpr int shortest_chunk = 256;  // rows

  // particles: how many; pairs: which particles act on each other (any order, repeats allowed).
  BlockPattern(int particles, std::vector<ParticlePair> pairs);

  int rows() const { return static_cast<int>(row_start_.size()) - 1; }
  int blocks() const { return static_cast<int>(column_.size()); }  // those of the upper triangle
  std::uint64_t serial() const { return serial_; }  // differs between any two patterns of a process

  const std::vector<int>& row_of() const { return row_of_; }            // particle -> row
  const std::vector<int>& particle_of() const { return particle_of_; }  // row -> particle
  const std::vector<int>& row_start() const { return row_start_; }      // rows + 1
  // The columns of the stored blocks, ascending within a row from the row itself on.
  const std::vector<int>& column() const { return column_; }
  int diagonal(int row) const { return row_start_[row]; }
  bool has(int row, int column) const;  // row <= column
  int slot(int row, int column) const;  // row <= column; throws std::logic_error when there is no such block

  int bandwidth() const { return bandwidth_; }
  int chunk_rows() const { return chunk_rows_; }
  int chunks() const { return (rows() + chunk_rows_ - 1) / chunk_rows_; }

 private:
  int find(int row, int column) const;  // -1: there is no such block

  std::vector<int> row_of_, particle_of_, row_start_, column_;
  int bandwidth_ = 0, chunk_rows_ = 1;
  std::uint64_t serial_ = 0;
};

// A number for a new pattern or overlay: no two in a process have the same.
std::uint64_t next_pattern_serial();

// The number of the piece that each particle belongs to: what blocks join, directly or through others. Pieces
// are numbered in the order in which their first particles come.
std::vector<int> connected_pieces(const BlockPattern& pattern);

// Convert between particle order and row order, with three numbers for each particle.
void to_rows(const BlockPattern& pattern, const VecX& by_particle, VecX& by_row);
void to_particles(const BlockPattern& pattern, const VecX& by_row, VecX& by_particle);

}  // namespace drape
