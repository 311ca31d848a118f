// Cloth against cloth: nothing passes through anything, layers carry and rub.
#include <numbers>
#include <random>

#include "constraints/self_contact.h"
#include "mesh/distance/triangle_crossings.h"
#include "solver/assembly/assembly.h"
#include "tests/allocations.h"
#include "tests/integrators.h"
#include "tests/together.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double r = 1e-3;  // m

int crossings(const TriangleMesh& mesh, const VecX& x, bool as_floats) {
  std::vector<Vec3> places = unstacked(x);
  if (as_floats)
    for (Vec3& p : places) p = p.cast<float>().cast<double>();
  return crossing_count(crossing_contours(places, mesh.triangles));
}

enum class Kind { squares, equilateral, irregular };
constexpr std::array kinds = {Kind::squares, Kind::equilateral, Kind::irregular};

TriangleMesh sheet(int n, double size, const Vec3& place, Kind kind = Kind::squares) {
  TriangleMesh mesh =
      kind == Kind::equilateral ? equilateral_sheet(n, n, size / (n - 1)) : grid(n, n, size, size);
  std::mt19937 random(static_cast<unsigned>(n));
  std::uniform_real_distribution<double> off(-0.25 * size / (n - 1), 0.25 * size / (n - 1));
  for (Vec3& x : mesh.positions) {
    if (kind == Kind::irregular) x += Vec3(off(random), 0, off(random));
    x += place;
  }
  return mesh;
}

struct Layers : Assembly {
  explicit Layers(const std::vector<TriangleMesh>& meshes, const Vec3& gravity = {0, -9.81, 0},
                  double friction = 0.3, ClothModel model = ClothModel::noh_jung, double thickness = r)
      : Assembly(gravity), all(together(meshes)) {
    for (const TriangleMesh& mesh : meshes)
      add({.mesh = mesh,
           .fabric = {.area_density = 0.2, .stretch = 200, .bend = 1e-5, .damping = 0.002},
           .model = model,
           .imperfection = 0,
           .self_contact = SelfContactOptions{.thickness = thickness, .friction = friction}});
  }
  int crossings(bool as_floats = false) const { return ::crossings(all, state.x, as_floats); }
  void hold(std::size_t k) {
    for (int i = cloths[k].first_particle; i < cloths[k].end_particle; ++i) constraints->pin(i);
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < state.particles(); ++i) sum += system->masses()[i] * state.v.segment<3>(3 * i);
    return sum;
  }
  // Takes steps of 10 ms; the most pairs that push in any of them.
  int most_contacts(int steps) {
    int most = 0;
    for (int k = 0; k < steps; ++k) {
      const StepReport report = advance(0.01);
      REQUIRE(report.done);
      most = std::max(most, report.self_contacts);
    }
    return most;
  }
  double speed() const {
    double most = 0;
    for (int i = 0; i < state.particles(); ++i) most = std::max(most, state.v.segment<3>(3 * i).norm());
    return most;
  }
  void throw_at(std::size_t k, const Vec3& v) {
    for (int i = cloths[k].first_particle; i < cloths[k].end_particle; ++i) state.v.segment<3>(3 * i) = v;
  }

  TriangleMesh all;
};

StepOptions usual() { return {.tolerance = 1e-4}; }

}  // namespace

