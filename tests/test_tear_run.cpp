// Cloth that tears: where it is cut, and what stays as it was.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "mesh/base/errors.h"
#include "solver/assembly/assembly.h"
#include "solver/assembly/tear_rule.h"
#include "tests/allocations.h"
#include "tests/same_bits.h"
#include "tests/tearing.h"

using namespace drape;
using namespace drape::test;
using Catch::Contains;

namespace {

constexpr double limit = 0.3;

ClothPart part(ClothModel model, TriangleMesh mesh, std::optional<double> tear = limit) {
  Fabric fabric{.area_density = 0.15, .stretch = 200, .bend = 1e-6};
  if (model != ClothModel::woven) fabric.damping = 0.05;
  ClothPart cloth{.mesh = std::move(mesh), .fabric = fabric, .model = model};
  cloth.tear = tear;
  return cloth;
}

std::vector<int> row(const Cloth& cloth, int nx, int j) {
  std::vector<int> particles;
  for (int i = 0; i < nx; ++i) particles.push_back(cloth.first_particle + j * nx + i);
  return particles;
}

// Holds the near end of a strip and moves its far end away, at 1 m/s until the strip is half as long again.
struct Pulled : Assembly {
  Pulled(ClothPart cloth, int nx, int nz, double h, const std::string& method) : Assembly(Vec3::Zero()) {
    const Cloth& strip = add(std::move(cloth));
    const double length = h * (nz - 1);
    constraints->pin(row(strip, nx, 0));
    constraints->pin_along(row(strip, nx, nz - 1),
                           Motion::constant({0, 0, 1}, Vec3::Zero(), Vec3::Zero(), 0, 0.5 * length), state.x);
    use(method, "cholmod", {.newton_iterations = method == "pbd" ? 1 : 3});
  }
};

}  // namespace

TEST_CASE("a strip that is pulled apart beyond the limit tears in two, and nothing stays above it",
          "[tear]") {
  struct Case {
    ClothModel model;
    const char* integrator;
  };
  for (const Case& c : {Case{ClothModel::noh_jung, "implicit-euler"},
                        {ClothModel::noh_jung, "pbd"},
                        {ClothModel::noh_jung, "bdf2"},
                        {ClothModel::woven, "implicit-euler"},
                        {ClothModel::woven, "pbd"},
                        {ClothModel::choi_ko, "implicit-euler"}}) {
    INFO(static_cast<int>(c.model) << " " << c.integrator);
    constexpr int nx = 7, nz = 15;
    constexpr double h = 0.02;
    Pulled strip(part(c.model, quad_sheet(nx, nz, h)), nx, nz, h, c.integrator);
    const double mass = sum(strip.system->masses());
    int torn = 0;
    double before = 0;  // the largest strain at the end of the step before the first tear
    while (strip.state.time < 0.8) {
      const StepReport report = strip.advance(0.005);
      REQUIRE(report.done);
      if (torn == 0 && report.torn == 0) {
        before = largest_strain(strip.cloths, strip.state.x);
        CHECK(before <= limit);
      }
      torn += report.torn;
    }
    const Cloth& cloth = strip.cloths[0];
    CHECK(before > 0.8 * limit);
    CHECK(torn == cloth.tearing->cuts);
    CHECK(pieces(cloth.mesh) == 2);
    CHECK(largest_strain(strip.cloths, strip.state.x) <= limit);
    CHECK(sum(strip.system->masses()) == Approx(mass).epsilon(1e-13));
    CHECK(strip.state.particles() == nx * nz + static_cast<int>(cloth.tearing->copy_of.size()));
    CHECK(cloth.mesh.vertex_count() == strip.state.particles());
  }
}

