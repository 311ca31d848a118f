// The first meeting of a path with a surface that moves meanwhile, against the cubics of all its triangles.
#include <algorithm>
#include <catch2/catch.hpp>
#include <complex>

#include "mesh/base/errors.h"
#include "mesh/triangles/generate.h"
#include "tests/shapes.h"

using namespace drape;
using namespace drape::test;

namespace {

using Places = std::vector<Vec3>;
using Number = long double;
using Complex = std::complex<Number>;

Shape moving(const TriangleMesh& mesh, const Places& start, const Places& end) {
  const auto surface = std::make_shared<SurfaceDistance>(mesh);
  surface->move(start, end);
  return DeformingBody{surface, nullptr};
}

// All roots of a polynomial of degree 3 at once [Durand 1960, Kerner 1966]: another way than the library's.
std::vector<double> real_roots(const std::array<Number, 4>& c) {
  int degree = 3;
  while (degree > 0 && c[degree] == 0) --degree;
  std::vector<Complex> roots;
  for (int k = 0; k < degree; ++k) roots.push_back(std::pow(Complex(0.4L, 0.9L), static_cast<Number>(k)));
  for (int sweep = 0; sweep < 500; ++sweep)
    for (int k = 0; k < degree; ++k) {
      Complex value = c[degree], others = c[degree];
      for (int i = degree - 1; i >= 0; --i) value = value * roots[k] + c[i];
      for (int i = 0; i < degree; ++i)
        if (i != k) others *= roots[k] - roots[i];
      if (others != Complex(0)) roots[k] -= value / others;
    }
  std::vector<double> real;
  for (const Complex& root : roots)
    if (std::abs(root.imag()) < 1e-12L * (1 + std::abs(root.real())))
      real.push_back(static_cast<double>(root.real()));
  return real;
}

Number det(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto x = [](double value) { return static_cast<Number>(value); };
  return x(a[0]) * (x(b[1]) * x(c[2]) - x(b[2]) * x(c[1])) -
         x(a[1]) * (x(b[0]) * x(c[2]) - x(b[2]) * x(c[0])) +
         x(a[2]) * (x(b[0]) * x(c[1]) - x(b[1]) * x(c[0]));
}

// The s at which the path is well within the triangle and goes through it well across; by the volume of the
// tetrahedron x a b c, a cubic known from four of its values.
std::vector<double> through(const Vec3& x0, const Vec3& x1, const std::array<Vec3, 3>& start,
                            const std::array<Vec3, 3>& end) {
  const auto between = [](const Vec3& p, const Vec3& q, double s) { return Vec3(p + s * (q - p)); };
  const auto sides = [&](double s) {
    std::array<Vec3, 3> d;
    for (int k = 0; k < 3; ++k) d[k] = between(start[k], end[k], s) - between(x0, x1, s);
    return d;
  };
  const auto volume = [&](double s) {
    const auto d = sides(s);
    return det(d[0], d[1], d[2]);
  };
  const Number g0 = volume(0), g1 = volume(1), gm = volume(-1), g2 = volume(2);
  const Number c2 = (g1 + gm) / 2 - g0, odd = (g1 - gm) / 2, c3 = (g2 - g0 - 4 * c2 - 2 * odd) / 6;
  std::vector<double> found;
  for (double s : real_roots({g0, odd - c3, c2, c3})) {
    if (s < 0 || s > 1) continue;
    const auto d = sides(s);
    const Vec3 n = (d[1] - d[0]).cross(d[2] - d[0]);
    const double area = n.squaredNorm();
    Vec3 way = x1 - x0,
         w(n.dot(d[1].cross(d[2])) / area, n.dot(d[2].cross(d[0])) / area, n.dot(d[0].cross(d[1])) / area);
    for (int k = 0; k < 3; ++k) way -= w[k] * (end[k] - start[k]);
    if (w.minCoeff() > 1e-6 && std::abs(n.normalized().dot(way)) > 1e-4) found.push_back(s);
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::array<Vec3, 3> corners(const Places& places, const Triangle& t) {
  return {places[t[0]], places[t[1]], places[t[2]]};
}

}  // namespace

TEST_CASE("no path goes through a moving triangle unseen", "[moving]") {
  Random r;
  int crossed = 0, unseen = 0, late = 0;
  for (int i = 0; i < 20000; ++i) {
    const double size = std::pow(10, r(-3, 0)), speed = std::pow(10, r(-3, 0));
    TriangleMesh mesh;
    mesh.triangles = {{0, 1, 2}};
    Places end;
    const Vec3 drift = speed * r.direction();
    for (int k = 0; k < 3; ++k) {
      mesh.positions.push_back(size * r.direction());
      end.push_back(mesh.positions[k] + drift + (i % 2 ? size : 0.1 * size) * r.direction());
    }
    const Places start = mesh.positions;
    // Through a point of the triangle at some s, as seen from it.
    const double s = r(0, 1), u = r(0, 0.5), v = r(0, 0.5);
    const auto point = [&](const Places& p) { return Vec3((1 - u - v) * p[0] + u * p[1] + v * p[2]); };
    const Vec3 meets = point(start) + s * (point(end) - point(start)),
               way = std::pow(10, r(-3, 0)) * r.direction();
    const Vec3 x0 = meets - s * way, x1 = meets + (1 - s) * way;
    const auto expected = through(x0, x1, corners(start, mesh.triangles[0]), corners(end, mesh.triangles[0]));
    if (expected.empty()) continue;
    ++crossed;
    const auto hit = first_hit(moving(mesh, start, end), x0, x1, 0);
    unseen += !hit;
    late += hit && hit->fraction > expected.front() + 1e-7;
    if (hit) CHECK(std::abs(hit->surface.distance) < 2e-8);
  }
  CHECK(crossed > 15000);
  CHECK(unseen == 0);
  CHECK(late == 0);
}

TEST_CASE("a moving surface is met on the margin, and nothing is nearer before", "[moving]") {
  for (const TriangleMesh& mesh : {sphere(2, 0.3), box_mesh({0.5, 0.02, 0.5}), open_sheet()}) {
    Random r;
    HitLaw law;
    for (int i = 0; i < 300; ++i) {
      const Vec3 drift = r(0, 0.3) * r.direction();
      const Mat3 turn = Eigen::AngleAxisd(r(0, 0.5), r.direction()).toRotationMatrix();
      Places end = mesh.positions;
      for (Vec3& x : end) x = turn * x + drift;
      const Shape shape = moving(mesh, mesh.positions, end);
      const double margin = i % 2 ? 0.002 : r(0, 0.05);
      const Vec3 x0 = on_mesh(mesh, r) + r(0.03, 0.2) * r.direction();
      const Vec3 x1 = i % 3 == 0 ? x0 : Vec3(x0 + r(0, 0.5) * r.direction());  // some stand and are hit
      law.path(shape, x0, x1, margin);
    }
    INFO(law);
    CHECK(law.holds(30));
  }
}

TEST_CASE("a plate at 5 m/s does not pass through what is in its way", "[moving]") {
  const double h = 1.0 / 60;
  for (double thickness : {1e-5, 1e-3})
    for (double margin : {0.0, 0.002}) {
      const TriangleMesh plate = box_mesh({1, thickness, 1});
      SurfaceDistance shape_of(plate);
      Random r;
      int missed = 0;
      for (int i = 0; i < 1000; ++i) {
        Places start = plate.positions, end = plate.positions;
        for (Vec3& x : start) x.y() -= thickness / 2 + margin + 0.08;
        for (std::size_t k = 0; k < end.size(); ++k) end[k] = start[k] + Vec3(0, 5 * h, 0);
        const double tilt = r(-0.003, 0.003);
        for (Vec3& x : end) x.y() += tilt * x.x();
        const Vec3 x(r(-0.4, 0.4), r(-0.07, -0.005), r(-0.4, 0.4));  // stands in its way
        const auto hit = first_hit(moving(plate, start, end), x, x + Vec3(0, -r(0, 5) * h, 0), margin);
        missed += !hit || hit->fraction <= 0 || hit->surface.normal.y() < 0.9;
      }
      CHECK(missed == 0);
    }
}

TEST_CASE("what moves along with a surface is not hit", "[moving]") {
  const TriangleMesh plate = box_mesh({1, 0.1, 1});
  Places end = plate.positions;
  const Vec3 way(0.08, 0.03, -0.05);
  for (Vec3& x : end) x += way;
  const Shape shape = moving(plate, plate.positions, end);
  for (double gap : {1e-7, 1e-4, 1e-2})
    for (double margin : {0.0, 0.002}) {
      const Vec3 x(0.1, 0.05 + margin + gap, 0.2);
      CHECK_FALSE(first_hit(shape, x, x + way, margin));
      CHECK_FALSE(first_hit(shape, x, x + way + Vec3(0.02, 0, 0.01), margin));
      CHECK_FALSE(first_hit(shape, x, x + way + Vec3(0, 0.01, 0), margin));
      CHECK(first_hit(shape, x, x + way - Vec3(0, gap + 0.01, 0), margin));
    }
}

TEST_CASE("what stays clear of a moving surface is nowhere as near as the margin", "[moving]") {
  for (const TriangleMesh& mesh : {sphere(2, 0.3), box_mesh({0.5, 0.02, 0.5}), open_sheet()}) {
    Random r;
    SurfaceDistance surface(mesh);
    int clear = 0, near = 0, alarms = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 drift = r(0, 0.3) * r.direction();
      const Mat3 turn = Eigen::AngleAxisd(r(0, 0.3), r.direction()).toRotationMatrix();
      Places end = mesh.positions;
      for (Vec3& x : end) x = turn * x + drift;
      surface.move(mesh.positions, end);
      const double margin = r(0, 0.02);
      const Vec3 x0 = on_mesh(mesh, r) + r(0.001, 0.1) * r.direction();
      const Vec3 x1 = turn * x0 + drift + r(0, 0.05) * r.direction();
      double least = 1;
      for (int k = 0; k <= 20; ++k) {
        const double s = k / 20.0;
        least = std::min(least, std::abs(surface.closest(x0 + s * (x1 - x0), s).distance));
      }
      const bool told = surface.stays_clear(x0, x1, margin);
      if (told) CHECK(least > margin);
      clear += told;
      near += least <= margin;
      alarms += !told && least > margin + 0.1;
    }
    CHECK(clear > 100);
    CHECK(near > 300);
    CHECK(alarms == 0);
  }
}

TEST_CASE("a body that deforms is a shape like the others", "[moving]") {
  const TriangleMesh ball = sphere(2, 0.5);
  Shape shape = moving(ball, ball.positions, ball.positions);
  CHECK(name(shape) == "mesh");
  CHECK(carried(shape, {1, 2, 3}) == Vec3(1, 2, 3));
  const auto frames = std::make_shared<MeshFrames>();
  for (int k = 0; k < 3; ++k) {
    Places places = ball.positions;
    for (Vec3& x : places) x += Vec3(0.5 * k * k, 0, 0);
    frames->add(k, places);
  }
  std::get<DeformingBody>(shape).frames = frames;
  CHECK_NOTHROW(check(shape));
  move(shape, 0, 1);
  CHECK(largest_displacement(shape) == Approx(0.5));
  CHECK((carried(shape, {0, 0.6, 0}) - Vec3(0.5, 0.6, 0)).norm() < 1e-7);
  move(shape, 1, 1.5);
  CHECK(largest_displacement(shape) == Approx(0.75));
  CHECK(closest(shape, {1.25 + 1, 0, 0}, 1).distance == Approx(0.5).margin(0.02));
  move(shape, 5, 6);
  CHECK(largest_displacement(shape) == 0);
  Shape plane = Plane{};
  move(plane, 0, 1);
  CHECK(largest_displacement(plane) == 0);
  CHECK(carried(plane, {1, 2, 3}) == Vec3(1, 2, 3));
  CHECK_THROWS_AS(check(Shape(DeformingBody{})), InputError);
}
