// What was run, as run.json, compare.json and the pages tell it.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "app/base/json.h"
#include "app/recording/recording.h"
#include "app/recording/scene_record.h"
#include "app/view/page_data.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/generate.h"
#include "tests/folder.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;
using JsonValue = nlohmann::json;

namespace {

struct Bench : Folder {
  Bench() {
    const TriangleMesh sheet = grid(3, 3, 0.4, 0.4);
    write_obj(path / "sheet.obj", sheet, sheet.positions);
    write("s.toml", R"(
[simulation]
duration = "80 ms"
[[cloth]]
mesh = "sheet.obj"
fabric = "cotton-poplin"
model = "noh-jung"
damping = "0.02 N.s/m"
pins = [{ vertices = [0, 2] }, { box = [[-1, -1, 0.1], [1, 1, 1]], follow = "hand" },
        { vertices = [3], motion = { velocity = [0.1, 0, 0] } }]
[[cloth]]
name = "other"
mesh = "sheet.obj"
translate = [0, 3, 0]
stretch_spring = "200 N/m"
bend_spring = "1e-7 N.m^2"
neighbour_weighting = true
[[soft]]
particles = [2, 2, 2]
spacing = "10 cm"
translate = [5, 0, 0]
young = "12 kPa"
pins = [{ box = [[4, -1, -1], [6, 1, 1]] }]
[[obstacle]]
name = "hand"
shape = "sphere"
radius = "5 cm"
centre = [0, -2, 0]
friction = { static = 0.4, kinetic = 0.2 }
margin = "3 mm"
[[obstacle]]
shape = "plane"
point = [0, -4, 0]
)");
  }
  JsonValue json(const std::string& name) const { return JsonValue::parse(content(path / name)); }
};

const std::string changes = " --set cloth.0.bend='12 uN.m' --set obstacle.hand.margin=0.004 ";

void check_scene(const JsonValue& json) {
  const JsonValue& sheet = json["cloths"][0];
  const JsonValue& fabric = sheet["fabric"];
  CHECK(fabric["name"] == "cotton-poplin");
  CHECK(fabric["model"] == "noh-jung");
  CHECK(fabric["bend"].get<double>() == Approx(12e-6));  // set
  CHECK(fabric["damping"] == 0.02);                      // of the scene
  CHECK(fabric["damping_kind"] == "relative");           // by default
  CHECK(fabric["area_density"] > 0.05);                  // of the fabric
  CHECK(fabric["area_density"] < 0.3);
  CHECK(fabric["stretch"] > 100);
  CHECK(fabric["stretch_spring"].is_null());
  CHECK(fabric["buckling_clamp"].is_null());
  CHECK(fabric["neighbour_weighting"] == false);
  REQUIRE(sheet["pins"].size() == 3);
  CHECK(sheet["pins"][0]["vertices"] == JsonValue({0, 2}));
  CHECK(sheet["pins"][0]["count"] == 2);
  CHECK(sheet["pins"][0]["follow"].is_null());
  CHECK(sheet["pins"][1]["box"] == JsonValue::parse("[[-1.0, -1.0, 0.1], [1.0, 1.0, 1.0]]"));
  CHECK(sheet["pins"][1]["count"] == 3);
  CHECK(sheet["pins"][1]["follow"] == "hand");
  CHECK(sheet["pins"][2]["motion"] == "velocity and spin");
  CHECK(sheet["seams"].empty());

  const JsonValue& other = json["cloths"][1]["fabric"];
  CHECK(other["name"].is_null());
  CHECK(other["stretch"].is_null());
  CHECK(other["stretch_spring"] == 200);
  CHECK(other["bend_spring"] == 1e-7);
  CHECK(other["neighbour_weighting"] == true);
  CHECK(json["cloths"][1]["pins"].empty());

  const JsonValue& soft = json["softs"][0];
  CHECK(soft["material"]["young"] == 12000);
  CHECK(soft["material"]["structural"].is_null());
  CHECK(soft["material"]["density"] == 300);
  CHECK(soft["pins"][0]["count"].is_null());

  const JsonValue& hand = json["bodies"][0];
  CHECK(hand["name"] == "hand");
  CHECK(hand["friction"]["static"] == 0.4);
  CHECK(hand["friction"]["kinetic"] == 0.2);
  CHECK(hand["margin"] == 0.004);
  CHECK(json["bodies"][1]["margin"] == 0.002);
  CHECK(json["bodies"][1]["restitution"] == 0);

  REQUIRE(json["settings"].size() == 3);
  CHECK(json["settings"][0] == JsonValue({{"path", "cloth.0.bend"}, {"value", "12 uN.m"}}));
  CHECK(json["settings"][2] == JsonValue({{"path", "simulation.duration"}, {"value", "0.04"}}));
}

}  // namespace

