// Laws of the signed distances, over a list of shapes: gradient, eikonal equation, Lipschitz bound, sign,
// zero set, projection; mesh surfaces against a search of all triangles with the sign from solid angles;
// first_hit on thin and grazing cases.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <sstream>

#include "constraints/shape.h"
#include "mesh/obj.h"
#include "mesh/surface_distance.h"

using namespace drape;

namespace {

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

TriangleMesh lat_long_sphere(int rings, int sectors, double radius, const Vec3& centre) {
  TriangleMesh m;
  m.positions.push_back(centre + Vec3(0, 0, radius));
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double t = pi * i / rings, a = 2 * pi * j / sectors;
      const Vec3 d(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t));
      m.positions.push_back(centre + radius * d);
    }
  m.positions.push_back(centre - Vec3(0, 0, radius));
  const int last = m.vertex_count() - 1;
  for (int j = 0; j < sectors; ++j) {
    const auto at = [&](int i, int k) { return 1 + (i - 1) * sectors + k % sectors; };
    m.triangles.push_back({0, at(1, j), at(1, j + 1)});
    for (int i = 1; i + 1 < rings; ++i) {
      m.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    m.triangles.push_back({last, at(rings - 1, j + 1), at(rings - 1, j)});
  }
  return m;
}

TriangleMesh box_mesh(const Vec3& size) {
  TriangleMesh m;
  for (int i = 0; i < 8; ++i)
    m.positions.push_back(size.cwiseProduct(Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1) - Vec3::Constant(0.5)));
  const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    m.triangles.push_back({q[0], q[1], q[2]});
    m.triangles.push_back({q[0], q[2], q[3]});
  }
  return m;
}

TriangleMesh open_sheet() {
  TriangleMesh m;
  m.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
  m.triangles = {{0, 2, 1}, {0, 3, 2}};
  return m;
}

MeshBody body(const TriangleMesh& m) { return std::make_shared<const SurfaceDistance>(m); }

Mat3 some_rotation() { return Eigen::AngleAxisd(0.7, Vec3(1, 2, -0.5).normalized()).toRotationMatrix(); }

// A shape, points of its surface by parametrisation, and whether a point is inside by another way than the
// distance.
struct Case {
  Shape shape;
  std::function<Vec3(Random&)> on_surface;
  std::function<bool(const Vec3&)> inside;
};

Vec3 on_bowl(const Bowl& b, Random& r) {
  const Vec3 axis = b.axis.normalized(), e = axis.unitOrthogonal(), g = axis.cross(e);
  const double a = r(0, 2 * pi), t = r(-pi / 2, 0), half = b.thickness / 2, middle = b.radius + half;
  const Vec3 round = std::cos(a) * e + std::sin(a) * g;
  const Vec3 down = std::cos(t) * round + std::sin(t) * axis;
  const int part = r.below(3);
  if (part == 0) return b.centre + b.radius * down;
  if (part == 1) return b.centre + (b.radius + b.thickness) * down;
  const double p = r(0, pi);
  return b.centre + (middle + half * std::cos(p)) * round + half * std::sin(p) * axis;
}

Case bowl_case() {
  const Bowl b{{0.1, -0.2, 0.3}, 0.8, 0.3, {1, 2, 0.5}};
  return {b, [b](Random& r) { return on_bowl(b, r); },
          [b](const Vec3& x) {
            const Vec3 d = x - b.centre, n = b.axis.normalized();
            const double h = n.dot(d), rho = (d - h * n).norm(), half = b.thickness / 2;
            if (h > 0) return std::pow(rho - b.radius - half, 2) + h * h < half * half;
            return d.norm() > b.radius && d.norm() < b.radius + b.thickness;
          }};
}

Case box_case() {
  const Box b{{0.2, 0.1, -0.3}, {1, 0.6, 1.4}, some_rotation()};
  return {b,
          [b](Random& r) -> Vec3 {
            Vec3 u = r.point(0.5);
            u[r.below(3)] = r.below(2) ? 0.5 : -0.5;
            return b.centre + b.rotation * u.cwiseProduct(b.size);
          },
          [b](const Vec3& x) {
            const Vec3 p = b.rotation.inverse() * (x - b.centre);
            return (p.array() < b.size.array() / 2).all() && (p.array() > -b.size.array() / 2).all();
          }};
}

