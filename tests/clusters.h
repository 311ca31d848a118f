// What laws of clusters need: random vectors and rotations, and a body of clusters.
#pragma once

#include <random>

#include "mesh/base/rotation.h"
#include "solver/forces/cluster.h"
#include "solver/forces/cluster_sets.h"

namespace drape::test {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vec3 vector(double size = 1) { return {between(-size, size), between(-size, size), between(-size, size)}; }
  Quaternion rotation() {
    Eigen::Vector4d q;  // in an order of its own: that of arguments is the compiler's
    for (int k = 3; k >= 0; --k) q[k] = normal();
    return Quaternion(q.normalized());
  }

 private:
  double normal() { return std::normal_distribution<double>()(engine_); }
  std::mt19937 engine_;
};

// Particles at rest and moved by anything, with overlapping sets of `per_set` particles.
struct ClusterSet {
  VecX rest, x, v;
  std::vector<double> masses;
  ParticleSets sets;
  Clusters clusters;
  std::vector<ClusterPose> poses;

  ClusterSet(int particles, int per_set, int step, unsigned seed, double disturbance = 1) {
    Random random(seed);
    rest.resize(3 * particles), x.resize(3 * particles), v.resize(3 * particles);
    const Quaternion turn = random.rotation();
    for (int i = 0; i < particles; ++i) {
      rest.segment<3>(3 * i) = random.vector();
      x.segment<3>(3 * i) =
          turn * Vec3(rest.segment<3>(3 * i)) + disturbance * random.vector() + Vec3(5, -3, 2);
      v.segment<3>(3 * i) = random.vector();
      masses.push_back(random.between(0.1, 2));
    }
    for (int first = 0; first + per_set <= particles; first += step) {
      sets.emplace_back();
      for (int k = 0; k < per_set; ++k) sets.back().push_back(first + k);
    }
    clusters = Clusters(sets, masses, rest, "body");
    poses.resize(sets.size());
    clusters.match(x, poses);
  }

  Vec3 momentum(const VecX& u) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < masses.size(); ++i) sum += masses[i] * u.segment<3>(3 * i);
    return sum;
  }
  Vec3 angular(const VecX& at, const VecX& u) const {  // about the origin
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < masses.size(); ++i)
      sum += masses[i] * Vec3(at.segment<3>(3 * i)).cross(Vec3(u.segment<3>(3 * i)));
    return sum;
  }
  double energy_at(const VecX& y, double k) const {
    double sum = 0;
    for (int c = 0; c < clusters.count(); ++c)
      sum += energy(clusters[c], matched(clusters[c], y, poses[c].rotation), y, k);
    return sum;
  }
  VecX gradient_at(const VecX& y, double k) const {
    VecX g = VecX::Zero(y.size());
    for (int c = 0; c < clusters.count(); ++c) {
      const ClusterPose pose = matched(clusters[c], y, poses[c].rotation);
      for (const ClusterMember& m : clusters[c])
        g.segment<3>(3 * m.particle) += k * m.share * (y.segment<3>(3 * m.particle) - pose.goal(m));
    }
    return g;
  }
};

}  // namespace drape::test
