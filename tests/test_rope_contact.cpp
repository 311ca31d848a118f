// Ropes meet cloth, soft bodies and ropes: as thick as they are, with friction, and nothing passes through
// them.
#include <cmath>
#include <limits>

#include "mesh/distance/approach.h"
#include "mesh/distance/closest_on_triangle.h"
#include "mesh/distance/triangle_crossings.h"
#include "mesh/triangles/line.h"
#include "tests/ropes.h"
#include "tests/same_bits.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double g = 9.81;                          // m/s^2
constexpr double radius = 5e-3, thickness = 1e-3;   // m, of ropes and of cloth
constexpr double apart = radius + 0.5 * thickness;  // m, of their middles

struct Meeting : Assembly {
  using Assembly::Assembly;

  void add_sheet(const TriangleMesh& mesh, double friction = 0.3) {
    add(ClothPart{.mesh = mesh,
                  .fabric = {.area_density = 0.2, .stretch = 500, .bend = 1e-5, .damping = 0.01},
                  .imperfection = 0,
                  .self_contact = SelfContactOptions{.thickness = thickness, .friction = friction}});
  }
  void add_rope(const std::vector<Vec3>& points, double friction = 0.3,
                RopeMaterial material = {.mass_per_length = 0.05,
                                         .stretch = 1e4,
                                         .bend = 1e-4,
                                         .damping = 1,
                                         .bend_damping = 1e-5,
                                         .radius = radius}) {
    add(RopePart{.points = points, .material = material, .self_contact = RopeContact{.friction = friction}});
  }
  void hold(std::size_t k) {
    for (int i = cloths[k].first_particle; i < cloths[k].end_particle; ++i) constraints->pin(i);
  }
  void hold_rim(std::size_t k, double size) {
    for (int i = cloths[k].first_particle; i < cloths[k].end_particle; ++i)
      if (std::max(std::abs(at(i)[0]), std::abs(at(i)[2])) > 0.499 * size) constraints->pin(i);
  }
  Vec3 at(int i) const { return state.x.segment<3>(3 * i); }
  std::vector<Vec3> points(std::size_t k) const { return cloths[k].embedding.positions(state.x); }
  double tension(std::size_t k, int segment) const {  // N
    const RestEdge& e = cloths[k].edges[static_cast<std::size_t>(segment)];
    return cloths[k].rope->stretch * ((at(e.j) - at(e.i)).norm() / e.L - 1);
  }
  void throw_at(std::size_t k, const Vec3& v) {
    for (int i = cloths[k].first_particle; i < cloths[k].end_particle; ++i) state.v.segment<3>(3 * i) = v;
  }
  StepReport go(double h, int steps) {
    StepReport report;
    for (int n = 0; n < steps; ++n) {
      report = advance(h);
      INFO("step " << n << ": " << report.failure.what);
      REQUIRE(report.done);
    }
    return report;
  }
  double mass(std::size_t k) const {
    double sum = 0;
    for (int i = cloths[k].first_particle; i < cloths[k].end_particle; ++i) sum += system->masses()[i];
    return sum;
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < state.particles(); ++i) sum += system->masses()[i] * state.v.segment<3>(3 * i);
    return sum;
  }
  Vec3 momentum_about_origin() const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < state.particles(); ++i)
      sum += system->masses()[i] * at(i).cross(Vec3(state.v.segment<3>(3 * i)));
    return sum;
  }
  // The nearest and the farthest that a point of rope k is from the triangles of part l [m].
  std::pair<double, double> distances(std::size_t k, std::size_t l) const {
    const std::vector<Vec3> surface = points(l);
    double least = 1, most = 0;
    for (const Vec3& x : points(k)) {
      double nearest = 1;
      for (const Triangle& t : cloths[l].mesh.triangles)
        nearest = std::min(
            nearest, (closest_on_triangle(x, surface[t[0]], surface[t[1]], surface[t[2]]).first - x).norm());
      least = std::min(least, nearest);
      most = std::max(most, nearest);
    }
    return {least, most};
  }
  // The nearest that the axes of two ropes are, or those of one whose ends are farther apart along it than
  // `along` [m].
  double between(std::size_t k, std::size_t l, double along = 0) const {
    const std::vector<Vec3> p = points(k), q = points(l);
    double least = 1, from = 0;
    for (std::size_t i = 1; i < p.size(); from += cloths[k].edges[i - 1].L, ++i) {
      double to = 0;
      for (std::size_t j = 1; j < q.size(); to += cloths[l].edges[j - 1].L, ++j)
        if (k != l || to - from - cloths[k].edges[i - 1].L > along)
          least = std::min(least, nearest(true, {p[i - 1], p[i], q[j - 1], q[j]}).distance);
    }
    return least;
  }
  int crossings(std::size_t rope, std::size_t sheet) const {
    std::vector<Vec3> places = points(sheet);
    std::vector<Triangle> triangles = cloths[sheet].mesh.triangles;
    const int first = static_cast<int>(places.size()), count = cloths[rope].mesh.vertex_count();
    for (const Vec3& x : points(rope)) places.push_back(x);
    for (int k = 1; k < count; ++k) triangles.push_back({first + k - 1, first + k, first + k});
    return crossing_count(crossing_contours(places, triangles, count - 1));
  }
};

