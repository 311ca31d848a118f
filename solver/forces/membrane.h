// The membrane of a woven fabric: triangles of constant strain.                    [Baraff & Witkin 1998, 4.2]
// A point of the rest shape has the coordinate u along the warp and v along the weft [m]. The triangle maps
// both axes into space, to f_u = dx/du and f_v = dx/dv, which are linear in its three corners. The strains
// are
//   e_u = |f_u| - 1,   e_v = |f_v| - 1,   gamma = f_u . f_v        (sine of the shear angle, at small strain)
// and the energy per area is
//   psi = s W(e) + (1 - s) R(e) + G gamma^2 / 2,     W(e) = e . C e / 2,    R(e) = min over w >= 0 of W(e + w)
//   C = ((Y_u, nu sqrt(Y_u Y_v)), (nu sqrt(Y_u Y_v), Y_v)) / (1 - nu^2)
// Y_u, Y_v [N/m] are the stiffnesses of warp and weft in a tensile test, nu the geometric mean of their two
// Poisson's ratios, G [N/m] the shear stiffness. The share s says how much of the resistance to compression
// stays: R is a fabric whose threads wrinkle below the size of the triangle, w being what the wrinkles take
// up. Both W and R are convex, and psi has a continuous gradient.
//
// With the stresses sigma = dpsi/de, tau = G gamma and the tangent k = d sigma/de, the Hessian over (f_u,
// f_v) is
//   k_ab n_a n_b^T + G (f_v, f_u)(f_v, f_u)^T      the material: positive semidefinite as it stands
//   sigma_u/|f_u| (I - n_u n_u^T), the same of v, and tau between f_u and f_v: the geometry
// The geometry is made positive semidefinite in closed form: out of the plane of the triangle it is the
// matrix ((sigma_u/|f_u|, tau), (tau, sigma_v/|f_v|)), which has two eigenvalues; in the plane each term is
// taken alone. So the stiffness is exact where a taut membrane resists a push from the side, and never too
// small. The viscosity is that of the strains: D = T_s k n n^T + T_g G (f_v, f_u)(f_v, f_u)^T with times T
// [s].
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "solver/forces/fabric.h"
#include "solver/forces/rest_corners.h"
#include "solver/forces/stencil_force.h"

namespace drape {

struct Membrane {
  static constexpr const char* name = "membrane";
  static constexpr int particles = 3;

  using Rest = RestSlopes;  // f_u and f_v are the sums of weight times corner
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

  static const Eigen::Matrix<double, 3, 2>& slope_weights(const Rest& r) { return r.weights; }

  static double energy(const Common& c, const Rest& r, const Slopes& f) {
    const double e_u = f.col(0).norm() - 1, e_v = f.col(1).norm() - 1, gamma = f.col(0).dot(f.col(1));
    const Response stretch = stress(c, e_u, e_v);  // homogeneous of degree 1 in the strains
    return 0.5 * r.area * (stretch.u * e_u + stretch.v * e_v + c.shear * gamma * gamma);
  }

  static Slopes gradient(const Common& c, const Rest& r, const Slopes& f) {
    const double l_u = f.col(0).norm(), l_v = f.col(1).norm();
    const double tau = c.shear * f.col(0).dot(f.col(1));
    const Response stretch = stress(c, l_u - 1, l_v - 1);
    Slopes pull;
    pull.col(0) = r.area * (per_length(stretch.u, l_u) * f.col(0) + tau * f.col(1));
    pull.col(1) = r.area * (per_length(stretch.v, l_v) * f.col(1) + tau * f.col(0));
    return pull;
  }

