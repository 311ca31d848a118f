// Bodies that cloth with self_contact meets with their triangles: nothing comes through, whichever of them
// moves.
#include "mesh/base/threads.h"
#include "mesh/distance/triangle_crossings.h"
#include "solver/assembly/assembly.h"
#include "tests/integrators.h"
#include "tests/same_bits.h"
#include "tests/sheets.h"
#include "tests/together.h"

using namespace drape;
using namespace drape::test;

namespace {

Shape mesh_body(const TriangleMesh& mesh) { return std::make_shared<const SurfaceDistance>(mesh); }

// A cone along y whose tip is near the origin, but beside every vertex and edge of a sheet about it.
TriangleMesh spike(double radius, double height) {
  TriangleMesh mesh = turned({{0, -height}, {radius, -height}, {0, 0}}, 12);
  for (Vec3& x : mesh.positions) x += Vec3(0.0031, 0, 0.0047);
  return mesh;
}

TriangleMesh flat(int n, Kind kind, double size) {
  return bent(n, kind, size, [](double, double) { return 0.0; });
}

struct Beside : Assembly {
  using Assembly::Assembly;

  void add_sheet(const TriangleMesh& mesh) {
    add(ClothPart{.mesh = mesh,
                  .fabric = {.area_density = 0.2, .stretch = 500, .bend = 1e-5, .damping = 0.002},
                  .model = ClothModel::woven,
                  .self_contact = SelfContactOptions{.thickness = 1e-3, .friction = 0.3}});
  }
  void add_sheet_held_beyond(double x, const TriangleMesh& mesh) {
    add_sheet(mesh);
    for (int i = 0; i < mesh.vertex_count(); ++i)
      if (std::abs(mesh.positions[i][0]) > x) constraints->pin(i);
  }
  // Pairs of a triangle of the cloth and one of a body.
  int crossings() const {
    std::vector<Vec3> places = unstacked(state.x);
    std::vector<Triangle> triangles = cloths[0].mesh.triangles;
    const auto of_cloth = static_cast<int>(triangles.size());
    for (const MovingBody& body : constraints->bodies()) {
      const int first = static_cast<int>(places.size());
      const TriangleMesh& mesh = *body.skin();
      for (int v = 0; v < mesh.vertex_count(); ++v) places.push_back(body.vertex_at_end(v));
      for (const Triangle& t : mesh.triangles)
        triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    return crossing_count(contours_between(places, triangles, of_cloth));
  }
  Vec3 angular_momentum() const {  // of the cloth and of the first body, about the origin
    const ReactingBody& body = *constraints->bodies()[0].reacting();
    Vec3 sum = body.angular_momentum() + body.centre().cross(body.momentum());
    for (int i = 0; i < state.particles(); ++i)
      sum += system->masses()[i] * Vec3(state.x.segment<3>(3 * i)).cross(Vec3(state.v.segment<3>(3 * i)));
    return sum;
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < state.particles(); ++i) sum += system->masses()[i] * state.v.segment<3>(3 * i);
    return sum;
  }
};

// A needle whose tip goes this way [m] up from 2 cm below the origin, and then stays.
Obstacle needle_that_is_led(double way, double speed) {
  return {.shape = mesh_body(spike(2e-3, 0.15)),
          .motion = Motion::keyframes({{.time = 0, .translate = {0, -0.02, 0}},
                                       {.time = way / speed, .translate = {0, way - 0.02, 0}}},
                                      Vec3::Zero())};
}

// The same as a mesh that deforms.
Obstacle needle_by_frames(double way, double speed) {
  const TriangleMesh needle = spike(2e-3, 0.15);
  const auto frames = std::make_shared<MeshFrames>();
  TriangleMesh start;
  for (const auto& [time, up] :
       {std::pair(0.0, 0.0), std::pair(way / speed, way), std::pair(way / speed + 1, way)}) {
    TriangleMesh moved = needle;
    for (Vec3& x : moved.positions) x[1] += up - 0.02;
    frames->add(time, moved.positions);
    if (time == 0) start = moved;
  }
  return {.shape = DeformingBody{std::make_shared<SurfaceDistance>(start), frames}};
}

}  // namespace

