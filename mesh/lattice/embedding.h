// Vertex positions of a mesh, computed from particle positions: the mesh is what is drawn and written, the
// particles are what is simulated.
//   x_v = sum_k w_k x_(p_k),  sum_k w_k = 1        x [m], w [-]
// A vertex of a cloth is one particle. Several vertices may be the same particle (a sewn seam), and a vertex
// may lie between particles (the surface of a lattice).
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
  // Each vertex v is the particle first + v.
  static Embedding each(int first, int vertices);

  void add_vertex(int particle) { add_vertex({{particle, 1.0}}); }
  void add_vertex(const std::vector<Share>& shares);

  int vertices() const { return static_cast<int>(start_.size()) - 1; }
  std::span<const Share> shares(int vertex) const {
    const std::size_t begin = start_[vertex];
    return {shares_.data() + begin, start_[vertex + 1] - begin};
  }
  // The particle that the vertex is, or -1 when the vertex lies between several particles.
  int particle(int vertex) const;
  // The first vertex that is this particle or has a share in it, or -1 when there is none.
  int vertex(int particle) const;
  // Renames the particles: particle i becomes number[i].
  void renumber(const std::vector<int>& number);
  // Positions of the vertices [m], for the positions x of the particles (3n, m).
  std::vector<Vec3> positions(const VecX& x) const;

 private:
  std::vector<std::size_t> start_ = {0};  // vertices + 1 entries into shares_
  std::vector<Share> shares_;
};

}  // namespace drape
