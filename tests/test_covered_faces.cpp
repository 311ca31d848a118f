// A closed surface that overlaps itself: the distance is that to the surface of all of its parts together.
// The oracle cuts away from every triangle of a part what lies in the others, which are convex.
#include <algorithm>
#include <catch2/catch.hpp>

#include "mesh/distance/closest_on_triangle.h"
#include "mesh/triangles/generate.h"
#include "tests/shapes.h"
#include "tests/together.h"

using namespace drape;
using namespace drape::test;

namespace {

using Polygon = std::vector<Vec3>;

// The part of a convex polygon on one side of a plane.
Polygon cut(const Polygon& polygon, const Vec3& normal, double offset) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = normal.dot(a) - offset, at_b = normal.dot(b) - offset;
    if (at_a >= 0) kept.push_back(a);
    if ((at_a < 0) != (at_b < 0)) kept.push_back(a + at_a / (at_a - at_b) * (b - a));
  }
  return kept;
}

// What of the polygons lies outside of a convex part.
std::vector<Polygon> outside(const std::vector<Polygon>& polygons, const TriangleMesh& part) {
  std::vector<Polygon> found;
  for (const Polygon& polygon : polygons) {
    Polygon rest = polygon;
    for (const Triangle& t : part.triangles) {
      const Vec3 &a = part.positions[t[0]], &b = part.positions[t[1]], &c = part.positions[t[2]];
      const Vec3 normal = (b - a).cross(c - a).normalized();
      if (const Polygon out = cut(rest, normal, normal.dot(a)); out.size() > 2) found.push_back(out);
      rest = cut(rest, -normal, -normal.dot(a));
      if (rest.size() < 3) break;
    }
  }
  return found;
}

double distance_to(const std::vector<Polygon>& polygons, const Vec3& x) {
  double best = 1e300;
  for (const Polygon& p : polygons)
    for (std::size_t k = 1; k + 1 < p.size(); ++k)
      best = std::min(best, (x - closest_on_triangle(x, p[0], p[k], p[k + 1]).first).norm());
  return best;
}

struct Overlap {
  std::vector<TriangleMesh> parts;

  TriangleMesh mesh() const { return together(parts); }
  std::vector<Polygon> exposed() const {
    std::vector<Polygon> all;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      std::vector<Polygon> own;
      for (const Triangle& t : parts[k].triangles)
        own.push_back({parts[k].positions[t[0]], parts[k].positions[t[1]], parts[k].positions[t[2]]});
      for (std::size_t other = 0; other < parts.size(); ++other)
        if (other != k) own = outside(own, parts[other]);
      all.insert(all.end(), own.begin(), own.end());
    }
    return all;
  }
  double sign(const Vec3& x) const {
    return std::any_of(parts.begin(), parts.end(), [&](const auto& part) { return winding(part, x) > 0.5; })
               ? -1
               : 1;
  }
};

TriangleMesh placed(TriangleMesh mesh, const Vec3& at, Random& r) {
  const Mat3 turn = Eigen::AngleAxisd(r(0, 3), r.direction()).toRotationMatrix();
  for (Vec3& x : mesh.positions) x = turn * x + at;
  return mesh;
}

TriangleMesh part(int kind, int level, double size) {
  if (kind == 0) return box_mesh(size * Vec3(1, 1.3, 0.8));
  return kind == 1 ? sphere(level, 0.6 * size)
                   : lat_long_sphere(4 << level, 5 << level, 0.6 * size, Vec3::Zero());
}

// Two convex parts that overlap each other, and one that lies in the first; of three kinds, of growing
// fineness.
Overlap overlap(int kind, int level) {
  Random r;
  return {{placed(part(kind, level, 1), {0, 0, 0}, r), placed(part(kind, level, 0.7), {0.6, 0.1, 0.05}, r),
           placed(part(kind, level, 0.2), {-0.15, -0.1, 0.02}, r)}};
}

Vec3 somewhere(const TriangleMesh& mesh, Random& r, int i) {
  return i % 3 ? Vec3(Vec3(0.3, 0.1, 0) + r.point(0.7)) : Vec3(on_mesh(mesh, r) + r.point(0.02));
}

double longest_edge(const TriangleMesh& mesh) {
  double longest = 0;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, (mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]).norm());
  return longest;
}

}  // namespace

