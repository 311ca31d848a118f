#include "mesh/base/rotation.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <optional>

namespace drape {
namespace {

constexpr double ambiguous = 1e-10;  // s2 + s3 as a share of s1 below which a rotation is not unique

// The derivative of tr(R^T A) by a turn of R: twice the axis of the antisymmetric part of S = R^T A.
Vec3 turn_of(const Mat3& S) { return {S(2, 1) - S(1, 2), S(0, 2) - S(2, 0), S(1, 0) - S(0, 1)}; }

// Solves (tr S 1 - sym S) w = turn_of(S), if that matrix is surely positive definite. Its determinant is at
// most its smallest eigenvalue times (tr S)^2.
std::optional<Vec3> newton_turn(const Mat3& S) {
  const double trace = S.trace();
  const double a = S(1, 1) + S(2, 2), b = S(0, 0) + S(2, 2), c = S(0, 0) + S(1, 1);
  const double d = -0.5 * (S(0, 1) + S(1, 0)), e = -0.5 * (S(0, 2) + S(2, 0)), f = -0.5 * (S(1, 2) + S(2, 1));
  const double A = b * c - f * f, D = e * f - d * c, E = d * f - b * e;  // the first row of the adjugate
  const double det = a * A + d * D + e * E;
  const double corner = a * b - d * d;
  if (!(a > 0 && corner > 0 && det > ambiguous * trace * trace * trace)) return std::nullopt;
  const Vec3 g = turn_of(S);
  const double B = a * c - e * e, F = d * e - a * f;
  return Vec3(A * g[0] + D * g[1] + E * g[2], D * g[0] + B * g[1] + F * g[2],
              E * g[0] + F * g[1] + corner * g[2]) /
         det;
}

std::optional<Quaternion> by_newton(const Mat3& A, Quaternion q) {
  constexpr int rounds = 8;
  for (int k = 0; k < rounds; ++k) {
    const std::optional<Vec3> w = newton_turn(q.toRotationMatrix().transpose() * A);
    if (!w) return std::nullopt;
    q = q * Quaternion(1, (*w)[0] / 2, (*w)[1] / 2, (*w)[2] / 2);
    q.normalize();
    if (w->squaredNorm() < 1e-16) return q;  // the next turn would be of the order of its square
  }
  return std::nullopt;
}

Quaternion by_eigenvector(const Mat3& A, const Quaternion& last) {
  Eigen::Matrix4d
      N;  // of (x, y, z, w), the order in which Eigen keeps a quaternion  [Horn 1987, section 4.A]
  N.topLeftCorner<3, 3>() = A + A.transpose() - A.trace() * Mat3::Identity();
  N.topRightCorner<3, 1>() = turn_of(A);
  N.bottomLeftCorner<1, 3>() = turn_of(A).transpose();
  N(3, 3) = A.trace();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(N);
  const Eigen::Vector4d& value = eigen.eigenvalues();  // ascending
  Eigen::Vector4d nearest = Eigen::Vector4d::Zero();
  for (int k = 3; k >= 0 && value[3] - value[k] <= 2 * ambiguous * value[3]; --k) {
    const Eigen::Vector4d u = eigen.eigenvectors().col(k);
    nearest += u * u.dot(last.coeffs());
  }
  // Perpendicular to all of the best ones: they all are half a turn away, and one is as near as another.
  if (nearest.squaredNorm() < 1e-20) nearest = eigen.eigenvectors().col(3);
  return Quaternion(Eigen::Vector4d(nearest.normalized()));
}

}  // namespace

Quaternion nearest_rotation(const Mat3& A, const Quaternion& last) {
  const double scale = A.cwiseAbs().maxCoeff();
  if (!A.allFinite() || scale < std::numeric_limits<double>::min()) return last;
  const Mat3 scaled = A / scale;
  const std::optional<Quaternion> found = by_newton(scaled, last);
  return found ? *found : by_eigenvector(scaled, last);
}

}  // namespace drape
