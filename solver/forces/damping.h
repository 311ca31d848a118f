// Internal damping between two particles; neither kind slows a free fall.
//   relative  f_i = -k_d (v_i - v_j),             D = k_d I       [Noh & Jung, eq. 14]
//   axial     f_i = -k_d ((v_i - v_j) . n) n,     D = k_d n n^T   along the connection only
// k_d [N s/m].  Coincident particles: axial damping is nil.
#pragma once

#include "solver/forces/pair_force.h"

namespace drape {

class PairDamping final : public Force {
 public:
  struct Element {
    int i, j;
    PairSlots slots = {};
  };

  PairDamping(std::vector<Element> elements, double k_d, DampingKind kind);

  std::string_view name() const override { return "damping"; }
  void list_pairs(std::vector<ParticlePair>& pairs) const override;
  void bind(const BlockPattern& pattern) override { bind_pairs(pattern, elements_, schedule_); }
  double energy(const VecX&) const override { return 0; }
  double dissipation(const VecX& x, const VecX& v) const override;
  void add_force(const VecX& x, const VecX& v, VecX& f) const override;
  void add_linearised(const VecX& x, const VecX& v, const VecX& y, double c, Stiffness stiffness,
                      BlockMatrix& A, VecX& b) const override;

 private:
  Mat3 coefficient(const VecX& x, const Element& e) const;  // D of the pair

  std::vector<Element> elements_;
  double k_d_;
  DampingKind kind_;
  ChunkSchedule schedule_;
};

}  // namespace drape
