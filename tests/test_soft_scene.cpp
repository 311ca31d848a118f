// [[soft]] in a scene: its keys, what is written, pins, and every mistake in one line.
#include "app/simulation/simulation.h"
#include "mesh/lattice/solid.h"
#include "tests/mistakes.h"
#include "tests/tables.h"
#include "tests/workshop.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

namespace {

const std::string box_text = "[[soft]]\nparticles = [4, 3, 5]\nspacing = \"10 cm\"\n";  // three lines

Scene read(const std::string& text, const std::filesystem::path& folder = "") {
  return read_scene(parse_toml(text, "scene.toml"), {}, folder, "scene.toml");
}

}  // namespace

TEST_CASE("a soft body's keys, their units, and what stands where none is given", "[soft]") {
  const Scene scene = read(
      box_text +
          "name = \"jelly\"\nmass = \"300 g\"\nequal_masses = true\nstructural = \"2 kN/m\"\nshear = 3\n"
          "bend = 4\ndamping = \"0.1 N.s/m\"\ntranslate = [0, \"50 cm\", 0]\n"
          "[[soft]]\nmesh = \"bunny.obj\"\nspacing = 0.05\nyoung = \"15 kPa\"\ndensity = \"0.4 g/cm^3\"\n"
          "damping_kind = \"relative\"\n[[soft]]\nparticles = [3, 2, 2]\nsize = [1, 0.5, \"30 cm\"]\n",
      "folder");
  REQUIRE(scene.softs.size() == 3);
  const SoftEntry& jelly = scene.softs[0];
  CHECK(jelly.name == "jelly");
  CHECK(jelly.particles == std::array<int, 3>{4, 3, 5});
  CHECK(jelly.spacing == Vec3(0.1, 0.1, 0.1));
  CHECK(jelly.material.mass == 0.3);
  CHECK(jelly.material.equal_masses);
  CHECK_FALSE(jelly.material.young);
  CHECK(jelly.material.structural == Approx(2000));
  CHECK(jelly.material.bend == 4);
  CHECK(jelly.material.damping_kind == DampingKind::axial);
  CHECK(scene.softs[1].name == "bunny");
  CHECK(scene.softs[1].mesh == std::filesystem::path("folder/bunny.obj"));
  CHECK(scene.softs[1].material.young == Approx(15e3));
  CHECK(scene.softs[1].material.density == Approx(400));
  CHECK(scene.softs[1].material.damping_kind == DampingKind::relative);
  CHECK(scene.softs[2].name == "soft");
  CHECK((scene.softs[2].spacing - Vec3(0.5, 0.5, 0.3)).norm() < 1e-15);
}

TEST_CASE("a mistake in a soft body is told with its line", "[soft]") {
  const Mistake table[] = {
      {"[[soft]]\nspacing = 1\n", "scene.toml:1:", "expected either particles = [10, 10, 10]"},
      {"[[soft]]\nparticles = [3, 3, 3]\nmesh = \"a.obj\"\nspacing = 1\n",
       "scene.toml:2:", "expected either particles"},
      {"[[soft]]\nmesh = \"a.obj\"\n", "scene.toml:1:", "'spacing' is missing"},
      {"[[soft]]\nparticles = [3, 3]\nspacing = 1\n", "scene.toml:2:", "along x, y and z"},
      {"[[soft]]\nparticles = [3, 1, 3]\nspacing = 1\n", "scene.toml:2:", "at least 2"},
      {"[[soft]]\nparticles = [3, -1, 3]\nspacing = 1\n", "scene.toml:2:", "from 0 up"},
      {"[[soft]]\nparticles = [3, 3, 3]\n", "scene.toml:1:", "either spacing or size"},
      {box_text + "size = [1, 1, 1]\n", "scene.toml:4:", "either spacing or size"},
      {"[[soft]]\nparticles = [3, 3, 3]\nspacing = \"1 kg\"\n", "scene.toml:3:", "expected a length"},
      {"[[soft]]\nparticles = [3, 3, 3]\nsize = [1, 0, 1]\n", "scene.toml:3:", "greater than zero"},
      {box_text + "structural = 1\nshear = 1\n", "scene.toml:1:", "'bend' is missing"},
      {box_text + "structural = 1\nshear = 1\nbend = 1\nyoung = 1\n", "scene.toml:7:", "either young"},
      {box_text + "young = \"3 N/m\"\n", "scene.toml:4:", "expected a modulus"},
      {box_text + "young = -1\n", "scene.toml:4:", "greater than zero"},
      {box_text + "structural = -1\nshear = 1\nbend = 1\n", "scene.toml:4:", "not negative"},
      {box_text + "density = \"3 g/m^2\"\n", "scene.toml:4:", "expected a density"},
      {box_text + "density = 1\nmass = 1\n", "scene.toml:5:", "not both"},
      {box_text + "stretch = 1\n", "scene.toml:4:", "unknown key 'stretch'"},
      {box_text + "damping_kind = \"both\"\n", "scene.toml:4:", "relative, axial"},
      {box_text + box_text, "scene.toml:4:", "two soft bodies are called 'soft'"},
      {"[[sotf]]\n", "scene.toml:1:", "did you mean 'soft'?"},
  };
  check_mistakes(table, [](const std::string& text) { return read(text); });
}

