#include "solver/integrators/rigid_motion.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "mesh/base/parallel.h"

namespace drape {
namespace {

// The inverse of a tensor of inertia in the directions that have an eigenvalue above 0, but for rounding; and
// the projection on the others.
struct Inverse {
  Mat3 inverse = Mat3::Zero(), without = Mat3::Zero();
};
Inverse invert(const Mat3& inertia) {
  constexpr double least = 1e-9;  // of the largest eigenvalue
  Inverse d;
  Eigen::SelfAdjointEigenSolver<Mat3> eigen;
  eigen.computeDirect(inertia);
  const double largest = eigen.eigenvalues()[2];
  for (int k = 0; k < 3; ++k) {
    const Vec3 a = eigen.eigenvectors().col(k);
    if (eigen.eigenvalues()[k] > least * largest)
      d.inverse += a * a.transpose() / eigen.eigenvalues()[k];
    else
      d.without += a * a.transpose();
  }
  return d;
}

}  // namespace

void RigidMotion::follow(const BlockPattern& pattern) {
  piece_ = connected_pieces(pattern);
  motions_.resize(piece_.empty() ? 0 : *std::max_element(piece_.begin(), piece_.end()) + std::size_t{1});
}

void RigidMotion::Sums::add(const Vec3& at, const Vec3& goes, double by) {
  weight += by;
  energy += by * goes.squaredNorm();
  x += by * at;
  v += by * goes;
  angular += by * at.cross(goes);
  spread += by * at * at.transpose();
}

void RigidMotion::Motion::find(double h) {
  constexpr double explained = 0.5;  // of the energy beside the centre of mass
  is_rigid = false;
  if (!(free.weight > 0)) return;
  Vec3 w = Vec3::Zero();
  Mat3 open = Mat3::Identity();  // the directions of w of which what is held says nothing
  if (held.weight > 0) {
    const Inverse of_held = invert(held.inertia());
    w = of_held.inverse * held.angular;
    open = of_held.without;
  }
  const Mat3 inertia = free.inertia();
  w += invert(open * inertia * open).inverse * (open * (free.angular - inertia * w));
  const double left = free.energy - 2 * w.dot(free.angular) + w.dot(inertia * w);
  const double beside_middle = free.energy - free.v.squaredNorm() / free.weight;
  t = 0.5 * h * w;
  is_rigid = t.allFinite() && left < (1 - explained) * beside_middle;
}

template <class F>  // f(particle, its motion, whether it is held)
void RigidMotion::each(const std::vector<double>& mass, const std::vector<char>& held, const F& f) {
  for (std::size_t i = 0; i < piece_.size(); ++i)
    f(static_cast<Eigen::Index>(i), motions_[piece_[i]], held[i] != 0 || mass[i] == 0);
}

void RigidMotion::go_on(const std::vector<double>& mass, const std::vector<char>& held, double h,
                        const VecX& v, VecX& x) {
  std::fill(motions_.begin(), motions_.end(), Motion());
  each(mass, held, [&](Eigen::Index i, Motion& motion, bool is_held) {
    const Vec3 at = x.segment<3>(3 * i), goes = v.segment<3>(3 * i);
    if (is_held)
      motion.held.add(at, goes, 1);
    else
      motion.free.add(at, goes, mass[static_cast<std::size_t>(i)]);
  });
  for (Motion& motion : motions_) {
    const Sums& of = motion.held.weight > 0 ? motion.held : motion.free;
    if (!(of.weight > 0)) continue;
    motion.pivot = of.x / of.weight;
    motion.velocity = of.v / of.weight;
    motion.held = motion.free = {};
  }
  each(mass, held, [&](Eigen::Index i, Motion& motion, bool is_held) {
    const Vec3 at = x.segment<3>(3 * i) - motion.pivot, goes = v.segment<3>(3 * i) - motion.velocity;
    if (is_held)
      motion.held.add(at, goes, 1);
    else
      motion.free.add(at, goes, mass[static_cast<std::size_t>(i)]);
  });
  for (Motion& motion : motions_) motion.find(h);
  for_chunks(static_cast<int>(piece_.size()), [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Motion& motion = motions_[piece_[i]];
      if (!motion.is_rigid) continue;
      const Vec3 across = motion.t.cross(x.segment<3>(3 * i) - motion.pivot);
      x.segment<3>(3 * i) +=
          h * motion.velocity + 2 / (1 + motion.t.squaredNorm()) * (across + motion.t.cross(across));
    }
  });
}

}  // namespace drape