Case capsule_case() {
  const Capsule c{{-0.4, 0, 0.1}, {0.5, 0.3, 0.2}, 0.35};
  const Vec3 axis = (c.b - c.a).normalized();
  return {c,
          [c, axis](Random& r) -> Vec3 {
            Vec3 d = r.direction();
            const double along = d.dot(axis);
            if (r.below(2)) return (along < 0 ? c.a : c.b) + c.radius * d;
            return c.a + r(0, 1) * (c.b - c.a) + c.radius * (d - along * axis).normalized();
          },
          [c, axis](const Vec3& x) {
            const double along = axis.dot(x - c.a);
            if (along > 0 && along < (c.b - c.a).norm()) return axis.cross(x - c.a).norm() < c.radius;
            return std::min((x - c.a).norm(), (x - c.b).norm()) < c.radius;
          }};
}

Vec3 on_mesh(const TriangleMesh& m, Random& r) {
  const Triangle& t = m.triangles[r.below(m.triangle_count())];
  double u = r(0, 1), v = r(0, 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return (1 - u - v) * m.positions[t[0]] + u * m.positions[t[1]] + v * m.positions[t[2]];
}

// Number of times the surface winds about x, from the solid angles of its triangles [van Oosterom & Strackee
// 1983].
double winding(const TriangleMesh& m, const Vec3& x) {
  double angle = 0;
  for (const Triangle& t : m.triangles) {
    const Vec3 a = m.positions[t[0]] - x, b = m.positions[t[1]] - x, c = m.positions[t[2]] - x;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * pi);
}

Case mesh_case(const TriangleMesh& m) {
  return {body(m), [m](Random& r) { return on_mesh(m, r); },
          [m](const Vec3& x) { return winding(m, x) > 0.5; }};
}

std::vector<Case> cases() {
  const Plane plane{{0.1, 0.2, 0.3}, {1, -2, 3}};
  const Sphere sphere{{0.1, -0.1, 0.2}, 0.7};
  TriangleMesh spun = box_mesh({1, 0.7, 0.5});
  for (Vec3& p : spun.positions) p = some_rotation() * p;
  return {{plane,
           [plane](Random& r) -> Vec3 {
             const Vec3 e = plane.normal.unitOrthogonal(), g = plane.normal.normalized().cross(e);
             return plane.point + r(-2, 2) * e + r(-2, 2) * g;
           },
           [plane](const Vec3& x) { return x.dot(plane.normal) < plane.point.dot(plane.normal); }},
          {sphere, [sphere](Random& r) -> Vec3 { return sphere.centre + sphere.radius * r.direction(); },
           [sphere](const Vec3& x) { return (x - sphere.centre).norm() < sphere.radius; }},
          bowl_case(),
          box_case(),
          capsule_case(),
          mesh_case(lat_long_sphere(24, 30, 0.8, {0.1, 0, 0})),
          mesh_case(spun),
          {body(open_sheet()), [](Random& r) { return Vec3(r(-1, 1), 0, r(-1, 1)); },
           [](const Vec3&) { return false; }}};
}

constexpr double step = 1e-6;

// Whether the normal turns abruptly within `step` of x.
bool near_medial_axis(const Shape& shape, const Vec3& x) {
  const Vec3 n = closest(shape, x).normal;
  for (int k = 0; k < 3; ++k)
    for (double h : {-step, step})
      if ((closest(shape, x + h * Vec3::Unit(k)).normal - n).norm() > 1e-3) return true;
  return false;
}

// Distance to a segment and to a triangle by the plain definition: the foot on the plane if it is within,
// else the sides.
double to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (x - a - t * (b - a)).norm();
}

double to_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  Mat3 frame;
  frame << b - a, c - a, (b - a).cross(c - a);
  const Vec3 w = frame.partialPivLu().solve(x - a);
  if (w[0] >= 0 && w[1] >= 0 && w[0] + w[1] <= 1) return std::abs(w[2]) * frame.col(2).norm();
  return std::min({to_segment(x, a, b), to_segment(x, b, c), to_segment(x, c, a)});
}

