// The axes that turn with a triangle: t_1 along f_u = dx/du, t_2 across it in the plane, and the normal n.
// They follow from the slopes f = (f_u, f_v) of the triangle. With f_v = a t_1 + b t_2 the axes turn, while f
// changes at the rate df, with the angular velocity
//   omega = p t_2 - q t_1 + r n,   p = -n . df_u / |f_u|,   q = -(n . df_v + a p) / b,   r = t_2 . df_u / |f_u|
#pragma once

#include <Eigen/Geometry>
#include <algorithm>

#include "solver/forces/stencil_force.h"

namespace drape::internal {

struct TriangleFrame {
  Mat3 axes;       // columns t_1, t_2, n; meaningless where the triangle is flat as a line
  double l, a, b;  // |f_u|, and the parts of f_v
  bool stands;     // whether there are axes

  explicit TriangleFrame(const Slopes& f) {
    const Vec3 n = f.col(0).cross(f.col(1));
    l = f.col(0).norm();
    const double size = n.norm();
    stands = l > 0 && size > 1e-12 * l * f.col(1).norm();
    if (!stands) return;
    axes.col(0) = f.col(0) / l;
    axes.col(2) = n / size;
    axes.col(1) = axes.col(2).cross(axes.col(0));
    a = axes.col(0).dot(f.col(1));
    b = axes.col(1).dot(f.col(1));
  }

  // The gradient over f of the angle by which the axes turn, times the torque: df . gradient = omega .
  // torque.
  Slopes turn(const Vec3& torque) const {
    const Vec3 of = axes.transpose() * torque;
    // A triangle that is squeezed to a line turns ever faster; it is kept from turning without bound.
    const double along = std::max(l, 0.01), across = std::max(b, 0.01);
    Slopes gradient;
    gradient.col(0) = ((-of[1] - of[0] * a / across) * axes.col(2) + of[2] * axes.col(1)) / along;
    gradient.col(1) = of[0] / across * axes.col(2);
    return gradient;
  }
};

}  // namespace drape::internal