TriangleMesh placed(TriangleMesh mesh, const Vec3& place) {
  for (Vec3& x : mesh.positions) x += place;
  return mesh;
}

}  // namespace

TEST_CASE("a segment crosses the triangle that it passes through, and no other", "[rope-contact]") {
  const auto count = [](const Vec3& from, const Vec3& to) {
    const std::vector<Vec3> x = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, from, to};
    return crossing_count(crossing_contours(x, {{0, 1, 2}, {3, 4, 4}}, 1));
  };
  CHECK(count({0.2, -1, 0.2}, {0.2, 1, 0.2}) == 1);
  CHECK(count({0.2, 1, 0.2}, {0.3, -1, 0.2}) == 1);
  CHECK(count({0.2, 1e-12, 0.2}, {0.2, 1, 0.2}) == 0);
  CHECK(count({0.7, -1, 0.7}, {0.7, 1, 0.7}) == 0);
  CHECK(count({0.2, 0, 0.2}, {0.2, 1, 0.2}) == 0);  // it touches
  const std::vector<Vec3> x = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0.2, -1, 0.2}, {0.2, 1, 0.2}};
  CHECK(crossing_contours(x, {{0, 1, 2}, {3, 4, 4}}).empty());  // a triangle that names a vertex twice
  const std::vector<CrossingContour> one = crossing_contours(x, {{0, 1, 2}, {3, 4, 4}}, 1);
  REQUIRE(one.size() == 1);
  CHECK(one[0].passages.size() == 1);
  CHECK((one[0].place - Vec3(0.2, 0, 0.2)).norm() < 1e-15);
}

TEST_CASE("a rope rests on a taut sheet at its radius and half of the sheet's thickness", "[rope-contact]") {
  for (const char* name : {"implicit-euler", "bdf2", "pbd"})
    for (const double spacing : {2.5e-3, 1e-2, 6e-2}) {  // below the radius, the sheet's edges, and longer
      CAPTURE(name, spacing);
      Meeting all;
      all.add_sheet(grid(21, 21, 0.4, 0.4));
      all.hold(0);
      const int segments = static_cast<int>(std::lround(0.24 / spacing));
      all.add_rope(straight({-0.113, apart + 1e-3, 0.021}, {0.117, apart + 1e-3, 0.052}, segments));
      all.use(name, "auto", {.tolerance = 1e-6});
      const StepReport report = all.go(0.01, 60);
      CHECK(report.self_contacts > 0);
      const auto [least, most] = all.distances(1, 0);
      CHECK(least > apart - 1e-4);
      CHECK(most < apart + 1e-6);
    }
}

TEST_CASE("a rope rests on a soft block", "[rope-contact]") {
  Meeting all;
  all.add(SoftPart{.name = "block",
                   .lattice = box_lattice({7, 4, 5}, Vec3::Constant(0.02)),
                   .material = {.density = 300, .young = 1e5, .damping = 0.02},
                   .self_contact = SelfContactOptions{.thickness = thickness, .friction = 0.3}});
  for (int i = 0; i < all.state.particles(); ++i)
    if (all.at(i)[1] < -0.029) all.constraints->pin(i);
  all.add_rope(straight({-0.05, 0.03 + apart + 1e-3, 0.011}, {0.05, 0.03 + apart + 1e-3, -0.013}, 12));
  all.use("implicit-euler", "auto", {.tolerance = 1e-6});
  all.go(0.01, 100);
  const auto [least, most] = all.distances(1, 0);
  CHECK(least > apart - 1e-4);
  CHECK(most < apart + 1e-6);
}