TEST_CASE("a strip tears in two by every explicit method that is stable, and keeps mass and momentum",
          "[tear]") {
  for (const char* integrator : {"symplectic-euler", "midpoint", "sb-implicit", "rk4"})
    for (const ClothModel model : {ClothModel::noh_jung, ClothModel::woven}) {
      INFO(integrator << " " << static_cast<int>(model));
      constexpr int nx = 4, nz = 7;
      Pulled strip(part(model, quad_sheet(nx, nz, 0.02)), nx, nz, 0.02, integrator);
      const double mass = sum(strip.system->masses());
      int torn = 0;
      while (strip.state.time < 0.08) {
        const std::vector<double> before = strip.system->masses();
        const StepReport report = strip.advance(1e-5);
        INFO(report.failure.what);
        REQUIRE(report.done);
        torn += report.torn;
        if (report.torn == 0) continue;
        const State& was = strip.outgrown.back();
        const Vec3 momentum = weighted(before, was.v);
        CHECK((weighted(strip.system->masses(), strip.state.v) - momentum).norm() < 1e-14 * momentum.norm());
      }
      CHECK(torn == strip.cloths[0].tearing->cuts);
      CHECK(pieces(strip.cloths[0].mesh) == 2);
      CHECK(largest_strain(strip.cloths, strip.state.x) <= limit);
      CHECK(sum(strip.system->masses()) == Approx(mass).epsilon(1e-13));
    }
}

TEST_CASE("a tear keeps mass, momentum and centre of mass to round-off", "[tear]") {
  for (const ClothModel model : {ClothModel::noh_jung, ClothModel::woven, ClothModel::choi_ko}) {
    Assembly all(Vec3::Zero());
    all.add(part(model, quad_sheet(9, 9, 0.05)));
    all.use("implicit-euler", "cholmod");
    const Vec3 diagonal = Vec3(1, 0, 1).normalized();
    for (int i = 0; i < all.state.particles(); ++i)  // it flies apart along a diagonal, and to one side
      all.state.v.segment<3>(3 * i) =
          Vec3(2, 1, 0) + 300 * (diagonal.dot(all.state.x.segment<3>(3 * i)) - 0.3) * diagonal;
    int tears = 0;
    for (int step = 0; step < 40; ++step) {
      const std::vector<double> before = all.system->masses();
      const StepReport report = all.advance(0.001);
      REQUIRE(report.done);
      if (report.torn == 0) continue;
      ++tears;
      const State &was = all.outgrown.back(), &is = all.state;
      const std::vector<double>& after = all.system->masses();
      check_kept(before, was, after, is);
    }
    CHECK(tears >= 3);
  }
}

TEST_CASE("below the limit nothing tears, and the bits are those of cloth that cannot tear", "[tear]") {
  State states[2];
  for (const bool tears : {false, true}) {
    constexpr int nx = 7, nz = 9;
    Pulled strip(
        part(ClothModel::noh_jung, quad_sheet(nx, nz, 0.02), tears ? std::optional(0.9) : std::nullopt), nx,
        nz, 0.02, "implicit-euler");
    for (int step = 0; step < 40; ++step) CHECK(strip.advance(0.005).torn == 0);
    CHECK(largest_strain(strip.cloths, strip.state.x) > 0.3);
    states[tears] = strip.state;
  }
  CHECK(same_bits(states[0].x, states[1].x));
  CHECK(same_bits(states[0].v, states[1].v));
}

TEST_CASE("a torn cloth has the same bits on any number of threads", "[tear]") {
  check_same_bits([] {
    constexpr int nx = 24, nz = 48;
    Pulled strip(part(ClothModel::noh_jung, quad_sheet(nx, nz, 0.01)), nx, nz, 0.01, "implicit-euler");
    int torn = 0;
    for (int step = 0; step < 40; ++step) torn += strip.advance(0.01).torn;
    CHECK(torn > 5);
    return strip.state;
  });
}

namespace {

// A vertex in the middle of six equilateral triangles, the two neighbours along +-angle pulled by `strain`.
struct Star {
  TriangleMesh mesh;
  std::vector<internal::StrainedEdge> edges;
  Star(double stretched) {
    mesh.positions.push_back(Vec3::Zero());
    for (int k = 0; k < 6; ++k) {
      const double angle = k * std::acos(0.5);
      mesh.positions.emplace_back(std::cos(angle), 0, std::sin(angle));
      mesh.triangles.push_back({0, 1 + k, 1 + (k + 1) % 6});
      const double along = std::abs(std::sin(angle));  // z is the direction of the stretch
      edges.push_back({0, 1 + k, stretched * along * along});
    }
  }
  std::vector<CutEdge> cuts(const Tearing& tearing, double t = 1, const std::vector<int>& held = {}) const {
    internal::TearingCloth cloth{mesh, mesh.positions, {}, std::vector<char>(mesh.positions.size(), 0), {}};
    for (const internal::StrainedEdge& e : edges) cloth.edges.push_back({e.a, e.b, e.strain});
    for (const int v : held) cloth.held[static_cast<std::size_t>(v)] = 1;
    return internal::edges_to_cut(std::move(cloth), tearing, t);
  }
};

}  // namespace

