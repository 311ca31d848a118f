// The library alone, without a scene: panels placed, seams planned, cloths and soft bodies assembled and
// stepped.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <numbers>
#include <numeric>

#include "app/pattern/pattern_read.h"
#include "app/scene/fabrics.h"
#include "mesh/base/errors.h"
#include "mesh/obj/obj.h"
#include "mesh/pattern/flat_pattern.h"
#include "mesh/pattern/panels.h"
#include "mesh/triangles/generate.h"
#include "tests/garment.h"
#include "tests/places.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;

namespace {

constexpr double pi = std::numbers::pi;

Mat3 turn(double angle, const Vec3& axis) { return Eigen::AngleAxisd(angle, axis).toRotationMatrix(); }

// The tube of tests/garment.h, placed as tube_cloth places it.
TriangleMesh placed_tube(const TriangleMesh& flat) {
  TriangleMesh mesh = flat;
  place_panels(
      mesh,
      {{.group = "front", .wrap = 0.16, .translate = {0, 0, 0.02}},
       {.group = "back", .wrap = 0.16, .rotation = turn(pi, Vec3::UnitY()), .translate = {0, 0, -0.02}}});
  return mesh;
}

TriangleMesh flat_tube() { return parse_obj(TwoPanels().obj(), "tube.obj"); }

ClothPart tube(std::vector<SeamPlan> seams) {
  const TriangleMesh flat = flat_tube();
  return {.name = "tube", .mesh = placed_tube(flat), .rest = flat, .seams = std::move(seams)};
}

double mass(const Assembly& a) {
  return std::accumulate(a.system->masses().begin(), a.system->masses().end(), 0.0);
}

Vec3 momentum(const Assembly& a) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < a.state.particles(); ++i) sum += a.system->masses()[i] * a.state.v.segment<3>(3 * i);
  return sum;
}

// What add() says of a cloth with these seams.
void add_tube(std::vector<SeamPlan> seams) { Assembly().add(tube(std::move(seams))); }

}  // namespace

TEST_CASE("the library sews the poncho as the scene does, to the bit", "[sewing]") {
  const std::filesystem::path data = std::filesystem::path(source_dir()) / "data";
  Names notes;
  const Pattern pattern = read_pattern(data / "patterns/poncho.svg", notes);
  const TriangleMesh flat = triangulate(pattern, {.edge = 0.04}).mesh;
  TriangleMesh laid = flat;
  place_panels(laid,
               {{.group = "front", .rotation = turn(-pi / 2, Vec3::UnitX()), .translate = {0, 1.50, 0.43}},
                {.group = "back",
                 .rotation = turn(pi / 2, Vec3::UnitX()) * turn(pi, Vec3::UnitY()),
                 .translate = {0, 1.50, -0.38}}});
  Fabric fabric = load_fabric("cotton-poplin").fabric;
  fabric.weave.compression = 0.1;
  Assembly poncho;
  poncho.add(ClothPart{.mesh = laid,
                       .rest = flat_pattern(flat),
                       .fabric = fabric,
                       .model = ClothModel::woven,
                       .warp = Vec3::UnitY(),
                       .seams = declared_seam_plans(flat, 0.2),
                       .self_contact = SelfContactOptions{}});
  const auto body = std::make_shared<const SurfaceDistance>(read_obj(data / "meshes/body.obj"));
  poncho.constraints->add(Obstacle{.shape = body, .friction = 0.4, .margin = 0.003});
  poncho.use("implicit-euler", "auto", {.tolerance = 1e-4});

  Simulation scene = make_simulation(read_scene(data / "scenes/poncho-sewn.toml", {}));
  const auto same = [](const State& a, const State& b) { return a.x == b.x && a.v == b.v; };
  REQUIRE(poncho.cloths[0].seams.size() == 2);
  REQUIRE(same(poncho.state, scene.state));
  const int particles = poncho.state.particles();
  while (poncho.state.time < 0.25) {
    REQUIRE(poncho.advance(0.005).done);
    REQUIRE(scene.advance(0.005).done);
    REQUIRE(same(poncho.state, scene.state));
  }
  CHECK(poncho.cloths[0].seams.empty());
  CHECK(poncho.state.particles() < particles);
}

TEST_CASE("a tube that is sewn without a scene keeps its mass and its momentum", "[sewing]") {
  Assembly all(Vec3::Zero());
  all.add(tube(declared_seam_plans(flat_tube(), 0.2)));
  all.use("implicit-euler", "mpcg", {.tolerance = 1e-10});
  const double weight = mass(all);
  const int particles = all.state.particles();
  double fastest = 0;
  while (!all.cloths[0].seams.empty()) {
    REQUIRE(all.advance(0.01).done);
    fastest = std::max(fastest, all.state.v.cwiseAbs().maxCoeff());
    REQUIRE(all.state.time < 2);
  }
  CHECK(all.state.particles() == particles - 2 * TwoPanels().ny);
  CHECK(mass(all) == Approx(weight).epsilon(1e-12));
  CHECK(fastest > 0.1);
  CHECK(momentum(all).norm() < 1e-6 * weight * fastest);
  CHECK(all.outgrown.size() == 1);
}