TEST_CASE("a body that overlaps itself is as deep as all of its parts together", "[shapes][mesh]") {
  for (int kind : {0, 1, 2})
    for (int level : {1, 2, 3}) {
      if (kind == 0 && level > 1) continue;
      INFO("kind " << kind << ", level " << level);
      const Overlap body = overlap(kind, level);
      const TriangleMesh mesh = body.mesh();
      const SurfaceDistance surface(mesh);
      const std::vector<Polygon> exposed = body.exposed();
      REQUIRE(surface.closed());
      Random r;
      double worst = 0, astray = 0;
      int inside = 0;
      for (int i = 0; i < (level == 3 ? 400 : 1500); ++i) {
        const Vec3 x = somewhere(mesh, r, i);
        const SurfacePoint found = surface.closest(x);
        const double sign = body.sign(x);
        worst = std::max(worst, std::abs(found.distance - sign * distance_to(exposed, x)));
        astray = std::max(astray, distance_to(exposed, x - found.distance * found.normal));
        inside += sign < 0;
      }
      CHECK(worst < 1e-9);
      CHECK(astray < 1e-9);  // the normal leads to the surface
      CHECK(inside > 100);
    }
}

TEST_CASE("where three parts overlap, the side is right, and the depth to within an edge", "[shapes][mesh]") {
  for (int kind : {1, 2})
    for (int level : {2, 3}) {
      INFO("kind " << kind << ", level " << level);
      Random placing;
      Overlap body = overlap(kind, level);
      body.parts.push_back(placed(part(kind, level, 0.6), {0.3, 0.45, -0.1}, placing));
      const TriangleMesh mesh = body.mesh();
      const SurfaceDistance surface(mesh);
      const std::vector<Polygon> exposed = body.exposed();
      Random r;
      double worst = 0;
      int wrong = 0;
      for (int i = 0; i < (level == 3 ? 400 : 1500); ++i) {
        const Vec3 x = somewhere(mesh, r, i);
        const double distance = surface.closest(x).distance, sign = body.sign(x);
        wrong += (distance < 0) != (sign < 0);
        worst = std::max(worst, std::abs(distance - sign * distance_to(exposed, x)));
      }
      CHECK(wrong == 0);
      CHECK(worst < longest_edge(mesh));
    }
}

TEST_CASE("a tube that is bent into itself is one body", "[shapes][mesh]") {
  // All that is within a of a line that goes once round a circle of radius b, and on, by 0.6 rad, half of a
  // beside itself.
  const double a = 0.2, b = 0.6, turn = 2 * pi + 0.6, beside = 0.5 * a / (2 * pi);
  const auto line = [&](double t) { return Vec3(b * std::cos(t), beside * t, b * std::sin(t)); };
  for (int n : {12, 24, 48}) {
    INFO(n << " vertices around");
    const int along = 5 * n, cap = n / 2;
    TriangleMesh mesh;
    mesh.positions.push_back(line(0) - a * Vec3(0, 0, 1));
    for (int i = 0; i <= along + 2 * cap - 2; ++i) {  // a half of a ball at each end
      const double before = std::min(0.0, (i - cap + 1) * 0.5 * pi / cap);
      const double after = std::max(0.0, (i - cap + 1 - along) * 0.5 * pi / cap), round = before + after;
      const double t = turn * std::clamp(i - cap + 1, 0, along) / along, radius = a * std::cos(round);
      const Vec3 out(std::cos(t), 0, std::sin(t)), on(-std::sin(t), 0, std::cos(t));
      for (int j = 0; j < n; ++j) {
        const double v = 2 * pi * j / n;
        mesh.positions.push_back(line(t) + a * std::sin(round) * on +
                                 radius * (std::cos(v) * out + std::sin(v) * Vec3::UnitY()));
      }
    }
    const int rings = (mesh.vertex_count() - 1) / n, last = mesh.vertex_count();
    mesh.positions.push_back(line(turn) + a * Vec3(-std::sin(turn), 0, std::cos(turn)));
    for (int j = 0; j < n; ++j) {
      const auto at = [&](int i, int k) { return 1 + i * n + k % n; };
      mesh.triangles.push_back({0, at(0, j), at(0, j + 1)});
      mesh.triangles.push_back({last, at(rings - 1, j + 1), at(rings - 1, j)});
      for (int i = 0; i + 1 < rings; ++i) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
    const SurfaceDistance surface(mesh);
    REQUIRE(surface.closed());
    Random r;
    const double chords =
        12.0 / (n * n) * a + 0.01 * a;  // the line is not quite at right angles to its discs
    double off = 0, least = 1;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 x = Vec3(b, 0, 0) + r.point(0.4);
      double to_line = 1e300;
      for (double t = 0; t <= turn; t += 0.002) to_line = std::min(to_line, (x - line(t)).norm());
      const double distance = surface.closest(x).distance;
      if (to_line > a)
        off = std::max(off, std::abs(distance - (to_line - a)));
      else  // a ball of this size about x is inside
        least = std::min(least, -distance - (a - to_line));
    }
    CHECK(off < chords);
    CHECK(least > -chords);
  }
}