TEST_CASE("a sheet that falls on a spike is not pierced", "[surfaces]") {
  for (const std::string name : {"implicit-euler", "bdf2", "symplectic-euler"})
    for (int n : {12, 16, 22})
      for (Kind kind : kinds) {
        const bool implicit = name != "symplectic-euler";
        if (!implicit && n > 12) continue;  // many short steps
        INFO(name << ", " << n << " vertices along an edge, kind " << static_cast<int>(kind));
        Beside all;
        all.constraints->add(Obstacle{.shape = mesh_body(spike(0.03, 0.3))});
        TriangleMesh sheet = flat(n, kind, 0.3);
        for (Vec3& x : sheet.positions) x[1] += 0.02;
        all.add_sheet(sheet);
        all.use(name, "auto");
        const double h = implicit ? 0.01 : 5e-5;
        for (int k = 0; k * h < 0.4; ++k) {
          INFO("step " << k);
          REQUIRE(all.advance(h).done);
          if (k % (implicit ? 1 : 200) == 0) REQUIRE(all.crossings() == 0);
        }
        CHECK(all.crossings() == 0);
      }
}

TEST_CASE("a needle that is driven into a hung sheet pushes it ahead", "[surfaces]") {
  for (const auto& [speed, by_frames] : {std::pair(0.5, false), std::pair(5.0, false), std::pair(0.5, true)})
    for (int n : {9, 15, 23})
      for (Kind kind : kinds) {
        INFO(speed << " m/s, " << n << " vertices along an edge, kind " << static_cast<int>(kind)
                   << (by_frames ? ", by frames of a mesh" : ""));
        const double way = 0.06;
        Beside all{Vec3::Zero()};
        all.constraints->add(by_frames ? needle_by_frames(way, speed) : needle_that_is_led(way, speed));
        const TriangleMesh sheet = flat(n, kind, 0.3);
        all.add_sheet_held_beyond(0.14, sheet);
        all.use("implicit-euler", "auto");
        for (int k = 0; k * 0.01 < way / speed + 0.1; ++k) {
          INFO("step " << k);
          const StepReport report = all.advance(0.01);
          REQUIRE(report.done);
          CHECK(report.pinched == 0);
          REQUIRE(all.crossings() == 0);
        }
        double highest = 0;
        for (int i = 0; i < all.state.particles(); ++i) highest = std::max(highest, all.state.x[3 * i + 1]);
        CHECK(highest > 0.6 * (way - 0.02));
      }
}

TEST_CASE("a spiked body with mass that meets a free sheet keeps the momentum of both", "[surfaces]") {
  for (const std::string name : {"implicit-euler", "bdf2"})
    for (Kind kind : kinds) {
      const int n = 12;
      // bdf2 keeps the momentum of both to first order (docs/limits.md).
      const double to = name == "bdf2" ? 0.1 : 1e-3, h = name == "bdf2" ? 1e-3 : 5e-3;
      INFO(name << ", kind " << static_cast<int>(kind));
      Beside all{Vec3::Zero()};
      const Shape shape = mesh_body(spike(0.02, 0.1));
      const double mass = 0.02;
      const auto solid = uniform_solid(shape, mass);
      REQUIRE(solid);
      all.constraints->add(Obstacle{.shape = shape,
                                    .rigid = RigidBody{.mass = mass,
                                                       .inertia = solid->inertia,
                                                       .centre = solid->centre,
                                                       .velocity = {0, 1, 0},
                                                       .gravity = Vec3::Zero()}});
      TriangleMesh sheet = flat(n, kind, 0.2);
      for (Vec3& x : sheet.positions) x[1] += 0.01;
      all.add_sheet(sheet);
      all.use(name, "auto", {.tolerance = 1e-8});
      const Vec3 turn = all.angular_momentum();
      for (int k = 0; k * h < 0.06; ++k) {
        INFO("step " << k);
        REQUIRE(all.advance(h).done);
        REQUIRE(all.crossings() == 0);
        const Vec3 body = all.constraints->bodies()[0].reacting()->momentum();
        CHECK((body + all.momentum() - Vec3(0, mass, 0)).norm() < to * mass);
        // An implicit step keeps it to first order; a push beside the point of contact would be off by 0.05.
        CHECK((all.angular_momentum() - turn).norm() < std::max(to, 0.01) * mass * 0.1);
      }
      CHECK(all.momentum()[1] > 0.05 * mass);
    }
}

