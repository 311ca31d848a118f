// Garments of flat patterns: the rest shape from uv, panels placed, seams that close.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>
#include <utility>

#include "app/simulation.h"
#include "app/toml_file.h"
#include "mesh/flat_pattern.h"
#include "mesh/generate.h"
#include "mesh/topology.h"
#include "solver/noh_jung.h"
#include "tests/folder.h"
#include "tests/garment.h"
#include "tests/mistakes.h"
#include "tests/same_bits.h"

using namespace drape;
using namespace drape::test;
using Catch::Contains;

namespace {

struct Tailor : Folder {
  TwoPanels panels;
  explicit Tailor(TwoPanels p = {}) : panels(p) { write("tube.obj", panels.obj()); }

  Scene scene(const std::string& more, const std::string& before = "") const {
    return read_scene(parse_toml(tube_cloth + more + before, "scene.toml"), {}, path, "scene.toml");
  }
  Simulation simulation(const std::string& more, const std::string& before = "") const {
    return make_simulation(scene(more, before));
  }
  // The widest gap between the sides that are sewn [m].
  double gap(const Simulation& s) const {
    const std::vector<Vec3> x = s.cloths[0].embedding.positions(s.state.x);
    double widest = 0;
    for (int j = 0; j < panels.ny; ++j)
      for (int p : {0, 1}) {
        const int left = panels.vertex(p, 0, j), right = panels.vertex(1 - p, panels.nx - 1, j);
        widest =
            std::max(widest, (x[static_cast<std::size_t>(left)] - x[static_cast<std::size_t>(right)]).norm());
      }
    return widest;
  }
};

const std::string pinned = "pins = [{ group = \"front.top\" }]\n";
const std::string light = "[simulation]\ntime_step = 0.01\n";

void advance(Simulation& s, double until) {
  while (s.state.time < until - 1e-9) REQUIRE(s.advance(0.01).done);
}

Vec3 momentum(const Simulation& s) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < s.state.particles(); ++i)
    sum += s.system->masses()[static_cast<std::size_t>(i)] * s.state.v.segment<3>(3 * i);
  return sum;
}
double mass(const Simulation& s) {
  return std::accumulate(s.system->masses().begin(), s.system->masses().end(), 0.0);
}

// By the ends, however the list is ordered.
template <class Connection>
std::map<std::pair<int, int>, Connection> by_ends(const std::vector<Connection>& all) {
  std::map<std::pair<int, int>, Connection> map;
  for (const Connection& c : all) map.emplace(std::minmax(c.i, c.j), c);
  return map;
}

}  // namespace

TEST_CASE("a cloth laid out as its pattern has no energy, and elsewhere what the pattern says", "[sewing]") {
  for (bool quads : {false, true}) {
    const TriangleMesh mesh = parse_obj(TwoPanels{.quads = quads}.obj(), "flat.obj");
    const TriangleMesh flat = flat_pattern(mesh);
    REQUIRE(flat.triangles.size() == mesh.triangles.size());
    TriangleMesh wide = mesh;
    for (Vec3& x : wide.positions) x[0] *= 1.1;
    for (const TriangleMesh* shape : {&std::as_const(mesh), &std::as_const(wide)}) {
      System system(lumped_mass(*shape, flat, 0.2));
      CHECK(std::accumulate(system.masses().begin(), system.masses().end(), 0.0) == Approx(0.2 * 0.4));
      system.add(forces_of(noh_jung_connections(*shape, flat, {}), {}));
      CHECK(system.elastic_energy(stacked(mesh.positions)) < 1e-10);  // six decimals in the file
      CHECK(system.elastic_energy(stacked(wide.positions)) > 0.1);
    }
    const TriangleMesh larger = flat_pattern(mesh, 2);
    CHECK(triangle_area(larger, larger.triangles[0]) == Approx(4 * triangle_area(flat, flat.triangles[0])));
  }
}