double distance_by_search(const TriangleMesh& m, const Vec3& x) {
  double best = 1e300;
  for (const Triangle& t : m.triangles)
    best = std::min(best, to_triangle(x, m.positions[t[0]], m.positions[t[1]], m.positions[t[2]]));
  return best;
}

void same_answers(const TriangleMesh& m, const SurfaceDistance& surface, int points, double half) {
  Random r;
  double worst = 0;
  for (int i = 0; i < points; ++i) {
    const Vec3 x = i % 2 ? r.point(half) : Vec3(on_mesh(m, r) + r.point(0.02));
    const double sign = std::abs(winding(m, x)) > 0.5 ? -1 : 1;
    worst = std::max(worst, std::abs(surface.closest(x).distance - sign * distance_by_search(m, x)));
  }
  CHECK(worst < 1e-12);
}

}  // namespace

TEST_CASE("the normal is the unit gradient of the distance", "[shapes]") {
  for (const Case& c : cases()) {
    INFO(name(c.shape));
    Random r;
    int looked = 0;
    double worst = 0, length = 0;
    for (int i = 0; i < 500; ++i) {
      const Vec3 x = r.point(1.5);
      const SurfacePoint p = closest(c.shape, x);
      length = std::max(length, std::abs(p.normal.norm() - 1));
      if (near_medial_axis(c.shape, x)) continue;
      ++looked;
      Vec3 gradient;
      for (int k = 0; k < 3; ++k) {
        const Vec3 e = step * Vec3::Unit(k);
        gradient[k] = (closest(c.shape, x + e).distance - closest(c.shape, x - e).distance) / (2 * step);
      }
      worst = std::max({worst, (gradient - p.normal).norm(), std::abs(gradient.norm() - 1)});
    }
    CHECK(looked > 480);
    CHECK(length < 1e-14);
    CHECK(worst < 1e-7);
  }
}

TEST_CASE("the distance is zero on the surface, negative inside and falls no faster than 1", "[shapes]") {
  for (const Case& c : cases()) {
    INFO(name(c.shape));
    Random r;
    double surface = 0, foot = 0, slope = 0;
    int wrong = 0;
    for (int i = 0; i < 500; ++i) {
      surface = std::max(surface, std::abs(closest(c.shape, c.on_surface(r)).distance));
      const Vec3 x = r.point(1.5), y = x + r(0, 0.5) * r.direction();
      const SurfacePoint p = closest(c.shape, x);
      wrong += (p.distance < 0) != c.inside(x);
      slope = std::max(slope, std::abs(closest(c.shape, y).distance - p.distance) - (y - x).norm());
      foot = std::max(foot, std::abs(closest(c.shape, x - p.distance * p.normal).distance));
    }
    CHECK(surface < 1e-14);
    CHECK(wrong == 0);
    CHECK(slope < 1e-14);
    CHECK(foot < 1e-14);
  }
}

TEST_CASE("where the normal is not defined a unit one is returned", "[shapes]") {
  const Bowl bowl{};
  const std::vector<std::pair<Shape, Vec3>> places = {
      {Sphere{}, Vec3::Zero()},
      {bowl, bowl.centre},
      {bowl, Vec3(0, 0.4, 0)},
      {bowl, Vec3(0, -1.01, 0)},
      {Box{}, Vec3::Zero()},
      {Box{}, Vec3(0.5, 0.5, 0.5)},
      {Capsule{}, Vec3(0, 0.3, 0)},
      {Capsule{.a = Vec3::Zero(), .b = Vec3::Zero()}, Vec3::Zero()},
      {body(box_mesh(Vec3::Ones())), Vec3::Zero()},
      {body(open_sheet()), Vec3(0.3, 0, 0.1)}};
  for (const auto& [shape, x] : places) {
    INFO(name(shape) << " at " << x.transpose());
    CHECK(std::abs(closest(shape, x).normal.norm() - 1) < 1e-15);
    CHECK(std::isfinite(closest(shape, x).distance));
  }
}

