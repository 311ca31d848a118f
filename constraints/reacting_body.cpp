#include "constraints/reacting_body.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <string>

#include "mesh/base/errors.h"

namespace drape {
namespace {

constexpr double close_enough = 1e-3;  // share of the change of velocity in the step
// A share of the velocity: for a body that floats freely without gravity there is no larger scale.
constexpr double round_off = 1e-12;

Mat3 turned_by(const Vec3& angle) {
  const double a = angle.norm();
  return a > 0 ? Eigen::AngleAxisd(a, angle / a).toRotationMatrix() : Mat3::Identity();
}

Mat3 cross_matrix(const Vec3& r) {
  Mat3 cross;
  cross << 0, -r[2], r[1], r[2], 0, -r[0], -r[1], r[0], 0;
  return cross;
}

}  // namespace

void check(const RigidBody& body) {
  if (!(body.mass > 0) || !std::isfinite(body.mass))
    throw InputError("mass = " + std::to_string(body.mass) + " kg: a mass is positive");
  if (body.mass < 1e-9)  // lighter than a grain of dust: a mistaken unit, and 1 / m is out of all range
    throw InputError("mass: a body that reacts has a microgram at least");
  for (const auto& [vector, called] : {std::pair(&body.centre, "centre"),
                                       {&body.velocity, "velocity"},
                                       {&body.spin, "spin"},
                                       {&body.gravity, "gravity"}})
    if (!vector->allFinite()) throw InputError(std::string(called) + ": three finite numbers are expected");
  if (!body.inertia.allFinite() ||
      !((body.inertia - body.inertia.transpose()).norm() <= 1e-9 * body.inertia.norm()))
    throw InputError("inertia: a symmetric matrix of finite numbers is expected");
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(body.inertia);
  const Vec3& I = principal.eigenvalues();  // ascending
  if (!(I[0] > 0))
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
      L_(world_inertia(pose.rotation) * body.spin),
      inverse_inertia_(world_inertia(pose.rotation).inverse()) {}

Mat3 ReactingBody::world_inertia(const Mat3& rotation) const {
  return rotation * body_.inertia * rotation.transpose();
}

// Newton's method for the spin W of the middle, in the body's frame there: I W = M with M = exp(-h [W] / 2)
// R^T L. Where it does not converge, because the body turns by more than half a turn or so in a step, the
// start stands for the middle.
Mat3 ReactingBody::middle_inertia(double h) const {
  constexpr int most_rounds = 30;
  const Mat3 R = pose_.rotation, &I = body_.inertia;
  const Vec3 start = R.transpose() * L_;
  Vec3 W = I.inverse() * start;
  for (int round = 0; round < most_rounds; ++round) {
    const Vec3 M = turned_by(-0.5 * h * W) * start, wrong = I * W - M;
    if (wrong.norm() <= 1e-14 * start.norm()) return world_inertia(R * turned_by(0.5 * h * W));
    const Mat3 turn = cross_matrix(0.5 * h * W);  // M changes by h/2 M x (1 - turn / 2 + turn^2 / 6 ...) dW
    const Mat3 change = Mat3::Identity() - 0.5 * turn + turn * turn / 6;
    W -= (I - 0.5 * h * cross_matrix(M) * change).inverse() * wrong;
  }
  return world_inertia(R);
}

Vec3 ReactingBody::spin() const { return world_inertia(pose_.rotation).inverse() * L_; }

Vec3 ReactingBody::momentum() const { return body_.mass * v_; }
Vec3 ReactingBody::centre() const { return pose_.to_world(body_.centre); }

Vec3 ReactingBody::met_velocity() const { return meets_ ? Vec3(met_.head<3>()) : Vec3(Vec3::Zero()); }
Vec3 ReactingBody::met_spin() const { return meets_ ? Vec3(met_.tail<3>() / radius_) : Vec3(Vec3::Zero()); }

Vec3 ReactingBody::free_velocity() const { return v_ + h_ * body_.gravity + J_ / body_.mass; }
Vec3 ReactingBody::free_spin() const { return inverse_inertia_ * (L_ + T_); }

Mat3 ReactingBody::mobility(const Vec3& place) const {
  const Mat3 cross = cross_matrix(place - centre());
  return Mat3::Identity() / body_.mass - cross * inverse_inertia_ * cross;
}

Pose ReactingBody::moved() const {
  const Vec6 q = meets_ ? Vec6(q_ + y_) : q_;
  const Vec3 c = pose_.to_world(body_.centre) + h_ * q.head<3>();
  const Mat3 R = turned_by(h_ / radius_ * q.tail<3>()) * pose_.rotation;
  return {R, c - R * body_.centre};
}

Pose ReactingBody::begin_step(double h) {
  const double share = last_h_ > 0 ? h / last_h_ : 0;  // of the impulses of the last step
  h_ = h;
  inverse_inertia_ = middle_inertia(h).inverse();
  meets_ = false;
  J_ = share * last_J_;
  T_ = share * last_T_;
  q_.head<3>() = v_ + h * body_.gravity + share * last_J_ / body_.mass;
  q_.tail<3>() = radius_ * (inverse_inertia_ * (L_ + share * last_T_));
  q_free_.head<3>() = v_ + h * body_.gravity;
  q_free_.tail<3>() = radius_ * (inverse_inertia_ * L_);
  corrections_ = changes_ = 0;
  known_ = false;
  if (last_J_.isZero(0)) relaxation_ = 0;
  return moved();
}

void ReactingBody::begin_corrections() {
  corrections_ = changes_ = 0;
  known_ = false;
}

void ReactingBody::clear_impulse() {
  J_.setZero();
  T_.setZero();
  pulled_J_.setZero();
  pulled_T_.setZero();
  approach_ = 0;
}

void ReactingBody::pull(const Vec3& impulse, const Vec3& place, double approach) {
  const Vec3 J = J_, T = T_;
  push(impulse, place, std::max(approach, impulse.norm() / body_.mass));
  pulled_J_ += J_ - J;
  pulled_T_ += T_ - T;
}

void ReactingBody::push(const Vec3& impulse, const Vec3& place, double approach) {
  J_ += impulse;
  const Vec3 u = meets_ ? Vec3(q_.head<3>() + y_.head<3>()) : Vec3(q_.head<3>());
  T_ += (place - (pose_.to_world(body_.centre) + h_ * u)).cross(impulse);
  approach_ = std::max(approach_, approach);
}

ReactingBody::Vec6 ReactingBody::difference() const {
  Vec6 d;
  d.head<3>() = v_ + h_ * body_.gravity + J_ / body_.mass;
  d.tail<3>() = radius_ * (inverse_inertia_ * (L_ + T_));
  if (meets_) d += met_;
  return d - q_;
}

void ReactingBody::meet(const Vec3& impulse, const Vec3& moment) {
  meets_ = true;
  A_ = moment;
  met_.head<3>() = impulse / body_.mass;
  met_.tail<3>() = radius_ * (inverse_inertia_ * moment);
}

Pose ReactingBody::expect(const Vec3& u, const Vec3& w) {
  y_.head<3>() = u;
  y_.tail<3>() = radius_ * w;
  q_ += met_;
  return moved();
}

double ReactingBody::change() const {
  const double by_bodies = meets_ ? met_.head<3>().norm() : 0;
  return (h_ * body_.gravity).norm() + J_.norm() / body_.mass + by_bodies;
}

// The cloth can throw the body back at twice the speed at which they met, and no faster.
void ReactingBody::stay_in_reach() {
  const double reach = 2 * (meeting_ + (h_ * body_.gravity).norm());
  const Vec6 alone = meets_ ? Vec6(q_free_ + met_) : q_free_;
  const Vec6 away = q_ - alone;
  if (away.norm() > reach) q_ = alone + reach / away.norm() * away;
}

bool ReactingBody::correct(Pose& end, double noise) {
  const Vec6 d = difference();
  if (corrections_ == 0 || meeting_ == 0) {
    const double spun = radius_ * (inverse_inertia_ * pulled_T_).norm();
    meeting_ = std::max(approach_, pulled_J_.norm() / body_.mass + spun);
  }
  const double near = close_enough * change() + noise / body_.mass + round_off * q_.norm();
  if (corrections_ == most_corrections || d.norm() <= near) return false;
  if (relaxation_ == 0) {
    const double Z = J_.norm() / std::max(approach_, h_ * body_.gravity.norm() + 1e-12);
    // How fast the point where it is pushed gives way to a unit of the impulse: 1/m where that is the centre
    // of mass.
    const double pushed = std::max({J_.squaredNorm(), T_.squaredNorm() / (radius_ * radius_), 1e-300});
    const double spins = T_.dot(inverse_inertia_ * T_) / pushed;
    relaxation_ = 1 / (1 + Z * (1 / body_.mass + spins));
  }
  if (known_) {  // the newest change comes first, and the oldest falls out
    changes_ = std::min(changes_ + 1, most_changes);
    for (int k = changes_ - 1; k > 0; --k) {
      dq_.col(k) = dq_.col(k - 1);
      dd_.col(k) = dd_.col(k - 1);
    }
    dq_.col(0) = q_ - last_q_;
    dd_.col(0) = d - last_d_;
  }
  last_q_ = q_;
  last_d_ = d;
  known_ = true;
  ++corrections_;
  Vec6 rest = d;
  if (changes_ > 0) {
    const auto dq = dq_.leftCols(changes_), dd = dd_.leftCols(changes_);
    const Eigen::VectorXd c = dd.colPivHouseholderQr().solve(-d);
    q_ += dq * c;
    rest += dd * c;
    if (changes_ == 1 && c[0] > 0)  // which share of d the first change should have been
      relaxation_ = std::clamp(relaxation_ * (1 + c[0]), 1e-6, 1.0);
  }
  q_ += relaxation_ * rest;
  stay_in_reach();
  end = moved();
  return true;
}

bool ReactingBody::converged(double share) const {
  return difference().norm() <= share * change() + round_off * q_.norm();
}

bool ReactingBody::end_step(const Pose& end) {
  const Vec6 d = difference();
  const bool converged = this->converged();
  const Vec6 q = converged ? Vec6(q_ + d) : q_;
  v_ = q.head<3>();
  const Vec3 T = meets_ ? Vec3(T_ + A_) : T_;
  L_ = converged ? Vec3(L_ + T) : Vec3(inverse_inertia_.inverse() * q.tail<3>() / radius_);
  pose_ = end;
  inverse_inertia_ = world_inertia(pose_.rotation).inverse();
  last_h_ = h_;
  last_J_ = J_;
  last_T_ = T_;
  last_P_ = meets_ ? Vec3(body_.mass * met_.head<3>()) : Vec3::Zero();
  return converged;
}

}  // namespace drape
