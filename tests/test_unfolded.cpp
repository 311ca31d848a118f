// Where cloth is told to be surely not folded onto itself, it is not.
#include "constraints/unfolded.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <set>

#include "mesh/distance/approach.h"
#include "tests/sheets.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::internal;
using namespace drape::test;

namespace {

constexpr double edge = 0.01;  // m
constexpr int n = 13;

// A sheet, in patches.
struct Patched {
  Patched(const TriangleMesh& mesh) : places(mesh.positions) {
    for (const Triangle& t : mesh.triangles) faces.push_back({t, {-1, -1, -1}});
    join(faces);
    boxes.emplace(faces, places, 1);
    unfolded.emplace(faces, *boxes, places);
  }

  std::vector<Triangle> of_patch(int p) const {
    std::vector<Triangle> all;
    for (int k = boxes->patches()[p].first; k < boxes->patches()[p].first + boxes->patches()[p].count; ++k)
      all.push_back(faces[boxes->face(k)].v);
    return all;
  }

  // Calls use(region, its triangles) for every one.
  template <class Use>
  void each_region(const Use& use) const {
    const int patches = static_cast<int>(boxes->patches().size());
    for (int p = 0; p < patches; ++p)
      for (int q = p; q < patches; ++q) {
        if (unfolded->region_of(p, q) < 0) continue;
        std::vector<Triangle> both = of_patch(p);
        if (q != p)
          for (const Triangle& t : of_patch(q)) both.push_back(t);
        use(unfolded->region_of(p, q), both);
      }
    for (int v = 0; v < static_cast<int>(places.size()); ++v) {
      if (unfolded->region_of_vertex(v) < 0) continue;
      std::vector<Triangle> around;
      for (const Face& f : faces)
        if (std::find(f.v.begin(), f.v.end(), v) != f.v.end()) around.push_back(f.v);
      use(unfolded->region_of_vertex(v), around);
    }
  }

  std::vector<Vec3> places;
  std::vector<Face> faces;
  std::optional<MovingBoxes> boxes;
  std::optional<Unfolded> unfolded;
};

// The least distance of a vertex and a triangle, or of two edges, that have no vertex in common, on the way.
double least_distance(const std::vector<Triangle>& triangles, const std::vector<Vec3>& start,
                      const std::vector<Vec3>& end) {
  std::set<std::pair<int, int>> edges;
  std::set<int> vertices;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
      vertices.insert(t[k]);
    }
  double least = std::numeric_limits<double>::infinity();
  for (const double s : {0.0, 0.5, 1.0}) {
    const auto at = [&](int v) { return Vec3((1 - s) * start[v] + s * end[v]); };
    for (const Triangle& t : triangles)
      for (int v : vertices)
        if (v != t[0] && v != t[1] && v != t[2])
          least = std::min(least, nearest(false, {at(v), at(t[0]), at(t[1]), at(t[2])}).distance);
    for (const auto& [a, b] : edges)
      for (const auto& [c, d] : edges)
        if (a < c && b != c && b != d)
          least = std::min(least, nearest(true, {at(a), at(b), at(c), at(d)}).distance);
  }
  return least;
}

// A bend along one direction.
struct Bend {
  double angle = 0;   // of the direction
  double radius = 0;  // m, of what is wound up; 0: both sides go down from a ridge
  double tilt = 0;    // there, which is gone at this distance
  double length = 0;  // m

  // Where what lies at s along the direction and y above the sheet comes to.
  Eigen::Vector2d place(double s, double y) const {
    if (radius > 0)
      return {(radius - y) * std::sin(s / radius), radius - (radius - y) * std::cos(s / radius)};
    const double u = std::min(std::abs(s), length), now = tilt * (1 - u / length), side = s < 0 ? -1 : 1;
    const Eigen::Vector2d at((length / tilt) * (std::sin(tilt) - std::sin(now)) + std::abs(s) - u,
                             -(length / tilt) * (std::cos(now) - std::cos(tilt)));
    return Eigen::Vector2d(side * at.x(), at.y()) + y * Eigen::Vector2d(side * std::sin(now), std::cos(now));
  }

  std::vector<Vec3> of(const std::vector<Vec3>& places, const Eigen::Quaterniond& turn, double tremble,
                       std::mt19937& random) const {
    std::uniform_real_distribution<double> number(-1, 1);
    const Vec3 along(std::cos(angle), 0, std::sin(angle)), axis(-along.z(), 0, along.x());
    std::vector<Vec3> now;
    for (const Vec3& x : places) {
      const Eigen::Vector2d at = place(along.dot(x), x.y());
      now.push_back(turn * Vec3(at.x() * along + axis.dot(x) * axis + at.y() * Vec3::UnitY()) +
                    tremble * edge * Vec3(number(random), number(random), number(random)));
    }
    return now;
  }
};