TEST_CASE("a vertex parts across the stretch, unless it is held or draws back", "[tear]") {
  using Cuts = std::vector<CutEdge>;
  const Star star(0.5);
  Tearing tearing;
  tearing.limit = 0.3;
  const Cuts across = {{0, 1}, {0, 4}};  // along x
  CHECK(star.cuts(tearing) == across);
  CHECK(star.cuts(tearing, 1, {1, 4}) == across);
  CHECK(star.cuts(tearing, 1, {0}).empty());
  tearing.limit = 0.38;  // 0.5 sin^2 60 deg = 0.375
  CHECK(star.cuts(tearing).empty());
  tearing.limit = 0.3;
  tearing.last = 1 - 0.5 * internal::draw_back;  // something was cut elsewhere
  CHECK(star.cuts(tearing).empty());
  CHECK(star.cuts(tearing, 1.1) == across);
  tearing.at_cut.assign(7, 0);
  tearing.at_cut[0] = 1;  // it grows there
  CHECK(star.cuts(tearing) == across);
  tearing.rests_until.assign(7, 0.0);
  tearing.rests_until[0] = 1.01;
  CHECK(star.cuts(tearing).empty());
  CHECK(star.cuts(tearing, 1.1) == across);
  tearing.rests_until[0] = 0.5;  // it is at the side of a tear: a branch waits as a new tear does
  CHECK(star.cuts(tearing).empty());
  CHECK(star.cuts(tearing, 1.1) == across);
  Star loose = star;  // nothing pulls on one side
  for (internal::StrainedEdge& e : loose.edges)
    if (loose.mesh.positions[static_cast<std::size_t>(e.b)].z() < 0) e.strain = 0;
  tearing.rests_until.clear();
  CHECK(loose.cuts(tearing).empty());
}

TEST_CASE("what is held does not begin to part", "[tear]") {
  constexpr int nx = 7;
  Assembly all(Vec3::Zero());
  const Cloth& strip = all.add(part(ClothModel::noh_jung, quad_sheet(nx, 3, 0.02)));
  all.constraints->pin(row(strip, nx, 1));  // of the middle, which is pulled from both sides
  for (const int j : {0, 2})
    all.constraints->pin_along(row(strip, nx, j),
                               Motion::constant({0, 0, j - 1.0}, Vec3::Zero(), Vec3::Zero(), 0, 0.01),
                               all.state.x);
  all.use("implicit-euler", "cholmod");
  for (int step = 0; step < 20; ++step) CHECK(all.advance(0.001).torn == 0);
  CHECK(largest_strain(all.cloths, all.state.x) == Approx(0.5));
}

TEST_CASE("a step allocates nothing where cloth is strained too far and cannot be cut yet", "[tear]") {
  if (!counts_allocations()) return;
  struct Kind {
    ClothModel model;
    int nx, nz;
  };
  for (const Kind& kind :
       {Kind{ClothModel::noh_jung, 5, 33}, {ClothModel::choi_ko, 7, 31}, {ClothModel::woven, 6, 41}})
    for (const bool held :
         {true, false}) {  // it flies apart, all of it held on its way, or draws back from tears
      const auto& [model, nx, nz] = kind;
      INFO(nx << " x " << nz << ", " << held);
      constexpr double rate = 20;  // 1/s, of the strain
      Assembly all(Vec3::Zero());
      const Cloth& strip = all.add(part(model, quad_sheet(nx, nz, 0.02)));
      for (int j = 0; j < nz; ++j) {
        const Vec3 v(0, 0, rate * 0.02 * j);
        for (const int i : row(strip, nx, j)) all.state.v.segment<3>(3 * i) = v;
        if (held || j == 0 || j + 1 == nz)
          all.constraints->pin_along(row(strip, nx, j), Motion::constant(v, Vec3::Zero(), Vec3::Zero()),
                                     all.state.x);
      }
      all.use("implicit-euler", "mpcg");
      int waited = 0;
      bool settled = false;  // whether the system is that of the step before
      for (int step = 0; step < 100; ++step) {
        const long before = allocations();
        const int torn = all.advance(5e-4).torn;
        const long used = allocations() - before;
        if (settled && torn == 0 && largest_strain(all.cloths, all.state.x) > limit) {
          ++waited;
          CHECK(used == 0);
        }
        settled = torn == 0 && step > 0;
      }
      CHECK(waited >= 10);
    }
}

