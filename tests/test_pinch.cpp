// Cloth between two bodies that close on it and do not give way: it stays there, keeps still, and comes out
// where it was.
#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

#include "mesh/triangles/topology.h"
#include "solver/assembly/assembly.h"
#include "tests/integrators.h"
#include "tests/same_bits.h"
#include "tests/shapes.h"
#include "tests/sheets.h"
#include "tests/together.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double margin = 2e-3;  // m

// A body whose surface is at the origin of its motion and which reaches to the side of +y or -y.
struct Jaw {
  const char* name;
  Shape shape;
};
Jaw ball(double side) { return {"ball", Sphere{{0, 0.1 * side, 0}, 0.1}}; }
Jaw block(double side) { return {"block", Box{.centre = {0, 0.05 * side, 0}, .size = {0.1, 0.1, 0.14}}}; }
Jaw wall(double side) { return {"wall", Plane{.point = Vec3::Zero(), .normal = {0, -side, 0}}}; }
Jaw mesh(double side) {
  return {"mesh", std::make_shared<const SurfaceDistance>(lat_long_sphere(24, 40, 0.1, {0, 0.1 * side, 0}))};
}

// A sheet in the plane y = 0, held along its border, and two jaws that are `apart` [m] at the given times
// [s].
struct Press : Assembly {
  using Way = std::vector<std::pair<double, double>>;

  // share: how much of the way the upper jaw makes.
  Press(const Jaw& upper, const Jaw& lower, const Way& apart, double share, double friction)
      : Assembly(Vec3::Zero()) {
    const auto add_jaw = [&](const Jaw& jaw, double side, double part) {
      std::vector<Keyframe> keys;
      for (const auto& [time, gap] : apart)
        keys.push_back({.time = time, .translate = {0, side * (0.01 + part * (gap - 0.02)), 0}});
      constraints->add(Obstacle{.shape = jaw.shape,
                                .friction = friction,
                                .margin = margin,
                                .motion = Motion::keyframes(keys, Vec3::Zero())});
    };
    add_jaw(upper, 1, share);
    add_jaw(lower, -1, 1 - share);
  }
  // The same with two parts of one body that deforms as jaws: the sides of a fold.
  Press(const TriangleMesh& upper, const TriangleMesh& lower, const Way& apart, double friction)
      : Assembly(Vec3::Zero()) {
    const TriangleMesh both = together({upper, lower});
    const auto frames = std::make_shared<MeshFrames>();
    for (const auto& [time, gap] : apart) {
      std::vector<Vec3> places = both.positions;
      for (int i = 0; i < both.vertex_count(); ++i)
        places[i][1] += (i < upper.vertex_count() ? 0.5 : -0.5) * gap;
      frames->add(time, places);
    }
    constraints->add(Obstacle{.shape = DeformingBody{std::make_shared<SurfaceDistance>(both), frames},
                              .friction = friction,
                              .margin = margin});
  }
  void add_sheet(int n, Kind kind, bool self_contact) {
    const TriangleMesh sheet = bent(n, kind, 0.3, [](double, double) { return 0.0; });
    ClothPart part{.mesh = sheet,
                   .fabric = {.area_density = 0.2, .stretch = 500, .bend = 1e-5, .damping = 0.02},
                   .model = ClothModel::woven};
    if (self_contact) part.self_contact = SelfContactOptions{.thickness = 1e-3, .friction = 0.3};
    add(std::move(part));
    Vec3 half = Vec3::Zero();
    for (const Vec3& x : sheet.positions) half = half.cwiseMax(x.cwiseAbs());
    for (int i = 0; i < sheet.vertex_count(); ++i)
      if (sheet.positions[i][0] > half[0] - 0.02 || sheet.positions[i][0] < 0.02 - half[0])
        constraints->pin(i);
    use("implicit-euler", "auto", {.tolerance = 1e-6});
  }
  double strain() const {
    double most = 0;
    const VecX& x = state.x;
    for (const Edge& e : edges(cloths[0].mesh)) {
      const int i = e.a, j = e.b;
      const double rest = (cloths[0].mesh.positions[i] - cloths[0].mesh.positions[j]).norm();
      most = std::max(most, (x.segment<3>(3 * i) - x.segment<3>(3 * j)).norm() / rest - 1);
    }
    return most;
  }
  // The largest speed of particles within this distance of the middle [m/s].
  double speed(double within) const {
    double most = 0;
    for (int i = 0; i < state.particles(); ++i)
      if (cloths[0].mesh.positions[i].norm() < within)
        most = std::max(most, state.v.segment<3>(3 * i).norm());
    return most;
  }
  double deepest() const {
    const std::vector<double> depths = constraints->penetration(state.x);
    return *std::max_element(depths.begin(), depths.end());
  }
};