TEST_CASE("a mesh answers as a search of all its triangles does", "[shapes][mesh]") {
  const TriangleMesh sphere = lat_long_sphere(16, 20, 1, {0.2, -0.1, 0.3});
  const SurfaceDistance surface(sphere);
  CHECK(surface.closed());
  CHECK_FALSE(surface.inside_out());
  same_answers(sphere, surface, 1000, 1.5);

  TriangleMesh star = lat_long_sphere(12, 15, 1, Vec3::Zero());  // deep creases and sharp spikes
  for (int i = 0; i < star.vertex_count(); ++i) star.positions[i] *= i % 2 ? 0.35 : 1.0;
  same_answers(star, SurfaceDistance(star), 1000, 1.2);
}

TEST_CASE("a mesh far from the origin keeps its digits", "[shapes][mesh]") {
  const Vec3 far(3e5, -2e5, 1e5);
  const TriangleMesh m = lat_long_sphere(16, 20, 1, far);
  const SurfaceDistance surface(m);
  Random r;
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 x = far + r.point(1.5);
    worst = std::max(worst, std::abs(std::abs(surface.closest(x).distance) - distance_by_search(m, x)));
  }
  CHECK(worst < 1e-9);
}

TEST_CASE("a box of triangles is the box, at its edges and corners too", "[shapes][mesh]") {
  const Vec3 size(1, 0.7, 0.4);
  const Shape exact = Box{.size = size}, mesh = body(box_mesh(size));
  Random r;
  double distance = 0, normal = 0;
  for (int i = 0; i < 3000; ++i) {
    Vec3 x = r.point(1);
    if (i % 3) {  // around a corner or an edge, at all scales
      for (int k = 0; k < 3; ++k) x[k] = (r.below(2) ? 0.5 : -0.5) * size[k];
      if (i % 3 == 1) x[r.below(3)] = r(-0.1, 0.1);
      x += std::pow(10, r(-9, -1)) * r.direction();
    }
    const SurfacePoint p = closest(exact, x), q = closest(mesh, x);
    distance = std::max(distance, std::abs(p.distance - q.distance));
    if (std::abs(p.distance) > 1e-4 && !near_medial_axis(exact, x))
      normal = std::max(normal, (p.normal - q.normal).norm());
  }
  CHECK(distance < 1e-15);
  CHECK(normal < 1e-11);
}

TEST_CASE("on a mesh's edge or vertex the normal is the pseudo-normal", "[shapes][mesh]") {
  const SurfaceDistance cube(box_mesh(Vec3::Ones()));
  CHECK((cube.closest({0.5, 0.5, 0.1}).normal - Vec3(1, 1, 0).normalized()).norm() < 1e-15);
  CHECK((cube.closest({0.5, 0.5, 0.5}).normal - Vec3(1, 1, 1).normalized()).norm() < 1e-15);
  CHECK((cube.closest({0.1, 0.5, 0.2}).normal - Vec3(0, 1, 0)).norm() < 1e-15);
}

TEST_CASE("a body badly wound, inside out, doubled or split along seams is the same body", "[shapes][mesh]") {
  const TriangleMesh sphere = lat_long_sphere(12, 16, 1, Vec3::Zero());
  TriangleMesh reversed = sphere, mixed = sphere, split, twice = sphere, two = sphere;
  for (Triangle& t : reversed.triangles) std::swap(t[0], t[1]);
  for (int i = 0; i < mixed.triangle_count(); i += 3) std::swap(mixed.triangles[i][0], mixed.triangles[i][1]);
  for (const Triangle& t : sphere.triangles) {
    const int n = split.vertex_count();
    for (int v : t) split.positions.push_back(sphere.positions[v]);
    split.triangles.push_back({n, n + 1, n + 2});
  }
  for (const Triangle& t : sphere.triangles) twice.triangles.push_back({t[0], t[2], t[1]});
  twice.triangles.push_back({3, 3, 4});
  Random r;
  const SurfaceDistance plain(sphere);
  for (const TriangleMesh* m : {&reversed, &mixed, &split, &twice}) {
    const SurfaceDistance surface(*m);
    CHECK(surface.closed());
    CHECK(surface.inside_out() == (m == &reversed));
    CHECK(surface.mesh().triangles == m->triangles);
    for (int i = 0; i < 200; ++i) {
      const Vec3 x = r.point(1.3);
      CHECK(std::abs(plain.closest(x).distance - surface.closest(x).distance) < 1e-12);
    }
  }
}

