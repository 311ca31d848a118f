#include "solver/forces/air.h"

#include <algorithm>
#include <cmath>

#include "mesh/base/errors.h"
#include "mesh/obj/quad_grid.h"
#include "mesh/triangles/normals.h"
#include "mesh/triangles/topology.h"
#include "solver/forces/require.h"
#include "solver/forces/stencil_force.h"

namespace drape {
namespace {

struct AirLaw {
  static constexpr const char* name = "air";
  static constexpr int particles = 3;
  struct Rest {
    Vec3 normal = Vec3::Zero();  // of length 1, or 0 where the triangle has no area
    double area = 0;             // m^2, as far as this triangle counts
  };
  using Common = Air;

  // What the velocity of the middle of the triangle is against the air.
  struct Flow {
    Vec3 across;   // w_t [m/s]
    double along;  // w_n [m/s]
    double speed;  // |w_t| [m/s]
  };
  static Flow flow(const Air& air, const Rest& r, const Vec3& v) {
    const Vec3 w = v - air.wind;
    const double along = r.normal.dot(w);
    const Vec3 across = w - along * r.normal;
    return {across, along, across.norm()};
  }

  static constexpr std::array<double, 3> weights(const Rest&) { return {1.0 / 3, 1.0 / 3, 1.0 / 3}; }
  static double energy(const Air&, const Rest&, const Vec3&) { return 0; }
  static double dissipation(const Air& air, const Rest& r, const Vec3&, const auto& velocity) {
    const Flow w = flow(air, r, velocity());
    const double normal = std::abs(w.along) * w.along * w.along, skin = w.speed * w.speed * w.speed;
    return air.density * r.area / 6 * (air.drag * normal + air.skin_friction * skin);
  }
  static Vec3 pull(const Air& air, const Rest& r, const Vec3&, const auto& velocity) {
    const Flow w = flow(air, r, velocity());
    return 0.5 * air.density * r.area *
           (air.drag * std::abs(w.along) * w.along * r.normal + air.skin_friction * w.speed * w.across);
  }
  static VectorResponse linearised(const Air& air, const Rest& r, const Vec3& p, const auto& velocity,
                                   const auto&, double c, Stiffness) {
    const Flow w = flow(air, r, velocity());
    const Vec3 t = w.speed > 0 ? Vec3(w.across / w.speed) : Vec3(Vec3::Zero());
    const Mat3 along = r.normal * r.normal.transpose(), across = t * t.transpose();
    return {.impulse = c * pull(air, r, p, velocity),
            .block = c * air.density * r.area *
                     (air.drag * std::abs(w.along) * along +
                      0.5 * air.skin_friction * w.speed * (Mat3::Identity() - along + across)),
            .acts = true};
  }
};

class AirDrag final : public StencilForce<AirLaw> {
 public:
  // Of the area of each triangle `share` counts.
  AirDrag(const TriangleMesh& mesh, const std::vector<Triangle>& triangles, double share, const Air& air,
          int first)
      : StencilForce(elements_of(mesh, triangles, share, first), air), share_(share) {}

  bool begin_step(const StepStart& start) override {
    change_elements([&](Element& e) {
      const auto corner = [&](std::size_t k) {
        const int i = 3 * e.particles[k];
        return Vec3(start.x.segment<3>(i) + start.ahead * start.v.segment<3>(i));
      };
      e.rest = rest_of(corner(0), corner(1), corner(2), share_);
    });
    return false;
  }

  double given_power(const VecX&, const VecX& v) const override {
    return sum([&](const Element& e) {
      const Vec3 velocity = at(e, v);
      const Vec3 pull = AirLaw::pull(common(), e.rest, velocity, [&] { return velocity; });
      return std::max(0.0, -pull.dot(velocity));
    });
  }

 private:
  static std::vector<Element> elements_of(const TriangleMesh& mesh, const std::vector<Triangle>& triangles,
                                          double share, int first) {
    std::vector<Element> elements;
    for (const Triangle& v : triangles) {
      const auto corner = [&](std::size_t k) { return mesh.positions[static_cast<std::size_t>(v[k])]; };
      elements.push_back({.particles = {first + v[0], first + v[1], first + v[2]},
                          .rest = rest_of(corner(0), corner(1), corner(2), share)});
    }
    return elements;
  }
  static AirLaw::Rest rest_of(const Vec3& a, const Vec3& b, const Vec3& c, double share) {
    const Vec3 normal = twice_area_normal(a, b, c);
    const double twice = normal.norm();
    return twice > 0 ? AirLaw::Rest{normal / twice, 0.5 * share * twice} : AirLaw::Rest{};
  }

  double share_;
};

}  // namespace

void check(const Air& air) {
  require(air.density >= 0, "density", air.density, "kg/m^3", "a density is not negative");
  require(air.drag >= 0, "drag", air.drag, "", "a coefficient is not negative");
  require(air.skin_friction >= 0, "skin_friction", air.skin_friction, "", "a coefficient is not negative");
  if (!air.wind.allFinite()) throw InputError("wind: a velocity is finite");
}

std::unique_ptr<Force> air_drag(const TriangleMesh& mesh, const Air& air, int first) {
  check(air);
  std::vector<Triangle> triangles;
  for (int t : counted_triangles(mesh)) triangles.push_back(mesh.triangles[static_cast<std::size_t>(t)]);
  return std::make_unique<AirDrag>(mesh, triangles, 1, air, first);
}

std::unique_ptr<Force> air_drag_of_quads(const TriangleMesh& mesh, const Air& air, int first) {
  check(air);
  std::vector<Triangle> triangles;
  for (const auto& [a, b, c, d] : quad_grid(mesh).quads)
    triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}, {a, b, d}, {b, c, d}});
  return std::make_unique<AirDrag>(mesh, triangles, 0.5, air, first);
}

}  // namespace drape