// A particle of 1 g, and bodies that go through keyframes.
struct One {
  explicit One(const Vec3& place) {
    system.add(Gravity{{0, 0, -1e-3}});
    state.x = place;
  }
  void add(const Jaw& jaw, const std::vector<std::pair<double, Vec3>>& places, double friction) {
    std::vector<Keyframe> keys;
    for (const auto& [time, place] : places) keys.push_back({.time = time, .translate = place});
    constraints.add({.shape = jaw.shape,
                     .friction = friction,
                     .margin = margin,
                     .motion = Motion::keyframes(keys, Vec3::Zero())});
  }
  StepReport advance(double h = 0.01) {
    const StepReport report = stepper.advance(state, h);
    INFO(report.failure.what);
    REQUIRE(report.done);
    return report;
  }

  System system{{1e-3}};
  Constraints constraints;
  State state{0, VecX::Zero(3), VecX::Zero(3)};
  ImplicitEuler stepper{system, constraints, make_linear_solver("mpcg"), {}};
};

const Press::Way closes_and_opens = {{0, 0.02}, {0.2, -0.02}, {0.5, -0.02}, {0.7, 0.02}, {0.8, 0.02}};

// Cloth between jaws that go this way keeps still, is not drawn out, and comes out where it was.
void check_that_it_is_held_and_comes_out(Press& press) {
  int pinched = 0;
  for (int k = 0; k < 110; ++k) {
    INFO("step " << k);
    const StepReport report = press.advance(0.01);
    REQUIRE(report.done);
    pinched = std::max(pinched, report.pinched);
    if (k == 48) {
      CHECK(press.speed(0.03) < 1e-9);  // between the bodies; the rest of the sheet still swings
      CHECK(press.speed(1) < 0.1);
      CHECK(press.strain() < 0.4);
    }
  }
  CHECK(pinched > 0);
  CHECK(press.deepest() == 0);
  CHECK(press.strain() < 0.01);
  CHECK(press.speed(1) < 0.1);
}

}  // namespace

TEST_CASE("cloth between bodies that overlap keeps still, is not drawn out, and comes out where it was",
          "[nips]") {
  const std::vector<std::pair<Jaw, Jaw>> jaws = {
      {ball(1), ball(-1)}, {ball(1), wall(-1)}, {mesh(1), mesh(-1)}, {block(1), mesh(-1)}};
  for (const auto& [upper, lower] : jaws)
    for (int n : {12, 17, 23})
      for (Kind kind : kinds) {
        const bool self_contact = n == 17;
        // A wall would come past the border of the sheet, which is held.
        const double share = std::holds_alternative<Plane>(lower.shape) ? 1.0
                             : n == 12                                  ? 0.7
                             : n == 17                                  ? 0.5
                                                                        : 0.4;
        INFO(upper.name << " on " << lower.name << ", " << n << " vertices along an edge, kind "
                        << static_cast<int>(kind));
        Press press(upper, lower, closes_and_opens, share, 0.5);
        press.add_sheet(n, kind, self_contact);
        check_that_it_is_held_and_comes_out(press);
      }
}

TEST_CASE("of a fold the other side is known, also where it closes within the step", "[nips]") {
  const double h = 0.01, offset = 2e-3;
  const Vec3 slab(0.5, 0.2, 0.4);
  for (const double width : {1.2, 2.1, 3.0, 3.8, 4.2})  // offsets
    for (const double closing : {0.0, 0.5, 1.0})        // so much of the width within the step
      for (const double share : {0.1, 0.3, 0.49}) {     // of the width, above the lower side
        INFO(width << " offsets wide, " << closing << " of it closes, at " << share);
        const Mat3 R = some_rotation();
        const double W = width * offset;
        TriangleMesh lower = box_mesh(slab), upper = lower;
        for (Vec3& x : lower.positions) x[1] -= slab[1] / 2;
        for (Vec3& x : upper.positions) x[1] += slab[1] / 2 + W;
        const TriangleMesh both = together({lower, upper});
        TriangleMesh start = both;
        const auto frames = std::make_shared<MeshFrames>();
        for (const double time : {0.0, h}) {
          std::vector<Vec3> places = both.positions;
          for (int i = lower.vertex_count(); i < both.vertex_count(); ++i)
            places[i][1] -= closing * W * time / h;
          for (Vec3& x : places) x = R * x;
          frames->add(time, places);
          if (time == 0) start.positions = places;
        }
        MovingBody body(
            {.shape = DeformingBody{std::make_shared<SurfaceDistance>(start), frames}, .margin = offset}, 0);
        body.begin_step(0, h);
        const Vec3 x = R * Vec3(0.013, share * W, -0.021), up = R.col(1);
        const auto far = body.opposite(x, body.at_start(x), offset);
        REQUIRE(far.has_value() == (width < 4));
        if (!far) continue;
        CHECK((far->normal + up).norm() < 1e-5);  // frames are floats
        CHECK(far->gap == Approx((1 - share) * W - offset).margin(1e-7));
        CHECK((far->body_velocity + closing * W / h * up).norm() < 1e-4);
      }
}