TEST_CASE("a rope sticks on a slope below its friction and slides as Coulomb says above it",
          "[rope-contact]") {
  constexpr double mu = 0.4, h = 0.01;
  for (const double tangent : {0.75 * mu, 2 * mu})
    for (const Vec3& along : {Vec3(0.1, 0, 0), Vec3(0, 0, 0.1), Vec3(0.06, 0, 0.08)}) {
      CAPTURE(tangent, along.transpose());
      const double angle = std::atan(tangent);
      Meeting all(g * Vec3(std::sin(angle), -std::cos(angle), 0));
      all.add_sheet(placed(grid(29, 15, 0.7, 0.35), {0.2, 0, 0}), mu);
      all.hold(0);
      all.add_rope(straight(Vec3(0, apart - 2e-5, 0.003) - along, Vec3(0, apart - 2e-5, 0.003) + along, 24),
                   mu);
      all.use("implicit-euler", "auto", {.tolerance = 1e-6});
      const auto place = [&] {
        double sum = 0;
        for (const Vec3& x : all.points(1)) sum += x[0] / 25;
        return sum;
      };
      all.go(h, 10);
      const double before = place(), speed = all.momentum()[0];
      constexpr int steps = 20;
      all.go(h, steps);
      if (tangent < mu)
        CHECK(std::abs(place() - before) < 1e-6);
      else
        CHECK((all.momentum()[0] - speed) / all.mass(1) / (steps * h) ==
              Approx(g * (std::sin(angle) - mu * std::cos(angle))).epsilon(0.02));
    }
}

TEST_CASE("a rope drawn over a cylinder of cloth pulls exp(mu phi) times as hard as what holds it back",
          "[rope-contact]") {
  constexpr double R = 0.1, mass = 1;  // m, kg
  constexpr int sides = 106;  // no multiple of the rope's segments, or all would pass its edges at once
  for (const double mu : {0.2, 0.4}) {
    TriangleMesh drum;
    const std::vector<Vec3> axis = straight({0, 0, -0.02}, {0, 0, 0.02}, 4);
    drum.positions = tube_positions(axis, R, sides);
    drum.triangles = tube_triangles(5, sides);
    Meeting all;
    all.add_sheet(drum, mu);
    all.hold(0);
    constexpr double r = R + apart;
    std::vector<Vec3> course = {{-r, -0.5, 0}};
    for (int k = 0; k <= 96; ++k)
      course.emplace_back(-r * std::cos(M_PI * k / 96), r * std::sin(M_PI * k / 96), 0);
    course.emplace_back(r, -0.2, 0);
    const int segments = static_cast<int>(std::lround(length_of(course) / (M_PI * r / 49)));
    all.add_rope(evenly_divided(course, segments), mu,
                 {.mass_per_length = 2e-3, .stretch = 5e3, .bend = 0, .damping = 5, .radius = radius});
    const int first = all.cloths[1].first_particle, last = first + segments;
    const Vec3 hook = all.at(first) - Vec3(0, 0.05, 0);
    all.constraints->add({.shape = Box{hook, Vec3::Constant(0.1), Mat3::Identity()},
                          .margin = 0,
                          .rigid = RigidBody{.mass = mass,
                                             .inertia = mass * 0.01 / 6 * Mat3::Identity(),
                                             .centre = hook,
                                             .gravity = {0, -g, 0}}});
    all.constraints->pin_to_body({first}, 0, all.state.x);
    all.constraints->pin_along({last}, Motion::constant({0, -0.1, 0}, Vec3::Zero(), Vec3::Zero()),
                               all.state.x);
    all.use("implicit-euler", "auto", {.tolerance = 1e-6});
    double low = 0, high = 0;
    for (int n = 0; n < 300; ++n) {
      all.go(2e-3, 1);
      if (n < 150) continue;
      low += all.tension(1, 2) / 150;
      high += all.tension(1, segments - 3) / 150;
    }
    CAPTURE(mu, low, high, high / low);
    CHECK(low == Approx(g * mass).epsilon(0.01));
    CHECK(high / low == Approx(std::exp(mu * M_PI)).epsilon(0.02));
  }
}

