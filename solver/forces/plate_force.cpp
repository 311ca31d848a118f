#include "solver/forces/plate_force.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/forces/triangle_frame.h"

namespace drape {

using internal::TriangleFrame;

namespace {

// A vector of the particles as a function of the particle.
auto rows_of(const VecX& all) {
  return [&all](int i) { return Vec3(all.segment<3>(3 * i)); };
}

template <class At>
Slopes slopes_at(const BentTriangle& t, const At& at) {
  Slopes f = Slopes::Zero();
  for (int k = 0; k < 3; ++k) f += at(t.corners[static_cast<std::size_t>(k)]) * t.weights.row(k);
  return f;
}

}  // namespace

PlateForce::PlateForce(const PlateEnergy& plate, double time, int first)
    : time_(time), pull_(plate.pull), size_(plate.size), bent_(plate.bent), parts_(plate.parts, time, first) {
  pairs_.reserve(plate.pairs.size());
  for (const PlatePair& p : plate.pairs) pairs_.push_back({first + p.i, first + p.j, p.k, -1});
  for (BentTriangle& t : bent_) {
    for (int& corner : t.corners) corner += first;
    for (BentTriangle::Pull& pull : t.pulls) pull.vertex += first;
  }
}

void PlateForce::list_pairs(std::vector<ParticlePair>& pairs) const {
  for (const Pair& p : pairs_) pairs.push_back({p.i, p.j});
}

void PlateForce::bind(const BlockLayout& layout) {
  const auto row = [&](int i) { return layout.base.row_of()[i]; };
  std::vector<std::pair<int, double>> of_row;  // what pairs add to the diagonal
  for (Pair& p : pairs_) {
    if (row(p.i) > row(p.j)) std::swap(p.i, p.j);
    p.slot = layout.slot(row(p.i), row(p.j));
    of_row.emplace_back(row(p.i), p.k);
    of_row.emplace_back(row(p.j), p.k);
  }
  std::stable_sort(pairs_.begin(), pairs_.end(), [&](const Pair& p, const Pair& q) {
    return std::pair(row(p.i), row(p.j)) < std::pair(row(q.i), row(q.j));
  });
  schedule_.bind(layout.base, static_cast<int>(pairs_.size()),
                 [&](int e) { return row(pairs_[static_cast<std::size_t>(e)].i); });
  std::stable_sort(of_row.begin(), of_row.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  diagonal_.clear();
  std::vector<int> rows;
  for (const auto& [r, k] : of_row) {
    if (rows.empty() || rows.back() != r) {
      rows.push_back(r);
      diagonal_.push_back({layout.base.diagonal(r), 0});
    }
    diagonal_.back().k += k;
  }
  diagonal_schedule_.bind(layout.base, static_cast<int>(rows.size()),
                          [&](int e) { return rows[static_cast<std::size_t>(e)]; });
}

// The terms of pairs far apart cancel those of pairs nearby where the cloth is flat. Cloth hardly stretches,
// so they stay as large as in the mesh; the difference of two places has the round-off of the places. What
// the bent triangles add cancels too, near the rest shape: energy() leaves it out there.
double PlateForce::energy_noise(const VecX& x) const {
  constexpr double eps = 4 * std::numeric_limits<double>::epsilon();
  return eps * (size_ + 4 * pull_ * x.lpNorm<Eigen::Infinity>());
}

double PlateForce::energy(const VecX& x) const {
  double sum = sum_chunks<Work::heavy>(static_cast<int>(pairs_.size()), [&](int begin, int end) {
    double total = 0;
    for (int e = begin; e < end; ++e) {
      const Pair& p = pairs_[static_cast<std::size_t>(e)];
      total += 0.5 * p.k * (x.segment<3>(3 * p.i) - x.segment<3>(3 * p.j)).squaredNorm();
    }
    return total;
  });
  const double flat = sum;
  for (const BentTriangle& t : bent_) {
    const TriangleFrame frame(slopes_at(t, rows_of(x)));
    if (!frame.stands) continue;
    const Vec3 origin = x.segment<3>(3 * t.corners[0]);
    sum += t.energy;
    for (const BentTriangle::Pull& pull : t.pulls)
      sum -= (frame.axes * pull.force).dot(x.segment<3>(3 * pull.vertex) - origin);
  }
  // Near the rest shape the two parts cancel, and what is left is round-off: it is no energy that a step
  // could lower.
  return std::abs(sum) > 1e-14 * flat ? sum : 0;
}

double PlateForce::dissipation(const VecX&, const VecX& v) const {
  if (time_ == 0) return 0;
  return time_ * sum_chunks<Work::heavy>(static_cast<int>(pairs_.size()), [&](int begin, int end) {
           double total = 0;
           for (int e = begin; e < end; ++e) {
             const Pair& p = pairs_[static_cast<std::size_t>(e)];
             total += 0.5 * p.k * (v.segment<3>(3 * p.i) - v.segment<3>(3 * p.j)).squaredNorm();
           }
           return total;
         });
}

// f -= K at, by the pairs.
template <class At>
void PlateForce::add_pairs(const At& at, VecX& f) const {
  schedule_.run(static_cast<int>(pairs_.size()), [&](int e) {
    const Pair& p = pairs_[static_cast<std::size_t>(e)];
    const Vec3 pull = p.k * (at(p.i) - at(p.j));
    f.segment<3>(3 * p.i) -= pull;
    f.segment<3>(3 * p.j) += pull;
  });
}

// f += factor times the force of the bent triangles.
template <class At>
void PlateForce::add_bent(const At& at, double factor, VecX& f) const {
  for (const BentTriangle& t : bent_) {
    const TriangleFrame frame(slopes_at(t, at));
    if (!frame.stands) continue;
    const Vec3 origin = at(t.corners[0]);
    Vec3 torque = Vec3::Zero();  // by which the pulls would turn the axes
    for (const BentTriangle::Pull& pull : t.pulls) {
      const Vec3 force = frame.axes * pull.force;
      torque += force.cross(at(pull.vertex) - origin);
      f.segment<3>(3 * pull.vertex) += factor * force;
    }
    const Slopes turn = frame.turn(torque);
    for (int k = 0; k < 3; ++k)
      f.segment<3>(3 * t.corners[static_cast<std::size_t>(k)]) +=
          factor * (t.weights(k, 0) * turn.col(0) + t.weights(k, 1) * turn.col(1));
  }
}

void PlateForce::add_force(const VecX& x, const VecX& v, VecX& f) const {
  if (time_ == 0)
    add_pairs(rows_of(x), f);
  else
    add_pairs([&](int i) { return Vec3(x.segment<3>(3 * i) + time_ * v.segment<3>(3 * i)); }, f);
  add_bent(rows_of(x), 1, f);
}

void PlateForce::add_linearised(const VecX& x, const VecX& v, const VecX& y, double c, Stiffness,
                                BlockMatrix& A, VecX& b) const {
  // c (f - K y) = -c K (x + y + T v), so that the blocks hold c (c + T) K.
  if (time_ == 0)
    add_pairs([&](int i) { return Vec3(c * (x.segment<3>(3 * i) + y.segment<3>(3 * i))); }, b);
  else
    add_pairs(
        [&](int i) {
          return Vec3(c * (x.segment<3>(3 * i) + y.segment<3>(3 * i) + time_ * v.segment<3>(3 * i)));
        },
        b);
  const double factor = c * (c + time_);
  const auto add = [&](int slot, double k) {
    double* const a = A.block(slot);
    a[0] += k;
    a[4] += k;
    a[8] += k;
  };
  schedule_.run(static_cast<int>(pairs_.size()), [&](int e) {
    const Pair& p = pairs_[static_cast<std::size_t>(e)];
    add(p.slot, -factor * p.k);
  });
  diagonal_schedule_.run(static_cast<int>(diagonal_.size()), [&](int e) {
    const Diagonal& d = diagonal_[static_cast<std::size_t>(e)];
    add(d.slot, factor * d.k);
  });
  if (!bent_.empty()) add_bent([&](int i) { return Vec3(x.segment<3>(3 * i) + y.segment<3>(3 * i)); }, c, b);
}

// The bent triangles hardly stiffen the plate, so their impulse is simply that of their force at x.
void PlateForce::project(Substep& substep) {
  parts_.run(substep);
  if (bent_.empty()) return;
  if (substep.first) bent_impulse_.setZero(substep.x.size());
  bent_now_.setZero(substep.x.size());
  add_bent(rows_of(substep.x), substep.h, bent_now_);
  for (Eigen::Index i = 0; i < substep.x.size() / 3; ++i) {
    const Vec3 change = bent_now_.segment<3>(3 * i) - bent_impulse_.segment<3>(3 * i);
    substep.x.segment<3>(3 * i) += substep.h * substep.mobility[static_cast<std::size_t>(i)] * change;
  }
  bent_impulse_.swap(bent_now_);
}

}  // namespace drape
