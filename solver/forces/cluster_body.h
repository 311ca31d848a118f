// A cluster (solver/forces/cluster.h) as a body that is pushed at a point: one impulse, shared among its
// particles.
//   M = sum w_i,  c = sum w_i x_i / M,  r_i = x_i - c,  I = sum w_i (|r_i|^2 1 - r_i r_i^T)
//   v = sum w_i v_i / M,   w = I^-1 sum w_i r_i x v_i
//   An impulse J at the point c + r:  dv = J/M + (I^-1 (r x J)) x r_i,   of which the particle takes w_i / m_i
// So momentum changes by J and angular momentum about c by r x J, to round-off, and the motion (v, w) of the
// body as that of a rigid body does, where no particle is in another cluster as well. At the point c + r the
// velocity v + w x r changes by K J, K = 1/M 1 - [r] I^-1 [r]. M counts the shares w_i of its particles
// (solver/forces/cluster.h): so the clusters of a body that overlap have its mass together, and a particle
// moves as the mean of what its clusters do.
// w_i, m_i [kg], x, c, r [m], v [m/s], w [rad/s], I [kg m^2], J [N s], K [1/kg].
//
// Particles on a line cannot take up a turn about it, and particles at one place no turn at all. There I^-1
// is the pseudo-inverse: an eigenvalue of I counts as zero up to 1e-10 of the largest one, and up to 1e-10 of
// sum w_i |b_i|^2, the same of the cluster at rest. The part of r x J along its axis is lost.
#pragma once

#include <span>

#include "solver/forces/cluster.h"

namespace drape {

struct ClusterBody {
  double mass;           // kg, M
  Vec3 centre;           // m, c: of the shares
  Mat3 inverse_inertia;  // 1/(kg m^2), pseudo-inverse of I, in the axes of the world
};

// The inertia I about c of a cluster at positions x [kg m^2].
Mat3 inertia_of(std::span<const ClusterMember> cluster, const Vec3& centre, const VecX& x);

ClusterBody body_of(std::span<const ClusterMember> cluster, const VecX& x);

struct ClusterMotion {
  Vec3 velocity;  // m/s, v
  Vec3 spin;      // rad/s, w
  Vec3 at(const Vec3& r) const { return velocity + spin.cross(r); }
  ClusterMotion operator+(const ClusterMotion& other) const {
    return {velocity + other.velocity, spin + other.spin};
  }
};
ClusterMotion motion_of(std::span<const ClusterMember> cluster, const ClusterBody& body, const VecX& x,
                        const VecX& v);

// K [1/kg] at the point c + r. The impulse between two bodies whose points are to part with the relative
// velocity u more is (K_1 + K_2)^-1 u.
Mat3 give_at(const ClusterBody& body, const Vec3& r);

// Adds the velocities dv_i that the impulse J [N s] at the point c + r gives to the particles.
void push(std::span<const ClusterMember> cluster, const ClusterBody& body, const Vec3& r, const Vec3& J,
          const VecX& x, VecX& v);

}  // namespace drape