TEST_CASE("parts beside a cloth that tears keep their places, pins, masses and joints", "[tear]") {
  constexpr int nx = 5, nz = 9;
  Assembly all(Vec3::Zero());
  const Cloth& strip = all.add(part(ClothModel::noh_jung, quad_sheet(nx, nz, 0.02)));
  all.constraints->pin(row(strip, nx, 0));
  all.constraints->pin_along(row(strip, nx, nz - 1),
                             Motion::constant({0, 0, 1}, Vec3::Zero(), Vec3::Zero(), 0, 0.1), all.state.x);
  TriangleMesh other = grid(4, 4, 0.1, 0.1);
  for (Vec3& x : other.positions) x.y() = 1;
  all.add(ClothPart{.name = "other", .mesh = other});
  all.pin(PinVertices{{0, 3}}, 1);
  const int carried = all.cloths[1].first_particle + 12;
  all.constraints->pin_along({carried}, Motion::constant({0, 0, 0.01}, Vec3::Zero(), Vec3::Zero()),
                             all.state.x);
  all.add(
      SoftPart{.lattice = box_lattice({3, 3, 3}, Vec3::Constant(0.1)), .place = {.translation = {2, 0, 0}}});
  const int joined = 2 * nx;  // of the strip
  all.add(RopePart{.points = {all.state.x.segment<3>(3 * joined), Vec3(-0.1, 0, 0.04), Vec3(-0.2, 0, 0.04)},
                   .first = joined});
  all.constraints->add(Obstacle{.shape = Sphere{{0, -9, 0}, 0.1}});
  all.use("implicit-euler", "mpcg");
  const auto of = [&](std::size_t k, const VecX& x) {
    const Cloth& c = all.cloths[k];
    return VecX(x.segment(3 * c.first_particle, 3 * (c.end_particle - c.first_particle)));
  };
  const Vec3 start = all.state.x.segment<3>(3 * carried);
  const VecX soft = of(2, all.state.x);
  int torn = 0;
  const double mass = sum(all.system->masses());
  for (int step = 0; step < 60; ++step) torn += all.advance(0.005).torn;
  REQUIRE(torn > 0);
  REQUIRE(all.cloths[0].end_particle > nx * nz);
  CHECK(all.cloths[1].first_particle == all.cloths[0].end_particle);
  CHECK(all.cloths[2].first_particle == all.cloths[1].end_particle);
  CHECK((of(2, all.state.x) - soft).lpNorm<Eigen::Infinity>() < 1e-9);  // nothing acts on it
  const Vec3 end = all.state.x.segment<3>(3 * (all.cloths[1].first_particle + 12));
  CHECK((end - start - Vec3(0, 0, 0.01 * all.state.time)).norm() < 1e-12);
  std::vector<Triangle> faces;  // of both cloths, one after the other
  for (const std::size_t k : {0, 1})
    for (Triangle t : all.cloths[k].mesh.triangles) {
      for (int& v : t) v += all.cloths[k].first_particle;
      faces.push_back(t);
    }
  REQUIRE(all.constraints->faces().all().size() >= faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
    CHECK(all.constraints->faces().all()[f].particles == faces[f]);
  const std::vector<int>& pinned = all.constraints->pinned();
  for (const int v : {0, 3})
    CHECK(std::binary_search(pinned.begin(), pinned.end(), all.cloths[1].first_particle + v));
  CHECK(all.cloths[3].embedding.particle(0) == joined);
  CHECK(all.cloths[3].embedding.particle(1) == all.cloths[3].first_particle);
  CHECK(sum(all.system->masses()) == Approx(mass).epsilon(1e-13));
}

TEST_CASE("a rope is held up by another while cloth beside them tears", "[tear]") {
  constexpr int nx = 5, nz = 9;
  Assembly all(Vec3::Zero());
  ClothPart cloth = part(ClothModel::noh_jung, quad_sheet(nx, nz, 0.02));
  cloth.self_contact = SelfContactOptions{};
  const Cloth& strip = all.add(std::move(cloth));
  all.constraints->pin(row(strip, nx, 0));
  all.constraints->pin_along(row(strip, nx, nz - 1),
                             Motion::constant({0, 0, 1}, Vec3::Zero(), Vec3::Zero(), 0, 0.1), all.state.x);
  const RopeMaterial material{.bend = 1e-6, .radius = 2e-3};
  const auto rope = [&](const std::string& name, const Vec3& middle, const Vec3& way) {
    std::vector<Vec3> points;
    for (int k = -2; k <= 2; ++k) points.push_back(middle + 0.02 * k * way);
    all.add(RopePart{.name = name, .points = points, .material = material, .self_contact = RopeContact{}});
  };
  rope("lower", {1, 0, 0}, {1, 0, 0});
  all.constraints->pin({all.cloths[1].first_particle, all.cloths[1].end_particle - 1});
  rope("upper", {1.003, 0.01, 0.003}, {0, 0, 1});
  const auto middle = [&](std::size_t k) { return all.cloths[k].first_particle + 2; };
  for (int i = all.cloths[2].first_particle; i < all.cloths[2].end_particle; ++i)
    all.state.v[3 * i + 1] = -0.3;
  all.use("implicit-euler", "mpcg");
  int torn = 0;
  for (int step = 0; step < 60; ++step) {
    torn += all.advance(0.005).torn;
    CHECK(all.state.x[3 * middle(2) + 1] > all.state.x[3 * middle(1) + 1] + 3e-3);
  }
  REQUIRE(torn > 0);
  REQUIRE(all.cloths[0].end_particle > nx * nz);
}

TEST_CASE("in the step that tears, what touches a body is told under its new number", "[tear]") {
  constexpr int nx = 5, nz = 9;
  Assembly all;
  const Cloth& strip = all.add(part(ClothModel::noh_jung, quad_sheet(nx, nz, 0.02)));
  all.constraints->pin(row(strip, nx, 0));
  all.constraints->pin_along(row(strip, nx, nz - 1),
                             Motion::constant({0, 0, 1}, Vec3::Zero(), Vec3::Zero(), 0, 0.1), all.state.x);
  TriangleMesh other = grid(4, 4, 0.1, 0.1);
  for (Vec3& x : other.positions) x.y() = -0.499;
  all.add(ClothPart{.name = "other", .mesh = other});
  all.constraints->add(Obstacle{.shape = Plane{{0, -0.5, 0}, {0, 1, 0}}, .friction = 0.3, .margin = 1e-3});
  all.use("implicit-euler", "mpcg");
  int torn = 0;
  for (int step = 0; step < 60; ++step) {
    if (all.advance(0.005).torn == 0) continue;
    ++torn;
    REQUIRE(all.constraints->contacts().size() == 16);
    for (const Contact& contact : all.constraints->contacts())
      CHECK((contact.particle >= all.cloths[1].first_particle &&
             contact.particle < all.cloths[1].end_particle));
  }
  CHECK(torn > 0);
}

TEST_CASE("limits that make no sense are refused, with what and where", "[tear]") {
  const TriangleMesh mesh = quad_sheet(3, 3, 0.1);
  const auto add = [](ClothPart cloth) { Assembly().add(std::move(cloth)); };
  for (const double wrong : {0.0, -0.1, std::nan(""), HUGE_VAL})
    CHECK_THROWS_WITH(add(part(ClothModel::noh_jung, mesh, wrong)),
                      Contains("tear") && Contains("greater than zero"));
  ClothPart strained = part(ClothModel::woven, mesh, 0.4);
  strained.rest = mesh;
  for (Vec3& x : strained.mesh.positions) x.z() *= 1.5;
  CHECK_THROWS_WITH(add(strained),
                    Contains("between the vertices 0 and 3 (from 0) starts with a strain of 0.5"));
  strained.tear = 0.6;
  CHECK_NOTHROW(add(strained));
  ClothPart weighted = part(ClothModel::noh_jung, mesh);
  weighted.fabric.neighbour_weighting = true;
  CHECK_THROWS_WITH(add(weighted), Contains("neighbour_weighting"));
}
