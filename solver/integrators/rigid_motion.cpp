#include "solver/integrators/rigid_motion.h"

#include <Eigen/LU>
#include <numeric>

#include "mesh/base/parallel.h"

namespace drape {

void RigidMotion::follow(const BlockPattern& pattern) {
  piece_ = connected_pieces(pattern);
  first_.clear();
  for (int i = 0; i < static_cast<int>(piece_.size()); ++i)
    if (piece_[i] == static_cast<int>(first_.size())) first_.push_back(i);
  motions_.resize(first_.size());
}

void RigidMotion::Motion::add(const Vec3& x, const Vec3& v, double by) {
  const Vec3 r = x - origin, momentum_of_it = by * v, weighted = by * r;
  weight += by;
  middle += weighted;
  momentum += momentum_of_it;
  angular += r.cross(momentum_of_it);
  spread += weighted * r.transpose();
}

// From sums over the piece to its motion in a step.
void RigidMotion::Motion::find(double h) {
  way = t = Vec3::Zero();
  if (!(weight > 0)) return;
  middle /= weight;
  way = h / weight * momentum;
  const Mat3 about_middle = spread - weight * middle * middle.transpose();
  const double trace = about_middle.trace();
  if (!(trace > 0)) return;
  // What lies along a line does not say how it turns about that.
  const Mat3 inertia = 1.000001 * trace * Mat3::Identity() - about_middle;
  t = 0.5 * h * (inertia.inverse() * (angular - middle.cross(momentum)));
  if (!t.allFinite()) t.setZero();
}

void RigidMotion::go_on(const std::vector<double>& mass, const std::vector<char>& held, double h,
                        const VecX& v, VecX& x) {
  constexpr double of_held = 1e6;  // times the mean mass
  for (std::size_t p = 0; p < motions_.size(); ++p) {
    motions_[p] = {};
    motions_[p].origin = x.segment<3>(3 * first_[p]);
  }
  const double sum = std::accumulate(mass.begin(), mass.end(), 0.0);
  const double most = of_held * (sum > 0 ? sum / static_cast<double>(mass.size()) : 1);
  for (std::size_t i = 0; i < piece_.size(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    motions_[piece_[i]].add(x.segment<3>(at), v.segment<3>(at),
                            held[i] != 0 || mass[i] == 0 ? most : mass[i]);
  }
  for (Motion& motion : motions_) motion.find(h);
  for_chunks(static_cast<int>(piece_.size()), [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Motion& motion = motions_[piece_[i]];
      const Vec3 r = x.segment<3>(3 * i) - motion.origin - motion.middle, across = motion.t.cross(r);
      x.segment<3>(3 * i) +=
          motion.way + 2 / (1 + motion.t.squaredNorm()) * (across + motion.t.cross(across));
    }
  });
}

}  // namespace drape