TEST_CASE("cloth in a fold of a body that closes keeps still, is not drawn out, and comes out where it was",
          "[nips]") {
  const auto ball = [](double radius, double side) {
    return lat_long_sphere(24, 40, radius, {0, radius * side, 0});
  };
  for (const double lower : {0.1, 0.07})  // m
    for (int n : {12, 17, 23})
      for (Kind kind : kinds)
        for (const double friction : {0.0, 0.5}) {
          INFO("lower radius " << lower << " m, " << n << " vertices along an edge, kind "
                               << static_cast<int>(kind) << ", friction " << friction);
          Press press(ball(0.1, 1), ball(lower, -1), closes_and_opens, friction);
          press.add_sheet(n, kind, n == 17);
          check_that_it_is_held_and_comes_out(press);
        }
}

TEST_CASE(
    "a particle in a wedge that closes is held where the friction of both sides can hold it, and else slips "
    "out",
    "[nips]") {
  constexpr double h = 0.01;
  for (double mu_a : {0.0, 0.2, 0.5, 3.0})
    for (double mu_b : {0.1, 0.4})
      for (double share : {0.0, 0.5, 0.8})
        for (double beyond : {-0.03, 0.03}) {  // rad
          const double holds = std::atan(mu_a) + std::atan(mu_b),
                       angle = std::clamp(holds, 0.1, 1.2) + beyond;
          if (mu_a > 1 && beyond < 0) continue;  // the bodies' way leads out of so wide a wedge, too
          INFO("friction " << mu_a << " and " << mu_b << ", " << share << " of the way, " << angle << " rad");
          // Planes that face each other, and meet far off at x < 0.
          const Vec3 up(std::sin(angle / 2), std::cos(angle / 2), 0), down(up[0], -up[1], 0);
          Constraints constraints;
          const auto add = [&](const Vec3& normal, double mu, double part) {
            constraints.add(
                {.shape = Plane{.point = -0.005 * normal, .normal = normal},
                 .friction = mu,
                 .margin = margin,
                 .motion = Motion::keyframes({{.time = 0}, {.time = 0.1, .translate = 0.01 * part * normal}},
                                             Vec3::Zero())});
          };
          add(up, mu_a, share);
          add(down, mu_b, 1 - share);
          System system({1e-3});
          system.add(Gravity{{0, 0, -0.1}});  // along the wedge
          State state{0, VecX::Zero(3), VecX::Zero(3)};
          ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg"), {});
          int held = 0;
          for (int k = 0; k < 10; ++k) {
            const StepReport report = stepper.advance(state, h);
            INFO(report.failure.what);
            REQUIRE(report.done);
            held += report.pinched;
          }
          const double overlap =
              0.01 - 2 * (0.005 - margin);  // m, by which the way of both is longer than the room
          if (beyond > 0) {
            CHECK(held == 0);
            for (const auto& plane : {up, down})
              CHECK(plane.dot(Vec3(state.x)) - (plane == up ? share : 1 - share) * 0.01 + 0.005 >
                    margin - 1e-9);
            CHECK(state.x[0] > 0.9 * overlap / 2 / std::sin(angle / 2));
          } else {
            CHECK(held > 0);
            CHECK(std::abs(state.x[0]) < 1.5 * overlap);
          }
        }
}

TEST_CASE("what two bodies hold stays in the middle between them, whichever of them moves", "[nips]") {
  for (double share : {0.0, 0.3, 0.5, 1.0})
    for (double speed : {0.05, 0.4})  // m/s, at which they close
      for (double start : {-0.002, 0.0, 0.003}) {
        INFO(share << " of the way, " << speed << " m/s, from " << start << " m");
        const double room = 0.016, way = 0.03;  // m, the distance of the bodies and by how much they close
        One one({0, start, 0});
        one.add(wall(1), {{0, {0, room / 2, 0}}, {way / speed, {0, room / 2 - share * way, 0}}}, 0.3);
        one.add(wall(-1), {{0, {0, -room / 2, 0}}, {way / speed, {0, (1 - share) * way - room / 2, 0}}}, 0.3);
        double held = 0;
        for (int k = 0; k * 0.01 < way / speed; ++k) {
          if (one.advance().pinched == 0) continue;
          ++held;
          const auto& bodies = one.constraints.bodies();
          CHECK(bodies[0].distance(one.state.x) == Approx(bodies[1].distance(one.state.x)).margin(1e-9));
        }
        CHECK(held > 1);
      }
}