TEST_CASE("a crack closed by a triangle without area keeps the body closed", "[shapes][mesh]") {
  TriangleMesh m = box_mesh(Vec3::Ones());
  m.positions.push_back(0.5 * (m.positions[6] + m.positions[7]));  // in the middle of the edge y = z = 1/2
  const auto edge_of = [&](const Triangle& t) {
    return std::count(t.begin(), t.end(), 6) && std::count(t.begin(), t.end(), 7);
  };
  for (Triangle t :
       std::vector<Triangle>(m.triangles)) {  // one neighbour of the edge is cut in two, the other is not
    const Vec3 n = (m.positions[t[1]] - m.positions[t[0]]).cross(m.positions[t[2]] - m.positions[t[0]]);
    if (!edge_of(t) || n.y() < 0.5) continue;
    std::erase(m.triangles, t);
    Triangle one = t, other = t;
    std::replace(one.begin(), one.end(), 6, 8);
    std::replace(other.begin(), other.end(), 7, 8);
    m.triangles.insert(m.triangles.begin(), {one, other, {6, 7, 8}});
  }
  const SurfaceDistance surface(m);
  REQUIRE(surface.closed());
  const Shape exact = Box{};
  Random r;
  for (int i = 0; i < 500; ++i) {
    const Vec3 x = Vec3(r(-0.4, 0.4), 0.5, 0.5) + 0.1 * r.direction();
    CHECK(std::abs(surface.closest(x).distance - closest(exact, x).distance) < 1e-14);
  }
}

TEST_CASE("an open mesh is a surface without an inside", "[shapes][mesh]") {
  TriangleMesh cup = lat_long_sphere(12, 16, 1, Vec3::Zero());
  cup.triangles.erase(cup.triangles.begin());
  for (const TriangleMesh& m : {cup, open_sheet()}) {
    const SurfaceDistance surface(m);
    CHECK_FALSE(surface.closed());
    Random r;
    for (int i = 0; i < 200; ++i) {
      const Vec3 x = r.point(1.2);
      const SurfacePoint p = surface.closest(x);
      CHECK(std::abs(p.distance - distance_by_search(m, x)) < 1e-12);
      CHECK(std::abs(surface.closest(x - p.distance * p.normal).distance) < 1e-12);
    }
  }
  const SurfaceDistance sheet(open_sheet());
  CHECK(sheet.closest({0.1, -0.3, 0.2}).normal == Vec3(0, -1, 0));
  CHECK(sheet.closest({0.1, -1e-11, 0.2}).normal.y() == -1);
}

TEST_CASE("the order of the triangles does not matter", "[shapes][mesh]") {
  const TriangleMesh m = lat_long_sphere(20, 24, 1, {0.1, 0.2, 0.3});
  TriangleMesh shuffled = m;
  Random r;
  for (int i = m.triangle_count() - 1; i > 0; --i)
    std::swap(shuffled.triangles[i], shuffled.triangles[r.below(i + 1)]);
  for (Triangle& t : shuffled.triangles) std::rotate(t.begin(), t.begin() + r.below(3), t.end());
  const SurfaceDistance one(m), other(shuffled), again(m);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 x = r.point(1.5);
    const SurfacePoint p = one.closest(x), q = other.closest(x), same = again.closest(x);
    CHECK(std::abs(p.distance - q.distance) < 1e-12);
    if (std::abs(p.distance) > 1e-3 && !near_medial_axis(body(m), x))
      CHECK((p.normal - q.normal).norm() < 1e-12);
    CHECK((p.distance == same.distance && p.normal == same.normal));
  }
}

TEST_CASE("a surface without area is refused", "[shapes][mesh]") {
  TriangleMesh m;
  CHECK_THROWS_AS(SurfaceDistance(m), InputError);
  m.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  m.triangles = {{0, 1, 2}};
  CHECK_THROWS_AS(SurfaceDistance(m), InputError);
}

