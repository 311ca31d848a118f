#include "solver/forces/cluster_force.h"

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

ClusterForce::ClusterForce(Clusters clusters, double k)
    : clusters_(std::move(clusters)), k_(k), poses_(static_cast<std::size_t>(clusters_.count())) {}

ClusterPose ClusterForce::pose(int cluster, const VecX& x) const {
  return matched(clusters_[cluster], x, poses_[static_cast<std::size_t>(cluster)].rotation);
}

double ClusterForce::energy(const VecX& x) const {
  double sum = 0;
  for (int c = 0; c < clusters_.count(); ++c) sum += drape::energy(clusters_[c], pose(c, x), x, k_);
  return sum;
}

void ClusterForce::add_force(const VecX& x, const VecX&, VecX& f) const {
  for (int c = 0; c < clusters_.count(); ++c) {
    const ClusterPose here = pose(c, x);
    for (const ClusterMember& member : clusters_[c])
      f.segment<3>(3 * member.particle) +=
          k_ * member.share * (here.goal(member) - Vec3(x.segment<3>(3 * member.particle)));
  }
}

// What is held does not move, and the others do not know of it before the next substep.
void ClusterForce::project(Substep& substep) {
  if (substep.first) moved_.setZero(substep.x.size());
  x_free_ = substep.x - moved_;
  substep.x = x_free_;
  clusters_.match(x_free_, poses_);
  clusters_.project(poses_, goal_share(k_, substep.h), substep.x);
  for (std::size_t i = 0; i < substep.mobility.size(); ++i)
    if (substep.mobility[i] == 0)
      substep.x.segment<3>(3 * static_cast<Eigen::Index>(i)) =
          x_free_.segment<3>(3 * static_cast<Eigen::Index>(i));
  moved_ = substep.x - x_free_;
}

}  // namespace drape