TEST_CASE("whatever particles are told to do, no cloth passes through cloth", "[self-contact]") {
  std::mt19937 random(5);
  for (int round = 0; round < 60; ++round) {
    const TriangleMesh mesh = together({sheet(5, 0.1, {0, 0, 0}), sheet(4, 0.1, {0.003, 0.004, 0.002})});
    StepMotion step;
    step.h = 0.01;
    step.x = stacked(mesh.positions);
    const auto n = mesh.positions.size();
    step.masses.assign(n, 1e-4);
    step.held.assign(n, 0);
    SelfContacts contacts;
    std::vector<SelfFace> faces;
    for (const Triangle& t : mesh.triangles) faces.push_back({t, r, 0.3});
    contacts.add(faces);
    std::uniform_real_distribution<double> number(-1, 1), power(-4, -0.5);
    int stopped = 0;
    for (int k = 0; k < 12; ++k) {
      const double size = std::pow(10, power(random));  // up to ten edges
      VecX x_new = step.x;
      const Vec3 common(number(random), number(random), number(random));
      for (int i = 0; i < static_cast<int>(n); ++i)
        for (int c = 0; c < 3; ++c) x_new[3 * i + c] += 0.1 * common[c] + size * number(random);
      step.v = (x_new - step.x) / step.h;
      VecX v_new = step.v;
      contacts.begin_step(step, {}, 1e-3, SelfSprings{});
      const VecX asked = x_new;
      stopped += contacts.guard({}, {}, true, x_new, v_new).guarded;
      contacts.end_step(x_new);
      INFO("round " << round << ", step " << k << ", size " << size);
      REQUIRE(crossings(mesh, x_new, false) == 0);
      REQUIRE(crossings(mesh, x_new, true) == 0);
      CHECK((x_new - step.x - step.h * v_new).norm() < 1e-12);
      Vec3 held_up = Vec3::Zero();  // what is stopped goes on with what it stopped at: all masses are equal
      for (std::size_t i = 0; i < n; ++i) held_up += (x_new - asked).segment<3>(3 * static_cast<int>(i));
      CHECK(held_up.norm() < 1e-9);
      step.x = x_new;
    }
    CHECK(stopped > 0);
  }
}

TEST_CASE("layers on the floor come to rest a thickness apart", "[self-contact]") {
  for (ClothModel model : {ClothModel::noh_jung, ClothModel::woven})
    for (int layers : {2, 10}) {
      INFO(layers << " layers, model " << static_cast<int>(model));
      std::vector<TriangleMesh> meshes;
      for (int k = 0; k < layers;
           ++k)  // sheets of different sizes and cuts, so that no vertex is above another
        meshes.push_back(sheet(7 + k % 3, 0.2, {0, 0.0022 + 0.0012 * k, 0},
                               kinds[static_cast<std::size_t>(k / 3 + k) % 3]));
      Layers pile(meshes, {0, -9.81, 0}, 0.3, model);
      pile.constraints->add(Obstacle{.shape = Plane{}, .margin = 2e-3});
      pile.use("implicit-euler", "auto", usual());
      for (int k = 0; k < 60; ++k) {
        const StepReport report = pile.advance(0.01);
        REQUIRE(report.done);
        CHECK(report.converged);
        CHECK(report.self_guarded <= (k < 20 ? 4 : 0));
      }
      CHECK(pile.crossings() == 0);
      CHECK(pile.speed() < 2e-3);
      for (int k = 1; k < layers; ++k) {
        double below = 0, above = 0;
        const auto height = [&](int layer) {
          const Cloth& cloth = pile.cloths[static_cast<std::size_t>(layer)];
          double sum = 0;
          for (int i = cloth.first_particle; i < cloth.end_particle; ++i) sum += pile.state.x[3 * i + 1];
          return sum / (cloth.end_particle - cloth.first_particle);
        };
        below = height(k - 1);
        above = height(k);
        CHECK(above - below > r - 1.5e-4);
        CHECK(above - below < r + 1e-5);
      }
    }
}

namespace {

// Sheets of n x n vertices above each other, `apart` [m], the lowest `above` [m] the place where it rests on
// the floor.
Layers pile_of(int layers, int n, double apart, double above, bool cuts = true) {
  std::vector<TriangleMesh> meshes;
  for (int k = 0; k < layers; ++k)
    meshes.push_back(sheet(cuts ? n + k % 3 : n, 0.1, {0, 0.002 + above + apart * k, 0},
                           cuts ? kinds[static_cast<std::size_t>(k / 3 + k) % 3] : Kind::squares));
  Layers pile(meshes);
  pile.constraints->add(Obstacle{.shape = Plane{}, .friction = 0.5, .margin = 2e-3});
  pile.use("implicit-euler", "auto", usual());
  return pile;
}

}  // namespace

