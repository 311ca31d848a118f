#include "solver/forces/cluster_force.h"

#include <algorithm>
#include <utility>

#include "solver/forces/cluster_body.h"

namespace drape {

double cluster_stiffness(const Clusters& clusters, double young, double density) {
  double mass = 0, moment = 0;
  for (int c = 0; c < clusters.count(); ++c)
    for (const ClusterMember& member : clusters[c]) {
      mass += member.share;
      moment += member.share * member.rest.squaredNorm();
    }
  return 3 * young * mass / (density * moment);
}

ClusterForce::ClusterForce(Clusters clusters, double k, double viscosity)
    : clusters_(std::move(clusters)),
      k_(k),
      poses_(static_cast<std::size_t>(clusters_.count())),
      viscosity_(viscosity) {
  if (viscosity_ > 0) {
    viscous_ = clusters_;
    start_ = poses_;
  }
  for (int c = 0; c < clusters_.count(); ++c)
    for (const ClusterMember& member : clusters_[c]) {
      const auto i = static_cast<std::size_t>(member.particle);
      if (masses_.size() <= i) masses_.resize(i + 1, 0.0);
      masses_[i] = member.mass;
    }
}

ClusterPose ClusterForce::pose(int cluster, const VecX& x) const {
  return matched(clusters_[cluster], x, poses_[static_cast<std::size_t>(cluster)].rotation);
}

double ClusterForce::energy(const VecX& x) const {
  double sum = 0;
  for (int c = 0; c < clusters_.count(); ++c) sum += drape::energy(clusters_[c], pose(c, x), x, k_);
  return sum;
}

void ClusterForce::add_force(const VecX& x, const VecX& v, VecX& f) const {
  for (int c = 0; c < clusters_.count(); ++c) {
    const ClusterPose here = pose(c, x);
    for (const ClusterMember& member : clusters_[c])
      f.segment<3>(3 * member.particle) +=
          k_ * member.share * (here.goal(member) - Vec3(x.segment<3>(3 * member.particle)));
    if (viscosity_ == 0) continue;
    const ClusterBody body = body_of(clusters_[c], x);
    const ClusterMotion motion = motion_of(clusters_[c], body, x, v);
    for (const ClusterMember& member : clusters_[c]) {
      const Vec3 rigid = motion.at(Vec3(x.segment<3>(3 * member.particle)) - body.centre);
      f.segment<3>(3 * member.particle) -=
          k_ * viscosity_ * member.share * (Vec3(v.segment<3>(3 * member.particle)) - rigid);
    }
  }
}

// Viscosity is as if the shapes at rest followed those at the start of the substep.
void ClusterForce::take_up_viscosity(const Substep& substep) {
  clusters_.match(substep.start, start_);
  viscous_.take_shapes(clusters_, start_, viscosity_ / (substep.h + viscosity_), substep.start);
}

// A particle that is held does not move, and one that a body carries moves as the body gives way: the impulse
// on it is that of its own mass. It has been put back since the last iteration, so only what is new is added.
void ClusterForce::project(Substep& substep) {
  if (substep.first) moved_.setZero(substep.x.size());
  x_free_ = substep.x;
  for (std::size_t i = 0; i < masses_.size(); ++i)
    if (substep.mobility[i] * masses_[i] > 1 - 1e-9)
      x_free_.segment<3>(3 * static_cast<Eigen::Index>(i)) -=
          moved_.segment<3>(3 * static_cast<Eigen::Index>(i));
  x_new_ = x_free_;
  if (viscosity_ > 0 && substep.first) take_up_viscosity(substep);
  const Clusters& shapes = viscosity_ > 0 ? viscous_ : clusters_;
  shapes.match(x_free_, poses_);
  shapes.project(poses_, goal_share(k_ * (1 + viscosity_ / substep.h), substep.h), x_new_);
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    const double gives_way = substep.mobility[i] * masses_[i];
    const Vec3 way = std::min(gives_way, 1.0) * (x_new_.segment<3>(at) - x_free_.segment<3>(at));
    const bool is_free = gives_way > 1 - 1e-9;
    substep.x.segment<3>(at) = x_free_.segment<3>(at) + way;
    if (!is_free) substep.x.segment<3>(at) -= moved_.segment<3>(at);
    moved_.segment<3>(at) = way;
  }
}

}  // namespace drape