TEST_CASE("a point that is not finite has no distance", "[shapes][mesh]") {
  const SurfaceDistance surface(box_mesh(Vec3::Ones()));
  CHECK(std::isnan(surface.closest({std::nan(""), 0, 0}).distance));
}

#ifdef DRAPE_SHARED_DIR
namespace {

// The whole number that follows "key": in a record of the manifest.
int number_after(const std::string& record, const std::string& key) {
  const std::size_t at = record.find('"' + key + "\":");
  return at == std::string::npos ? -1 : std::stoi(record.substr(at + key.size() + 3));
}

}  // namespace

TEST_CASE("bodies and obstacles are closed where their description says so", "[shapes][mesh][files]") {
  const std::filesystem::path folder = std::filesystem::path(DRAPE_SHARED_DIR) / "meshes";
  std::ifstream manifest(folder / "manifest.json");
  if (!manifest) {
    WARN("no shared meshes here");
    return;
  }
  std::stringstream text;
  text << manifest.rdbuf();
  const std::string all = text.str(), mark = "\"file\": \"";
  int looked = 0;
  for (std::size_t at = all.find(mark); at != std::string::npos;) {
    const std::size_t following = all.find(mark, at + 1);
    const std::string record = all.substr(at, following - at);
    at = following;
    const std::string file = record.substr(mark.size(), record.find('"', mark.size()) - mark.size());
    const std::string room = file.substr(0, file.find('/'));
    if (room != "bodies" && room != "obstacles" && room != "dressed") continue;
    INFO(file);
    const SurfaceDistance surface(read_obj(folder / file));
    const bool clean = number_after(record, "nm_edges") == 0, open = number_after(record, "bnd_loops") > 0;
    if (clean && !open) CHECK(surface.closed());
    if (clean && open && number_after(record, "dup_verts") == 0) CHECK_FALSE(surface.closed());
    const bool simple =
        number_after(record, "tris") < 8000 && record.find("\"self_pairs\": \"0\"") != std::string::npos;
    if (surface.closed() && simple) same_answers(surface.mesh(), surface, 60, 1);
    ++looked;
  }
  CHECK(looked > 10);
}
#endif

TEST_CASE("a thin plate is not stepped over", "[shapes][hit]") {
  const Vec3 size(2, 0.001, 2);
  for (const Shape& plate :
       {Shape(Box{.size = size}), Shape(body(box_mesh(size))), Shape(body(open_sheet()))}) {
    INFO(name(plate));
    for (double margin : {0.0, 0.001, 0.02})
      for (double slant : {0.0, 0.3, 0.9}) {
        const Vec3 x0(-slant * 0.5, 1.5, 0.011), x1(slant * 0.5, -1.5, 0.013);
        const auto hit = first_hit(plate, x0, x1, margin);
        REQUIRE(hit);
        CHECK(std::abs(hit->surface.distance - margin) < 1e-7);
        CHECK(hit->surface.normal.y() == Approx(1));
        const double top =
            std::holds_alternative<MeshBody>(plate) && !std::get<MeshBody>(plate)->closed() ? 0 : 0.0005;
        CHECK(hit->fraction == Approx((1.5 - top - margin) / 3).margin(1e-6));
      }
  }
}

TEST_CASE("a hit lies on the margin and nothing is nearer before it", "[shapes][hit]") {
  for (const Case& c : cases()) {
    INFO(name(c.shape));
    Random r;
    int hits = 0, early = 0, missed = 0;
    double off = 0;
    for (int i = 0; i < 300; ++i) {
      const Vec3 x0 = r.point(2);
      const Vec3 x1 =
          i % 2 ? Vec3(x0 + r(0.01, 2) * r.direction()) : Vec3(x0 + r(0.5, 2) * (c.on_surface(r) - x0));
      const double margin = r(0, 0.05);
      if (closest(c.shape, x0).distance < margin) continue;
      const auto hit = first_hit(c.shape, x0, x1, margin);
      const double until = hit ? hit->fraction : 1;
      hits += hit.has_value();
      if (hit) off = std::max(off, std::abs(hit->surface.distance - margin));
      for (int k = 0; k < 400; ++k) {
        const double t = until * k / 400, d = closest(c.shape, x0 + t * (x1 - x0)).distance;
        (hit ? early : missed) += d < margin - 1e-7;
      }
    }
    CHECK(hits > 40);
    CHECK(off < 1e-7);
    CHECK(early == 0);
    CHECK(missed == 0);
  }
}