TEST_CASE("cloth twice as thick as its edges are long feels nothing flat, and parts where it is folded",
          "[self-contact]") {
  constexpr double edge = 0.01, thick = 2 * edge, gap = 1.2 * edge;
  for (const Kind kind : kinds) {
    INFO("mesh " << static_cast<int>(kind));
    Layers cloth({sheet(13, 12 * edge, {0, 0, 0}, kind)}, {0, 0, 0}, 0.3, ClothModel::noh_jung, thick);
    cloth.use("implicit-euler", "auto", usual());
    const VecX flat = cloth.state.x;
    for (int k = 0; k < 5; ++k) REQUIRE(cloth.advance(0.01).done);
    CHECK((cloth.state.x - flat).lpNorm<Eigen::Infinity>() < 1e-9);

    std::vector<int> above, below;  // what lies far from the fold
    double middle = 0;
    for (int i = 0; i < cloth.state.particles(); ++i) middle += flat[3 * i] / cloth.state.particles();
    for (int i = 0; i < cloth.state.particles(); ++i) {
      const double s = flat[3 * i] - middle, half = std::numbers::pi * gap / 4;  // of the arc
      const double angle = std::clamp(s / half, -1.0, 1.0) * std::numbers::pi / 2;
      cloth.state.x[3 * i] = gap / 2 * std::cos(angle) - std::max(0.0, std::abs(s) - half);
      cloth.state.x[3 * i + 1] = gap / 2 * std::sin(angle);
      if (std::abs(s) > 4 * edge) (s > 0 ? above : below).push_back(i);
    }
    const auto height = [&](const std::vector<int>& of) {
      double sum = 0;
      for (int i : of) sum += cloth.state.x[3 * i + 1];
      return sum / static_cast<double>(of.size());
    };
    REQUIRE(height(above) - height(below) == Approx(gap));
    CHECK(cloth.most_contacts(60) > 10);
    CHECK(height(above) - height(below) > 0.95 * thick);
    CHECK(cloth.crossings() == 0);
  }
}

TEST_CASE("layers come to rest in steps of any length, whose rims lie across each other", "[self-contact]") {
  for (const std::string name : {"implicit-euler", "pbd"})
    for (const Kind kind : kinds)
      for (const double h : {0.01, 0.004, 0.001}) {
        INFO(name << ", steps of " << 1000 * h << " ms, kind " << static_cast<int>(kind));
        Layers layers({sheet(7, 0.3, {0, 0, 0}, kind), sheet(7, 0.3, {0.011, 0.0015, 0.007}, kind)});
        layers.use(name, "mpcg", {.tolerance = 1e-4, .projection = {.substeps = 2}});
        layers.hold(0);
        while (layers.state.time < 0.4) REQUIRE(layers.advance(h).done);
        double fastest = 0;
        for (int n = 0; n < 5; ++n) {
          REQUIRE(layers.advance(h).done);
          fastest = std::max(fastest, layers.speed());
        }
        CHECK(fastest < 5e-4);
        for (int i = 49; i < layers.state.particles(); ++i) {
          CHECK(layers.state.x[3 * i + 1] > r - 2e-4);
          CHECK(layers.state.x[3 * i + 1] < 1.2 * r);  // rims stick out
        }
      }
}

TEST_CASE("a pile of many layers makes no energy, and comes to rest", "[self-contact]") {
  for (bool cuts : {false, true}) {
    INFO((cuts ? "three kinds of triangles" : "vertices above vertices"));
    const int layers = 24;
    Layers pile = pile_of(layers, 5, 1e-3, 0, cuts);
    const double start = pile.system->total_energy(pile.state), weight = 9.81 * layers * 0.2 * 0.01;
    for (int k = 0; k < 150; ++k) {
      const StepReport report = pile.advance(0.01);
      REQUIRE(report.done);
      if (k < 20) continue;
      CHECK(report.self_guarded == 0);
      CHECK(pile.system->total_energy(pile.state) < start + 0.02 * weight * layers * r);
    }
    CHECK(pile.speed() < 2e-3);
    CHECK(pile.crossings() == 0);
  }
}

TEST_CASE("what stops the lowest layers of a pile that falls lets the others fall on", "[self-contact]") {
  for (int n : {2, 4, 6}) {
    INFO(n << " vertices along an edge");
    const int layers = 50;
    Layers pile = pile_of(layers, n, 5e-3, 8e-3, false);
    // At 1.2 m/s the layers come down 12 mm in a step, more than two gaps. Half of the pile is still above
    // the floor.
    for (int k = 0; k < 14; ++k) {
      REQUIRE(pile.advance(0.01).done);
      REQUIRE(pile.crossings() == 0);
    }
    const Cloth& highest = pile.cloths.back();
    for (int i = highest.first_particle; i < highest.end_particle; ++i)
      CHECK(pile.state.v[3 * i + 1] < -9.81 * 0.14 + 1e-3);
    CHECK(-pile.momentum()[1] > 0.4 * 9.81 * 0.14 * layers * 0.2 * 0.01);
    // Where single pairs would pass while the pile is pressed together, the rest of it goes on.
    while (pile.state.time < 0.395) {
      const StepReport report = pile.advance(0.01);
      REQUIRE(report.done);
      CHECK(report.self_guarded < 0.4 * pile.state.particles());
      CHECK(pile.crossings() == 0);
    }
  }
}