TEST_CASE("two ropes that are pulled against each other do not pass", "[rope-contact]") {
  for (const char* name : {"implicit-euler", "pbd"})
    for (const int segments : {6, 60}) {  // longer and shorter than the ropes are thick
      CAPTURE(name, segments);
      Meeting all;
      all.add_rope(straight({-0.3, 0, 0}, {0.3, 0, 0}, segments));
      all.add_rope(straight({0.011, 2.2 * radius, -0.3}, {0.017, 2.2 * radius, 0.3}, segments));
      const int first = all.cloths[1].first_particle, last = all.cloths[1].end_particle - 1;
      all.constraints->pin({0, segments});
      all.constraints->pin_along({first, last}, Motion::constant({0, -0.4, 0}, Vec3::Zero(), Vec3::Zero()),
                                 all.state.x);
      all.use(name, "auto", {.tolerance = 1e-5});
      all.go(5e-3, 80);  // by 16 cm: both are stretched by a tenth
      CHECK(all.tension(0, segments / 2) > 50);
      CHECK(all.between(0, 1) > 1.9 * radius);
      const auto lowest = [&](std::size_t k) {
        double least = 1;
        for (const Vec3& x : all.points(k)) least = std::min(least, x[1]);
        return least;
      };
      CHECK(lowest(0) < -0.05);  // it is drawn down by the other
      CHECK(lowest(1) < lowest(0) - 0.05);
    }
}

TEST_CASE("a rope that is thrown at a sheet does not pass, however fast", "[rope-contact]") {
  for (const char* name : {"implicit-euler", "pbd", "symplectic-euler"}) {
    CAPTURE(name);
    const double h = std::string_view(name) == "symplectic-euler" ? 1e-4 : 0.01;
    Meeting all;
    all.add_sheet(grid(17, 17, 0.4, 0.4));
    all.hold_rim(0, 0.4);
    std::vector<Vec3> points;
    for (int k = 0; k <= 30; ++k)
      points.emplace_back(-0.1 + 0.2 * k / 30, 0.05 + 0.01 * std::sin(0.7 * k), 0.02 * std::cos(0.5 * k));
    if (std::string_view(name) == "symplectic-euler")  // soft enough for such steps
      all.add_rope(points, 0.3, {.mass_per_length = 0.05, .stretch = 50, .bend = 1e-6, .radius = radius});
    else
      all.add_rope(points);
    all.use(name, "auto", {.tolerance = 1e-4});
    all.throw_at(1, {0.5, -10, 0.2});
    for (int n = 0; n * h < 0.1; ++n) {
      all.go(h, 1);
      REQUIRE(all.crossings(1, 0) == 0);
      for (int i = all.cloths[1].first_particle; i < all.cloths[1].end_particle; ++i) {
        if (std::max(std::abs(all.at(i)[0]), std::abs(all.at(i)[2])) > 0.15) continue;
        double height = 1;  // over the sheet
        for (int k = 0; k < all.cloths[0].end_particle; ++k)
          if ((all.at(k) - all.at(i)).cwiseProduct(Vec3(1, 0, 1)).norm() < 0.02)
            height = std::min(height, all.at(i)[1] - all.at(k)[1]);
        CHECK(height > -0.02);
      }
    }
  }
}