TEST_CASE("what starts beside the middle is brought there no faster than what starts inside a body",
          "[nips]") {
  for (double h : {1e-4, 1e-3, 1e-2}) {
    INFO(h << " s");
    One one({0, 3e-4, 0});
    one.add(wall(1), {{0, {0, 1.5e-3, 0}}}, 0.3);
    one.add(wall(-1), {{0, {0, -1.5e-3, 0}}}, 0.3);
    CHECK(one.advance(h).pinched == 1);
    CHECK(-one.state.v[1] == Approx(std::min(3e-4 / h, 0.25)));
  }
}

TEST_CASE("what starts between two bodies, however narrow the room, is held from the start", "[nips]") {
  for (const double room : {0.3e-3, 0.9e-3, 1.9e-3, 2e-3, 2.1e-3})
    for (const double beside : {0.0, 0.2, -0.4}) {  // of half of the room
      INFO(room << " m between the bodies, " << beside << " of the way to one of them");
      One one({0, 0.5 * beside * room, 0});
      one.add(block(1), {{0, {0, 0.5 * room, 0}}}, 0.3);
      one.add(wall(-1), {{0, {0, -0.5 * room, 0}}}, 0.3);
      for (int k = 0; k < 40; ++k) CHECK(one.advance().pinched == 1);
      CHECK(std::abs(one.state.x[1]) < 1e-9);
      CHECK(std::abs(one.state.x[2]) < 1e-9);
    }
}

TEST_CASE("what starts inside one of two bodies goes no deeper, whatever their margins are", "[nips]") {
  for (const double of_upper : {0.5e-3, 2e-3, 5e-3}) {
    INFO("margin of the upper body " << of_upper << " m");
    One one({0, -1e-3, 0});
    one.constraints.add({.shape = block(1).shape, .friction = 0.3, .margin = of_upper});
    one.constraints.add({.shape = wall(-1).shape, .friction = 0.3, .margin = 0.5e-3});
    one.advance();
    double deepest = 1e-3;
    for (int k = 0; k < 40; ++k) {
      one.advance();
      deepest = -one.constraints.bodies()[1].distance(one.state.x);
    }
    CHECK(deepest < (of_upper > 2e-3 ? 1e-3 + 1e-9 : 0.9e-3));  // a wide margin holds it there
  }
}

TEST_CASE("what starts inside bodies that overlap comes out of both", "[nips]") {
  for (double beside : {0.03, 0.05, 0.06})
    for (double mu : {0.3, 1.0}) {
      INFO(beside << " m beside the middle, friction " << mu);
      One one({beside, 0.001, 0});
      one.add(ball(1), {{0, {0, -0.03, 0}}}, mu);
      one.add(ball(-1), {{0, {0, 0.03, 0}}}, mu);
      for (int k = 0; k < 60; ++k) one.advance();
      for (const MovingBody& body : one.constraints.bodies())
        CHECK(body.distance(one.state.x) > margin - 1e-9);
    }
}

TEST_CASE("what is held stays held where another side of the body is nearer", "[nips]") {
  for (double from_side : {0.003, 0.006}) {
    INFO(from_side << " m from the side of the block");
    One one({0.05 - from_side, 0, 0});
    const auto keys = [](double side) {
      return std::vector<std::pair<double, Vec3>>{{0.0, {0, side * 0.01, 0}},
                                                  {0.2, {0, side * -0.01, 0}},
                                                  {0.4, {0, side * -0.01, 0}},
                                                  {0.6, {0, side * 0.01, 0}}};
    };
    one.add(block(1), keys(1), 0.5);
    one.add(wall(-1), keys(-1), 0.5);
    int held = 0;
    for (int k = 0; k < 60; ++k) {
      held += one.advance().pinched;
      CHECK(one.state.x[0] == Approx(0.05 - from_side).margin(1e-9));
      CHECK(std::abs(one.state.x[1]) < 0.009);
    }
    CHECK(held > 20);
  }
}