TEST_CASE("a high pile that falls does not swing up and down for ever", "[self-contact]") {
  const int layers = 50;
  for (const double h : {0.01, 0.005})
    for (const int n : {2, 3, 4}) {
      if (h < 0.01 && n > 2) continue;
      INFO(n << " vertices along an edge, steps of " << 1000 * h << " ms");
      Layers pile = pile_of(layers, n, 5e-3, 8e-3);
      const auto mean_speed = [&] { return pile.momentum().norm() / (layers * 0.2 * 0.01); };
      while (pile.state.time < 1.2) REQUIRE(pile.advance(h).done);
      double most = 0;
      while (pile.state.time < 1.4) {
        REQUIRE(pile.advance(h).done);
        most = std::max(most, mean_speed());
      }
      CHECK(most < 5e-4);
      CHECK(pile.crossings() == 0);
    }
}

// How it crumples is a matter of chance: one place or another is held up on the way, but none for good.
TEST_CASE("thin cloth on a coarse mesh crumples, and nothing in it gets stuck", "[self-contact]") {
  for (int n : {12, 16, 20})
    for (double wave : {0.03, 0.0301, 0.0303}) {
      INFO(n << " vertices along an edge, waves of " << wave << " m");
      TriangleMesh mesh = sheet(n, 0.3, {0, 0, 0});
      for (Vec3& x : mesh.positions)  // it stands in folds
        x = Vec3(0.3 * x[0], x[2] + 0.16, wave * std::sin(60 * x[0]));
      Layers sheet({mesh}, {0, -9.81, 0}, 0.3, ClothModel::woven, 1e-4);
      sheet.constraints->add(Obstacle{.shape = Plane{}, .friction = 0.3});
      sheet.use("implicit-euler", "auto", usual());
      for (int k = 0; k < 300; ++k) {
        const StepReport report = sheet.advance(0.01);
        REQUIRE(report.done);
        if (k % 10 == 0) CHECK(sheet.crossings() == 0);
        if (k >= 280) CHECK(report.self_guarded <= 12);
      }
      CHECK(sheet.crossings() == 0);
      CHECK(largest_strain(sheet.cloths, sheet.state.x) < 0.06);
    }
}

TEST_CASE("sheets that collide keep their momentum and gain no energy", "[self-contact]") {
  for (double friction : {0.0, 0.5}) {
    INFO("friction " << friction);
    Layers pair({sheet(9, 0.2, {0, 0, 0}), sheet(8, 0.15, {0.01, 0.01, 0.02})}, Vec3::Zero(), friction);
    pair.use("implicit-euler", "auto", {.tolerance = 1e-8, .contact_tolerance = 1e-5});
    pair.throw_at(1, {0.4, -1.5, 0.1});
    const Vec3 before = pair.momentum();
    double energy = pair.system->total_energy(pair.state);
    int met = 0;
    for (int k = 0; k < 25; ++k) {
      const StepReport report = pair.advance(0.01);
      REQUIRE(report.done);
      met = std::max(met, report.self_contacts);
      CHECK(report.self_guarded == 0);
      CHECK((pair.momentum() - before).norm() < 1e-5 * before.norm());
      const double now = pair.system->total_energy(pair.state);
      CHECK(now < energy + 1e-3 * pair.system->kinetic_energy(pair.state.v));
      energy = now;
      CHECK(pair.crossings() == 0);
    }
    CHECK(met > 20);
  }
}