// Shapes wider and narrower than an edge of the sheet: none may come through, by a corner, a rim or as a
// whole, without being told; and hardly any may be told.
TEST_CASE("a body of any shape that falls on a hung sheet is held by it", "[surfaces]") {
  const Shape shapes[] = {
      Box{.centre = {0.013, 0.1, 0.007}, .size = Vec3::Constant(0.04)},
      Box{.centre = {0.013, 0.1, 0.007}, .size = {0.1, 0.01, 0.1}},
      Plate{.centre = {0.013, 0.1, 0.007}, .radius = 0.05, .height = 0.01, .axis = Vec3(0.3, 1, 0.1)},
      Sphere{.centre = {0.013, 0.1, 0.007}, .radius = 0.03},
      Capsule{.a = {-0.03, 0.1, 0.007}, .b = {0.05, 0.12, 0.027}, .radius = 0.008},
  };
  int passed = 0;
  for (const Shape& shape : shapes)
    for (int n : {7, 10, 16})
      for (Kind kind : kinds) {
        INFO(name(shape) << ", " << n << " vertices along an edge, kind " << static_cast<int>(kind));
        const double mass = 0.4;
        const auto solid = uniform_solid(shape, mass);
        REQUIRE(solid);
        Beside all;
        all.constraints->add(Obstacle{
            .shape = shape,
            .rigid = RigidBody{
                .mass = mass, .inertia = solid->inertia, .centre = solid->centre, .velocity = {0, -1.5, 0}}});
        const TriangleMesh sheet = flat(n, kind, 0.4);
        all.add_sheet_held_beyond(0.19, sheet);
        all.use("implicit-euler", "auto");
        bool told = false;
        for (int k = 0; k < 40; ++k) {
          INFO("step " << k);
          const StepReport report = all.advance(0.01);
          REQUIRE(report.done);
          told = told || report.pinched > 0;
          REQUIRE((told || all.crossings() == 0));
        }
        passed += told;
        CHECK((!told || std::holds_alternative<Capsule>(shape)));
        double lowest = 0;
        for (int i = 0; i < all.state.particles(); ++i) lowest = std::min(lowest, all.state.x[3 * i + 1]);
        CHECK((told || all.constraints->bodies()[0].reacting()->centre()[1] > lowest));
      }
  CHECK(passed <= 1);  // of 45
}

