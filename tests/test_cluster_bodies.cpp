// Laws of a cluster that is pushed: it moves as a rigid body.
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "solver/forces/cluster_body.h"
#include "tests/clusters.h"

using namespace drape;
using namespace drape::test;

TEST_CASE("a push changes momentum by J, angular momentum by r x J, and the motion as that of a rigid body",
          "[clusters]") {
  Random random(8);
  for (unsigned seed = 0; seed < 200; ++seed) {
    const bool overlaps = seed % 4 < 2;
    ClusterSet body(12, 8, overlaps ? 4 : 8, seed);  // of two, the first shares four particles with the other
    const bool flat = seed % 2 == 1;                 // a flat set has an inertia of full rank
    if (flat)
      for (int i = 0; i < 12; ++i) body.x[3 * i + 1] = 0;
    const ClusterBody b = body_of(body.clusters[0], body.x);
    const Vec3 r = random.vector(), J = random.vector();
    VecX v = body.v;
    push(body.clusters[0], b, r, J, body.x, v);
    CHECK((body.momentum(v - body.v) - J).norm() < 1e-12);
    CHECK((body.angular(body.x, v - body.v) - (b.centre + r).cross(J)).norm() < 1e-11);
    if (overlaps) continue;  // what is shared moves by its share
    const ClusterMotion before = motion_of(body.clusters[0], b, body.x, body.v),
                        after = motion_of(body.clusters[0], b, body.x, v);
    CHECK((after.at(r) - before.at(r) - give_at(b, r) * J).norm() < 1e-11);
  }
}

TEST_CASE("the impulse between two clusters makes the relative velocity that is asked for", "[clusters]") {
  Random random(9);
  for (unsigned seed = 0; seed < 100; ++seed) {
    ClusterSet body(16, 8, 8, seed);
    const auto one = body.clusters[0], two = body.clusters[1];
    const ClusterBody a = body_of(one, body.x), b = body_of(two, body.x);
    const Vec3 point = random.vector(), asked = random.vector(), ra = point - a.centre, rb = point - b.centre;
    const auto relative = [&](const VecX& v) {
      return Vec3(motion_of(one, a, body.x, v).at(ra) - motion_of(two, b, body.x, v).at(rb));
    };
    const Vec3 J = (give_at(a, ra) + give_at(b, rb)).inverse() * (asked - relative(body.v));
    VecX v = body.v;
    push(one, a, ra, J, body.x, v);
    push(two, b, rb, -J, body.x, v);
    CHECK((relative(v) - asked).norm() < 1e-10);
    CHECK(body.momentum(v - body.v).norm() < 1e-12);
    CHECK(body.angular(body.x, v - body.v).norm() < 1e-11);
  }
}

TEST_CASE("a line of particles takes up all but the turn about it, and one place no turn", "[clusters]") {
  Random random(10);
  for (unsigned seed = 0; seed < 100; ++seed) {
    ClusterSet body(6, 6, 6, seed);
    const Vec3 axis = random.vector().normalized(), start = random.vector();
    for (int i = 0; i < 6; ++i) body.x.segment<3>(3 * i) = start + random.between(-1, 1) * axis;
    const Vec3 r = random.vector(), J = random.vector();
    for (const bool one_place : {false, true}) {
      if (one_place)
        for (int i = 0; i < 6; ++i) body.x.segment<3>(3 * i) = start;
      const ClusterBody b = body_of(body.clusters[0], body.x);
      VecX v = VecX::Zero(body.v.size());
      push(body.clusters[0], b, r, J, body.x, v);
      CHECK((body.momentum(v) - J).norm() < 1e-12);
      Vec3 turn = r.cross(J) - axis.dot(r.cross(J)) * axis;
      if (one_place) turn.setZero();
      const Vec3 about_centre = body.angular(body.x, v) - b.centre.cross(J);
      CHECK((about_centre - turn).norm() < 1e-6);
      CHECK(v.cwiseAbs().maxCoeff() < 100);
    }
  }
}