namespace {

// A limb of radius 0.2 m whose axis turns by `angle` about a line 0.16 m above it, so that it is folded
// through itself in the crook: the line along which it meets itself ends at vertices of the fold.
TriangleMesh bent_limb(int n, double angle) {
  const double radius = 0.2, pivot = 0.16, bend = 0.15,
               arm = 0.6;  // m; the axis turns from x = -bend to bend
  TriangleMesh mesh;
  const int rings = 6 * n + 1;
  for (int i = 0; i < rings; ++i) {
    const double s = arm * (2.0 * i / (rings - 1) - 1);
    const double turned = angle * std::clamp((s + bend) / (2 * bend), 0.0, 1.0);
    const Mat3 turn = Eigen::AngleAxisd(turned, Vec3::UnitZ()).toRotationMatrix();
    const Vec3 middle = s <= -bend
                            ? Vec3(s, 0, 0)
                            : Vec3(Vec3(-bend, pivot, 0) + turn * Vec3(std::max(s - bend, 0.0), -pivot, 0));
    for (int j = 0; j < n; ++j) {
      const double v = 2 * pi * j / n;
      mesh.positions.push_back(middle + turn * Vec3(0, -radius * std::cos(v), radius * std::sin(v)));
    }
  }
  const int first = mesh.vertex_count(), last = first + 1;
  for (const int ring : {0, rings - 1}) {
    Vec3 sum = Vec3::Zero();
    for (int j = 0; j < n; ++j) sum += mesh.positions[ring * n + j];
    mesh.positions.push_back(sum / n);
  }
  for (int j = 0; j < n; ++j) {
    const auto at = [&](int i, int k) { return i * n + k % n; };
    mesh.triangles.push_back({first, at(0, j), at(0, j + 1)});
    mesh.triangles.push_back({last, at(rings - 1, j + 1), at(rings - 1, j)});
    for (int i = 0; i + 1 < rings; ++i) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("a limb that is folded through itself in its crook is one body", "[shapes][mesh]") {
  Random r;
  int wrong = 0, inside = 0, asked = 0;
  for (const int n : {10, 14, 20, 28})
    for (const double angle : {1.2, 2.0, 2.6, 2.9}) {
      TriangleMesh mesh = bent_limb(n, angle);
      for (Vec3& x : mesh.positions) x += r.point(0.06 / n);  // no two folds are alike
      const SurfaceDistance surface(mesh);
      REQUIRE(surface.closed());
      for (int i = 0; i < 1500; ++i) {
        const Vec3 x = Vec3(-0.05, 0.15, 0) + r.point(0.3);
        const bool is_inside = winding(mesh, x) > 0.5;
        ++asked;
        inside += is_inside;
        wrong += is_inside != (surface.closest(x).distance < 0);
      }
    }
  // Where a fold ends between triangles that have a vertex in common, single points may be on the wrong side.
  CAPTURE(wrong, inside, asked);
  CHECK(1000 * wrong < asked);
  CHECK(3 * inside > asked);
}

TEST_CASE("a body that comes to overlap itself in a step is looked at as it is at the end",
          "[shapes][mesh]") {
  Overlap body = overlap(1, 3);
  const std::vector<Vec3> end = body.mesh().positions;
  for (Vec3& x : body.parts[1].positions) x += Vec3(0.8, 0, 0);
  const TriangleMesh apart = body.mesh();
  SurfaceDistance surface(apart);
  surface.move(apart.positions, end);
  TriangleMesh together = apart;
  together.positions = end;
  const SurfaceDistance anew(together);
  Random r;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 x = somewhere(together, r, i);
    const SurfacePoint found = surface.closest(x, 1), expected = anew.closest(x);
    CHECK(std::abs(found.distance - expected.distance) < 1e-12);
    CHECK((found.normal - expected.normal).norm() < 1e-6);
  }
  // And when it has come apart again, nothing is covered.
  surface.move(end, apart.positions);
  const SurfaceDistance before(apart);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 x = somewhere(apart, r, i);
    CHECK(std::abs(surface.closest(x, 1).distance - before.closest(x).distance) < 1e-12);
  }
}

TEST_CASE("what is inside a body does not meet the parts of its surface that are inside, too",
          "[shapes][hit]") {
  const Overlap body = overlap(1, 3);
  const TriangleMesh mesh = body.mesh();
  SurfaceDistance surface(mesh);
  surface.move(mesh.positions, mesh.positions);
  CHECK_FALSE(
      surface.first_crossing({0.1, 0.1, 0.05}, {0.35, 0.1, 0.05}));  // within the first part, into the second
  const auto outer = surface.first_crossing({1.5, 0.1, 0.05}, {0.3, 0.1, 0.05});
  REQUIRE(outer);
  CHECK(std::abs(1.5 - 1.2 * *outer - 1.02) < 0.01);
}