// The polyhedron of a round shape lies below its surface: what starts between both, or in both, comes out as
// from a body that stands, which has no polyhedron.
TEST_CASE("cloth that starts inside a round shape comes out, whether the shape moves or not", "[surfaces]") {
  constexpr double radius = 0.25;
  const Motion later =
      Motion::keyframes({{.time = 10}, {.time = 11, .translate = {0, 0.1, 0}}}, Vec3::Zero());
  const Shape shapes[] = {Sphere{.radius = radius},
                          Capsule{.a = {-0.2, 0, 0}, .b = {0.2, 0, 0}, .radius = radius}};
  for (const Shape& shape : shapes)
    for (const double depth : {1e-3, 2e-3, 3.5e-3, 6e-3})
      for (int n : {9, 13, 19})
        for (Kind kind : kinds) {
          INFO(name(shape) << ", " << depth << " m inside, " << n << " vertices along an edge, kind "
                           << static_cast<int>(kind));
          std::array<double, 2> strain{}, least{};
          for (const bool moves : {false, true}) {
            Beside all{Vec3::Zero()};
            all.constraints->add(Obstacle{.shape = shape, .motion = moves ? later : Motion()});
            TriangleMesh sheet = flat(n, kind, 0.06);
            for (Vec3& x : sheet.positions) {
              if (std::holds_alternative<Capsule>(shape))
                x[1] = std::sqrt(std::pow(radius - depth, 2) - x[2] * x[2]);
              else
                x = (radius - depth) * Vec3(x + Vec3(0, radius, 0)).normalized();
            }
            all.add_sheet(sheet);
            all.use("implicit-euler", "auto");
            for (int k = 0; k < 20; ++k) {
              REQUIRE(all.advance(0.01).done);
              for (const Triangle& t : sheet.triangles)
                for (std::size_t c = 0; c < 3; ++c) {
                  const int i = 3 * t[c], j = 3 * t[(c + 1) % 3];
                  const double rest = (sheet.positions[t[c]] - sheet.positions[t[(c + 1) % 3]]).norm();
                  const double now = (all.state.x.segment<3>(i) - all.state.x.segment<3>(j)).norm();
                  strain[moves] = std::max(strain[moves], std::abs(now / rest - 1));
                }
            }
            least[moves] = 1;
            for (int i = 0; i < all.state.particles(); ++i)
              least[moves] = std::min(least[moves], closest(shape, all.state.x.segment<3>(3 * i)).distance);
          }
          CHECK(strain[1] < strain[0] + 0.02);
          CHECK(least[1] > 1.9e-3);
        }
}

TEST_CASE("a thin box that is driven edge-on into a hung sheet pushes it ahead", "[surfaces]") {
  for (double speed : {0.5, 3.0})
    for (int n : {9, 15, 23})
      for (Kind kind : kinds) {
        INFO(speed << " m/s, " << n << " vertices along an edge, kind " << static_cast<int>(kind));
        const double way = 0.06;
        Beside all{Vec3::Zero()};
        all.constraints->add(
            Obstacle{.shape = Box{.centre = {0.003, -0.05, 0.005}, .size = {0.15, 0.1, 0.002}},
                     .motion = Motion::keyframes({{.time = 0, .translate = {0, -0.01, 0}},
                                                  {.time = way / speed, .translate = {0, way - 0.01, 0}}},
                                                 Vec3::Zero())});
        const TriangleMesh sheet = flat(n, kind, 0.3);
        all.add_sheet_held_beyond(0.14, sheet);
        all.use("implicit-euler", "auto");
        for (int k = 0; k * 0.01 < way / speed + 0.05; ++k) {
          INFO("step " << k);
          REQUIRE(all.advance(0.01).done);
          REQUIRE(all.crossings() == 0);
        }
      }
}

TEST_CASE("cloth that starts through a body comes out of it, and is then kept out", "[surfaces]") {
  for (int n : {13, 18, 25}) {
    INFO(n << " vertices along an edge");
    Beside all;
    all.constraints->add(Obstacle{.shape = mesh_body(sphere(3, 0.1)), .motion = {}});
    TriangleMesh sheet = flat(n, Kind::squares, 0.3);
    for (Vec3& x : sheet.positions) x[1] += 0.09;  // the ball's top is 1 cm above it
    all.add_sheet(sheet);
    all.use("implicit-euler", "auto");
    CHECK(all.crossings() > 0);
    for (int k = 0; k < 60; ++k) {
      const StepReport report = all.advance(0.01);
      REQUIRE(report.done);
      if (k == 0) CHECK(report.pinched > 0);
      if (k < 40) continue;
      CHECK(report.pinched == 0);
      REQUIRE(all.crossings() == 0);
    }
  }
}