TEST_CASE("what is pinned by group stays, and every part has its own particles", "[sewing]") {
  Assembly all;
  all.add(tube({}));
  all.add(
      SoftPart{.lattice = box_lattice({3, 3, 3}, Vec3::Constant(0.1)), .place = {.translation = {2, 0, 0}}});
  all.pin(PinGroup{"front"});
  all.pin(PinBox{{1, -1, -1}, {3, 0, 1}}, 1);  // its lower two layers
  CHECK(all.constraints->pinned().size() == 99 + 18);
  CHECK(all.cloths[1].first_particle == all.cloths[0].end_particle);
  all.use("implicit-euler", "mpcg");
  const State before = all.state;
  for (int step = 0; step < 5; ++step) REQUIRE(all.advance(0.01).done);
  for (int i : all.constraints->pinned())
    CHECK((all.state.x.segment<3>(3 * i) - before.x.segment<3>(3 * i)).norm() == 0);
  CHECK(all.state.x != before.x);
  CHECK(largest_strain(all.cloths, before.x) < 1);
}

TEST_CASE("faces are kept off bodies, whenever these are added before the system is made", "[sewing]") {
  for (const bool with_body : {false, true}) {
    Assembly all;
    all.add(ClothPart{.mesh = grid(5, 5, 1, 1)});
    if (with_body) all.constraints->add(Obstacle{.shape = Sphere{.centre = {0, -2, 0}, .radius = 1}});
    all.use("implicit-euler", "mpcg");
    CHECK(all.constraints->faces().all().size() == (with_body ? 32 : 0));
  }
}

TEST_CASE("mistakes in what is assembled are told in one line", "[sewing]") {
  CHECK_THROWS_WITH(add_tube({{.name = "a / b", .pairs = {}}}), Contains("seam a / b: has no pairs"));
  CHECK_THROWS_WITH(add_tube({{.name = "a / b", .pairs = {{0, 500}}}}),
                    Contains("vertex 0 to 500") && Contains("0 to 197"));
  CHECK_THROWS_WITH(add_tube({{.name = "a / b", .pairs = {{0, 1}}, .close = -1}}), Contains("not negative"));
  CHECK_THROWS_WITH(add_tube({{.name = "a / b", .pairs = {{0, 1}}, .stiffness = 0}}),
                    Contains("greater than zero"));
  Assembly all;
  CHECK_THROWS_WITH(all.add(ClothPart{.name = "no cloth", .mesh = {}}), Contains("no cloth: refused"));
  CHECK_THROWS_WITH(all.add(ClothPart{.mesh = grid(3, 3, 1, 1), .rest = grid(4, 4, 1, 1)}),
                    Contains("18 triangles and the mesh 8"));
  CHECK_THROWS_WITH(all.add(ClothPart{.mesh = grid(3, 3, 1, 1), .fabric = {.area_density = -1}}),
                    Contains("area_density"));
  CHECK(all.cloths.empty());
  CHECK(all.state.particles() == 0);
  all.add(ClothPart{.mesh = grid(3, 3, 1, 1)});
  all.use("implicit-euler", "mpcg");
  CHECK_THROWS_WITH(all.add(ClothPart{.mesh = grid(3, 3, 1, 1)}), Contains("after use()"));
  CHECK_THROWS_WITH(all.add(SoftPart{.lattice = box_lattice({2, 2, 2}, Vec3::Ones())}),
                    Contains("after use()"));
}

TEST_CASE("mistakes in panels and seams name the panel or the seam where there is no file", "[sewing]") {
  TriangleMesh mesh = flat_tube();
  const std::vector<Polyline> lines = polylines(mesh);
  CHECK_THROWS_WITH(place_panels(mesh, {{.group = "fron"}}),
                    Contains("panel: group = \"fron\"") && Contains("'front'"));
  CHECK_THROWS_WITH(place_panels(mesh, {{.group = "front.left"}}), Contains("is a line of the mesh"));
  CHECK_THROWS_WITH(place_panels(mesh, {{.group = "front"}, {.group = "front"}}),
                    Contains("is in panel 'front'"));
  CHECK_THROWS_WITH(seam_pairs(lines, {"front.left", "back", false, ""}),
                    Contains("seam front.left / back: curves: the mesh has no line 'back'"));
  CHECK_THROWS_WITH(seam_pairs(lines, {"front.left", "front.left", false, ""}), Contains("to itself"));
  CHECK_THROWS_WITH(seam_pairs(lines, {"front.left", "front.top", false, "here"}),
                    Contains("here: seam front.left / front.top: its curves have 9 and 11 vertices"));
  CHECK(declared_seams(grid(3, 3, 1, 1)).empty());
  CHECK(declared_seams(mesh).size() == 2);
  const auto opposite = seam_pairs(lines, {"front.left", "back.right", false, ""}),
             same = seam_pairs(lines, {"front.left", "back.right", true, ""});
  CHECK(opposite.front().second == same.back().second);
  CHECK(opposite.front().first == same.front().first);
}

