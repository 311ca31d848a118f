// The distance to a mesh against a search of all its triangles with the sign from solid angles: bodies badly
// made, open, and real ones.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>

#include "mesh/obj/obj.h"
#include "tests/folder.h"
#include "tests/places.h"
#include "tests/shapes.h"

using namespace drape;
using namespace drape::test;

namespace {

// Distance to a segment and to a triangle by the plain definition: the foot on the plane if it
// is within, else the sides.
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

TEST_CASE("a surface with a corner nowhere is refused, and a vertex that no triangle has may be anywhere",
          "[shapes][mesh]") {
  const double nowhere = std::nan("");
  TriangleMesh box = box_mesh(Vec3::Ones());
  box.positions.emplace_back(nowhere, 0, 0);
  CHECK_NOTHROW(SurfaceDistance(box));
  box.positions[3][1] = nowhere;
  CHECK_THROWS_WITH(SurfaceDistance(box), Catch::Contains("vertex 3"));
}

TEST_CASE("a point that is not finite has no distance", "[shapes][mesh]") {
  const SurfaceDistance surface(box_mesh(Vec3::Ones()));
  CHECK(std::isnan(surface.closest({std::nan(""), 0, 0}).distance));
}

namespace {

// The whole number that follows "key": in a record of the manifest.
int number_after(const std::string& record, const std::string& key) {
  const std::size_t at = record.find('"' + key + "\":");
  return at == std::string::npos ? -1 : std::stoi(record.substr(at + key.size() + 3));
}

}  // namespace

TEST_CASE("bodies and obstacles are closed where their description says so", "[shapes][mesh][files]") {
  const std::filesystem::path folder = std::filesystem::path(shared_dir()) / "meshes";
  const std::string all = content(folder / "manifest.json"), mark = "\"file\": \"";
  if (all.empty()) {
    WARN("no shared meshes here");
    return;
  }
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