TEST_CASE("a sheet goes round with a turning body that holds it by its spikes", "[surfaces]") {
  TriangleMesh body = box({0.1, 0.1, 0.1});
  for (double x : {-0.03, 0.031})
    for (double z : {-0.029, 0.032}) {
      TriangleMesh nail = spike(0.004, 0.06);
      const int first = body.vertex_count();
      for (const Vec3& p : nail.positions) body.positions.push_back(p + Vec3(x, 0.08, z));
      for (const Triangle& t : nail.triangles)
        body.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  Beside all;
  all.constraints->add(Obstacle{.shape = mesh_body(body),
                                .friction = 1.0,
                                .motion = Motion::constant(Vec3::Zero(), {0, 6, 0}, Vec3::Zero(), 0.5, 1.5)});
  TriangleMesh sheet = flat(17, Kind::irregular, 0.25);
  for (Vec3& x : sheet.positions) x[1] += 0.085;
  all.add_sheet(sheet);
  all.use("implicit-euler", "auto");
  double strain = 0;
  for (int k = 0; k < 150; ++k) {
    INFO("step " << k);
    REQUIRE(all.advance(0.01).done);
    REQUIRE(all.crossings() == 0);
    strain = std::max(strain, largest_strain(all.cloths, all.state.x));
  }
  CHECK(strain < 0.2);
  // It has gone round by 6 rad, as the mean of where its vertices were says.
  double sine = 0, cosine = 0;
  const Cloth& cloth = all.cloths[0];
  for (int i = 0; i < cloth.mesh.vertex_count(); ++i) {
    const Vec3 &before = cloth.mesh.positions[i], after = all.state.x.segment<3>(3 * i);
    cosine += before[0] * after[0] + before[2] * after[2];
    sine += before[2] * after[0] - before[0] * after[2];
  }
  CHECK(std::abs(std::remainder(std::atan2(sine, cosine) - 6, 2 * 3.14159265358979)) < 0.3);
}

TEST_CASE("bodies that close on folded cloth do not press it through itself, and let it out again",
          "[surfaces]") {
  for (int n : {11, 17}) {
    INFO(n << " vertices along an edge");
    Beside all{Vec3::Zero()};
    const auto add = [&](double side) {
      all.constraints->add(
          Obstacle{.shape = mesh_body(box({0.2, 0.06, 0.2})),
                   .motion = Motion::keyframes({{.time = 0, .translate = {0, side * 0.045, 0}},
                                                {.time = 0.2, .translate = {0, side * 0.0295, 0}},
                                                {.time = 0.3, .translate = {0, side * 0.0295, 0}},
                                                {.time = 0.5, .translate = {0, side * 0.045, 0}}},
                                               Vec3::Zero())});
    };
    add(1);
    add(-1);
    // Two layers that are joined along a fold beside the bodies.
    TriangleMesh sheet = flat(n, Kind::squares, 0.3);
    for (Vec3& x : sheet.positions) {
      const double s = x[0] + 0.15, bend = 3.14159265358979 * 0.004;
      if (s < 0.14)
        x = {s - 0.09, -0.004, x[2]};
      else if (s < 0.14 + bend)
        x = {0.05 + 0.004 * std::sin((s - 0.14) / 0.004), -0.004 * std::cos((s - 0.14) / 0.004), x[2]};
      else
        x = {0.05 - (s - 0.14 - bend), 0.004, x[2]};
    }
    all.add_sheet(sheet);
    all.use("implicit-euler", "auto");
    int most = 0;
    for (int k = 0; k < 80; ++k) {
      INFO("step " << k);
      const StepReport report = all.advance(0.01);
      REQUIRE(report.done);
      most = std::max(most, report.pinched);
      REQUIRE(crossing_count(crossing_contours(unstacked(all.state.x), sheet.triangles)) == 0);
      if (k == 79) CHECK(report.pinched == 0);
    }
    CHECK(most > 0);  // 1 mm cannot hold two layers and their margins
    CHECK(all.crossings() == 0);
  }
}

TEST_CASE("where a body is pressed into itself, cloth stays between, keeps still, and comes out where it was",
          "[surfaces]") {
  for (int n : {12, 17, 23}) {
    INFO(n << " vertices along an edge");
    // Two blocks, one mesh, with a sheet hung between them. They close until they overlap by 2 cm, and open
    // again.
    const TriangleMesh body = together({box({0.2, 0.2, 0.06}), box({0.19, 0.19, 0.06})});
    const int first = body.vertex_count() / 2;
    const auto frames = std::make_shared<MeshFrames>();
    const auto at = [&](double apart) {
      std::vector<Vec3> places = body.positions;
      for (int i = 0; i < body.vertex_count(); ++i)
        places[i][2] += (i < first ? 1 : -1) * (0.03 + 0.5 * apart);
      return places;
    };
    for (const auto& [time, apart] : {std::pair(0.0, 0.03), std::pair(0.3, -0.02), std::pair(0.9, -0.02),
                                      std::pair(1.2, 0.03), std::pair(1.3, 0.03)})
      frames->add(time, at(apart));
    TriangleMesh start = body;
    start.positions = at(0.03);
    Beside all;
    all.constraints->add(Obstacle{.shape = DeformingBody{std::make_shared<SurfaceDistance>(start), frames}});
    TriangleMesh sheet = flat(n, Kind::irregular, 0.3);
    for (Vec3& x : sheet.positions) x = Vec3(x[0], x[2], 0.001);
    all.add_sheet(sheet);
    for (int i = 0; i < sheet.vertex_count(); ++i)
      if (sheet.positions[i][1] > 0.14) all.constraints->pin(i);
    all.use("implicit-euler", "auto");
    double deepest = 0;
    int pinched = 0;
    for (int k = 0; k < 200; ++k) {
      INFO("step " << k);
      const StepReport report = all.advance(0.01);
      REQUIRE(report.done);
      REQUIRE(crossing_count(crossing_contours(unstacked(all.state.x), sheet.triangles)) == 0);
      deepest = std::max(deepest, report.penetration);
      pinched = std::max(pinched, report.pinched);
      if (k == 85) {
        // What is in between keeps still. Edges that lead out of there are stretched.
        for (int i = 0; i < sheet.vertex_count(); ++i)
          if (std::abs(all.state.x[3 * i]) < 0.08 && std::abs(all.state.x[3 * i + 1]) < 0.08)
            CHECK(all.state.v.segment<3>(3 * i).norm() < 1e-3);
        CHECK(largest_strain(all.cloths, all.state.x) < 0.6);
      }
    }
    CHECK(pinched > 20);
    CHECK(deepest >
          0.05);  // the true depth: the sheet is in the middle of blocks that are 20 cm high and wide
    CHECK(all.crossings() == 0);
    for (const double depth : all.constraints->penetration(all.state.x)) CHECK(depth == 0);
    CHECK(largest_strain(all.cloths, all.state.x) < 0.05);
  }
}

TEST_CASE("cloth on the surface of a body has the same bits on any number of threads", "[surfaces]") {
  check_same_bits([] {
    Beside all;
    TriangleMesh nail = spike(0.01, 0.3);
    for (Vec3& x : nail.positions) x += Vec3(0.06, 0.1, 0.06);
    all.constraints->add(Obstacle{.shape = mesh_body(nail)});
    all.constraints->add(Obstacle{.shape = mesh_body(sphere(5, 0.1)), .motion = {}});
    TriangleMesh sheet = flat(60, Kind::irregular, 0.5);
    for (Vec3& x : sheet.positions) x[1] += 0.102;
    all.add_sheet(sheet);
    all.use("implicit-euler", "auto");
    for (int k = 0; k < 8; ++k) REQUIRE(all.advance(0.01).done);
    return all.state;
  });
}