TEST_CASE("a layer sticks on a slope below its friction and slides as Coulomb says above it",
          "[self-contact]") {
  constexpr double mu = 0.4, h = 0.01;
  struct Slope {
    double tangent;
    int n;
    Kind kind;
    bool turned;  // whether it slides along z, and not along x
  };
  std::vector<Slope> slopes;
  for (double tangent : {0.75 * mu, 2 * mu})
    for (int n : {4, 6, 10})
      for (Kind kind : kinds)
        for (bool turned : {false, true}) slopes.push_back({tangent, n, kind, turned});
  for (const auto& [tangent, n, kind, turned] : slopes) {
    INFO("tan " << tangent << ", " << n << " vertices along an edge, kind " << static_cast<int>(kind)
                << (turned ? ", along z" : ", along x"));
    const int down = turned ? 2 : 0;
    const double angle = std::atan(tangent), g = 9.81;
    Vec3 gravity(0, -g * std::cos(angle), 0);
    gravity[down] = g * std::sin(angle);
    Layers slope({sheet(9, 0.8, {0, 0, 0}, kind), sheet(n, 0.1, {0.003, r, 0.002}, kind)}, gravity, mu);
    slope.hold(0);
    slope.use("implicit-euler", "auto", {.tolerance = 1e-8, .contact_tolerance = 1e-6});
    const auto place = [&] {
      double sum = 0;
      const Cloth& top = slope.cloths[1];
      for (int i = top.first_particle; i < top.end_particle; ++i) sum += slope.state.x[3 * i + down];
      return sum / (top.end_particle - top.first_particle);
    };
    for (int k = 0; k < 10; ++k) slope.advance(h);
    const double first = place();
    const double speed = slope.momentum()[down];
    constexpr int steps = 20;
    for (int k = 0; k < steps; ++k) REQUIRE(slope.advance(h).converged);
    const double t = steps * h;
    if (tangent < mu) {
      CHECK(std::abs(place() - first) < 1e-6);
    } else {
      double mass = 0;
      for (int i = slope.cloths[1].first_particle; i < slope.cloths[1].end_particle; ++i)
        mass += slope.system->masses()[i];
      const double gained = (slope.momentum()[down] - speed) / mass / t;
      CHECK(gained == Approx(g * (std::sin(angle) - mu * std::cos(angle))).epsilon(0.02));
    }
  }
}

TEST_CASE("where all layers of a stack slide, ten solves settle a step on average", "[self-contact]") {
  for (const Kind kind : kinds)
    for (const int n : {4, 6, 10}) {
      INFO(n << " vertices along an edge, kind " << static_cast<int>(kind));
      constexpr int count = 6;
      std::vector<TriangleMesh> sheets;
      for (int k = 0; k < count; ++k) sheets.push_back(sheet(n, 0.1, {0.003 * k, k * r, 0.002 * k}, kind));
      Layers stack(sheets, {0, -9.81, 0}, 0.4);
      stack.hold(0);
      stack.use("implicit-euler", "auto", {.tolerance = 1e-4});
      for (int k = 1; k < count; ++k)  // each faster than the one below it, and turning
        for (int i = stack.cloths[k].first_particle; i < stack.cloths[k].end_particle; ++i) {
          const Vec3 x = stack.state.x.segment<3>(3 * i);
          stack.state.v.segment<3>(3 * i) = k * Vec3(0.3 - 2 * x[2], 0, 0.1 + 2 * x[0]);
        }
      int solves = 0;
      constexpr int steps = 10;
      for (int k = 0; k < steps; ++k) {
        const StepReport report = stack.advance(0.01);
        REQUIRE(report.converged);
        solves += report.linear_solves;
      }
      CHECK(solves <= 10 * steps);
    }
}

TEST_CASE("a stack that flies as one is not held up by itself", "[self-contact]") {
  Layers stack({sheet(6, 0.1, {0, 0, 0}), sheet(7, 0.1, {0, 0.0012, 0}), sheet(5, 0.1, {0, 0.0024, 0})},
               Vec3::Zero());
  stack.use("implicit-euler", "auto", usual());
  for (std::size_t k = 0; k < 3; ++k) stack.throw_at(k, {10, -3, 2});
  const VecX before = stack.state.x;
  for (int k = 0; k < 20; ++k) {
    const StepReport report = stack.advance(0.01);
    CHECK(report.self_guarded == 0);
    CHECK(report.self_contacts == 0);
  }
  const VecX moved = stack.state.x - before;
  for (int i = 0; i < stack.state.particles(); ++i)
    CHECK((moved.segment<3>(3 * i) - Vec3(2, -0.6, 0.4)).norm() < 1e-9);
}

