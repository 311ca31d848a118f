// Shapes for the laws of distances: meshes, points of their surfaces, and whether a point is inside by
// another way than the distance.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <ostream>
#include <random>
#include <vector>

#include "constraints/shape.h"
#include "mesh/distance/surface_distance.h"

namespace drape::test {

using std::numbers::pi;

struct Random {
  std::mt19937 engine{7};
  double operator()(double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(engine()) / 4294967296.0);
  }
  Vec3 point(double half) { return {(*this)(-half, half), (*this)(-half, half), (*this)(-half, half)}; }
  Vec3 direction() {
    const double z = (*this)(-1, 1), a = (*this)(0, 2 * pi), r = std::sqrt(1 - z * z);
    return {r * std::cos(a), r * std::sin(a), z};
  }
  int below(int n) { return static_cast<int>(engine() % static_cast<unsigned>(n)); }
};

TriangleMesh lat_long_sphere(int rings, int sectors, double radius, const Vec3& centre);

TriangleMesh box_mesh(const Vec3& size);

TriangleMesh open_sheet();

MeshBody body(const TriangleMesh& m);

Mat3 some_rotation();

// A shape, points of its surface by parametrisation, and whether a point is inside
// by another way than the distance.
struct Case {
  Shape shape;
  std::function<Vec3(Random&)> on_surface;
  std::function<bool(const Vec3&)> inside;
};

Vec3 on_mesh(const TriangleMesh& m, Random& r);

// Number of times the surface winds about x, from the solid angles of its triangles
// [van Oosterom & Strackee 1983].
double winding(const TriangleMesh& m, const Vec3& x);

std::vector<Case> cases();

// What first_hit says of many paths: it must lie on the margin, and nothing be nearer before it, or ever
// where it says nothing.
struct HitLaw {
  int hits = 0, early = 0, missed = 0;
  double off = 0;  // m

  void path(const Shape& shape, const Vec3& x0, const Vec3& x1, double margin);
  bool holds(int least_hits) const { return hits > least_hits && off < 1e-7 && early == 0 && missed == 0; }
};

inline std::ostream& operator<<(std::ostream& out, const HitLaw& law) {
  return out << law.hits << " hits, up to " << law.off << " m off the margin; nearer before a hit "
             << law.early << " times, without one " << law.missed << " times";
}

inline constexpr double step = 1e-6;

// Whether the normal turns abruptly within `step` of x.
bool near_medial_axis(const Shape& shape, const Vec3& x);

}  // namespace drape::test