TEST_CASE("where the pattern is cut the cloth is joined as if it were not", "[sewing]") {
  const TriangleMesh whole = equilateral_sheet(8, 7, 0.05);
  TriangleMesh cut;  // every triangle by itself, moved and turned as it likes
  for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
    const double angle = 0.7 * static_cast<double>(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = whole.positions[static_cast<std::size_t>(whole.triangles[t][k])];
      cut.positions.emplace_back(std::cos(angle) * x.x() - std::sin(angle) * x.z() + angle, 0,
                                 std::sin(angle) * x.x() + std::cos(angle) * x.z());
    }
    const int first = static_cast<int>(3 * t);
    cut.triangles.push_back({first, first + 1, first + 2});
  }
  const Fabric fabric{.stretch = 700, .bend = 2e-5};
  const Connections as_whole = noh_jung_connections(whole, whole, fabric),
                    as_cut = noh_jung_connections(whole, cut, fabric);
  const auto stretch = by_ends(as_whole.stretch);
  const auto bend = by_ends(as_whole.bend);
  REQUIRE(as_cut.stretch.size() == stretch.size());
  REQUIRE(as_cut.bend.size() == bend.size());
  for (const auto& [ends, s] : by_ends(as_cut.stretch)) {
    CHECK(s.L == Approx(stretch.at(ends).L));
    CHECK(s.k == Approx(stretch.at(ends).k));
  }
  for (const auto& [ends, b] : by_ends(as_cut.bend)) {
    CHECK(b.L == Approx(bend.at(ends).L));
    CHECK(b.k_b == Approx(bend.at(ends).k_b));
    CHECK(b.clamp_k2 == Approx(bend.at(ends).clamp_k2));
  }
}

TEST_CASE("two sides of different lengths are two springs side by side, of the same stiffness together",
          "[sewing]") {
  TriangleMesh pair, rest;
  pair.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -1, 0}};
  pair.triangles = {{0, 1, 2}, {1, 0, 3}};
  rest.positions = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0, 0, 0}, {1.2, 0, 0}, {0.6, -1, 0}};
  rest.triangles = {{0, 1, 2}, {4, 3, 5}};
  const Connections c = noh_jung_connections(pair, rest, {.stretch_spring = 100});
  double k = 0;
  std::vector<double> lengths;
  for (const StretchConnection& s : c.stretch)
    if (std::minmax(s.i, s.j) == std::pair<const int&, const int&>(0, 1)) {
      k += s.k;
      lengths.push_back(s.L);
    }
  CHECK(k == Approx(100));
  REQUIRE(lengths.size() == 2);
  CHECK(lengths[0] == Approx(1));
  CHECK(lengths[1] == Approx(1.2));
  REQUIRE(c.bend.size() == 1);
  CHECK(c.bend[0].L == Approx(2));  // unfolded, middle on middle
}

TEST_CASE("a panel that is wrapped keeps its lengths along and round the cylinder", "[sewing]") {
  const Tailor tailor;
  const Simulation s = tailor.simulation("");
  const std::vector<Vec3>& x = s.cloths[0].mesh.positions;
  for (int p : {0, 1})
    for (int j = 0; j < tailor.panels.ny; ++j)
      for (int i = 0; i < tailor.panels.nx; ++i) {
        Vec3 on = x[static_cast<std::size_t>(tailor.panels.vertex(p, i, j))];
        on.z() -= p == 0 ? 0.02 : -0.02;
        CHECK(std::hypot(on.x(), on.z()) == Approx(0.16));
        CHECK(on.z() * (p == 0 ? 1 : -1) > -0.01);  // in front, or behind
        CHECK(on.y() == Approx(0.4 * j / (tailor.panels.ny - 1) - 0.2));
        if (i == 0) continue;
        const Vec3& before = x[static_cast<std::size_t>(tailor.panels.vertex(p, i - 1, j))];
        const double chord = 2 * 0.16 * std::sin(0.5 * 0.05 / 0.16);
        CHECK((x[static_cast<std::size_t>(tailor.panels.vertex(p, i, j))] - before).norm() ==
              Approx(chord).epsilon(1e-5));
      }
}

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
      for (int& v : t) v = weld[static_cast<std::size_t>(v)];
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