TriangleMesh without(TriangleMesh mesh, const std::function<bool(const Vec3&)>& is_left_out) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return is_left_out((mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / (3 * edge));
  });
  return mesh;
}

TriangleMesh twice(TriangleMesh mesh, double distance) {
  const int half = mesh.vertex_count();
  for (int v = 0; v < half; ++v) mesh.positions.push_back(mesh.positions[v] + Vec3(0, distance, 0));
  for (int t = mesh.triangle_count() - 1; t >= 0; --t) {
    const Triangle& of = mesh.triangles[t];
    mesh.triangles.push_back({of[0] + half, of[1] + half, of[2] + half});
  }
  return mesh;
}

// What cloth is at the reference.
struct Reference {
  const char* name;
  std::function<TriangleMesh(Kind)> mesh;
  std::function<double(const Vec3&)> loose;  // by what share of a common way a vertex goes
};

// A strip with a pleat, of which the part that goes back is wound the other way, so that all of it faces up.
TriangleMesh pleat() {
  constexpr std::array along = {0, 1, 2, 3, 2, 3, 4, 5};
  constexpr int rows = 3, back = 3;
  TriangleMesh mesh;
  for (int k = 0; k < static_cast<int>(along.size()); ++k)
    for (int row = 0; row < rows; ++row)
      mesh.positions.push_back(edge * Vec3(along[k], std::max(0.0, 0.1 * (k - back)), -row));
  for (int k = 0; k + 1 < static_cast<int>(along.size()); ++k)
    for (int row = 0; row + 1 < rows; ++row) {
      const int a = rows * k + row, b = a + rows;
      mesh.triangles.push_back(k == back ? Triangle{a, a + 1, b} : Triangle{a, b, a + 1});
      mesh.triangles.push_back(k == back ? Triangle{b, a + 1, b + 1} : Triangle{b, b + 1, a + 1});
    }
  return mesh;
}

TriangleMesh sheet(
    Kind kind, const std::function<double(double, double)>& height = [](double, double) { return 0.0; }) {
  return bent(n, kind, edge * (n - 1), height);
}
double nothing(const Vec3&) { return 0; }

const std::vector<Reference> references = {
    {"flat", [](Kind kind) { return sheet(kind); }, nothing},
    {"with a hole",
     [](Kind kind) { return without(sheet(kind), [](const Vec3& at) { return at.norm() < 2; }); }, nothing},
    {"an L",
     [](Kind kind) { return without(sheet(kind), [](const Vec3& at) { return at.x() > 0 && at.z() > 0; }); },
     nothing},
    {"slit",
     [](Kind kind) {
       return without(sheet(kind),
                      [](const Vec3& at) { return std::abs(at.x() - 1.5) < 0.5 && at.z() > -2; });
     },
     [](const Vec3& x) {
       return x.x() > 1.5 * edge ? std::clamp(0.25 * (x.z() / edge + 2), 0.0, 1.0) : 0.0;
     }},
    {"two layers", [](Kind kind) { return twice(sheet(kind), 0.4 * edge); },
     [](const Vec3& x) { return x.y() > 0 ? 1.0 : 0.0; }},
    {"bowl", [](Kind kind) { return sheet(kind, [](double x, double z) { return 4 * (x * x + z * z); }); },
     nothing},
    {"pleat", [](Kind) { return pleat(); }, nothing},
    {"roof", [](Kind kind) { return sheet(kind, [](double x, double) { return -0.5 * std::abs(x); }); },
     nothing},
    {"waves",
     [](Kind kind) { return sheet(kind, [](double x, double) { return 0.004 * std::sin(120 * x); }); },
     nothing}};

// Looks at motions in a row.
struct Row {
  explicit Row(Kind kind) : cloth(sheet(kind)) {}

  // What is told of this motion is true, also where a first look would not tell it, and where it would.
  void look(const std::vector<Vec3>& start, const std::vector<Vec3>& end) {
    cloth.unfolded->look(start, end, gap);
    Unfolded anew(cloth.faces, *cloth.boxes, cloth.places);
    anew.look(start, end, gap);
    long near = 0;
    fewer = regions = told_now = 0;
    cloth.each_region([&](int region, const std::vector<Triangle>& triangles) {
      const bool apart = cloth.unfolded->is_apart(region), first = anew.is_apart(region);
      ++regions;
      told_now += apart;
      fewer += !apart && first;
      more += apart && !first;
      near += apart && !(least_distance(triangles, start, end) > gap);
    });
    told += told_now;
    CHECK(near == 0);
  }