TEST_CASE("sliding just outside the margin is no hit", "[shapes][hit]") {
  const double margin = 0.002;
  const TriangleMesh block = box_mesh({4, 1, 4});
  for (double gap : {1e-6, 1e-4, 1e-2}) {
    const Vec3 x0(-1.5, 0.5 + margin + gap, 0.1), x1(1.5, 0.5 + margin + gap, 0.2);
    CHECK_FALSE(first_hit(Plane{.point = {0, 0.5, 0}}, x0, x1, margin));
    CHECK_FALSE(first_hit(Box{.size = {4, 1, 4}}, x0, x1, margin));
    CHECK_FALSE(first_hit(body(block), x0, x1, margin));
    CHECK_FALSE(
        first_hit(Sphere{.radius = 0.5}, {-1, 0.5 + margin + gap, 0}, {1, 0.5 + margin + gap, 0}, margin));
    CHECK_FALSE(first_hit(Capsule{.radius = 0.5}, {-1, 0.1, 0.5 + margin + gap}, {1, 0.2, 0.5 + margin + gap},
                          margin));
  }
  const auto into =
      first_hit(body(block), {-1.5, 0.5 + margin + 0.01, 0}, {1.5, 0.5 + margin - 0.01, 0}, margin);
  REQUIRE(into);
  CHECK(into->fraction == Approx(0.5).margin(1e-5));
}

TEST_CASE("a start within the margin: away is clear, nearer is a hit at once", "[shapes][hit]") {
  const std::vector<Shape> shapes = {Plane{},
                                     Sphere{.centre = {0, -1, 0}},
                                     Box{.centre = {0, -0.5, 0}},
                                     Capsule{.a = {0, -1, 0}, .b = {1, -1, 0}},
                                     Bowl{.centre = {0, 1, 0}, .radius = 0.98},
                                     body(open_sheet())};
  for (const Shape& shape : shapes) {
    INFO(name(shape));
    const Vec3 x0(0.02, 0.025, 0.01);
    const double phi = closest(shape, x0).distance, margin = phi + 0.01;
    const Vec3 out = x0 + 0.3 * closest(shape, x0).normal, in = x0 - 0.003 * closest(shape, x0).normal;
    CHECK_FALSE(first_hit(shape, x0, out, margin));
    const auto hit = first_hit(shape, x0, in, margin);
    REQUIRE(hit);
    CHECK(hit->fraction == 0);
    CHECK_FALSE(first_hit(shape, x0, x0, margin));
  }
  // Out of the inner side of a bowl and across: away at first, then onto the other side.
  const auto across = first_hit(Bowl{}, {-0.99, -0.01, 0}, {0.99, -0.01, 0}, 0.05);
  REQUIRE(across);
  CHECK(across->fraction > 0.9);
  CHECK(across->surface.normal.x() < -0.9);
}

TEST_CASE("sizes that are none are refused by name", "[shapes]") {
  const std::vector<std::pair<Shape, std::string>> bad = {{Plane{.normal = Vec3::Zero()}, "normal"},
                                                          {Sphere{.radius = 0}, "radius"},
                                                          {Sphere{.centre = {std::nan(""), 0, 0}}, "centre"},
                                                          {Bowl{.thickness = -1}, "thickness"},
                                                          {Bowl{.axis = Vec3::Zero()}, "axis"},
                                                          {Box{.size = {1, 0, 1}}, "size"},
                                                          {Box{.rotation = 2 * Mat3::Identity()}, "rotation"},
                                                          {Capsule{.radius = std::nan("")}, "radius"},
                                                          {MeshBody{}, "mesh"}};
  for (const auto& [shape, field] : bad) CHECK_THROWS_WITH(check(shape), Catch::Contains(field));
  for (const Case& c : cases()) CHECK_NOTHROW(check(c.shape));
}