namespace {

// A strip that stands on the floor and folds up under its weight.
Layers folding(int n) {
  TriangleMesh mesh = grid(n, 4, 0.4, 0.08);
  for (Vec3& x : mesh.positions) x = Vec3(0.02 * std::sin(40 * x[0]), x[0] + 0.21, x[2]);
  Layers layers({mesh});
  layers.constraints->add(Obstacle{.shape = Plane{}});
  return layers;
}

}  // namespace

TEST_CASE("a strip folds up without passing through itself, by the same bits on any number of threads",
          "[self-contact]") {
  const int before = threads();
  VecX first;
  for (int count : {1, 2, 7}) {
    set_threads(count);
    Layers strip = folding(160);  // 640 particles: some loops are shared by threads, some are not
    strip.use("implicit-euler", "auto", usual());
    CHECK(strip.most_contacts(45) > 10);
    CHECK(strip.crossings() == 0);
    CHECK(strip.crossings(true) == 0);
    if (count == 1) first = strip.state.x;
    CHECK(strip.state.x == first);
  }
  set_threads(before);
}

TEST_CASE("no integrator and no linear solver lets cloth through cloth", "[self-contact]") {
  const auto fall = [](const std::string& integrator, const std::string& solver, double h) {
    INFO(integrator << ", " << solver);
    Layers pair({sheet(6, 0.1, {0, 0, 0}), sheet(5, 0.06, {0.003, 0.006, 0.002})});
    pair.hold(0);
    pair.use(integrator, solver, usual());
    pair.throw_at(1, {0, -1, 0});
    int met = 0;
    for (int k = 0; k * h < 0.1; ++k) {
      const StepReport report = pair.advance(h);
      REQUIRE(report.done);
      met = std::max(met, report.self_contacts);
      if (k % 50 == 0) REQUIRE(pair.crossings() == 0);
    }
    CHECK(pair.crossings() == 0);
    CHECK(met > 0);
  };
  for (const IntegratorInfo& integrator : integrators()) {
    const std::string name(integrator.name);
    const bool implicit = name == "implicit-euler" || name == "bdf2" || name == "newton-kinsol";
    fall(name, "mpcg", implicit ? 0.01 : 1e-4);
  }
  for (const LinearSolverInfo& solver : linear_solvers())
    fall("implicit-euler", std::string(solver.name), 0.01);
}

TEST_CASE("cloth that starts through cloth is left to move there, and meets elsewhere", "[self-contact]") {
  TriangleMesh through = sheet(6, 0.1, {0, 0.0, 0});
  for (Vec3& x : through.positions) x = Vec3(x[0], 0.02 * x[0] / 0.1 + 1e-4, x[2]);
  Layers pair({sheet(5, 0.1, {0.001, 0, 0.002}), through}, Vec3::Zero());
  pair.use("implicit-euler", "auto", usual());
  CHECK(pair.crossings() > 0);
  pair.throw_at(1, {0, 0.3, 0});
  for (int k = 0; k < 20; ++k) REQUIRE(pair.advance(0.01).done);
  CHECK(pair.momentum()[1] > 0);
}

TEST_CASE("a thickness and a friction that make no sense are refused", "[self-contact]") {
  const auto refused = [](const SelfContactOptions& options, const std::string& word) {
    Assembly all;
    CHECK_THROWS_WITH(all.add(ClothPart{.mesh = sheet(3, 0.1, Vec3::Zero()), .self_contact = options}),
                      Catch::Contains(word));
  };
  refused({.thickness = 0}, "thickness");
  refused({.thickness = -1e-3}, "thickness");
  refused({.thickness = 1}, "thickness");
  refused({.friction = -0.1}, "friction");
}

TEST_CASE("layers at rest allocate nothing", "[self-contact]") {
  if (!counts_allocations()) {
    WARN("skipped: allocations are not counted under the sanitizers");
    return;
  }
  Layers pile({sheet(9, 0.2, {0, 0.0022, 0}), sheet(8, 0.2, {0, 0.0034, 0})});
  pile.constraints->add(Obstacle{.shape = Plane{}, .margin = 2e-3});
  pile.use("implicit-euler", "auto", usual());
  for (int k = 0; k < 60; ++k) pile.advance(0.01);
  const long before = allocations();
  const StepReport report = pile.advance(0.01);
  CHECK(allocations() == before);
  CHECK(report.self_contacts > 20);
}
