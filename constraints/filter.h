// Which changes of velocity a particle is free to make, and which are prescribed.
//                                                                [Baraff & Witkin 1998, section 5.1]
//   dv_i = S_i (free part) + z_i
//   S = I: the particle is free; I - p p^T: it is locked along p; I - p p^T - q q^T: along p and q;
//   0: entirely
//   z is the prescribed change in the locked directions
// Only constrained particles are stored: first those that are held, then those that touch; renumber() sorts
// them. S [3x3], z [m/s].
#pragma once

#include <vector>

#include "mesh/base/vectors.h"

namespace drape {

struct FilterEntry {
  int particle;
  Mat3 S;
  Vec3 z;
};

class Filter {
 public:
  void clear() { entries_.clear(); }
  void reserve(std::size_t n) { entries_.reserve(n); }
  // To be called at most once for each particle.
  void constrain(int particle, const Mat3& S, const Vec3& z) { entries_.push_back({particle, S, z}); }
  // Particle p gets the number number[p]; the entries are sorted again.
  void renumber(const std::vector<int>& number);

  const std::vector<FilterEntry>& entries() const { return entries_; }

  // v_i <- S_i v_i
  void apply(VecX& v) const;
  // dv_i <- S_i dv_i + z_i
  void impose(VecX& dv) const;

 private:
  std::vector<FilterEntry> entries_;
};

}  // namespace drape