TEST_CASE("a soft body that cannot be made is refused before it is", "[soft]") {
  const Workshop shop;
  const auto refused = [&](const std::string& text, const std::string& message) {
    INFO(text);
    shop.write("soft.toml", text);
    const Outcome outcome = shop.drape("simulate soft.toml");
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Catch::StartsWith("error: ") && Catch::Contains(message));
    CHECK(lines_of(outcome.err) == 1);
  };
  refused("[[soft]]\nparticles = [3000, 3000, 3000]\nspacing = 0.001\n", "take a wider spacing");
  refused("[[soft]]\nmesh = \"ball.obj\"\nspacing = 0.0001\n", "take a wider spacing");
  refused("[[soft]]\nmesh = \"sheet.obj\"\nspacing = 0.1\n", "sheet.obj: the mesh is not closed");
  refused("[[soft]]\nmesh = \"none.obj\"\nspacing = 0.1\n", "none.obj: no such file");
  refused("[[soft]]\nparticles = [3, 3, 3]\nsize = [1, 1, 2]\nyoung = 1000\n", "cubic cells");
  refused("[[soft]]\nparticles = [3, 3, 3]\nspacing = 0.1\npins = [{ vertices = [99] }]\n",
          "soft.toml:4: pins");
  refused("[[soft]]\nparticles = [3, 3, 3]\nspacing = 0.1\npins = [{ box = [[5, 5, 5], [6, 6, 6]] }]\n",
          "holds no");
}

TEST_CASE("a scene of soft bodies alone is run, checked and written", "[soft]") {
  const Workshop shop;
  shop.write("soft.toml",
             "[simulation]\nduration = 0.3\ntime_step = 0.01\n[[soft]]\nmesh = \"ball.obj\"\nspacing = 0.15\n"
             "translate = [0, 0.5, 0]\nyoung = 5000\n[[soft]]\nname = \"box\"\nparticles = [3, 4, 3]\n"
             "spacing = 0.1\ntranslate = [1, 0.5, 0]\n[[obstacle]]\nshape = \"plane\"\n");
  CHECK(shop.drape("check soft.toml").exit_code == 0);
  const Outcome outcome = shop.drape("simulate soft.toml --out o");
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK(shop.files("o") == std::set<std::string>{"ball.obj", "ball.pc2", "box.obj", "box.pc2", "fields",
                                                 "run.json", "steps.csv"});
  const Json run = shop.json("o/run.json");
  CHECK(run["cloths"].empty());
  REQUIRE(run["softs"].size() == 2);
  CHECK(run["softs"][1]["particles"] == 36);
  CHECK(run["softs"][1]["structural"] == 2 * 12 + 3 * 9 + 2 * 12);
  CHECK(run["softs"][0]["vertices"] == 162);
  const TriangleMesh ball = read_obj(shop.path / "o/ball.obj");
  CHECK(ball.vertex_count() == 162);  // the user's own
  CHECK(read_obj(shop.path / "o/box.obj").vertex_count() == 36 - 2);
  CHECK(ball.positions[0][1] < read_obj(shop.path / "ball.obj").positions[0][1] + 0.5);
  CHECK(shop.drape("simulate soft.toml --out o2 --threads 2 --set soft.box.mass=0.01").exit_code == 0);
  CHECK(shop.json("o2/run.json")["state_hash"] != run["state_hash"]);
  CHECK(shop.drape("simulate soft.toml --out o2 --threads 2").exit_code == 0);
  CHECK(shop.json("o2/run.json")["state_hash"] == run["state_hash"]);
}

TEST_CASE("mass, placement and pins of soft bodies in a scene", "[soft]") {
  const Workshop shop;
  const TriangleMesh ball = read_obj(shop.path / "ball.obj");
  const Scene scene = read(
      "[[soft]]\nmesh = \"ball.obj\"\nspacing = 0.1\nscale = 2\ndensity = 100\ntranslate = [0, 3, 0]\n"
      "rotate = { axis = [1, 2, 3], angle = 1 }\npins = [{ vertices = [0] }]\n"
      "[[soft]]\nname = \"box\"\nparticles = [3, 3, 3]\nspacing = 0.1\npins = [{ box = [[-0.05, -0.05, "
      "-0.05], "
      "[0.05, 0.05, 0.05]] }]\n",
      shop.path);
  const Simulation s = make_simulation(scene);
  REQUIRE(s.cloths.size() == 2);
  double mass = 0;
  for (int i = 0; i < s.cloths[0].end_particle; ++i) mass += s.system->masses()[i];
  CHECK(mass == Approx(100 * 8 * solid_of(ball).volume).epsilon(1e-9));  // the mesh's, not the cells'
  const std::vector<Vec3> at = s.cloths[0].embedding.positions(s.state.x);
  const Mat3 R = rotation(1, {1, 2, 3});
  for (std::size_t v = 0; v < at.size(); ++v)
    CHECK((at[v] - (R * (2 * ball.positions[v]) + Vec3(0, 3, 0))).norm() < 1e-13);
  // The vertex's corners, and the particle in the middle of the box, which is on no face.
  const auto pinned = s.constraints->pinned();
  CHECK(pinned.size() > 2);
  CHECK(pinned.size() <= 9);
  CHECK(pinned.back() == s.cloths[1].first_particle + 13);
  CHECK(s.system->elastic_energy(s.state.x) < 1e-20);
}