  static constexpr double gap = 0.15 * edge;
  Patched cloth;
  long told = 0, more = 0;                    // in all looks; more: than first looks
  long told_now = 0, fewer = 0, regions = 0;  // in the last one
};

}  // namespace

TEST_CASE("what is told to be unfolded stays apart", "[approach]") {
  long told = 0, folded = 0;
  for (const Reference& reference : references)
    for (const Kind kind : kinds) {
      Patched cloth(reference.mesh(kind));
      std::mt19937 random(static_cast<unsigned>(kind) + 1);
      std::uniform_real_distribution<double> number(0, 1);
      for (int motion = 0; motion < 48; ++motion) {
        INFO(reference.name << ", mesh " << static_cast<int>(kind) << ", motion " << motion);
        const double tremble = motion % 4 == 0 ? 0 : 0.4 * number(random) * number(random),
                     change = 0.5 * number(random);
        Bend bend{.angle = 3 * number(random), .radius = edge * std::pow(30, number(random))};
        if (motion % 2 == 0)
          bend = {.angle = motion % 4 == 0 ? 0 : bend.angle,
                  .tilt = 0.2 + 1.6 * number(random),
                  .length = edge * (3 + std::pow(1000, number(random)))};
        if (motion % 8 == 0) bend = {.tilt = 1.0 + 0.12 * number(random), .length = 1};
        if (motion % 8 == 4)
          bend = {.tilt = 1.4 + 0.4 * number(random), .length = edge * (3 + 6 * number(random))};
        Bend after = bend;
        after.radius *= std::exp(-change);
        after.tilt *= 1 + 0.2 * change;
        const Vec3 axis = Vec3(number(random), number(random), 0.5).normalized();
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(3 * number(random), axis)),
            more(Eigen::AngleAxisd(change, axis));
        std::vector<Vec3> places = cloth.places;
        const Vec3 way = 2 * edge * Vec3(-number(random), 0.1 * number(random) - 0.25, 0);
        for (Vec3& x : places) x += reference.loose(x) * way;
        const std::vector<Vec3> start = bend.of(places, turn, tremble, random),
                                end = after.of(places, more * turn, tremble, random);
        const double gap = edge * 0.3 * number(random);
        cloth.unfolded.emplace(cloth.faces, *cloth.boxes, cloth.places);
        cloth.unfolded->look(start, end, gap);
        long near = 0;
        cloth.each_region([&](int region, const std::vector<Triangle>& triangles) {
          if (!cloth.unfolded->is_apart(region)) {
            ++folded;
            return;
          }
          ++told;
          near += !(least_distance(triangles, start, end) > gap);
        });
        CHECK(near == 0);
      }
    }
  CHECK(told > 1000);
  CHECK(folded > 1000);
}

TEST_CASE("a sheet that is bent a little is told to be unfolded everywhere", "[approach]") {
  for (const Kind kind : kinds)
    for (const double turn_in_a_step : {0.0, 0.3}) {
      INFO("mesh " << static_cast<int>(kind) << ", turned by " << turn_in_a_step);
      Patched cloth(sheet(kind));
      std::mt19937 random(3);
      const Bend bend{.angle = 0.4, .radius = 12 * edge};
      const auto at = [&](double angle) {
        return bend.of(cloth.places, Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::UnitX())), 0, random);
      };
      cloth.unfolded->look(at(2), at(2 + turn_in_a_step), 0.15 * edge);
      int regions = 0, told = 0;
      cloth.each_region([&](int region, const auto&) {
        ++regions;
        told += cloth.unfolded->is_apart(region);
      });
      CHECK(told > 0.98 * regions);
      CHECK(regions > 0.9 * n * n);  // there is none at a border that is not straight
    }
}

