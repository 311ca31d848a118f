#include "tests/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace drape::test {

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

Vec3 on_mesh(const TriangleMesh& m, Random& r) {
  const Triangle& t = m.triangles[r.below(m.triangle_count())];
  double u = r(0, 1), v = r(0, 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return (1 - u - v) * m.positions[t[0]] + u * m.positions[t[1]] + v * m.positions[t[2]];
}

double winding(const TriangleMesh& m, const Vec3& x) {
  double angle = 0;
  for (const Triangle& t : m.triangles) {
    const Vec3 a = m.positions[t[0]] - x, b = m.positions[t[1]] - x, c = m.positions[t[2]] - x;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * pi);
}

namespace {

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

Vec3 on_plate(const Plate& p, Random& r) {
  const Vec3 axis = p.axis.normalized(), e = axis.unitOrthogonal(), g = axis.cross(e);
  const double a = r(0, 2 * pi), core = p.radius - p.rim, wall = p.height / 2 - p.rim;
  const Vec3 round = std::cos(a) * e + std::sin(a) * g, up = r.below(2) ? axis : Vec3(-axis);
  const int part = r.below(3);
  if (part == 0) return p.centre + r(0, core) * round + p.height / 2 * up;
  if (part == 1) return p.centre + p.radius * round + r(0, wall) * up;
  const double t = r(0, pi / 2);
  return p.centre + (core + p.rim * std::cos(t)) * round + (wall + p.rim * std::sin(t)) * up;
}

// Inside it is at most as far from the axis as the outline at its height.
Case plate_case(double rim) {
  const Plate p{{0.2, -0.1, 0.1}, 0.9, 0.7, rim, {-1, 2, 0.5}};
  return {p, [p](Random& r) { return on_plate(p, r); },
          [p](const Vec3& x) {
            const Vec3 d = x - p.centre, n = p.axis.normalized();
            const double h = std::abs(n.dot(d)), over = h - (p.height / 2 - p.rim);
            if (h >= p.height / 2) return false;
            const double outline =
                p.radius - p.rim + (over > 0 ? std::sqrt(p.rim * p.rim - over * over) : p.rim);
            return n.cross(d).norm() < outline;
          }};
}

Case mesh_case(const TriangleMesh& m) {
  return {body(m), [m](Random& r) { return on_mesh(m, r); },
          [m](const Vec3& x) { return winding(m, x) > 0.5; }};
}

}  // namespace

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
          plate_case(0.2),
          plate_case(0),
          plate_case(0.35),
          mesh_case(lat_long_sphere(24, 30, 0.8, {0.1, 0, 0})),
          mesh_case(spun),
          {body(open_sheet()), [](Random& r) { return Vec3(r(-1, 1), 0, r(-1, 1)); },
           [](const Vec3&) { return false; }}};
}

void HitLaw::path(const Shape& shape, const Vec3& x0, const Vec3& x1, double margin) {
  if (closest(shape, x0).distance < margin + 1e-6) return;
  const auto hit = first_hit(shape, x0, x1, margin);
  const double until = hit ? hit->fraction : 1;
  hits += hit.has_value();
  if (hit) off = std::max(off, std::abs(hit->surface.distance - margin));
  for (int k = 0; k < 300; ++k) {
    const double s = until * k / 300, d = closest(shape, x0 + s * (x1 - x0), s).distance;
    (hit ? early : missed) += d < margin - 1e-7;
  }
}

bool near_medial_axis(const Shape& shape, const Vec3& x) {
  const Vec3 n = closest(shape, x).normal;
  for (int k = 0; k < 3; ++k)
    for (double h : {-step, step})
      if ((closest(shape, x + h * Vec3::Unit(k)).normal - n).norm() > 1e-3) return true;
  return false;
}

}  // namespace drape::test
