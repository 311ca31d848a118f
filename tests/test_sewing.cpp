// Seams as they run: they close, are merged or kept, and take masses, momentum, pins and bodies with them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "mesh/triangles/topology.h"
#include "solver/assembly/assembly.h"
#include "tests/garment.h"
#include "tests/same_bits.h"
#include "tests/tearing.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

namespace {

void advance(Simulation& s, double until) {
  while (s.state.time < until - 1e-9) REQUIRE(s.advance(0.01).done);
}

Vec3 momentum(const Simulation& s) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < s.state.particles(); ++i) sum += s.system->masses()[i] * s.state.v.segment<3>(3 * i);
  return sum;
}
double mass(const Simulation& s) {
  return std::accumulate(s.system->masses().begin(), s.system->masses().end(), 0.0);
}

}  // namespace

TEST_CASE("seams close, become one, and the garment is a tube without a cut", "[sewing]") {
  const Tailor tailor;
  for (const char* integrator : {"implicit-euler", "bdf2"}) {
    Simulation s = tailor.simulation("seams = [{ close = 0.3 }]\n" + pinned,
                                     light + "integrator = \"" + integrator + "\"\n");
    CHECK(s.cloths[0].seams.size() == 2);
    const int particles = s.state.particles();
    const double weight = mass(s);
    CHECK(tailor.gap(s) > 0.03);
    advance(s, 1);
    CHECK(s.cloths[0].seams.empty());
    CHECK(tailor.gap(s) == 0);
    CHECK(s.state.particles() == particles - 2 * tailor.panels.ny);
    CHECK(mass(s) == Approx(weight).epsilon(1e-12));

    TriangleMesh sewn = s.cloths[0].mesh;  // welded where vertices are in the same place
    sewn.positions = s.cloths[0].embedding.positions(s.state.x);
    const std::vector<int> weld = welded(sewn.positions);
    for (Triangle& t : sewn.triangles)
      for (int& v : t) v = weld[v];
    CHECK(boundary_loops(sewn).size() == 2);  // top and bottom
    CHECK(holes(s.cloths[0].mesh).size() == 2);
    double longest = 0;
    for (const RestEdge& e : s.cloths[0].edges)
      longest =
          std::max(longest, (s.state.x.segment<3>(3 * e.i) - s.state.x.segment<3>(3 * e.j)).norm() / e.L - 1);
    CHECK(longest < 0.05);
  }
}

TEST_CASE("seams that meet in a corner close one after the other", "[sewing]") {
  const Tailor tailor;
  Simulation s = tailor.simulation(
      "seams = [{ close = 0.2 }, { curves = [\"front.top\", \"back.top\"], close = 0.5 }]\n",
      light + "gravity = [0, 0, 0]\n");
  const int particles = s.state.particles();
  const double weight = mass(s);
  advance(s, 0.4);
  CHECK(s.cloths[0].seams.size() == 1);
  CHECK(s.state.particles() == particles - 2 * tailor.panels.ny);
  advance(s, 2);
  CHECK(s.cloths[0].seams.empty());
  CHECK(s.state.particles() == particles - 2 * tailor.panels.ny - (tailor.panels.nx - 2));
  CHECK(mass(s) == Approx(weight).epsilon(1e-12));
  TriangleMesh bag = s.cloths[0].mesh;
  for (Triangle& t : bag.triangles)
    for (int& v : t) v = s.cloths[0].embedding.particle(v);
  CHECK(boundary_loops(bag).size() == 1);  // the lower edge
}

