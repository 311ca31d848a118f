// The membrane of a woven fabric: triangles of constant strain.                    [Baraff & Witkin 1998, 4.2]
// A point of the rest shape has the coordinate u along the warp and v along the weft [m]. The triangle maps
// both axes into space, to f_u = dx/du and f_v = dx/dv, which are linear in its three corners. The strains are
//   e_u = |f_u| - 1,   e_v = |f_v| - 1,   gamma = f_u . f_v        (sine of the shear angle, at small strain)
// and the energy per area is
//   psi = s W(e) + (1 - s) R(e) + G gamma^2 / 2,     W(e) = e . C e / 2,    R(e) = min over w >= 0 of W(e + w)
//   C = ((Y_u, nu sqrt(Y_u Y_v)), (nu sqrt(Y_u Y_v), Y_v)) / (1 - nu^2)
// Y_u, Y_v [N/m] are the stiffnesses of warp and weft in a tensile test, nu the geometric mean of their two
// Poisson's ratios, G [N/m] the shear stiffness. The share s says how much of the resistance to compression
// stays: R is a fabric whose threads wrinkle below the size of the triangle, w being what the wrinkles take up.
// Both W and R are convex, and psi has a continuous gradient.
//
// With the stresses sigma = dpsi/de, tau = G gamma and the tangent k = d sigma/de, the Hessian over (f_u, f_v) is
//   k_ab n_a n_b^T + G (f_v, f_u)(f_v, f_u)^T      the material: positive semidefinite as it stands
//   sigma_u/|f_u| (I - n_u n_u^T), the same of v, and tau between f_u and f_v: the geometry
// The geometry is made positive semidefinite in closed form: out of the plane of the triangle it is the matrix
// ((sigma_u/|f_u|, tau), (tau, sigma_v/|f_v|)), which has two eigenvalues; in the plane each term is taken
// alone. So the stiffness is exact where a taut membrane resists a push from the side, and never too small.
// The viscosity is that of the strains: D = T_s k n n^T + T_g G (f_v, f_u)(f_v, f_u)^T with times T [s].
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "solver/forces/stencil_force.h"

namespace drape {

struct Membrane {
  static constexpr const char* name = "membrane";
  static constexpr int particles = 3;

  struct Rest {
    Eigen::Matrix<double, 3, 2> weights;  // f_u and f_v are the sums of weight times corner [1/m]
    double area;                          // m^2
  };
  struct Common {
    double warp, weft, cross;         // Y_u, Y_v and nu sqrt(Y_u Y_v) [N/m]
    double uu, uv, vv;                // C [N/m]
    double shear;                     // G [N/m]
    double compression;               // s, from 0 to 1
    double stretch_time, shear_time;  // T_s, T_g [s]
  };

  // The stresses [N/m], and how they grow with the strains [N/m].
  struct Response {
    double u, v;
    double uu, uv, vv;
  };
  static Response stress(const Common& c, double e_u, double e_v) {
    const Response all{c.uu * e_u + c.uv * e_v, c.uv * e_u + c.vv * e_v, c.uu, c.uv, c.vv};
    if (c.compression == 1 || (all.u >= 0 && all.v >= 0)) return all;
    Response taut{0, 0, 0, 0, 0};  // of R: a thread that would push has wrinkled instead
    if (all.u < 0 && e_v > 0)
      taut = {0, c.weft * e_v, 0, 0, c.weft};
    else if (all.v < 0 && e_u > 0)
      taut = {c.warp * e_u, 0, c.warp, 0, 0};
    const double s = c.compression, r = 1 - s;
    return {s * all.u + r * taut.u, s * all.v + r * taut.v, s * all.uu + r * taut.uu, s * all.uv,
            s * all.vv + r * taut.vv};
  }

  static double energy(const Common& c, const Rest& r, const Points<3>& X) {
    const Eigen::Matrix<double, 3, 2> f = X * r.weights;
    const double e_u = f.col(0).norm() - 1, e_v = f.col(1).norm() - 1, gamma = f.col(0).dot(f.col(1));
    const Response stretch = stress(c, e_u, e_v);  // homogeneous of degree 1 in the strains
    return 0.5 * r.area * (stretch.u * e_u + stretch.v * e_v + c.shear * gamma * gamma);
  }

  static Points<3> gradient(const Common& c, const Rest& r, const Points<3>& X) {
    const Eigen::Matrix<double, 3, 2> f = X * r.weights;
    const double l_u = f.col(0).norm(), l_v = f.col(1).norm();
    const double tau = c.shear * f.col(0).dot(f.col(1));
    const Response stretch = stress(c, l_u - 1, l_v - 1);
    Eigen::Matrix<double, 3, 2> pull;
    pull.col(0) = per_length(stretch.u, l_u) * f.col(0) + tau * f.col(1);
    pull.col(1) = per_length(stretch.v, l_v) * f.col(1) + tau * f.col(0);
    return r.area * pull * r.weights.transpose();
  }

