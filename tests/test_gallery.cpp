// The scenes of the gallery as the program reads them: nothing of the cloth ends a step inside a body, and no
// cloth that meets cloth passes through any.
//   -phi(x) <= 0        vertices, to round-off: they are guarded
//   -phi(x) <= margin   eight points of every edge: contact is between vertices and a body
// phi [m]: signed distance of the body where it is then. Each scene goes to where its cloth lies on the body,
// or has been hit by it; whole scenes would take minutes.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "app/simulation/sheets.h"
#include "app/simulation/simulation.h"
#include "mesh/triangles/topology.h"
#include "tests/folder.h"

#include "tests/places.h"

using namespace drape;
using namespace drape::app;
namespace fs = std::filesystem;

namespace {

const fs::path scenes = test::source_dir() + "/data/scenes";
constexpr int points_on_edge = 8;
constexpr double round_off = 1e-9;  // m

struct Part {
  const char* scene;
  double until;  // s
  int every;     // steps from one look to the next
};

// clang-format off
const Part gallery[] = {
    {"ball-on-floor", 0.8, 2},    // has come to the floor; the ball turns from 1.5 s on
    {"boxes-stack", 0.4, 4},      // they stand on each other; the sheet comes down
    {"choi-ko-100", 0.5, 1},
    {"choi-ko-200", 0.5, 1},
    {"dress-on-towel", 0.35, 2},  // the dress has come to the towel
    {"dressed-sits", 0.4, 4},     // the poncho has come to the tee
    {"dressed-turn", 1.7, 4},     // the first step and half of the turn
    {"fast-ball", 0.3, 1},        // is thrown back at 0.1 s; the nails come at 0.2 s
    {"fifty-sheets", 0.12, 4},    // the lowest lie on the cylinder
    {"flag", 1.1, 1},             // swings against the pole
    {"funnel", 0.5, 2},           // all three lie in the funnel
    {"layers", 0.5, 2},           // all three have come to each other
    {"ls-ball-0", 0.7, 10},       // slides over the ball and comes to the floor
    {"ls-ball-09", 0.9, 10},
    {"nails", 0.5, 1},            // hangs over the nails
    {"needle", 0.3, 1},           // is driven in at 0.1 s and drawn back
    {"net", 0.9, 1},              // the ball comes to it after 0.32 s
    {"net-on-table", 1.2, 4},     // the ball lies on the table
    {"noh-jung-100", 0.5, 1},
    {"noh-jung-200", 0.5, 1},
    {"pocket", 0.4, 4},           // comes apart in 0.3 s
    {"poncho", 0.6, 2},           // has come to the shoulders
    {"poncho-sewn", 0.5, 4},      // is sewn after 0.2 s
    {"rabbit-clusters", 0.6, 2},
    {"rabbit-links", 0.6, 2},     // has come to the steps
    {"rabbit-seesaw", 0.6, 2},    // the board lies on the floor, and the rabbit on its side
    {"reef-knot", 1.2, 4},        // the bands have come to each other
    {"rope-box", 1.0, 2},         // swings through below its pin
    {"rope-chain", 0.6, 2},
    {"rope-drum", 1.5, 2},        // is hauled over the drum
    {"rope-on-sheet", 0.7, 4},    // the first coil lies
    {"rope-sheet", 0.6, 2},       // the ball has come to the sheet
    {"rotating-ball", 4.8, 1},    // the ball turns from 3 s on, the fastest at 4.5 s
    {"sheet-in-bowl", 0.6, 1},
    {"sheet-on-ball", 0.6, 1},
    {"sheet-torn", 0.7, 2},       // tears, and the ball goes through
    {"skirt-sewn", 0.6, 4},
    {"sleeve-twist", 1.6, 4},     // winds itself up from 1 s on
    {"soft-bowl", 0.8, 10},
    {"soft-plane", 0.5, 10},
    {"soft-sphere", 0.8, 10},     // turns over the ball
    {"soft-stack", 0.5, 1},       // the cloth has come to both cubes
    {"soft-tilted", 0.8, 10},
    {"stack", 0.4, 4},            // half of the ten lie on the cylinder
    {"tablecloth", 0.6, 1},       // hangs over the rims
    {"tablecloth-pull", 1.6, 1},  // and is pulled from 1 s on
    {"tablecloth-under", 0.7, 4}, // is pulled from 0.5 s on
    {"tee", 0.3, 2},
    {"towel", 0.5, 2},            // falls into folds
};
// clang-format on

// The point that is farthest inside a body, or nearest to it.
struct Deepest {
  double depth = -std::numeric_limits<double>::infinity();  // m, negative: outside
  double time = 0;                                          // s
  int a = -1, b = -1;                                       // particles: of the edge, or twice the vertex
  Vec3 place = Vec3::Zero();                                // m, as the body sees it