TEST_CASE("a pattern named by the scene is the mesh that triangulate writes", "[sewing]") {
  const Folder folder;
  folder.write(
      "p.toml",
      "unit = \"1 cm\"\n[[panel]]\nname = \"a\"\noutline = [[0, 0], [30, 0], { bezier = [[33, 20]] }, "
      "[28, 40], [2, 40]]\nsides = [\"hem\", \"right\", \"waist\", \"left\"]\n");
  REQUIRE(folder.drape("triangulate p.toml -o p.obj --edge 3cm --quiet").exit_code == 0);
  const auto made = [&](const std::string& text) {
    return make_simulation(
        read_scene(parse_toml("[[cloth]]\nname = \"c\"\n" + text, "s.toml"), {}, folder.path, "s.toml"));
  };
  const Simulation drawn = made("mesh = \"p.toml\"\nedge = \"3 cm\"\npins = [{ group = \"a.waist\" }]\n");
  const Simulation cut = made("mesh = \"p.obj\"\nrest = \"uv\"\npins = [{ group = \"a.waist\" }]\n");
  CHECK(drawn.state.x == cut.state.x);
  CHECK(drawn.cloths[0].mesh.triangles == cut.cloths[0].mesh.triangles);
  CHECK(drawn.constraints->pinned() == cut.constraints->pinned());
  CHECK(drawn.system->masses() == cut.system->masses());
  CHECK(drawn.system->elastic_energy(drawn.state.x) < 1e-20);
  CHECK_THROWS_WITH(made("mesh = \"p.obj\"\nedge = \"3 cm\"\n"), Contains("s.toml:4") && Contains("pattern"));
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

TEST_CASE("a rest shape folded onto itself in uv is the sheet unfolded", "[sewing]") {
  TriangleMesh flap, folded;
  flap.positions = {{0, 0, 0}, {1, 0, 0}, {0.4, 1, 0}, {0.5, -0.8, 0}};
  flap.triangles = {{0, 1, 2}, {1, 0, 3}};
  folded = flap;
  folded.positions[3].y() = 0.8;  // on the side of the other one
  const Connections open = noh_jung_connections(flap, flap, {}),
                    mirrored = noh_jung_connections(flap, folded, {});
  REQUIRE(mirrored.bend.size() == 1);
  CHECK(mirrored.bend[0].L == Approx(open.bend[0].L));
  CHECK(mirrored.bend[0].k_b == Approx(open.bend[0].k_b));
}

TEST_CASE("a pattern that is scaled rests scaled", "[sewing]") {
  const Tailor tailor;
  const Simulation plain = tailor.simulation(""), twice = tailor.simulation("scale = 2\n");
  REQUIRE(plain.cloths[0].edges.size() == twice.cloths[0].edges.size());
  for (std::size_t k = 0; k < plain.cloths[0].edges.size(); ++k)
    CHECK(twice.cloths[0].edges[k].L == Approx(2 * plain.cloths[0].edges[k].L));
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
    CHECK((x[v] - s.cloths[0].mesh.positions[v]).norm() < 1e-12);
  }
}

TEST_CASE("what rests is not settled while its seams are closing", "[sewing]") {
  const Tailor tailor;
  tailor.write("s.toml", tube_cloth +
                             "seams = [{ close = \"1.5 s\" }]\npins = [{ group = \"front\" }, { group = "
                             "\"back\" }]\n[simulation]\nstop_when_settled = true\nduration = 3\n");
  const Outcome run = tailor.drape("simulate s.toml --out o --frames none --quiet");
  REQUIRE(run.exit_code == 0);
  CHECK(content(tailor.path / "o/run.json").find("has not closed") != std::string::npos);
}

