// The global sparse symmetric matrix in 3x3 blocks: a pattern that is built once, values that are refilled
// every step.
//   Rows are renumbered by reverse Cuthill-McKee for locality [Cuthill & McKee 1969]; row_of() maps particle
//   -> row. The upper triangle is stored, the diagonal block first in its row, a block column by column (9
//   doubles): a block (i, j) also stands for its transpose (j, i). Rows are cut into chunks at least as long
//   as the bandwidth: an element, and a row of the product, touches the chunk of its lowest row and the next
//   one only, so all even chunks can be done at the same time, then all odd ones, without locks and in an
//   order that no thread count changes.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "mesh/base/vectors.h"

namespace drape {

struct ParticlePair {
  int i, j;
};

class BlockPattern {
 public:
  // particles: how many; pairs: which particles act on each other (any order, repeats allowed).
  BlockPattern(int particles, std::vector<ParticlePair> pairs);

  int rows() const { return static_cast<int>(row_start_.size()) - 1; }
  int blocks() const { return static_cast<int>(column_.size()); }  // stored ones: of the upper triangle
  std::uint64_t serial() const { return serial_; }  // differs between any two patterns of a process

  const std::vector<int>& row_of() const { return row_of_; }            // particle -> row
  const std::vector<int>& particle_of() const { return particle_of_; }  // row -> particle
  const std::vector<int>& row_start() const { return row_start_; }      // rows + 1
  const std::vector<int>& column() const { return column_; }  // ascending within a row, from the row itself
  int diagonal(int row) const { return row_start_[static_cast<std::size_t>(row)]; }
  int slot(int row, int column) const;  // row <= column; throws std::logic_error when there is no such block

  int bandwidth() const { return bandwidth_; }
  int chunk_rows() const { return chunk_rows_; }
  int chunks() const { return (rows() + chunk_rows_ - 1) / chunk_rows_; }

 private:
  std::vector<int> row_of_, particle_of_, row_start_, column_;
  int bandwidth_ = 0, chunk_rows_ = 1;
  std::uint64_t serial_ = 0;
};

class BlockMatrix {
 public:
  explicit BlockMatrix(std::shared_ptr<const BlockPattern> pattern);

  const BlockPattern& pattern() const { return *pattern_; }
  int rows() const { return pattern_->rows(); }

  double* block(int slot) { return values_.data() + 9 * static_cast<std::size_t>(slot); }
  const double* block(int slot) const { return values_.data() + 9 * static_cast<std::size_t>(slot); }
  Eigen::Map<Mat3> at(int slot) { return Eigen::Map<Mat3>(block(slot)); }
  Eigen::Map<const Mat3> at(int slot) const { return Eigen::Map<const Mat3>(block(slot)); }

  // All zero but the diagonal blocks, which become mass of the row's particle times the identity.
  void set_to_mass(const std::vector<double>& mass);

  void multiply(const VecX& x, VecX& y) const;  // y = A x, in row order

 private:
  std::shared_ptr<const BlockPattern> pattern_;
  std::vector<double> values_;  // 9 a block, and 3 more, so that the last column can be read four wide
};

// Particle order <-> row order, three numbers a particle.
void to_rows(const BlockPattern& pattern, const VecX& by_particle, VecX& by_row);
void to_particles(const BlockPattern& pattern, const VecX& by_row, VecX& by_particle);

}  // namespace drape
