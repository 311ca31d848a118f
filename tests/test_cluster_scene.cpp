// Clusters in a scene: the keys of a cloth and of a soft body, what becomes of them, and every mistake in one
// line.
#include "app/simulation/simulation.h"
#include "tests/mistakes.h"
#include "tests/places.h"
#include "tests/workshop.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

namespace {

const std::string cloth = "[[cloth]]\nmesh = \"sheet-625.obj\"\nclusters = \"faces\"\n";  // three lines
const std::string soft = "[[soft]]\nparticles = [4, 3, 5]\nspacing = \"10 cm\"\n";        // three lines

Scene scene_of(const std::string& text) {
  return read_scene(parse_toml(text, "scene.toml"), {}, source_dir() + "/data/meshes", "scene.toml");
}

}  // namespace

TEST_CASE("a scene says that faces are clusters, and what viscosity soft ones have", "[clusters]") {
  CHECK(scene_of(cloth).cloths[0].clusters);
  CHECK_FALSE(scene_of("[[cloth]]\nmesh = \"a.obj\"\n").cloths[0].clusters);
  CHECK(scene_of(cloth + "model = \"woven\"\n").cloths[0].clusters);
  CHECK(scene_of(soft + "clusters = \"cells\"\nviscosity = \"5 ms\"\n").softs[0].material.viscosity ==
        Approx(0.005));
}

TEST_CASE("a mistake about clusters is told with its line", "[clusters]") {
  const Mistake table[] = {
      {"[[cloth]]\nmesh = \"a.obj\"\nclusters = \"face\"\n", "scene.toml:3:", "faces"},
      {"[[cloth]]\nmesh = \"a.obj\"\nclusters = 12\n", "scene.toml:3:", "clusters"},
      {cloth + "model = \"choi-ko\"\n", "scene.toml:3:", "expected \"noh-jung\" or \"woven\""},
      {cloth + "stretch_spring = 200\n", "scene.toml:3:", "stretch_spring is of springs"},
      {cloth + "neighbour_weighting = true\n", "scene.toml:3:", "neighbour_weighting is of springs"},
      {cloth + "model = \"woven\"\ncompression = 0.5\n",
       "scene.toml:5:", "faces that are clusters resist it"},
      {soft + "clusters = \"cells\"\ndamping = 1\n", "scene.toml:5:", "they take viscosity"},
      {soft + "viscosity = \"1 ms\"\n", "scene.toml:4:", "springs take damping"},
      {soft + "clusters = \"cells\"\nviscosity = -1\n", "scene.toml:5:", "viscosity"},
      {soft + "clusters = \"faces\"\n", "scene.toml:4:", "expected \"cells\""},
  };
  check_mistakes(table, scene_of);
}

TEST_CASE("clusters of a scene need pbd, and are run and recorded by it", "[clusters]") {
  const Workshop shop;
  const std::string faces =
      "[[cloth]]\nmesh = \"sheet.obj\"\nclusters = \"faces\"\npins = [{ vertices = [0] }]\n";
  shop.write("implicit.toml", faces);
  const Outcome refused = shop.drape("simulate implicit.toml");
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, Catch::Contains("'clusters' has no stiffness for a matrix; take \"pbd\""));
  CHECK(lines_of(refused.err) == 1);
  shop.write("faces.toml", "[simulation]\nintegrator = \"pbd\"\nduration = 0.05\n" + faces);
  const Outcome run = shop.drape("simulate faces.toml --out o");
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK(shop.drape("simulate faces.toml --out p --threads 2").exit_code == 0);
  CHECK(shop.json("o/run.json")["state_hash"] == shop.json("p/run.json")["state_hash"]);
}