  static SlopeBlocks hessian(const Common& c, const Rest& r, const Slopes& f, Stiffness stiffness) {
    const double l_u = f.col(0).norm(), l_v = f.col(1).norm();
    const Vec3 n_u = direction(f.col(0), l_u), n_v = direction(f.col(1), l_v);
    const double tau = c.shear * f.col(0).dot(f.col(1));
    const Response now = stress(c, l_u - 1, l_v - 1);
    const Response k = stiffness == Stiffness::majorant ? whole(c) : now;
    SlopeBlocks h = material(k, c.shear, f, n_u, n_v);
    const double a = per_length(now.u, l_u), b = per_length(now.v, l_v);
    Vec3 normal = f.col(0).cross(f.col(1));
    if (!normal.isZero(0))
      normal.normalize();
    else if (l_u > 0)
      normal = n_u.unitOrthogonal();  // collapsed onto a line
    else if (l_v > 0)
      normal = n_v.unitOrthogonal();
    // ((a, tau), (tau, b)) without its negative part: its eigenvalues are middle +- radius.
    const double middle = 0.5 * (a + b), radius = std::sqrt(0.25 * (a - b) * (a - b) + tau * tau);
    const double high = std::max(middle + radius, 0.0), low = std::max(middle - radius, 0.0);
    const double mean = 0.5 * (high + low), half = radius > 0 ? 0.5 * (high - low) / radius : 0;
    const double off = 0.5 * half * (a - b), loose = 0.5 * std::abs(tau);
    const Vec3 t_u = normal.cross(n_u), t_v = normal.cross(n_v);
    // In the plane: loose (I - n n^T), which makes room for tau of either sign.
    h.uu += outer(mean + off - loose, normal, normal, loose) + outer(std::max(a, 0.0), t_u, t_u);
    h.vv += outer(mean - off - loose, normal, normal, loose) + outer(std::max(b, 0.0), t_v, t_v);
    h.uv += outer((half - 0.5) * tau, normal, normal, 0.5 * tau);
    return {r.area * h.uu, r.area * h.uv, r.area * h.vv};
  }

  static bool damped(const Common& c) { return c.stretch_time > 0 || c.shear_time > 0; }
  static SlopeBlocks damping(const Common& c, const Rest& r, const Slopes& f) {
    const double l_u = f.col(0).norm(), l_v = f.col(1).norm(), t = c.stretch_time;
    const Response k = stress(c, l_u - 1, l_v - 1);
    const SlopeBlocks d = material({0, 0, t * k.uu, t * k.uv, t * k.vv}, c.shear_time * c.shear, f,
                                   direction(f.col(0), l_u), direction(f.col(1), l_v));
    return {r.area * d.uu, r.area * d.uv, r.area * d.vv};
  }

 private:
  static double per_length(double stress, double length) { return length > 0 ? stress / length : 0; }
  static Vec3 direction(const Vec3& f, double length) {
    return length > 0 ? Vec3(f / length) : Vec3(Vec3::Zero());
  }
  // The tangent of the full law, whatever is wrinkled.
  static Response whole(const Common& c) { return {0, 0, c.uu, c.uv, c.vv}; }

  // factor p q^T + diagonal I
  static Mat3 outer(double factor, const Vec3& p, const Vec3& q, double diagonal = 0) {
    const double x = factor * q[0], y = factor * q[1], z = factor * q[2];
    Mat3 block;
    block << p[0] * x + diagonal, p[0] * y, p[0] * z, p[1] * x, p[1] * y + diagonal, p[1] * z, p[2] * x,
        p[2] * y, p[2] * z + diagonal;
    return block;
  }

  // k_ab n_a n_b^T + G (f_v, f_u)(f_v, f_u)^T
  static SlopeBlocks material(const Response& k, double G, const Slopes& f, const Vec3& n_u,
                              const Vec3& n_v) {
    return {outer(k.uu, n_u, n_u) + outer(G, f.col(1), f.col(1)),
            outer(k.uv, n_u, n_v) + outer(G, f.col(1), f.col(0)),
            outer(k.vv, n_v, n_v) + outer(G, f.col(0), f.col(0))};
  }
};

Membrane::Common membrane_of(const Fabric& fabric);  // of a fabric that check() takes

}  // namespace drape