  void look(const MovingBody& body, const Vec3& x, int i, int j, double t) {
    const double here = -body.distance(x);
    if (here > depth) *this = {here, t, i, j, body.pose().to_body(x)};
  }
};

std::ostream& operator<<(std::ostream& out, const Deepest& d) {
  return out << 1000 * d.depth << " mm at " << d.time << " s, between particles " << d.a << " and " << d.b
             << ", where the body has " << d.place.transpose();
}

struct Depths {
  Deepest vertex, edge;
};

std::vector<RestEdge> edges_of(const std::vector<Cloth>& cloths) {
  std::vector<RestEdge> all;
  for (const Cloth& cloth : cloths) all.insert(all.end(), cloth.edges.begin(), cloth.edges.end());
  return all;
}

void look(const MovingBody& body, const std::vector<RestEdge>& edges, const State& state, Depths& depths) {
  const auto at = [&](int i) { return Vec3(state.x.segment<3>(3 * i)); };
  for (int i = 0; i < state.particles(); ++i) depths.vertex.look(body, at(i), i, i, state.time);
  for (const RestEdge& e : edges) {
    const Vec3 a = at(e.i), way = at(e.j) - a;
    // A distance changes no faster than the place: from there none of the points is inside.
    if (body.distance(a + 0.5 * way) > 0.5 * way.norm()) continue;
    for (int k = 1; k <= points_on_edge; ++k)
      depths.edge.look(body, a + k / (points_on_edge + 1.0) * way, e.i, e.j, state.time);
  }
}

void check_part(const Part& part, const Scene& scene) {
  Simulation simulation = make_simulation(scene);
  const std::vector<MovingBody>& bodies = simulation.constraints->bodies();
  std::vector<Depths> depths(bodies.size());
  const double h = scene.simulation.time_step;
  const long steps = std::lround(part.until / h);
  const bool layers = std::any_of(scene.cloths.begin(), scene.cloths.end(),
                                  [](const ClothEntry& cloth) { return cloth.self_contact; });
  const auto crossings = [&] { return Sheets(simulation.cloths, simulation.state.x).crossings(); };
  const int at_start = layers ? crossings() : 0;
  for (long n = 1; n <= steps; ++n) {
    INFO(part.scene << ", step " << n);
    REQUIRE(simulation.advance(h).done);
    for (std::size_t k = 0; k < bodies.size() && n % part.every == 0; ++k)
      look(bodies[k], edges_of(simulation.cloths), simulation.state, depths[k]);
    if (layers && n % 5 == 0) CHECK(crossings() <= at_start);
  }
  bool met = false;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const double margin = bodies[k].obstacle().margin;
    INFO(part.scene << ", " << scene.obstacles[k].name << ", margin " << 1000 * margin << " mm");
    INFO("vertices: " << depths[k].vertex);
    INFO("edges: " << depths[k].edge);
    CHECK(depths[k].vertex.depth <= round_off);
    CHECK(depths[k].edge.depth <= margin);
    met = met || depths[k].vertex.depth > -1.01 * margin;
  }
  INFO(part.scene);
  CHECK((met || bodies.empty()));  // the cloth has come to a body
}

// Whether all that the scene reads is there. The motion of a body is not kept but made: here, if it must be.
bool complete(Scene& scene, const test::Folder& folder) {
  const std::string script = test::source_dir() + "/data/meshes/make_motion.py";
  for (ObstacleEntry& obstacle : scene.obstacles)
    for (fs::path& file : obstacle.frames.files) {
      if (fs::exists(file)) continue;
      const test::Outcome made =
          folder.shell("/usr/bin/python3 '" + script + "' '" + obstacle.mesh.string() + "' motion.pc2");
      if (made.exit_code != 0) {
        WARN(scene.label << " is skipped: there is no " << file << ", and it was not made: " << made.err);
        return false;
      }
      file = folder.path / "motion.pc2";
    }
  return true;
}

}  // namespace

TEST_CASE("a look at the cloth finds what is inside a body", "[gallery]") {
  Constraints constraints;
  constraints.add(Obstacle{.shape = Sphere{{0, 0, 0}, 0.3}});
  const std::vector<RestEdge> edges = {{0, 1, 1}, {1, 2, 1}};
  State state{0.5, VecX::Zero(9), VecX::Zero(9)};
  // An edge over the top, and one that leads away.
  state.x << -0.09, 0.295, 0, 0.09, 0.295, 0, 0.09, 0.295, 5;
  Depths depths;
  look(constraints.bodies()[0], edges, state, depths);
  CHECK(depths.vertex.depth == Approx(0.3 - std::hypot(0.09, 0.295)));  // outside
  CHECK(depths.vertex.depth < 0);
  CHECK(depths.edge.depth == Approx(0.3 - std::hypot(0.01, 0.295)));  // the fourth point of eight
  CHECK((depths.edge.a == 0 && depths.edge.b == 1));
  CHECK(depths.edge.time == 0.5);
}

TEST_CASE("nothing of the cloth ends a step inside a body or in cloth, in the whole gallery", "[gallery]") {
  std::set<std::string> listed, found;
  for (const Part& part : gallery) listed.insert(part.scene);
  for (const auto& file : fs::directory_iterator(scenes))
    if (file.path().extension() == ".toml") {
      const Scene scene = read_scene(file.path(), {});
      if (!scene.obstacles.empty() || std::any_of(scene.cloths.begin(), scene.cloths.end(),
                                                  [](const ClothEntry& cloth) { return cloth.self_contact; }))
        found.insert(file.path().stem().string());
    }
  CHECK(found == listed);
  for (const Part& part : gallery) DYNAMIC_SECTION(part.scene) {
      const test::Folder folder;
      Scene scene = read_scene(scenes / (std::string(part.scene) + ".toml"), {});
      if (complete(scene, folder)) check_part(part, scene);
    }
}

TEST_CASE("the contacts of garments on a body settle in every step, with few solves", "[gallery]") {
  for (const char* name : {"tee", "poncho"})
    for (const char* model : {"woven", "noh-jung"}) {
      const Scene scene = read_scene(scenes / (std::string(name) + ".toml"),
                                     {parse_setting("cloth.0.model=" + std::string(model))});
      Simulation simulation = make_simulation(scene);
      constexpr int steps = 60;
      int solves = 0;
      for (int n = 0; n < steps; ++n) {
        const StepReport report = simulation.advance(scene.simulation.time_step);
        INFO(name << ", " << model << ", step " << n << ": contact residual " << report.contact_residual);
        REQUIRE(report.done);
        CHECK(report.converged);
        solves += report.linear_solves;
      }
      CHECK(solves < 9 * steps);
    }
}
