#include "constraints/reacting_body.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "mesh/obj.h"

namespace drape {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;

constexpr int most_corrections = 6;    // in a step
constexpr double close_enough = 1e-3;  // of the change of velocity in the step
constexpr double least_relaxation = 1e-3;

Mat3 turned_by(const Vec3& angle) {
  const double a = angle.norm();
  return a > 0 ? Eigen::AngleAxisd(a, angle / a).toRotationMatrix() : Mat3::Identity();
}

}  // namespace

void check(const RigidBody& body) {
  if (!(body.mass > 0) || !std::isfinite(body.mass))
    throw InputError("mass = " + std::to_string(body.mass) + " kg: a mass is positive");
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(body.inertia);
  const Vec3 I = principal.eigenvalues();  // ascending
  if (!body.inertia.allFinite() || !(I[0] > 0))
    throw InputError("inertia: the principal moments are positive, the least is " + std::to_string(I[0]) +
                     " kg m^2");
  if (I[2] > (I[0] + I[1]) * (1 + 1e-9))
    throw InputError("inertia: no body has a principal moment greater than the sum of the other two");
}

ReactingBody::ReactingBody(const RigidBody& body, const Pose& pose)
    : body_(body),
      radius_(std::sqrt(body.inertia.trace() / (3 * body.mass))),
      pose_(pose),
      v_(body.velocity),
      L_(world_inertia(pose) * body.spin) {}

Mat3 ReactingBody::world_inertia(const Pose& pose) const {
  return pose.rotation * body_.inertia * pose.rotation.transpose();
}

Vec3 ReactingBody::spin() const { return world_inertia(pose_).inverse() * L_; }

Pose ReactingBody::moved() const {
  const Vec3 c = pose_.to_world(body_.centre) + h_ * u_;
  const Mat3 R = turned_by(h_ * w_) * pose_.rotation;
  return {R, c - R * body_.centre};
}

Pose ReactingBody::begin_step(double h) {
  const double share = h_ > 0 ? h / h_ : 0;  // of the last step's impulses
  h_ = h;
  u_ = v_ + h * body_.gravity + share * J_ / body_.mass;
  w_ = world_inertia(pose_).inverse() * (L_ + share * T_);
  corrections_ = 0;
  return moved();
}

void ReactingBody::push(const Vec3& impulse, const Vec3& place) {
  J_ += impulse;
  T_ += (place - (pose_.to_world(body_.centre) + h_ * u_)).cross(impulse);
}

Vec6 ReactingBody::difference() const {
  Vec6 d;
  d.head<3>() = v_ + h_ * body_.gravity + J_ / body_.mass - u_;
  d.tail<3>() = radius_ * (world_inertia(moved()).inverse() * (L_ + T_) - w_);
  return d;
}

bool ReactingBody::correct(Pose& end) {
  const Vec6 d = difference();
  const double change = (h_ * body_.gravity).norm() + J_.norm() / body_.mass;
  if (corrections_ == most_corrections || d.norm() <= close_enough * change) return false;
  if (corrections_ > 0) {
    const Vec6 less = last_difference_ - d;
    const double squared = less.squaredNorm();
    if (squared > 0)
      relaxation_ = std::clamp(relaxation_ * last_difference_.dot(less) / squared, least_relaxation, 1.0);
  }
  ++corrections_;
  last_difference_ = d;
  u_ += relaxation_ * d.head<3>();
  w_ += relaxation_ / radius_ * d.tail<3>();
  end = moved();
  return true;
}

void ReactingBody::end_step(const Pose& end) {
  v_ += h_ * body_.gravity + J_ / body_.mass;
  L_ += T_;
  pose_ = end;
}

}  // namespace drape