TEST_CASE("regions of unfolded cloth are the same on any number of threads", "[approach]") {
  const ThreadsRestored restored;
  for (const Kind kind : kinds) {
    const TriangleMesh saddle = bent(32, kind, 32 * edge, [](double x, double z) { return x * x - z * z; });
    const Bend bend{.angle = 0.4, .radius = 3 * edge};
    std::vector<bool> first;
    for (const int t : {1, 2, 7}) {
      INFO("mesh " << static_cast<int>(kind) << ", " << t << " threads");
      set_threads(t);
      Patched cloth(saddle);
      std::mt19937 random(3);
      const std::vector<Vec3> at = bend.of(cloth.places, Eigen::Quaterniond::Identity(), 0, random);
      cloth.unfolded->look(at, at, 0.15 * edge);
      std::vector<bool> told;
      cloth.each_region([&](int region, const auto&) { told.push_back(cloth.unfolded->is_apart(region)); });
      if (t == 1) first = told;
      CHECK(told == first);
      CHECK(std::count(told.begin(), told.end(), true) > 100);
      CHECK(std::count(told.begin(), told.end(), false) > 100);
    }
  }
}

TEST_CASE("what looks in a row tell stays apart", "[approach]") {
  for (const Kind kind : kinds) {
    INFO("mesh " << static_cast<int>(kind));
    Row row(kind);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(0, 1);
    const auto somewhere = [&] {
      Bend bend{.angle = 3 * number(random), .radius = edge * 2 * std::pow(30, number(random))};
      if (number(random) < 0.5)
        bend = {.angle = bend.angle, .tilt = 1.5 + 0.2 * number(random), .length = 0.3 * edge};
      return bend.of(row.cloth.places, Eigen::Quaterniond::Identity(), 0, random);
    };
    std::vector<Vec3> start = somewhere(), end = somewhere();
    for (int motion = 0; motion < 90; ++motion) {
      if (motion % 4 == 2) start = end;  // the next step
      if (motion % 7 == 6)
        start = somewhere();  // taken elsewhere
      else
        end = somewhere();
      row.look(start, end);
    }
    CHECK(row.told > 1000);
    const std::vector<Vec3>& flat = row.cloth.places;
    for (int look = 0; look < 60; ++look) {
      if (look % 10 == 9) CHECK(row.fewer == 0);  // nothing is left alone for long
      if (look % 20 == 9) row.look(somewhere(), flat);
      if (look % 20 == 19) row.look(flat, somewhere());
      row.look(flat, flat);
    }
  }
}

TEST_CASE("of places that are no numbers, or have no squares, nothing is told, and later all is again",
          "[approach]") {
  for (const Kind kind : kinds)
    for (const double place :
         {std::numeric_limits<double>::quiet_NaN(), 1e200, std::numeric_limits<double>::infinity()})
      for (const bool at_start : {false, true}) {
        INFO("mesh " << static_cast<int>(kind) << ", " << place
                     << (at_start ? " at the start" : " at the end"));
        Row row(kind);
        const std::vector<Vec3>& flat = row.cloth.places;
        std::vector<Vec3> wild = flat;
        for (std::size_t v = 0; v < wild.size(); v += 2) wild[v] *= place;
        row.cloth.unfolded->look(at_start ? wild : flat, at_start ? flat : wild, Row::gap);
        long told = 0;
        row.cloth.each_region([&](int region, const auto&) { told += row.cloth.unfolded->is_apart(region); });
        CHECK(told == 0);
        for (int look = 0; look < 10; ++look) row.look(flat, flat);
        CHECK(row.told_now > 0);
        CHECK(row.fewer == 0);
      }
}

TEST_CASE("a sheet that folds little by little is told to be unfolded until it is not", "[approach]") {
  long more = 0;
  for (const Kind kind : kinds)
    for (const double turns : {0.0, 0.03}) {
      INFO("mesh " << static_cast<int>(kind) << ", turns by " << turns << " rad in a step");
      Row row(kind);
      std::mt19937 random(3);
      constexpr int steps = 80;
      const auto at = [&](int step) {
        const Bend bend{.angle = 0.4, .tilt = 1e-6 + 1.7 * step / steps, .length = 2 * edge};
        return bend.of(row.cloth.places, Eigen::Quaterniond(Eigen::AngleAxisd(turns * step, Vec3::UnitX())),
                       0, random);
      };
      long told_at_the_middle = 0;
      for (int step = 0; step < steps; ++step) {
        row.look(at(step), at(step + 1));
        if (step == steps / 4) told_at_the_middle = row.told_now;
        if (step % 8 != 7) continue;
        for (int look = 0; look < 20; ++look) row.cloth.unfolded->look(at(step + 1), at(step + 1), Row::gap);
        row.look(at(step + 1), at(step + 1));
        CHECK(row.fewer == 0);  // of a sheet that stays as it is
      }
      more += row.more;
      CHECK(5 * told_at_the_middle > 4 * row.regions);
      CHECK(row.told_now < told_at_the_middle);
    }
  CHECK(more > 0);  // what is known goes on to hold where a first look does not tell it
}