TEST_CASE("what friction has drawn under a ball that lies on a floor can be drawn out again", "[nips]") {
  for (double mu : {0.0, 0.3, 1.0})
    for (double gap : {-1.5e-3, -2e-3, -4e-3}) {  // m, between the margins where ball and floor are nearest
      INFO("friction " << mu << ", gap " << gap);
      Constraints constraints;
      constraints.add({.shape = Plane{}, .friction = mu, .margin = margin});
      constraints.add(
          {.shape = Sphere{{0, 0.1 + 2 * margin + gap, 0}, 0.1}, .friction = mu, .margin = margin});
      State state{0, VecX::Zero(3), VecX::Zero(3)};
      state.x = Vec3(0.1, margin, 0);
      const auto pull = [&](const Vec3& force, int steps) {
        System system({1e-3});
        system.add(Gravity{force});
        ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg"), {});
        for (int k = 0; k < steps; ++k) {
          const StepReport report = stepper.advance(state, 0.01);
          REQUIRE(report.done);
          CHECK(report.pinched == 0);
        }
      };
      pull({-20, -1, 0}, 60);
      CHECK(state.x[0] < 0.05);
      pull({20, -1, 0}, 60);
      CHECK(state.x[0] > 0.1);
    }
}

TEST_CASE("cloth that bodies hold between them has the same bits on any number of threads", "[nips]") {
  check_same_bits([] {
    Press press(ball(1), mesh(-1), {{0, 0.01}, {0.1, -0.01}}, 0.5, 0.5);
    press.add_sheet(60, Kind::irregular, true);
    int held = 0;
    for (int k = 0; k < 12; ++k) {
      const StepReport report = press.advance(0.01);
      REQUIRE(report.done);
      held = std::max(held, report.pinched);
    }
    CHECK(held > 0);
    return press.state;
  });
}

TEST_CASE("what a finger presses on a table goes with the rougher of both, and is not torn", "[nips]") {
  // The finger comes down on the middle of a sheet, so that there is 0.5 mm less room than both margins, and
  // goes 2 cm along.
  struct Case {
    double of_finger, of_table, goes;  // friction; the share of the finger's way that the sheet makes
  };
  constexpr double down = 0.02 + 0.5e-3, along = 0.02;  // m
  const auto with = [&](const Jaw& finger, const Case& c, int n, Kind kind) {
    Assembly all({0, -9.81, 0});
    all.add({.mesh = bent(n, kind, 0.2, [](double, double) { return margin; }),
             .fabric = {.area_density = 0.12, .stretch = 500, .bend = 8e-6},
             .model = ClothModel::woven,
             .imperfection = 0});
    all.constraints->add(Obstacle{.shape = Plane{Vec3::Zero(), Vec3::UnitY()}, .friction = c.of_table});
    const std::vector<Keyframe> keys = {{.time = 0},
                                        {.time = 0.1, .translate = {0, -down, 0}},
                                        {.time = 0.15, .translate = {0, -down, 0}},
                                        {.time = 0.4, .translate = {along, -down, 0}}};
    all.constraints->add(Obstacle{.shape = finger.shape,
                                  .friction = c.of_finger,
                                  .margin = margin,
                                  .motion = Motion::keyframes(keys, Vec3::Zero())});
    all.use("implicit-euler", "auto");
    double before = 0, after = 0, strain = 0;
    const int count = all.state.particles();
    for (int i = 0; i < count; ++i) before += all.state.x[3 * i] / count;
    while (all.state.time < 0.5 - 1e-9) REQUIRE(all.advance(0.005).done);
    for (int i = 0; i < count; ++i) after += all.state.x[3 * i] / count;
    for (const RestEdge& e : all.cloths[0].edges)
      strain = std::max(
          strain,
          std::abs((all.state.x.segment<3>(3 * e.j) - all.state.x.segment<3>(3 * e.i)).norm() / e.L - 1));
    CHECK(after - before == Approx(c.goes * along).margin(0.05 * along));
    CHECK(strain < 0.05);
  };
  const double above = 2 * margin + 0.02;  // m, of its lowest point at first
  const Jaw box{"box", Box{.centre = {0, above + 0.01, 0}, .size = {0.06, 0.02, 0.06}}};
  for (const Kind kind : kinds)
    for (const int n : {11, 17, 25})
      for (const Case& c : {Case{1, 0, 1}, Case{0.6, 0.3, 1}, Case{0.3, 0.3, 1}, Case{0, 1, 0}}) {
        INFO("mesh " << static_cast<int>(kind) << ", " << n << " vertices along an edge, friction "
                     << c.of_finger << " and " << c.of_table);
        with(box, c, n, kind);
      }
}