TEST_CASE("ropes that collide keep their momentum", "[rope-contact]") {
  for (const double friction : {0.0, 0.5}) {
    CAPTURE(friction);
    Meeting all(Vec3::Zero());
    all.add_rope(straight({-0.1, 0, 0}, {0.1, 0, 0}, 20), friction);
    all.add_rope(straight({0.02, 0.015, -0.1}, {0.01, 0.02, 0.12}, 13), friction);
    all.use("implicit-euler", "auto", {.tolerance = 1e-10, .contact_tolerance = 1e-8});
    all.throw_at(1, {0.2, -1, 0.1});
    const Vec3 before = all.momentum(), about = all.momentum_about_origin();
    const double size = before.norm() * 0.1;  // of the momentum about the origin
    double energy = all.system->total_energy(all.state);
    int met = 0;
    for (int n = 0; n < 300; ++n) {
      met = std::max(met, all.go(5e-4, 1).self_contacts);
      const double now = all.system->total_energy(all.state);
      CHECK(now < energy * (1 + 1e-3));
      energy = now;
    }
    CHECK(met > 0);
    CHECK((all.momentum() - before).norm() < 1e-7 * before.norm());
    CHECK((all.momentum_about_origin() - about).norm() < 0.02 * size);  // of first order in the step
    double lower = 0;                                                   // it was pushed
    for (int i = 0; i < all.cloths[0].end_particle; ++i)
      lower += all.system->masses()[i] * all.state.v[3 * i + 1];
    CHECK(lower < 0.2 * before[1]);
  }
}

TEST_CASE("what follows along a rope does not push, and a knot that is drawn tight does", "[rope-contact]") {
  SECTION("straight, and bent to twice the radius") {
    for (const double bend : {0.0, 1 / (2 * radius)}) {  // 1/m
      CAPTURE(bend);
      std::vector<Vec3> points;
      constexpr double spacing = radius / 4;
      for (int k = 0; k <= 24; ++k) {  // three quarters of a circle would be 38 of them
        const double s = k * spacing;
        points.push_back(bend > 0 ? Vec3(std::sin(bend * s) / bend, (1 - std::cos(bend * s)) / bend, 0)
                                  : Vec3(s, 0, 0));
      }
      Meeting all(Vec3::Zero());
      all.add_rope(straight(Vec3::Zero(), {24 * spacing, 0, 0}, 24), 0.3,
                   {.mass_per_length = 0.05, .stretch = 1e4, .bend = 0, .radius = radius});
      all.use("implicit-euler", "auto", {.tolerance = 1e-8});
      all.advance(1e-3);  // it rests straight
      for (int k = 0; k <= 24; ++k) all.state.x.segment<3>(3 * k) = points[static_cast<std::size_t>(k)];
      all.state.v.setZero();
      CHECK(all.go(1e-3, 1).self_contacts == 0);
    }
  }
  SECTION("a knot") {
    for (const int segments : {60, 240}) {
      CAPTURE(segments);
      constexpr double a = 0.02;  // m
      const auto trefoil = [&](double t) {
        return Vec3(
            a * Vec3(std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)));
      };
      std::vector<Vec3> course = {Vec3::Zero()};  // an overhand knot, which is a trefoil that is cut open
      for (int k = 1; k < 60; ++k) course.push_back(trefoil(M_PI / 3 + 2 * M_PI * k / 60));
      const Vec3 out = trefoil(M_PI / 3).normalized(), way = (course[2] - course[1]).normalized();
      course[0] = course[1] + 0.06 * out + 0.1 * way;
      course.push_back(course.back() + 0.06 * out - 0.1 * way);
      Meeting all(Vec3::Zero());
      all.add_rope(evenly_divided(course, segments));
      const auto draw = [](const Vec3& v) { return Motion::constant(v, Vec3::Zero(), Vec3::Zero()); };
      all.constraints->pin_along({0}, draw(0.4 * way), all.state.x);
      all.constraints->pin_along({segments}, draw(-0.4 * way), all.state.x);
      all.use("implicit-euler", "auto", {.tolerance = 1e-5});
      int met = 0;
      for (int n = 0; n < 100; ++n) {
        met = std::max(met, all.go(5e-3, 1).self_contacts);
        REQUIRE(all.between(0, 0, 5 * radius) > 1.5 * radius);
      }
      CHECK(all.between(0, 0, 5 * radius) < 2.1 * radius);  // the knot is still there
      CHECK(met > 0);
    }
  }
}

