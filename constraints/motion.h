#pragma once
#include <Eigen/Geometry>
#include "constraints/pose.h"
namespace drape {
class Motion {
 public:
  static Motion constant(const Vec3& velocity, const Vec3& spin, const Vec3& centre, double = 0,
                         double = 1e9) {
    Motion m;
    m.v = velocity;
    m.w = spin;
    m.c = centre;
    return m;
  }
  Pose at(double t) const {
    Mat3 R = w.norm() > 0 ? Mat3(Eigen::AngleAxisd(w.norm() * t, w.normalized()).toRotationMatrix())
                          : Mat3(Mat3::Identity());
    return {R, c - R * c + t * v};
  }
  bool moves() const { return v.norm() + w.norm() > 0; }
  Vec3 v = Vec3::Zero(), w = Vec3::Zero(), c = Vec3::Zero();
};
}  // namespace drape
