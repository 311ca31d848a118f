// Laws of the goals of clusters: they keep momentum and angular momentum, and are the slope of an energy.
#include <catch2/catch.hpp>

#include "mesh/base/threads.h"
#include "tests/clusters.h"

using namespace drape;
using namespace drape::test;

TEST_CASE("the pull to the goals is the slope of the energy", "[clusters]") {
  constexpr double k = 40, step = 1e-5;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const ClusterSet body(12, 5, seed % 2 ? 5 : 2, seed,
                          seed % 3 ? 0.3 : 2);  // overlapping or not, disturbed little or much
    const VecX g = body.gradient_at(body.x, k);
    for (Eigen::Index i = 0; i < body.x.size(); ++i) {
      VecX up = body.x, down = body.x;
      up[i] += step, down[i] -= step;
      const double slope = (body.energy_at(up, k) - body.energy_at(down, k)) / (2 * step);
      CHECK(g[i] == Approx(slope).margin(2e-6 * g.norm()));
    }
  }
}

TEST_CASE("at rest and after a rigid motion the goals are where the particles are", "[clusters]") {
  Random random(7);
  for (const auto& [per_set, step] : {std::pair(4, 4), std::pair(6, 3), std::pair(12, 12)}) {
    ClusterSet body(24, per_set, step, 9);
    const Quaternion q = random.rotation();
    VecX moved(body.rest.size());
    for (int i = 0; i < 24; ++i)
      moved.segment<3>(3 * i) = q * Vec3(body.rest.segment<3>(3 * i)) + Vec3(1, 2, 3);
    for (const VecX& x : {body.rest, moved}) {
      body.clusters.match(x, body.poses);
      VecX y = x;
      body.clusters.project(body.poses, 1, y);
      CHECK((y - x).cwiseAbs().maxCoeff() < 1e-13);
      CHECK(body.energy_at(x, 1) < 1e-26);
    }
  }
}

TEST_CASE("the way to the goals keeps momentum and angular momentum", "[clusters]") {
  for (unsigned seed = 0; seed < 40; ++seed) {
    for (const int step : {2, 3, 6}) {
      ClusterSet body(30, 6, step, seed);
      VecX together = body.x, one = body.x;
      body.clusters.project(body.poses, 0.7, together);
      project(body.clusters[1], body.poses[1], 0.7, one);
      for (const VecX& y : {together, one}) {
        const VecX moved = y - body.x;
        CHECK(moved.norm() > 1e-3);
        CHECK(body.momentum(moved).norm() < 1e-12);
        CHECK(body.angular(body.x, moved).norm() < 1e-11);
      }
    }
  }
}

TEST_CASE("the whole way makes a cluster rigid, and overlapping ones go to the mean of their goals",
          "[clusters]") {
  ClusterSet apart(24, 6, 6, 11);
  VecX y = apart.x;
  apart.clusters.project(apart.poses, 1, y);
  for (const std::vector<int>& set : apart.sets)
    for (const int i : set)
      for (const int j : set)
        CHECK((y.segment<3>(3 * i) - y.segment<3>(3 * j)).norm() ==
              Approx((apart.rest.segment<3>(3 * i) - apart.rest.segment<3>(3 * j)).norm()).margin(1e-13));
  ClusterSet over(24, 6, 3, 12);
  y = over.x;
  over.clusters.project(over.poses, 1, y);
  VecX one_by_one = over.x;  // the same by the kernel of one cluster, each from where the particles were
  for (int c = 0; c < over.clusters.count(); ++c) {
    VecX z = over.x;
    project(over.clusters[c], over.poses[c], 1, z);
    one_by_one += z - over.x;
  }
  CHECK((y - one_by_one).cwiseAbs().maxCoeff() < 1e-13);
}

TEST_CASE("one projection is the step of implicit Euler of clusters that do not overlap", "[clusters]") {
  for (const double h : {0.001, 0.01, 0.1}) {
    for (const double k : {1.0, 1e3, 1e7}) {
      ClusterSet body(24, 6, 6, 13);
      VecX y = body.x;
      body.clusters.project(body.poses, goal_share(k, h), y);
      VecX residual = h * h * body.gradient_at(y, k);
      for (std::size_t i = 0; i < body.masses.size(); ++i)
        residual.segment<3>(3 * i) += body.masses[i] * (y - body.x).segment<3>(3 * i);
      CHECK(residual.norm() < 1e-13 * (1 + k * h * h));
    }
  }
  CHECK(goal_share(0, 0.01) == 0);
  CHECK(goal_share(std::numeric_limits<double>::infinity(), 0.01) == 1);
}

TEST_CASE("shares add up to the masses", "[clusters]") {
  const ClusterSet body(30, 6, 2, 14);
  std::vector<double> sum(body.masses.size(), 0);
  for (int c = 0; c < body.clusters.count(); ++c)
    for (const ClusterMember& m : body.clusters[c]) {
      sum[m.particle] += m.share;
      CHECK(m.mass == body.masses[m.particle]);
    }
  for (std::size_t i = 0; i < sum.size(); ++i) CHECK(sum[i] == Approx(body.masses[i]).epsilon(1e-14));
}

TEST_CASE("clusters have the same bits on any number of threads", "[clusters]") {
  ClusterSet body(6000, 8, 3, 15);
  VecX first;
  const int before = threads();
  for (const int t : {1, 2, 7}) {
    set_threads(t);
    VecX y = body.x;
    std::vector<ClusterPose> poses(body.sets.size());
    for (int round = 0; round < 3; ++round) {
      body.clusters.match(y, poses);
      body.clusters.project(poses, 0.5, y);
    }
    if (t == 1) first = y;
    CHECK(y == first);
  }
  set_threads(before);
}
