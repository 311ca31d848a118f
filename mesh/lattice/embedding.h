// Where the vertices of a mesh are, given particles: what is seen, carried by what is computed.
//   x_v = sum_k w_k x_(p_k),  sum_k w_k = 1
// A cloth's vertex is one particle; several vertices may be the same one (a sewn seam), and a vertex may lie
// between particles (the surface of a lattice).                    x [m], w without a unit.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mesh/base/vectors.h"

namespace drape {

class Embedding {
 public:
  struct Share {
    int particle;
    double weight;
  };

  Embedding() = default;
  // Vertex v is the particle first + v.
  static Embedding each(int first, int vertices);

  void add_vertex(int particle) { add_vertex({{particle, 1.0}}); }
  void add_vertex(const std::vector<Share>& shares);

  int vertices() const { return static_cast<int>(start_.size()) - 1; }
  std::span<const Share> shares(int vertex) const {
    const std::size_t begin = start_[static_cast<std::size_t>(vertex)];
    return {shares_.data() + begin, start_[static_cast<std::size_t>(vertex) + 1] - begin};
  }
  // The particle that the vertex is; -1: it lies between several.
  int particle(int vertex) const;
  // The first vertex that is this particle, or moves with it; -1: none does.
  int vertex(int particle) const;
  // Particle i is number[i] from now on.
  void renumber(const std::vector<int>& number);
  std::vector<Vec3> positions(const VecX& x) const;

 private:
  std::vector<std::size_t> start_ = {0};  // vertices + 1 entries into shares_
  std::vector<Share> shares_;
};

}  // namespace drape
