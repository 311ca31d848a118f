#include "solver/forces/hinge.h"

#include <algorithm>
#include <cmath>

#include "solver/forces/plate_slopes.h"
#include "solver/forces/stencil_force.h"

namespace drape::internal {

namespace {

constexpr double pi = 3.14159265358979323846;

// The particles are the ends a and b of the edge, and the corners c and d across from it.
struct HingeLaw {
  static constexpr const char* name = "bend";
  static constexpr int particles = 4;
  struct Rest {
    double k, angle;  // N m; theta_0
    // m^4. A triangle whose squared double area is less than this is taken to have this one, so that the
    // force stays bounded; it is then no longer the slope of the energy.
    double least_c, least_d;
  };
  struct Common {
    double time;  // s
  };

  struct Angle {
    Vec3 e, n_c, n_d;  // the edge, and the normals: twice the areas

    explicit Angle(const Points<4>& X)
        : e(X.col(1) - X.col(0)), n_c(e.cross(X.col(2) - X.col(0))), n_d((X.col(3) - X.col(0)).cross(e)) {}

    // From -pi to pi; 0 where the triangles are in one plane.
    double value() const { return std::atan2(n_d.cross(n_c).dot(e.normalized()), n_c.dot(n_d)); }

    Points<4> slope(const Rest& rest, const Points<4>& X) const {
      const double l = e.norm();
      if (!(l > 0)) return Points<4>::Zero();
      const Vec3 up_c = n_c / (l * std::max(n_c.squaredNorm(), rest.least_c)),
                 up_d = n_d / (l * std::max(n_d.squaredNorm(), rest.least_d));
      const auto along = [&](int corner, int end) { return (X.col(corner) - X.col(end)).dot(e); };
      Points<4> slope;
      slope << along(2, 1) * up_c + along(3, 1) * up_d, -along(2, 0) * up_c - along(3, 0) * up_d,
          l * l * up_c, l * l * up_d;
      return slope;
    }
  };

  static double difference(const Rest& rest, const Angle& angle) {
    return std::remainder(angle.value() - rest.angle, 2 * pi);
  }
  static double energy(const Common&, const Rest& rest, const Points<4>& X) {
    const double d = difference(rest, Angle(X));
    return 0.5 * rest.k * d * d;
  }
  static Points<4> gradient(const Common&, const Rest& rest, const Points<4>& X) {
    const Angle angle(X);
    return rest.k * difference(rest, angle) * angle.slope(rest, X);
  }
  // Without the part d theta'', which is not positive semidefinite.
  static Blocks<4> hessian(const Common&, const Rest& rest, const Points<4>& X, Stiffness) {
    const Points<4> slope = std::sqrt(rest.k) * Angle(X).slope(rest, X);
    const Eigen::Map<const Eigen::Matrix<double, 12, 1>> u(slope.data());
    return u * u.transpose();  // symmetric to the last bit
  }
  static Blocks<4> damping(const Common& common, const Rest& rest, const Points<4>& X) {
    return common.time * hessian(common, rest, X, Stiffness::tangent);
  }
  static bool damped(const Common& common) { return common.time > 0; }
};

double area(const RestCorners& corners) { return slopes_of(corners).area; }

// B_n of an edge, in one of its triangles.
double across(const PlateSlopes& slopes, int t, const Hinge& hinge, const PlateStiffness& D) {
  const Eigen::Vector2d e = (slopes.at_rest(t, hinge.b) - slopes.at_rest(t, hinge.a)).normalized();
  const double u = e.y() * e.y(), v = e.x() * e.x();  // squares of the parts of the normal
  return D.warp * u * u + D.weft * v * v + (2 * D.cross + 4 * D.twist) * u * v;
}

// Calls f(hinge, k, area of the triangle of c, area of that of d).
template <class F>
void each_hinge(const PlateSlopes& slopes, const std::vector<RestCorners>& corners, const PlateStiffness& D,
                const F& f) {
  for (const Hinge& hinge : slopes.hinges()) {
    const double B = 0.5 * (across(slopes, hinge.tc, hinge, D) + across(slopes, hinge.td, hinge, D)),
                 l = (slopes.at_rest(hinge.tc, hinge.b) - slopes.at_rest(hinge.tc, hinge.a)).norm(),
                 area_c = area(corners[static_cast<std::size_t>(hinge.tc)]),
                 area_d = area(corners[static_cast<std::size_t>(hinge.td)]);
    f(hinge, B * l * l / (area_c + area_d), area_c, area_d);
  }
}

}  // namespace

std::unique_ptr<Force> hinge_force(const TriangleMesh& mesh, const std::vector<RestCorners>& corners,
                                   const PlateStiffness& stiffness, double rest_angle, double time,
                                   int first) {
  const PlateSlopes slopes(mesh, corners);
  std::vector<StencilForce<HingeLaw>::Element> all;
  each_hinge(slopes, corners, stiffness, [&](const Hinge& hinge, double k, double area_c, double area_d) {
    Points<4> at;
    const std::array<int, 4> vertices = {hinge.a, hinge.b, hinge.c, hinge.d};
    for (int v = 0; v < 4; ++v)
      at.col(v) = mesh.positions[static_cast<std::size_t>(vertices[static_cast<std::size_t>(v)])];
    const auto least = [](double area) { return 4e-4 * area * area; };  // a hundredth of the area
    const double angle = rest_angle > 0 ? rest_angle * HingeLaw::Angle(at).value() : 0;
    all.push_back({.particles = {first + hinge.a, first + hinge.b, first + hinge.c, first + hinge.d},
                   .rest = {.k = k, .angle = angle, .least_c = least(area_c), .least_d = least(area_d)}});
  });
  return std::make_unique<StencilForce<HingeLaw>>(std::move(all), HingeLaw::Common{time});
}

PlateEnergy quadratic_hinges(const TriangleMesh& mesh, const std::vector<RestCorners>& corners,
                             const PlateStiffness& stiffness) {
  const PlateSlopes slopes(mesh, corners);
  PlateEnergy energy;
  each_hinge(slopes, corners, stiffness, [&](const Hinge& hinge, double k, double, double) {
    Functional s;
    for (int t : {hinge.tc, hinge.td}) slopes.add_inward(t, hinge, 1, s);
    PlatePart& part = energy.parts.emplace_back();
    part.stiffness(0, 0) = k;
    for (std::size_t i = 0; i < s.vertices.size(); ++i)
      part.shares.push_back({s.vertices[i], {s.weights[i], 0, 0}});
    for (std::size_t i = 0; i < s.vertices.size(); ++i)
      for (std::size_t j = i + 1; j < s.vertices.size(); ++j) {
        const auto [low, high] = std::minmax(s.vertices[i], s.vertices[j]);
        energy.pairs.push_back({low, high, -k * s.weights[i] * s.weights[j]});
      }
  });
  energy.pairs = summed(std::move(energy.pairs));
  measure_pairs(mesh, energy);
  return energy;
}

}  // namespace drape::internal