  static Blocks<3> hessian(const Common& c, const Rest& r, const Points<3>& X, Stiffness stiffness) {
    const Eigen::Matrix<double, 3, 2> f = X * r.weights;
    const double l_u = f.col(0).norm(), l_v = f.col(1).norm();
    const double tau = c.shear * f.col(0).dot(f.col(1));
    const Response stretch = stress(c, l_u - 1, l_v - 1);
    Common whole = c;
    if (stiffness == Stiffness::majorant) whole.compression = 1;
    Second h = material(whole, f, l_u, l_v, 1, 1);
    const double a = per_length(stretch.u, l_u), b = per_length(stretch.v, l_v);
    const Vec3 n_u = l_u > 0 ? Vec3(f.col(0) / l_u) : Vec3::Zero(),
               n_v = l_v > 0 ? Vec3(f.col(1) / l_v) : Vec3::Zero();
    Vec3 normal = f.col(0).cross(f.col(1));
    if (!normal.isZero(0))
      normal.normalize();
    else if (l_u > 0)
      normal = n_u.unitOrthogonal();  // collapsed onto a line
    else if (l_v > 0)
      normal = n_v.unitOrthogonal();
    const Mat3 across = normal * normal.transpose();
    // ((a, tau), (tau, b)) without its negative part: its eigenvalues are middle +- radius.
    const double middle = 0.5 * (a + b), radius = std::hypot(0.5 * (a - b), tau);
    const double high = std::max(middle + radius, 0.0), low = std::max(middle - radius, 0.0);
    const double mean = 0.5 * (high + low), half = radius > 0 ? 0.5 * (high - low) / radius : 0;
    const Mat3 in_plane = Mat3::Identity() - across;
    const Vec3 t_u = normal.cross(n_u), t_v = normal.cross(n_v);
    h.uu += (mean + half * 0.5 * (a - b)) * across + 0.5 * std::abs(tau) * in_plane +
            std::max(a, 0.0) * t_u * t_u.transpose();
    h.vv += (mean - half * 0.5 * (a - b)) * across + 0.5 * std::abs(tau) * in_plane +
            std::max(b, 0.0) * t_v * t_v.transpose();
    h.uv += half * tau * across + 0.5 * tau * in_plane;
    return of_corners(h, r);
  }

  static bool damped(const Common& c) { return c.stretch_time > 0 || c.shear_time > 0; }
  static Blocks<3> damping(const Common& c, const Rest& r, const Points<3>& X) {
    const Eigen::Matrix<double, 3, 2> f = X * r.weights;
    return of_corners(material(c, f, f.col(0).norm(), f.col(1).norm(), c.stretch_time, c.shear_time), r);
  }

 private:
  struct Second {
    Mat3 uu, uv, vv;  // the second derivatives over f_u and f_v
  };

  static double per_length(double stress, double length) { return length > 0 ? stress / length : 0; }

  // times_k k_ab n_a n_b^T + times_g G (f_v, f_u)(f_v, f_u)^T
  static Second material(const Common& c, const Eigen::Matrix<double, 3, 2>& f, double l_u, double l_v,
                         double times_k, double times_g) {
    const Response k = stress(c, l_u - 1, l_v - 1);
    const Vec3 n_u = l_u > 0 ? Vec3(f.col(0) / l_u) : Vec3::Zero(),
               n_v = l_v > 0 ? Vec3(f.col(1) / l_v) : Vec3::Zero();
    const double g = times_g * c.shear;
    return {times_k * k.uu * n_u * n_u.transpose() + g * f.col(1) * f.col(1).transpose(),
            times_k * k.uv * n_u * n_v.transpose() + g * f.col(1) * f.col(0).transpose(),
            times_k * k.vv * n_v * n_v.transpose() + g * f.col(0) * f.col(0).transpose()};
  }

  static Blocks<3> of_corners(const Second& h, const Rest& r) {
    Blocks<3> blocks;
    for (int k = 0; k < 3; ++k)
      for (int l = k; l < 3; ++l) {
        const double ku = r.weights(k, 0), kv = r.weights(k, 1), lu = r.weights(l, 0), lv = r.weights(l, 1);
        const Mat3 block =
            r.area * (ku * lu * h.uu + kv * lv * h.vv + ku * lv * h.uv + kv * lu * h.uv.transpose());
        blocks.block<3, 3>(3 * k, 3 * l) = block;
        if (l > k) blocks.block<3, 3>(3 * l, 3 * k) = block.transpose();
      }
    return blocks;
  }
};

}  // namespace drape