TEST_CASE("a panel is as wide as it is told to be", "[sewing]") {
  TriangleMesh mesh = flat_tube();
  const std::vector<double> widths =
      place_panels(mesh, {{.group = "front", .wrap = 0.16}, {.group = "back"}});
  REQUIRE(widths.size() == 2);
  CHECK(widths[0] == Approx(0.5));
  CHECK(widths[1] == Approx(0.5));
}

TEST_CASE("strains of triangles tell what edges hide: compression, and area that is lost", "[woven]") {
  Assembly all;
  const TriangleMesh sheet = grid(5, 9, 0.4, 0.8);
  TriangleMesh rest = sheet;  // laid elsewhere
  for (Vec3& x : rest.positions) x = Vec3(x.z(), x.x(), 3);
  all.add({.mesh = sheet, .rest = rest});
  all.add({.mesh = sheet, .model = ClothModel::woven, .imperfection = 0});
  std::vector<double> smallest;
  const auto strained = [&](double along, double across) {
    VecX x = all.state.x;
    for (Eigen::Index i = 0; i < x.size(); i += 3) {  // of the first cloth alone, and shown from the side
      const bool first = i < 3 * sheet.vertex_count();
      x[i] *= first ? 1 + along : 1;
      x[i + 1] = first ? 0.6 * (1 + across) * x[i + 2] : 0.0;
      x[i + 2] *= first ? 0.8 * (1 + across) : 1;
    }
    return triangle_strains(all.cloths, x, smallest);
  };
  for (const auto& [along, across] : {std::pair{0.02, -0.05}, std::pair{-0.3, 0.1}, std::pair{0.0, -1.0}}) {
    INFO(along << " " << across);
    const TriangleStrains s = strained(along, across);
    CHECK(smallest.size() == 2 * sheet.triangles.size());
    CHECK(s.least == Approx(std::min(along, across)).margin(1e-7));
    CHECK(s.first_percent == Approx(std::min(along, across)).margin(1e-7));
    CHECK(s.largest == Approx(std::max(along, across)).margin(1e-7));
    CHECK(s.area_least == Approx(std::min(1.0, (1 + along) * (1 + across))).margin(1e-12));
    CHECK(s.area_kept == Approx(0.5 + 0.5 * (1 + along) * (1 + across)));
  }
  CHECK(largest_strain(all.cloths, all.state.x) < 1e-12);
}

TEST_CASE("a particle is shown with what is strained most there, compression as well as extension",
          "[woven]") {
  for (const ClothModel model : {ClothModel::noh_jung, ClothModel::woven}) {
    Assembly all;
    const TriangleMesh sheet = grid(5, 9, 0.4, 0.8);
    all.add({.mesh = sheet, .model = model, .imperfection = 0});
    std::vector<double> strain;
    particle_strains(all.cloths[0], all.state.x, strain);
    REQUIRE(strain.size() == sheet.positions.size());
    for (double s : strain) CHECK(std::abs(s) < 1e-12);
    for (const auto& [along, across] :
         {std::pair{0.02, -0.05}, std::pair{0.1, -0.03}, std::pair{-0.3, 0.0}}) {
      VecX x = all.state.x;
      for (Eigen::Index i = 0; i < x.size(); i += 3) x[i] *= 1 + along, x[i + 2] *= 1 + across;
      particle_strains(all.cloths[0], x, strain);
      for (double s : strain) CHECK(s == Approx(std::abs(along) > std::abs(across) ? along : across));
    }
    // Simple shear lengthens one diagonal more than it shortens the other.
    VecX x = all.state.x;
    for (Eigen::Index i = 0; i < x.size(); i += 3) x[i] += 0.2 * x[i + 2];
    particle_strains(all.cloths[0], x, strain);
    const double longest = std::sqrt(1.02 + std::sqrt(1.02 * 1.02 - 1)) - 1;  // of the singular values
    if (model == ClothModel::woven)
      for (double s : strain) CHECK(s == Approx(longest));
  }
}