TEST_CASE("the words of a woven cloth name all of its weave", "[recording]") {
  const Folder folder;
  const TriangleMesh sheet = grid(3, 3, 0.4, 0.4);
  write_obj(folder.path / "sheet.obj", sheet, sheet.positions);
  folder.write(
      "s.toml",
      "[simulation]\nduration = 0.01\n[[cloth]]\nmesh = \"sheet.obj\"\nmodel = \"woven\"\nwarp = [0, 0, 1]\n"
      "stretch = { warp = 500, weft = 400, shear = 40, poisson = 0.2 }\n"
      "bend = { warp = 3e-6, weft = 2e-6, poisson = 0.1 }\ncompression = 0.5\n"
      "viscosity = { stretch = 0.001, shear = 0.002, bend = 0.003 }\n");
  REQUIRE(folder.drape("simulate s.toml --out o --quiet").exit_code == 0);
  std::string words;
  for (const SceneFact& fact : scene_facts(parse_json(content(folder.path / "o/run.json"), "run.json")))
    if (fact.name == "Fabric of sheet") words = fact.value;
  for (const char* part :
       {"woven", "stretch 500 N/m", "weft 400 N/m", "shear 40 N/m", "bend of the weft 2e-06 N m",
        "Poisson's ratio 0.2", "of bending 0.1", "compression 0.5", "viscosity of stretch 0.001 s",
        "of shear 0.002 s", "of bending 0.003 s", "warp along 0, 0, 1"})
    CHECK_THAT(words, Contains(part));
}

TEST_CASE("run.json has what was run, after defaults, fabrics and settings", "[recording]") {
  const Bench bench;
  const Outcome run = bench.drape("simulate s.toml --out o --quiet --duration 0.04" + changes);
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const JsonValue json = bench.json("o/run.json");
  check_scene(json);
  CHECK(json["gravity"] == JsonValue({0.0, -9.81, 0.0}));
  CHECK(json["frame_rate"] == 25);
  CHECK(json["newton_iterations"] == 1);
  CHECK(json["tolerance"] == 1e-6);

  const std::string page = compact_json_text(page_facts(Recording(bench.path / "o")));
  CHECK_THAT(page, Contains("\"Fabric of sheet\",\"cotton-poplin, noh-jung, ") &&
                       Contains(" N/m, bend 1.2e-05 N m"));
  CHECK_THAT(
      page,
      Contains("\"Fabric of other\",\"noh-jung, 0.15 kg/m^2, stretch 200 N/m each edge, bend 1e-07 N m^2 "
               "each diagonal, damping 0 N s/m relative, neighbour weighting\""));
  CHECK_THAT(
      page,
      Contains("\"Pins of sheet\",\"2 vertices; 3 vertices in a box, following hand; 1 vertex, moved by "
               "velocity and spin\""));
  CHECK_THAT(page, Contains("\"Contact with hand\",\"static friction 0.4, kinetic 0.2, margin 4 mm\""));
  CHECK_THAT(page, Contains("\"Settings\",\"cloth.0.bend = 12 uN.m; obstacle.hand.margin = 0.004; "
                            "simulation.duration = 0.04\""));
  CHECK_THAT(page, !Contains("asked for"));
}

TEST_CASE("compare.json and compare.html have it, too", "[compare]") {
  const Bench bench;
  const Outcome run = bench.drape("compare s.toml --out o --quiet --steps 2 --solvers mpcg,eigen-ldlt" +
                                  changes + "--set simulation.duration=0.04");
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  check_scene(bench.json("o/compare.json"));
  CHECK(bench.json("o/compare.json")["time_step_asked"] == 0.01);
  const std::string html = content(bench.path / "o/compare.html");
  CHECK_THAT(html,
             Contains("<dt>Contact with hand</dt><dd>static friction 0.4, kinetic 0.2, margin 4 mm</dd>"));
  CHECK_THAT(html, Contains("<dt>Fabric of sheet</dt><dd>cotton-poplin, noh-jung, "));
}

TEST_CASE("seams are told as they are made, and an older run.json tells nothing", "[recording]") {
  const Folder folder;
  const Outcome run = folder.drape("simulate '" + source_dir() +
                                   "/data/scenes/poncho-sewn.toml' --duration 0.02 --out o --quiet");
  REQUIRE(run.exit_code == 0);
  const JsonValue json = JsonValue::parse(content(folder.path / "o/run.json"));
  const JsonValue& seams = json["cloths"][0]["seams"];
  REQUIRE(!seams.empty());
  for (const JsonValue& seam : seams) {
    CHECK(!seam["name"].get<std::string>().empty());
    CHECK(seam["pairs"] > 1);
    CHECK(seam["close"] > 0);
    CHECK(seam["stiffness"] > 0);
    CHECK(seam["then"] == "merge");
  }
  CHECK(scene_facts(parse_json("{\"cloths\": [{\"name\": \"a\"}], \"bodies\": [{\"name\": \"b\"}]}", "t"))
            .empty());
}