TEST_CASE("a rope presses on nothing beside its joint", "[rope-contact]") {
  Meeting all;
  all.add_sheet(grid(21, 21, 0.05, 0.05));  // edges of half of the rope's radius
  const int middle = 10 * 21 + 10;
  const Vec3 x = all.at(middle);
  all.add(RopePart{.points = straight(x, x + Vec3(0, 0.1, 0), 40),
                   .material = {.mass_per_length = 0.05, .bend = 1e-5, .damping = 1, .radius = radius},
                   .first = middle,
                   .self_contact = RopeContact{}});
  const int first = all.cloths[1].first_particle;
  all.constraints->pin(all.cloths[1].end_particle - 1);
  all.use("implicit-euler", "auto", {.tolerance = 1e-5});
  int presses = 0;
  for (int n = 0; n < 100; ++n) {  // the sheet comes down round its middle, and hangs
    all.go(5e-3, 1);
    for (const SelfContact& c : all.constraints->self().pushed())
      presses +=
          c.before > 0 && std::any_of(c.who.v.begin(), c.who.v.end(), [&](int v) { return v >= first; });
  }
  CHECK(presses == 0);
  CHECK(all.tension(1, 1) > 0.5 * g * all.mass(0));
  CHECK(all.crossings(1, 0) == 0);
}

TEST_CASE("ropes on a sheet have the same bits on any number of threads", "[rope-contact]") {
  check_same_bits([] {
    Meeting all;
    all.add_sheet(grid(56, 56, 0.4, 0.4));
    all.hold_rim(0, 0.4);
    for (int k = 0; k < 4; ++k)
      all.add_rope(straight({-0.1, 0.01 + 0.02 * k, -0.03 * k}, {0.1, 0.02 + 0.02 * k, 0.05 * k - 0.1}, 40));
    all.use("implicit-euler", "auto", {.tolerance = 1e-4});
    const StepReport report = all.go(0.01, 8);
    CHECK(report.self_contacts > 0);
    return all.state;
  });
}

TEST_CASE("a rope that starts through a sheet comes out of it", "[rope-contact]") {
  Meeting all(Vec3::Zero());
  all.add_sheet(grid(11, 11, 0.2, 0.2));
  all.hold(0);
  all.add_rope(straight({0.003, -0.012, 0.004}, {0.005, 0.1, 0.002}, 20));
  all.use("implicit-euler", "auto", {.tolerance = 1e-4});
  CHECK(all.crossings(1, 0) == 1);
  for (int n = 0; n < 100; ++n) {
    const StepReport report = all.go(0.01, 1);
    if (n == 0) CHECK(report.tangled > 0);
  }
  CHECK(all.crossings(1, 0) == 0);
  for (const Vec3& x : all.points(1)) CHECK(x[1] > 0);  // on the side of the heavier part
}

// Bodies meet ropes by their particles; that they have triangles as well is no business of a rope's.
TEST_CASE("a rope with self_contact alone falls on bodies with triangles as one without", "[rope-contact]") {
  const Box box{.centre = {0, -0.03, 0}, .size = {0.1, 0.04, 0.1}};
  const Motion later =
      Motion::keyframes({{.time = 10}, {.time = 11, .translate = {0, 0.1, 0}}}, Vec3::Zero());
  const Obstacle bodies[] = {
      {.shape = box, .motion = later},
      {.shape = std::make_shared<const SurfaceDistance>(mesh_of(Shape(box)))},
  };
  for (const Obstacle& body : bodies)
    for (int segments : {10, 20, 40}) {
      INFO(name(body.shape) << ", " << segments << " segments");
      VecX ends[2];
      for (const bool meets : {false, true}) {
        Meeting all;
        all.constraints->add(body);
        std::vector<Vec3> points;
        for (int k = 0; k <= segments; ++k) points.emplace_back(-0.2 + 0.4 * k / segments, 0.02, 0.003);
        RopePart rope{.points = points,
                      .material = {.mass_per_length = 0.05, .stretch = 1e4, .bend = 1e-4, .radius = radius}};
        if (meets) rope.self_contact = RopeContact{.friction = 0.3};
        all.add(std::move(rope));
        all.use("implicit-euler", "auto");
        all.go(0.01, 20);
        ends[meets] = all.state.x;
      }
      CHECK((ends[0] - ends[1]).lpNorm<Eigen::Infinity>() < 1e-9);
    }
}

TEST_CASE("a friction of a rope that makes no sense is refused", "[rope-contact]") {
  Assembly all;
  CHECK_THROWS_WITH(all.add(RopePart{.points = straight(Vec3::Zero(), {1, 0, 0}, 3),
                                     .self_contact = RopeContact{.friction = -1}}),
                    Catch::Contains("friction"));
}
