// The rotation that is nearest to a matrix.
//   R maximises tr(R^T A), so it minimises |R - A|; of A = sum m_i a_i b_i^T it turns the b_i onto the a_i as well as
//   a rotation can.                       [Horn 1987, section 4; Umeyama 1991]
// Always a proper rotation, det R = +1, whatever A is: flat, collinear, inverted, zero.
//
// Two methods, of which the second is asked only where the first cannot prove its answer.
//   1. Newton's method from the rotation of the last step, on the condition that S = R^T A be symmetric:
//        (tr S 1 - sym S) w = axis of (S - S^T),  R <- R exp [w].
//      With s1 >= s2 >= |s3| the signed singular values of A, the matrix on the left has the eigenvalues s2 + s3,
//      s1 + s3 and s1 + s2 at the maximum and a negative one at every other stationary point. So a positive definite
//      matrix proves the maximum. Three rounds are the rule; each is a closed formula.
//      [The same warm start, with steps of first order and without a proof: Mueller, Bender, Chentanez & Macklin 2016.]
//   2. The eigenvector of the largest eigenvalue of Horn's symmetric 4x4 matrix N(A), as a unit quaternion.
// Where s2 + s3 <= 1e-10 s1 (a collinear set, or a mirrored one without a thinnest direction) many rotations are as good as
// each other: they are the unit quaternions in an eigenspace of N. Of these the projection of the last quaternion is
// taken, which is the nearest to the rotation of the last step.
#pragma once

#include <Eigen/Geometry>

#include "mesh/base/vectors.h"

namespace drape {

using Quaternion = Eigen::Quaterniond;

// A may have any unit. Where A is zero or not finite the answer is `last`, a unit quaternion.
Quaternion nearest_rotation(const Mat3& A, const Quaternion& last);

}  // namespace drape
