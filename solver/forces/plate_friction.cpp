#include "solver/forces/plate_friction.h"

#include <algorithm>
#include <cmath>

#include "solver/forces/triangle_frame.h"

namespace drape {

using internal::TriangleFrame;

Vec3 PlateFrictionLaw::moments() const { return {warp, weft, std::sqrt(0.5 * warp * weft)}; }

double PlateFrictionLaw::e_0() const { return onset * std::sqrt(warp * weft); }

// `e` is meaningless where the frame does not stand, and the triangle then gives no force.
struct PlateFriction::Bent {
  TriangleFrame frame;
  Mat3 curvature;  // columns H_k x_k of k = uu, vv, uv [N/m]
  Vec3 e;          // N/m
  double size;     // |e|

  Vec3 normal() const { return frame.axes.col(2); }
};

PlateFriction::PlateFriction(const std::vector<PlateCurvature>& plate, const PlateFrictionLaw& law,
                             std::shared_ptr<BendMemory> memory, int first)
    : e_0_(law.e_0()), memory_(std::move(memory)) {
  const Vec3 H = law.moments();
  triangles_.reserve(plate.size());
  std::size_t slots = 0;
  for (const PlateCurvature& p : plate) {
    Triangle t{static_cast<std::size_t>(p.number), p.corners, p.slopes, p.area, shares_.size(), 0, slots};
    for (int& corner : t.corners) corner += first;
    for (const PlateCurvature::Share& share : p.shares)
      shares_.push_back({first + share.vertex, H.cwiseProduct(share.weights)});
    t.end = shares_.size();
    slots += p.shares.size() * (p.shares.size() + 1) / 2;
    triangles_.push_back(t);
    if (memory_->rest.size() <= t.number) memory_->rest.resize(t.number + 1, Vec3::Zero());
  }
  slots_.assign(slots, -1);
  memory_->kept = memory_->rest;
}

void PlateFriction::list_pairs(std::vector<ParticlePair>& pairs) const {
  for (const Triangle& t : triangles_)
    for (std::size_t k = t.share; k < t.end; ++k)
      for (std::size_t l = k + 1; l < t.end; ++l) pairs.push_back({shares_[k].particle, shares_[l].particle});
}

void PlateFriction::bind(const BlockLayout& layout) {
  const auto row = [&](std::size_t share) { return layout.base.row_of()[shares_[share].particle]; };
  const auto first_row = [&](const Triangle& t) {
    int least = row(t.share);
    for (std::size_t k = t.share; k < t.end; ++k) least = std::min(least, row(k));
    return least;
  };
  std::stable_sort(triangles_.begin(), triangles_.end(), [&](const Triangle& a, const Triangle& b) {
    return std::pair(first_row(a), a.number) < std::pair(first_row(b), b.number);
  });
  schedule_.bind(layout.base, static_cast<int>(triangles_.size()),
                 [&](int e) { return first_row(triangles_[static_cast<std::size_t>(e)]); });
  for (const Triangle& t : triangles_) {
    std::size_t slot = t.slot;
    for (std::size_t k = t.share; k < t.end; ++k)
      for (std::size_t l = k; l < t.end; ++l)
        slots_[slot++] = layout.slot(std::min(row(k), row(l)), std::max(row(k), row(l)));
  }
}

template <class F>
void PlateFriction::run(const F& f) const {
  schedule_.run(static_cast<int>(triangles_.size()),
                [&](int e) { f(triangles_[static_cast<std::size_t>(e)]); });
}

template <class At>
PlateFriction::Bent PlateFriction::bent(const Triangle& t, const At& at) const {
  Slopes f = Slopes::Zero();
  for (int k = 0; k < 3; ++k) f += at(t.corners[static_cast<std::size_t>(k)]) * t.slopes.row(k);
  Bent b{TriangleFrame(f), Mat3::Zero(), Vec3::Zero(), 0};
  if (!b.frame.stands) return b;
  const Vec3 origin = at(t.corners[0]);
  for (std::size_t k = t.share; k < t.end; ++k)
    b.curvature += (at(shares_[k].particle) - origin) * shares_[k].weights.transpose();
  if (memory_->begun) b.e = b.curvature.transpose() * b.normal() - memory_->rest[t.number];
  b.size = b.e.norm();
  return b;
}

// The springs are at rest in the shape with which the first step begins, whatever it is.
bool PlateFriction::begin_step(const StepStart& start) {
  if (memory_->begun) return false;
  memory_->begun = true;
  for (const Triangle& t : triangles_) {
    memory_->rest[t.number].setZero();
    memory_->rest[t.number] = bent(t, [&](int i) { return Vec3(start.x.segment<3>(3 * i)); }).e;
  }
  return false;
}

// Lets every spring follow until it holds as much as friction does.
void PlateFriction::end_step(const VecX& x) {
  const auto at = [&x](int i) { return Vec3(x.segment<3>(3 * i)); };
  for_chunks<Work::heavy>(static_cast<int>(triangles_.size()), [&](int begin, int end) {
    for (int e = begin; e < end; ++e) {
      const Triangle& t = triangles_[static_cast<std::size_t>(e)];
      const Bent b = bent(t, at);
      if (b.frame.stands && b.size > e_0_) memory_->rest[t.number] += (1 - e_0_ / b.size) * b.e;
    }
  });
}

double PlateFriction::energy(const VecX& x) const {
  const auto at = [&x](int i) { return Vec3(x.segment<3>(3 * i)); };
  return sum_chunks<Work::heavy>(static_cast<int>(triangles_.size()), [&](int begin, int end) {
    double total = 0;
    for (int e = begin; e < end; ++e) {
      const Triangle& t = triangles_[static_cast<std::size_t>(e)];
      const Bent b = bent(t, at);
      if (!b.frame.stands) continue;
      total += t.area * (b.size <= e_0_ ? 0.5 * b.size * b.size / e_0_ : b.size - 0.5 * e_0_);
    }
    return total;
  });
}

// f += factor times the force: that of fixed n, and what follows from its turning.
void PlateFriction::push(const Triangle& t, const Bent& b, double factor, VecX& f) const {
  const Vec3 pull = -factor * t.area / std::max(e_0_, b.size) * b.e, n = b.normal();
  for (std::size_t k = t.share; k < t.end; ++k)
    f.segment<3>(3 * shares_[k].particle) += pull.dot(shares_[k].weights) * n;
  const Slopes turn = b.frame.turn(n.cross(b.curvature * pull));
  for (int k = 0; k < 3; ++k)
    f.segment<3>(3 * t.corners[static_cast<std::size_t>(k)]) +=
        t.slopes(k, 0) * turn.col(0) + t.slopes(k, 1) * turn.col(1);
}

void PlateFriction::add_force(const VecX& x, const VecX&, VecX& f) const {
  const auto at = [&x](int i) { return Vec3(x.segment<3>(3 * i)); };
  run([&](const Triangle& t) {
    const Bent b = bent(t, at);
    if (b.frame.stands) push(t, b, 1, f);
  });
}

// A += factor times the second derivative, for fixed n, of psi or of the parabola that touches it.
void PlateFriction::add_blocks(const Triangle& t, const Bent& b, double factor, bool tangent,
                               BlockMatrix& A) const {
  const double stiffness = factor * t.area / std::max(e_0_, b.size);
  const Vec3 along = tangent && b.size > e_0_ ? Vec3(b.e / b.size) : Vec3(Vec3::Zero()), n = b.normal();
  const Mat3 across = n * n.transpose();
  std::size_t slot = t.slot;
  for (std::size_t k = t.share; k < t.end; ++k) {
    const Vec3 weights = stiffness * (shares_[k].weights - along.dot(shares_[k].weights) * along);
    for (std::size_t l = k; l < t.end; ++l) {
      const double weight = weights.dot(shares_[l].weights);
      double* const a = A.block(slots_[slot++]);
      for (int i = 0; i < 9; ++i) a[i] += weight * across.data()[i];
    }
  }
}

void PlateFriction::add_linearised(const VecX& x, const VecX&, const VecX& y, double c, Stiffness stiffness,
                                   BlockMatrix& A, VecX& b) const {
  const auto at = [&](int i) { return Vec3(x.segment<3>(3 * i) + y.segment<3>(3 * i)); };
  run([&](const Triangle& t) {
    const Bent how = bent(t, at);
    if (!how.frame.stands) return;
    push(t, how, c, b);
    add_blocks(t, how, c * c, stiffness == Stiffness::tangent, A);
  });
}

}  // namespace drape