TEST_CASE("a corner whose sides are both sewn keeps its mass, and a soft body beside it its springs",
          "[sewing]") {
  const Folder folder;
  std::string pillow = "unit = \"1 cm\"\n";
  for (int p = 0; p < 2; ++p)
    pillow += "[[panel]]\nname = \"" + std::string(p == 0 ? "a" : "b") + "\"\noutline = [[" +
              std::to_string(60 * p) + ", 0], [" + std::to_string(40 + 60 * p) + ", 0], [" +
              std::to_string(20 + 60 * p) + ", 35]]\nsides = [\"x\", \"y\", \"z\"]\n";
  pillow +=
      "[[seam]]\ncurves = [\"a.x\", \"b.x\"]\n[[seam]]\ncurves = [\"a.y\", \"b.z\"]\n"
      "[[seam]]\ncurves = [\"a.z\", \"b.y\"]\n";
  folder.write("pillow.toml", pillow);
  for (const bool weighted : {false, true}) {
    Simulation s = make_simulation(read_scene(
        parse_toml(
            std::string(
                "[simulation]\ngravity = [0, 0, 0]\n[[cloth]]\nmesh = \"pillow.toml\"\nedge = \"6 cm\"\n"
                "panels = [{ group = \"a\" }, { group = \"b\", rotate = { axis = [0, 1, 0], angle = \"180 "
                "deg\" }, "
                "translate = [0, 0, -0.02] }]\nseams = [{ close = 0.2 }]\nneighbour_weighting = ") +
                (weighted ? "true" : "false") +
                "\n[[soft]]\nparticles = [3, 3, 3]\nspacing = 0.1\ntranslate = [0, 1, 0]\n",
            "s.toml"),
        {}, folder.path, "s.toml"));
    const double weight = mass(s);
    advance(s, 1);
    CHECK(s.cloths[0].seams.empty());
    CHECK(mass(s) == Approx(weight).epsilon(1e-12));
    for (const RestEdge& e : s.cloths[1].edges) {
      REQUIRE(std::max(e.i, e.j) < s.state.particles());
      CHECK((s.state.x.segment<3>(3 * e.i) - s.state.x.segment<3>(3 * e.j)).norm() ==
            Approx(e.L).epsilon(1e-3));
    }
  }
}

TEST_CASE("a pin that stands and one that moves become the first of them", "[sewing]") {
  const Tailor tailor;
  Simulation s = tailor.simulation(
      "seams = [{ close = 0.1 }]\npins = [{ group = \"front.right\" }, { group = \"back.left\", motion = "
      "{ keyframes = [{ time = 0 }, { time = 0.15, translate = [0, 0, 0.04] }, "
      "{ time = 1, translate = [0, 0.5, 0] }] } }]\n",
      light);
  advance(s, 0.8);
  CHECK(s.cloths[0].seams.size() <= 1);
  const std::vector<Vec3> x = s.cloths[0].embedding.positions(s.state.x);
  for (int j = 0; j < tailor.panels.ny; ++j) {
    const auto v = static_cast<std::size_t>(tailor.panels.vertex(0, tailor.panels.nx - 1, j));
    CHECK((x[v] - s.cloths[0].mesh.positions[v]).norm() < s.cloths[0].imperfection + 1e-12);
  }
}

TEST_CASE("a seam that is kept holds to a micrometre", "[sewing]") {
  const Tailor tailor;
  Simulation s = tailor.simulation("seams = [{ close = 0.3, then = \"keep\" }]\n" + pinned, light);
  const int particles = s.state.particles();
  advance(s, 1.2);
  CHECK(s.state.particles() == particles);
  CHECK(tailor.gap(s) < 1e-6);
}

TEST_CASE("sewing is an inner matter: without gravity momentum stays what it was", "[sewing]") {
  const Tailor tailor({.back_width = 0.45});
  Simulation s = tailor.simulation("seams = [{ close = 0.2 }]\ndamping = 0\n",
                                   light + "gravity = [0, 0, 0]\ntolerance = 1e-10\n");
  double fastest = 0;
  while (!s.cloths[0].seams.empty()) {
    REQUIRE(s.advance(0.01).done);
    for (int i = 0; i < s.state.particles(); ++i)
      fastest = std::max(fastest, s.state.v.segment<3>(3 * i).norm());
    REQUIRE(s.state.time < 2);
  }
  CHECK(fastest > 0.1);
  CHECK(momentum(s).norm() < 1e-6 * mass(s) * fastest);
}