TEST_CASE("seams make no scene unstable", "[sewing]") {
  const Tailor tailor;
  tailor.write("s.toml", tube_cloth + "seams = [{ close = \"0.1 s\" }]\n" + pinned);
  const Outcome run =
      tailor.drape("stability s.toml --time 0.2s --integrators implicit-euler --out st --quiet");
  REQUIRE(run.exit_code == 0);
  CHECK(content(tailor.path / "st/stability.csv").find("none") == std::string::npos);
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
    CHECK((x[v] - s.cloths[0].mesh.positions[v]).norm() < 1e-12);
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

TEST_CASE("an explicit method does not take the work of a seam for an explosion", "[sewing]") {
  const Tailor tailor;
  Simulation s = tailor.simulation("seams = [{ close = 0.2 }]\n" + pinned + "bend = 0\nstretch = 50\n",
                                   "[simulation]\ntime_step = 0.001\nintegrator = \"symplectic-euler\"\n");
  while (s.state.time < 0.4) REQUIRE(s.advance(0.001).done);
  CHECK(s.cloths[0].seams.empty());
}

TEST_CASE("mistakes in a garment say where they are", "[sewing]") {
  const Tailor tailor;
  const std::vector<Mistake> mistakes = {
      {"seams = [{ curves = [\"front.left\"] }]\n", "scene.toml:7:", "expected two names"},
      {"seams = [{ curves = [\"front.left\", \"back.lift\"] }]\n", "scene.toml:7:", "did you mean"},
      {"seams = [{ curves = [\"front.left\", \"back.top\"] }]\n", "scene.toml:7:", "9 and 11 vertices"},
      {"seams = [{ direction = \"same\" }]\n", "scene.toml:7:", "expected curves"},
      {"seams = [{ close = \"3 m\" }]\n", "scene.toml:7:", "close"},
      {"seams = [{ then = \"glue\" }]\n", "scene.toml:7:", "merge"},
      {"seams = [{ stiffness = -1 }]\n", "scene.toml:7:", "stiffness"},
      {"seams = [{ curves = [\"front.top\", \"front.top\"] }]\n", "scene.toml:7:", "to itself"},
      {"seams = [{}, { curves = [\"back.right\", \"front.left\"] }]\n", "scene.toml:7:", "sewn twice"},
      {"seams = [{}]\nmodel = \"choi-ko\"\n", "scene.toml:8:", "noh-jung"},
  };
  check_mistakes(mistakes, [&](const std::string& text) { return tailor.simulation(text); });
  const auto with_cloth = [&](const std::string& keys, const std::string& obj) {
    tailor.write("other.obj", obj);
    return [&, keys] {
      return make_simulation(read_scene(parse_toml("[[cloth]]\nmesh = \"other.obj\"\n" + keys, "scene.toml"),
                                        {}, tailor.path, "scene.toml"));
    };
  };
  const std::string lines = tailor.panels.obj();
  CHECK_THROWS_WITH(with_cloth("panels = [{ group = \"front.left\" }]\n", lines)(),
                    Contains("a line of the mesh"));
  CHECK_THAT(with_cloth("panels = [{ group = \"front\", wrap = 0.05 }]\n", lines)().messages.front(),
             Contains("more than once round"));
  CHECK_THAT(with_cloth("rest = \"uv\"\nuv_scale = 3\n", lines)().messages.front(),
             Contains("another uv_scale") && Contains("with 1 m"));
  const std::string plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  CHECK_THROWS_WITH(with_cloth("rest = \"uv\"\n", plain)(), Contains("no texture coordinates"));
  CHECK_THROWS_WITH(with_cloth("rest = \"uv\"\n", "vt 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\n")(),
                    Contains("face 1") && Contains("no area"));
  CHECK_THROWS_WITH(with_cloth("uv_scale = 2\n", plain)(), Contains("uv_scale"));
  CHECK_THROWS_WITH(with_cloth("seams = [{}]\n", plain)(), Contains("declares none"));
  CHECK_THROWS_WITH(with_cloth("seams = [{ curves = [\"a\", \"b\"] }]\n", plain)(),
                    Contains("it has no lines"));
  CHECK_THROWS_WITH(with_cloth("panels = [{ group = \"front\" }]\n", plain)(), Contains("no such group"));
  CHECK_THROWS_WITH(with_cloth("panels = [{ group = \"a\" }, { group = \"b\" }]\n",
                               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\ng a\nf 1 2 3\ng b\nf 2 4 3\n")(),
                    Contains("vertex 1") && Contains("'a', too"));
}

TEST_CASE("what is gathered is said", "[sewing]") {
  TwoPanels narrow{.back_width = 0.5};
  std::string text = narrow.obj();
  // The back's sides are half as long again: the file says so in uv only.
  const Tailor tailor(narrow);
  const auto about_seams = [&] {
    Names lines = tailor.simulation("seams = [{ close = 1 }]\n").messages;
    std::erase_if(lines, [](const std::string& line) { return line.find("seam") == line.npos; });
    return lines;
  };
  CHECK(about_seams().empty());
  TwoPanels tall = narrow;
  tall.height = 0.6;
  std::string other = tall.obj();
  const std::size_t back = static_cast<std::size_t>(narrow.nx * narrow.ny);
  std::string mixed;
  std::istringstream one(text), two(other);
  std::string a, b;
  for (std::size_t v = 0; std::getline(one, a) && std::getline(two, b);) {
    const bool point = a.starts_with("v ") || a.starts_with("vt ");
    mixed += (point && v / 2 >= back ? b : a) + "\n";
    v += point;
  }
  tailor.write("tube.obj", mixed);
  const Names gathered = about_seams();
  REQUIRE(gathered.size() == 2);
  CHECK_THAT(gathered[0], Contains("front.left / back.right") && Contains("gathered by 50 %"));
}
