#include "app/simulation/motion_extent.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drape::app {
namespace {

using Eigen::Quaterniond;

constexpr double least_samples = 2000, most_samples = 1e6;

Quaterniond turn_between(const Pose& from, const Pose& to) {
  return Quaterniond(Mat3(to.rotation * from.rotation.transpose()));
}

// So many that it turns by a quarter of a radian at most between two: whole turns are not missed.
double samples_of(const Motion& motion, double start, double end) {
  const double length = end - start, moment = 1e-7 * length;
  double fastest = 0;  // rad/s
  for (double k = 0; k < least_samples; ++k) {
    const double t = start + k / least_samples * length;
    const Quaterniond turn = turn_between(motion.at(t), motion.at(t + moment));
    fastest = std::max(fastest, 2 * std::atan2(turn.vec().norm(), std::abs(turn.w())) / moment);
  }
  return std::clamp(std::ceil(4 * fastest * length), least_samples, most_samples);
}

}  // namespace

MotionExtent motion_extent(const Motion& motion, const Vec3& X, double start, double end) {
  MotionExtent extent;
  const Pose first = motion.at(start);
  const Vec3 x = first.to_world(X);
  Vec3 turn = Vec3::Zero();
  const double samples = samples_of(motion, start, end);
  for (double k = 1; k <= samples; ++k) {
    const Pose pose = motion.at(k < samples ? start + k / samples * (end - start) : end);
    turn = unwrapped(turn_between(first, pose), turn);
    extent.way = std::max(extent.way, (pose.to_world(X) - x).norm());
    extent.turn = std::max(extent.turn, turn.norm());
  }
  return extent;
}

std::string described(const Motion& motion, const MotionSource& source, const Vec3& X, double duration) {
  const std::string kind = source.poses.empty() ? source.kind : source.poses.string();
  if (!motion.moves()) return kind.empty() ? "stands" : "stands, as " + kind + " says";
  const bool ends = std::isfinite(motion.last_time());
  const double end = ends ? motion.last_time() : duration;
  std::string text = "moved by " + kind + ", " + rounded(source.start, 4);
  text += ends ? " to " + rounded(end, 4) + " s: " : " s on: ";
  if (!(end > source.start)) return text + "after the end of the run";
  const MotionExtent extent = motion_extent(motion, X, source.start, end);
  return text + "by up to " + rounded(extent.way, 4) + " m, turned by up to " +
         rounded(extent.turn * 180 / std::numbers::pi, 4) + " deg" + (ends ? "" : " in the run");
}

}  // namespace drape::app
