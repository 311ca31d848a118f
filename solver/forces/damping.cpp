#include "solver/forces/damping.h"

namespace drape {

PairDamping::PairDamping(std::vector<Element> elements, double k_d, DampingKind kind)
    : elements_(std::move(elements)), k_d_(k_d), kind_(kind) {}

void PairDamping::list_pairs(std::vector<ParticlePair>& pairs) const {
  for (const Element& e : elements_) pairs.push_back({e.i, e.j});
}

Mat3 PairDamping::coefficient(const VecX& x, const Element& e) const {
  if (kind_ == DampingKind::relative) return k_d_ * Mat3::Identity();
  const Vec3 d = x.segment<3>(3 * e.i) - x.segment<3>(3 * e.j);
  const double l2 = d.squaredNorm();
  return l2 == 0 ? Mat3::Zero() : Mat3((k_d_ / l2 * d) * d.transpose());
}

double PairDamping::dissipation(const VecX& x, const VecX& v) const {
  return sum_chunks(static_cast<int>(elements_.size()), [&](int begin, int end) {
    double sum = 0;
    for (int k = begin; k < end; ++k) {
      const Element& e = elements_[static_cast<std::size_t>(k)];
      const Vec3 dv = v.segment<3>(3 * e.i) - v.segment<3>(3 * e.j);
      sum += 0.5 * dv.dot(coefficient(x, e) * dv);
    }
    return sum;
  });
}

void PairDamping::add_force(const VecX& x, const VecX& v, VecX& f) const {
  schedule_.run(static_cast<int>(elements_.size()), [&](int k) {
    const Element& e = elements_[static_cast<std::size_t>(k)];
    const Vec3 drag = coefficient(x, e) * (v.segment<3>(3 * e.i) - v.segment<3>(3 * e.j));
    f.segment<3>(3 * e.i) -= drag;
    f.segment<3>(3 * e.j) += drag;
  });
}

void PairDamping::add_linearised(const VecX& x, const VecX& v, const VecX&, double c, Stiffness,
                                 BlockMatrix& A, VecX& b) const {
  schedule_.run(static_cast<int>(elements_.size()), [&](int k) {
    const Element& e = elements_[static_cast<std::size_t>(k)];
    const Mat3 cD = c * coefficient(x, e);
    const Vec3 impulse = cD * (v.segment<3>(3 * e.i) - v.segment<3>(3 * e.j));
    b.segment<3>(3 * e.i) -= impulse;
    b.segment<3>(3 * e.j) += impulse;
    add_pair_block(A, e.slots, cD);
  });
}

}  // namespace drape
