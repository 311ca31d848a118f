#include "solver/forces/cluster_body.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace drape {
namespace {

constexpr double no_inertia = 1e-10;  // of the largest eigenvalue of I, or of sum w |b|^2

Vec3 at(const VecX& x, int particle) { return x.segment<3>(3 * particle); }

Mat3 cross_matrix(const Vec3& r) {
  Mat3 m;
  m << 0, -r[2], r[1], r[2], 0, -r[0], -r[1], r[0], 0;
  return m;
}

Mat3 pseudo_inverse(const Mat3& inertia, double at_rest) {
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(inertia);
  const double least = no_inertia * std::max(eigen.eigenvalues()[2], at_rest);  // the eigenvalues ascend
  Mat3 inverse = Mat3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = eigen.eigenvectors().col(k);
    if (eigen.eigenvalues()[k] > least) inverse += axis * axis.transpose() / eigen.eigenvalues()[k];
  }
  return inverse;
}

}  // namespace

Mat3 inertia_of(std::span<const ClusterMember> cluster, const Vec3& centre, const VecX& x) {
  Mat3 inertia = Mat3::Zero();
  for (const ClusterMember& member : cluster) {
    const Vec3 r = at(x, member.particle) - centre;
    inertia += member.share * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  }
  return inertia;
}

ClusterBody body_of(std::span<const ClusterMember> cluster, const VecX& x) {
  ClusterBody body{0, Vec3::Zero(), Mat3::Zero()};
  double at_rest = 0;
  for (const ClusterMember& member : cluster) {
    at_rest += member.share * member.rest.squaredNorm();
    body.mass += member.share;
    body.centre += member.share * at(x, member.particle);
  }
  body.centre /= body.mass;
  body.inverse_inertia = pseudo_inverse(inertia_of(cluster, body.centre, x), at_rest);
  return body;
}

ClusterMotion motion_of(std::span<const ClusterMember> cluster, const ClusterBody& body, const VecX& x,
                        const VecX& v) {
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
  for (const ClusterMember& member : cluster) {
    const Vec3 p = member.share * at(v, member.particle);
    momentum += p;
    angular += (at(x, member.particle) - body.centre).cross(p);
  }
  return {momentum / body.mass, body.inverse_inertia * angular};
}

Mat3 give_at(const ClusterBody& body, const Vec3& r) {
  return Mat3::Identity() / body.mass - cross_matrix(r) * body.inverse_inertia * cross_matrix(r);
}

void push(std::span<const ClusterMember> cluster, const ClusterBody& body, const Vec3& r, const Vec3& J,
          const VecX& x, VecX& v) {
  const ClusterMotion change{J / body.mass, body.inverse_inertia * r.cross(J)};
  for (const ClusterMember& member : cluster)
    v.segment<3>(3 * member.particle) +=
        member.share / member.mass * change.at(at(x, member.particle) - body.centre);
}

}  // namespace drape