TEST_CASE("a pin stays a pin when its particle is sewn to another one", "[sewing]") {
  const Tailor tailor;
  Simulation s = tailor.simulation("seams = [{ close = 0.2 }]\n" + pinned, light);
  advance(s, 1);
  REQUIRE(s.cloths[0].seams.empty());
  CHECK(s.constraints->pinned().size() == static_cast<std::size_t>(tailor.panels.nx));
  const std::vector<Vec3> x = s.cloths[0].embedding.positions(s.state.x);
  for (int i = 1; i + 1 < tailor.panels.nx; ++i) {  // between the ones that were sewn
    const auto v = static_cast<std::size_t>(tailor.panels.vertex(0, i, tailor.panels.ny - 1));
    CHECK((x[v] - s.cloths[0].mesh.positions[v]).norm() < s.cloths[0].imperfection + 1e-12);
  }
  const State before = s.state;
  advance(s, 1.2);
  for (int i : s.constraints->pinned()) {
    const Vec3 moved = s.state.x.segment<3>(3 * i) - before.x.segment<3>(3 * i);
    CHECK(moved.norm() < 1e-12);
  }
}

TEST_CASE("a garment that is sewn round a body stands off it, whatever the number of threads", "[sewing]") {
  const Tailor tailor({.nx = 25, .ny = 20});
  check_same_bits([&] {
    Simulation s = tailor.simulation("seams = [{ close = 0.3 }]\ntranslate = [0, 0.3, 0]\n",
                                     light +
                                         "[[obstacle]]\nshape = \"capsule\"\na = [0, -1, 0]\n"
                                         "b = [0, 0.5, 0]\nradius = 0.15\n");
    advance(s, 0.6);
    CHECK(s.cloths[0].seams.empty());
    for (double depth : s.constraints->penetration(s.state.x)) CHECK(depth < 1e-6);
    return s.state;
  });
}

TEST_CASE("a seam that is held apart is not merged by force", "[sewing]") {
  const Tailor tailor;
  Simulation s = tailor.simulation(
      "seams = [{ close = 0.1 }]\npins = [{ group = \"front\" }, "
      "{ group = \"back\" }]\n",
      light);
  advance(s, 0.5);
  CHECK(s.cloths[0].seams.size() == 2);
  CHECK(tailor.gap(s) > 0.03);
}

TEST_CASE("a single pair of vertices is sewn and becomes one", "[sewing]") {
  for (const ClothModel model : {ClothModel::noh_jung, ClothModel::woven})
    for (const int n : {3, 5, 9}) {
      INFO(n);
      ClothPart cloth{.mesh = parse_obj(two_sheets(n, n, 0.02, 0.005), "two.obj"),
                      .fabric = {.area_density = 0.15, .stretch = 200, .bend = 1e-6},
                      .model = model};
      cloth.seams = {{.name = "button", .pairs = {{n * n - 2, n * n + 1}}, .close = 0.1}};
      Assembly all(Vec3::Zero());
      all.add(std::move(cloth));
      all.use("implicit-euler", "cholmod");
      while (all.state.time < 0.3) REQUIRE(all.advance(0.005).done);
      CHECK(all.cloths[0].seams.empty());
      CHECK(all.state.particles() == 2 * n * n - 1);
    }
}

TEST_CASE("an explicit method does not take the work of a seam for an explosion", "[sewing]") {
  const Tailor tailor;
  Simulation s = tailor.simulation(
      "seams = [{ close = 0.2 }]\n" + pinned + "bend = 0\nstretch = 50\n",
      "[simulation]\ntime_step = 0.001\ngravity = [0, 0, 0]\nintegrator = \"symplectic-euler\"\n");
  while (s.state.time < 0.4) REQUIRE(s.advance(0.001).done);
  CHECK(s.cloths[0].seams.empty());
}
