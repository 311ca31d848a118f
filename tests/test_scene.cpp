// The scene reader: what a scene becomes, and for every kind of mistake the file, the line and the words.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "app/base/toml_file.h"
#include "app/scene/fabrics.h"
#include "app/scene/scene.h"
#include "solver/forces/woven.h"
#include "tests/mistakes.h"

using namespace drape;
using namespace drape::app;
using Catch::Contains;
using Catch::StartsWith;

namespace {

Scene read(const std::string& text, const std::vector<Setting>& settings = {}) {
  return read_scene(parse_toml(text, "scene.toml"), settings, "folder", "scene.toml");
}

const std::string cloth = "[[cloth]]\nmesh = \"sheet.obj\"\n";  // two lines: the next one is line 3
const std::string sphere = "[[obstacle]]\nshape = \"sphere\"\n";

}  // namespace

TEST_CASE("the example of the interface is read", "[scene]") {
  const Scene scene = read(R"(
[simulation]
duration      = "2 s"
time_step     = "10 ms"
frame_rate    = "25 Hz"
gravity       = [0, -9.81, 0]
integrator    = "implicit-euler"
newton_iterations = 2
linear_solver = "mpcg"
tolerance     = 1e-6
[[cloth]]
name         = "sheet"
mesh         = "sheet.obj"
scale        = 0.01
rotate       = { axis = [1, 0, 0], angle = "90 deg" }
translate    = ["0 m", "50 cm", 0]
model        = "noh-jung"
fabric       = "cotton-poplin"
area_density = "150 g/m^2"
stretch      = "500 N/m"
bend         = "10 uN.m"
damping      = "0.01 N.s/m"
neighbour_weighting = true
pins         = [ { vertices = [0, 24] }, { box = [[-1, 0.9, -1], [1, "110 cm", 1]] }, { group = "collar" } ]
[[obstacle]]
shape    = "sphere"
centre   = [0, 0, 0]
radius   = "0.3 m"
friction = { static = 0.4, kinetic = 0.3 }
margin   = "3 mm"
[[obstacle]]
shape    = "mesh"
mesh     = "body.obj"
friction = 0.1
)");
  CHECK(scene.simulation.duration == 2);
  CHECK(scene.simulation.time_step == Approx(0.01));
  CHECK(scene.simulation.step.newton_iterations == 2);
  REQUIRE(scene.cloths.size() == 1);
  const ClothEntry& sheet = scene.cloths[0];
  CHECK(sheet.mesh == std::filesystem::path("folder/sheet.obj"));
  CHECK((sheet.placement.rotation * Vec3(0, 1, 0) - Vec3(0, 0, 1)).norm() < 1e-12);
  CHECK((sheet.placement.translate - Vec3(0, 0.5, 0)).norm() < 1e-12);
  CHECK(sheet.fabric.area_density == Approx(0.15));
  CHECK(sheet.fabric.bend == Approx(1e-5));
  CHECK(sheet.fabric.neighbour_weighting);
  REQUIRE(sheet.pins.size() == 3);
  CHECK(std::get<PinBox>(sheet.pins[1].rule).upper[1] == Approx(1.1));
  CHECK(std::get<PinGroup>(sheet.pins[2].rule).name == "collar");
  REQUIRE(scene.obstacles.size() == 2);
  CHECK(std::get<Sphere>(scene.obstacles[0].obstacle.shape).radius == Approx(0.3));
  CHECK(scene.obstacles[0].obstacle.friction.statics == Approx(0.4));
  CHECK(scene.obstacles[0].obstacle.margin == Approx(3e-3));
  CHECK(scene.obstacles[1].obstacle.friction.kinetic == Approx(0.1));
  CHECK(scene.obstacles[1].mesh == std::filesystem::path("folder/body.obj"));
}

TEST_CASE("a fabric by name is woven, unless constants of connections or the scene say otherwise",
          "[scene][woven]") {
  const auto model = [](const std::string& keys) { return read(cloth + keys).cloths[0].model; };
  const std::string named = "fabric = \"polyester-twill\"\n";
  CHECK(model("") == "noh-jung");
  CHECK(model(named) == "woven");
  CHECK(model(named + "damping = 0.1\nbend = \"3 uN.m\"\n") == "woven");
  CHECK(model(named + "model = \"noh-jung\"\n") == "noh-jung");
  for (const char* key : {"stretch_spring = 200\n", "bend_spring = 1e-7\n", "buckling_clamp = 3\n"})
    CHECK(model(named + key) == "noh-jung");
}

TEST_CASE("a shear stiffness that was measured for itself outlives a stretch that the scene gives",
          "[scene][woven]") {
  const auto shear = [](const std::string& keys) {
    return read(cloth + "fabric = \"polyester-twill\"\n" + keys).cloths[0].fabric.weave.shear;
  };
  const std::optional<double> own = shear("");
  REQUIRE(own);
  for (const char* keys :
       {"stretch = \"800 N/m\"\n", "stretch = { warp = \"800 N/m\", weft = \"600 N/m\" }\n",
        "kes = { EMT = \"10 %\" }\n", "bend = \"3 uN.m\"\n"})
    CHECK(shear(keys) == own);
  CHECK(*shear("stretch = { warp = \"800 N/m\", shear = \"55 N/m\" }\n") == 55);
  CHECK(*shear("kes = { G = \"70 N/(m.rad)\" }\n") == 70);
}

TEST_CASE("where the warp runs is given, chosen or refused", "[scene][woven]") {
  const std::string twill = "fabric = \"polyester-twill\"\n", woven = "model = \"woven\"\n",
                    down = "warp = \"down\"\n";
  const auto entry = [](const std::string& keys) { return read(cloth + keys).cloths[0]; };
  CHECK(entry(twill).warp_is_down);
  CHECK(entry(twill + woven + down).warp_is_down);
  CHECK_FALSE(entry(twill + "warp = [1, 0, 0]\n").warp_is_down);
  CHECK((*entry(twill + "rest = \"uv\"\n").warp - Vec3(0, 1, 0)).norm() == 0);
  CHECK_FALSE(entry(twill + "rest = \"uv\"\n").warp_is_down);
  CHECK_FALSE(entry(twill + "model = \"noh-jung\"\n" + down).warp_is_down);
  CHECK(entry(twill + woven).warp_is_down);
  CHECK_THROWS_WITH(read(cloth + woven + "bend = { warp = 2e-6, weft = 1e-6 }\n"),
                    Catch::Contains("warp = \"down\""));
  CHECK_THROWS_WITH(read(cloth + twill + "warp = \"up\"\n"), Contains("expected \"down\", a direction"));
}

TEST_CASE("the default value of a key of connections is no mistake beside a woven cloth", "[scene][woven]") {
  CHECK_FALSE(
      read(cloth + "model = \"woven\"\nneighbour_weighting = false\n").cloths[0].fabric.neighbour_weighting);
}

TEST_CASE("springs given replace the fabric's, and the other way round", "[scene]") {
  const Scene springs =
      read(cloth + "fabric = \"cotton-poplin\"\nstretch_spring = 200\nbend_spring = \"1e-7 N.m^2\"\n");
  CHECK(springs.cloths[0].fabric.stretch_spring == 200.0);
  CHECK(springs.cloths[0].fabric.bend_spring == 1e-7);
  CHECK_FALSE(read(cloth).cloths[0].fabric.stretch_spring);
}

TEST_CASE("a mistake in a scene is told with its line", "[scene]") {
  const test::Mistake table[] = {
      {cloth + "bend = \"10 N/m\"\n",
       "scene.toml:3:", "bend = \"10 N/m\": expected a bending rigidity such as \"10 uN.m\""},
      {cloth + "bent = 3\n",
       "scene.toml:3:", "unknown key 'bent' in [[cloth]] number 0; did you mean 'bend'?"},
      {cloth + "\n\nstretch = -3\n", "scene.toml:5:", "not negative"},
      {cloth + "stretch = true\n", "scene.toml:3:", "expected a membrane stiffness"},
      {cloth + "stretch = 1\nstretch_spring = 1\n", "scene.toml:4:", "not both"},
      {cloth + "area_density = 0\n", "scene.toml:3:", "greater than zero"},
      {cloth + "fabric = \"coton-poplin\"\n", "scene.toml:3:", "did you mean 'cotton-poplin'?"},
      {cloth + "fabric = 3\n", "scene.toml:3:", "expected a text in quotes"},
      {cloth + "damping_kind = \"both\"\n", "scene.toml:3:", "relative, axial"},
      {cloth + "scale = -1\n", "scene.toml:3:", "greater than zero"},
      {cloth + "name = \"a/b\"\n", "scene.toml:3:", "slash"},
      {cloth + "name = \"..\"\n", "scene.toml:3:", "dot"},
      {cloth + "rotate = { axis = [0, 0, 0], angle = 1 }\n", "scene.toml:3:", "axis"},
      {cloth + "rotate = { axis = [1, 0, 0] }\n", "scene.toml:3:", "'angle' is missing"},
      {cloth + "rotate = { axis = [1, 0, 0], angle = 90 }\n",
       "scene.toml:3:", "an angle such as \"90 deg\", or \"90 rad\""},
      {cloth + "translate = [1, 2]\n", "scene.toml:3:", "list of three"},
      {cloth + "translate = [1, \"2 s\", 0]\n", "scene.toml:3:", "expected a length"},
      {cloth + "pins = [3]\n", "scene.toml:3:", "expected tables"},
      {cloth + "pins = [{ vertices = [-1] }]\n", "scene.toml:3:", "from 0 up"},
      {cloth + "pins = [{ vertices = [1], group = \"a\" }]\n", "scene.toml:3:", "expected one of"},
      {cloth + "pins = [{ box = [[1, 1, 1], [0, 2, 2]] }]\n", "scene.toml:3:", "lower"},
      {cloth + "neighbour_weighting = 1\n", "scene.toml:3:", "true or false"},
      {cloth + cloth, "scene.toml:3:", "two cloths are called 'sheet'"},
      {cloth + "[simulation]\ntime_step = \"-1 s\"\n", "scene.toml:4:", "greater than zero"},
      {cloth + "[simulation]\ntime_step = \"100 Hz\"\n", "scene.toml:4:", "expected a time"},
      {cloth + "[simulation]\nduration = nan\n", "scene.toml:4:", "not a finite number"},
      {cloth + "[simulation]\nduration = 1e300\n", "scene.toml:4:", "steps"},
      {cloth + "[simulation]\nframe_rate = -1\n", "scene.toml:4:", "not negative"},
      {cloth + "[simulation]\nnewton_iterations = 0\n", "scene.toml:4:", "from 1 up"},
      {cloth + "[simulation]\nnewton_iterations = 1.5\n", "scene.toml:4:", "whole number"},
      {cloth + "[simulation]\ntolerance = 0\n", "scene.toml:4:", "greater than zero"},
      {cloth + "[simulation]\nthreads = 0\n", "scene.toml:4:", "from 1 up"},
      {cloth + "[simulation]\nintegrator = \"euler\"\n", "scene.toml:4:", "known are: implicit-euler"},
      {cloth + "[simulation]\nlinear_solver = \"mpgc\"\n", "scene.toml:4:", "did you mean 'mpcg'?"},
      {cloth + "[simulatoin]\n", "scene.toml:3:", "did you mean 'simulation'?"},
      {cloth + "[[obstacle]]\nshape = \"spere\"\n", "scene.toml:4:", "did you mean 'sphere'?"},
      {cloth + sphere, "scene.toml:3:", "'radius' is missing"},
      {cloth + sphere + "radius = 0\n", "scene.toml:5:", "greater than zero"},
      {cloth + sphere + "radius = 1\nsize = [1, 1, 1]\n", "scene.toml:6:", "unknown key 'size'"},
      {cloth + sphere + "radius = 1\nfriction = -0.1\n", "scene.toml:6:", "not negative"},
      {cloth + sphere + "radius = 1\nfriction = { static = 0.1, kinetic = 0.3 }\n",
       "scene.toml:6:", "kinetic = 0.3: is more than static = 0.1"},
      {cloth + sphere + "radius = 1\nmargin = \"-1 mm\"\n", "scene.toml:6:", "not negative"},
      {cloth + "[[obstacle]]\nshape = \"box\"\nsize = [1, 0, 1]\n", "scene.toml:3:", "size"},
      {cloth + "[[obstacle]]\nshape = \"plane\"\nnormal = [0, 0, 0]\n", "scene.toml:3:", "normal"},
      {cloth + "[[obstacle]]\nshape = \"mesh\"\n", "scene.toml:3:", "'mesh' is missing"},
      {"[simulation]\nduration = 1\n", "scene.toml:1:", "'cloth' is missing"},
      {"cloth = []\n", "scene.toml:1:", "there is no cloth"},
      {"cloth = 3\n", "scene.toml:1:", "expected tables"},
      {"[[cloth]]\nname = \"a\"\n", "scene.toml:1:", "'mesh' is missing"},
      {"x = " + std::string(100000, '[') + "\n", "scene.toml:", "nested too deep"},
      {cloth + "= 4\n", "scene.toml:3:", "is not TOML"},
      {cloth + "mesh = \"again.obj\"\n", "scene.toml:", "is not TOML"},
      {cloth + "bend = 10 uN.m\n", "scene.toml:3:", "is not TOML"},
  };
  test::check_mistakes(table, [](const std::string& text) { return read(text); });
}

TEST_CASE("a woven cloth is read, and refused where its directions are not known", "[scene][woven]") {
  const std::string woven = cloth + "model = \"woven\"\n";
  const Scene scene =
      read(woven +
           "warp = [0, 0, 2]\nstretch = { warp = \"6 N/cm\", weft = 400, shear = 50, poisson = 0.2 }\n"
           "bend = { warp = \"2.1 uN.m\", weft = \"1.4 uN.m\", bias = \"1.6 uN.m\", poisson = 0.1 }\n"
           "compression = 0.25\nrest_angle = 0.4\nviscosity = { stretch = \"1 ms\", bend = \"5 ms\" }\n");
  const ClothEntry& entry = scene.cloths.at(0);
  CHECK(entry.model == "woven");
  CHECK((*entry.warp - Vec3(0, 0, 2)).norm() == 0);
  const Weave& w = entry.fabric.weave;
  CHECK(entry.fabric.stretch == Approx(600));
  CHECK(*w.stretch_weft == 400);
  CHECK(*w.shear == 50);
  CHECK(w.poisson == 0.2);
  CHECK(entry.fabric.bend == Approx(2.1e-6));
  CHECK(*w.bend_weft == Approx(1.4e-6));
  CHECK(*w.bend_bias == Approx(1.6e-6));
  CHECK(w.bend_poisson == 0.1);
  CHECK(w.compression == 0.25);
  CHECK(w.rest_angle == 0.4);
  CHECK(read(woven + "rest_angle = \"mesh\"\n").cloths[0].fabric.weave.rest_angle == 1);
  CHECK(read(woven + "rest_angle = \"flat\"\n").cloths[0].fabric.weave.rest_angle == 0);
  CHECK(w.bending == Bending::plate);
  CHECK(read(woven + "bending = \"hinges\"\nrest_angle = 1\n").cloths[0].fabric.weave.bending ==
        Bending::hinges);
  CHECK(read(woven + "bending = \"quadratic-hinges\"\n").cloths[0].fabric.weave.bending ==
        Bending::quadratic_hinges);
  CHECK_FALSE(read(cloth).cloths[0].self_contact);
  const ClothEntry layer =
      read(cloth + "self_contact = true\nthickness = \"2 mm\"\nfriction = 0.4\n").cloths[0];
  CHECK(layer.self_contact);
  CHECK(layer.self.thickness == Approx(2e-3));
  CHECK(layer.self.friction == 0.4);
  const Scene rubbing = read(cloth +
                             "name = \"a\"\nself_contact = true\n[[pair]]\n"
                             "between = [\"a\", \"a\"]\nfriction = 0.2\n");
  CHECK(rubbing.frictions.at(0).friction == 0.2);
  CHECK_FALSE(read(cloth + "self_contact = false\nthickness = \"2 mm\"\n").cloths[0].self_contact);
  CHECK_FALSE(read(woven).cloths[0].imperfection);
  CHECK(*read(cloth + "imperfection = \"2 um\"\n").cloths[0].imperfection == Approx(2e-6));
  CHECK(w.stretch_time == Approx(1e-3));
  CHECK(w.shear_time == 0);
  CHECK(w.bend_time == Approx(5e-3));
  CHECK_FALSE(read(woven).cloths[0].warp);
  CHECK_THROWS_WITH(read(woven + "compression = 0.5\n"), Catch::Contains("give warp = [x, y, z]"));
  CHECK((*read(woven + "rest = \"uv\"\n").cloths[0].warp - Vec3(0, 1, 0)).norm() == 0);

  const test::Mistake table[] = {
      {cloth + "warp = [1, 0, 0]\n", "scene.toml:3:", "goes with model = \"woven\""},
      {cloth + "compression = 0.5\n", "scene.toml:3:", "goes with model = \"woven\""},
      {cloth + "rest_angle = \"mesh\"\n", "scene.toml:3:", "goes with model = \"woven\""},
      {cloth + "bending = \"hinges\"\n", "scene.toml:3:", "goes with model = \"woven\""},
      {woven + "bending = \"hinge\"\n", "scene.toml:4:", "hinges"},
      {woven + "rest_angle = 1\nbending = \"quadratic-hinges\"\n",
       "scene.toml:5:", "quadratic hinges rest flat"},
      {woven + "rest_angle = \"bent\"\n", "scene.toml:4:", "\"flat\", \"mesh\", or a number"},
      {woven + "rest_angle = 1.5\n", "scene.toml:4:", "from 0 (flat) to 1"},
      {woven + "rest_angle = 1\n[[cloth.seams]]\n", "scene.toml:4:", "with seams"},
      {woven + "imperfection = -1\n", "scene.toml:4:", "imperfection"},
      {cloth + "thickness = \"1 mm\"\n", "scene.toml:3:", "goes with self_contact = true"},
      {cloth + "layer = 2\n", "scene.toml:3:", "goes with self_contact = true"},
      {cloth + "self_contact = true\nlayer = -1\n", "scene.toml:4:", "expected a whole number from 0"},
      {cloth + "self_contact = true\nlayer = {}\n", "scene.toml:4:", "names no group"},
      {cloth + "self_contact = true\nlayer = { pocket = \"out\" }\n", "scene.toml:4:", "pocket"},
      {cloth + "self_contact = true\n[[pair]]\nbetween = [\"sheet\", \"coat\"]\nfriction = 0.3\n",
       "scene.toml:4:", "no cloth, soft body or rope 'coat'"},
      {cloth + "[[pair]]\nbetween = [\"sheet\", \"sheet\"]\nfriction = 0.3\n",
       "scene.toml:3:", "set its self_contact = true"},
      {cloth + "[[pair]]\nbetween = [\"sheet\"]\nfriction = 0.3\n", "scene.toml:4:", "two names"},
      {cloth + "self_contact = true\nthickness = 0\n", "scene.toml:4:", "thickness"},
      {cloth + "self_contact = true\nfriction = -1\n", "scene.toml:4:", "friction"},
      {cloth + "viscosity = { bend = 1 }\n", "scene.toml:3:", "goes with model = \"woven\""},
      {woven + "warp = [0, 0, 0]\n", "scene.toml:4:", "a direction is not [0, 0, 0]"},
      {woven + "stretch = { warp = 500, weft = 300 }\n", "scene.toml:3:", "give warp = [x, y, z]"},
      {woven + "stretch = { weft = 300 }\n", "scene.toml:4:", "'warp' is missing"},
      {woven + "stretch = { warp = 500, wefft = 300 }\n", "scene.toml:4:", "did you mean 'weft'?"},
      {woven + "stretch = { warp = 500, poisson = 1 }\n",
       "scene.toml:4:", "poisson = 1: Poisson's ratio is between -1 and 1"},
      {woven + "bend = { warp = \"2 N/m\" }\n", "scene.toml:4:", "expected a bending rigidity"},
      {woven + "buckling_clamp = 3\n", "scene.toml:4:", "is of connections"},
      {woven + "neighbour_weighting = true\n", "scene.toml:4:", "is of connections"},
      {woven + "bend = { warp = 4e-6, weft = 4e-6, bias = 1e-6 }\n", "scene.toml:4:",
       "bend.bias: comes to 1 uN.m, but with this warp and weft a bending rigidity at 45 degrees is "
       "greater than 2 uN.m"},

      {woven + "compression = 1.5\n", "scene.toml:4:", "from 0 to 1"},
      {woven + "viscosity = 3\n", "scene.toml:4:", "expected a table"},
  };
  test::check_mistakes(table, [](const std::string& text) { return read(text); });
}

TEST_CASE("what a scene gives and its integrator or model does not use is told", "[scene][warnings]") {
  const auto idle = [](const std::string& integrator) {
    return read("[simulation]\nintegrator = \"" + integrator +
                "\"\nsubsteps = 7\nalpha = 0.5\ntolerance = 1e-4\nrelative_tolerance = 1e-3\n" + cloth)
        .simulation.idle_keys;
  };
  CHECK(idle("implicit-euler") == Names{"substeps", "alpha", "relative_tolerance"});
  CHECK(idle("pbd") == Names{"relative_tolerance"});
  for (const IntegratorInfo& one : integrators())
    if (one.name.starts_with("cvode-")) CHECK(idle(std::string(one.name)) == Names{"substeps", "alpha"});
  CHECK(read("[simulation]\ntolerance = 1e-4\n" + cloth).simulation.idle_keys.empty());
  for (const IntegratorInfo& one : integrators()) {
    INFO(one.name);
    const std::string name(one.name);
    const Names found = read("[simulation]\nintegrator = \"" + name +
                             "\"\nlinear_solver = \"mpcg\"\nnewton_iterations = 2\n" + cloth)
                            .simulation.idle_keys;
    Names expected;
    if (name != "implicit-euler" && name != "bdf2" && name != "newton-kinsol") {
      if (name != "cvode-bdf" && name != "arkode-dirk") expected.emplace_back("linear_solver");
      expected.emplace_back("newton_iterations");
    }
    CHECK(std::is_permutation(found.begin(), found.end(), expected.begin(), expected.end()));
  }

  const std::string warp = cloth + "warp = [1, 0, 0]\n";
  CHECK(read(warp + "model = \"noh-jung\"\nviscosity = { bend = \"1 ms\" }\n").cloths[0].idle_keys ==
        Names{"warp", "viscosity"});
  CHECK(read(warp + "model = \"woven\"\n").cloths[0].idle_keys.empty());
  CHECK_THROWS_WITH(read(warp), Contains("goes with model = \"woven\""));
}

TEST_CASE("a scene whose duration is no step is refused", "[scene]") {
  for (const char* table :
       {"duration = \"1 ns\"", "time_step = \"10 ns\"\nframe_rate = 0\nduration = \"5e-15 s\""})
    CHECK_THROWS_WITH(read(std::string("[simulation]\n") + table + "\n" + cloth),
                      StartsWith("scene.toml:2: duration") || Contains("duration = \"5e-15 s\""));
}

TEST_CASE("the air of a scene is none unless there is a table", "[scene][air]") {
  CHECK_FALSE(read(cloth).simulation.air);
  const std::optional<Air> air =
      read(cloth + "[air]\nwind = [0, 0, \"18 km/h\"]\nskin_friction = 0.05\n").simulation.air;
  REQUIRE(air);
  CHECK((air->wind - Vec3(0, 0, 5)).norm() < 1e-12);
  CHECK(air->density == 1.2);
  CHECK(air->drag == 1.2);
  CHECK(air->skin_friction == 0.05);
  const test::Mistake table[] = {
      {cloth + "[air]\nwind = 3\n", "scene.toml:4:", "wind"},
      {cloth + "[air]\nwind = [0, 0, \"1 kg\"]\n", "scene.toml:4:", "speed"},
      {cloth + "[air]\ndensity = -1\n", "scene.toml:4:", "density"},
      {cloth + "[air]\nwinds = [0, 0, 1]\n", "scene.toml:4:", "did you mean 'wind'?"},
      {cloth + "[[air]]\n[[air]]\n", "scene.toml:3:", "only one"},
  };
  test::check_mistakes(table, [](const std::string& text) { return read(text); });
}

TEST_CASE("stretch and bend replace all directions of a named fabric", "[scene][woven]") {
  for (const bool table : {false, true}) {
    Fabric fabric;
    fabric.weave = {
        .stretch_weft = 3, .shear = 4, .poisson = 0.1, .bend_weft = 5, .bend_bias = 6, .bend_poisson = 0.2};
    const Node node = parse_toml(
        table ? "stretch = { warp = 7 }\nbend = { warp = 8 }\n" : "stretch = 7\nbend = 8\n", "fabric.toml");
    Table keys(node, "the fabric");
    FabricRecord record;
    read_fabric(keys, fabric, record);
    CHECK(fabric.stretch == 7);
    CHECK(fabric.bend == 8);
    CHECK_FALSE(has_directions(fabric));
    CHECK(fabric.weave.poisson == Weave().poisson);
    CHECK(fabric.weave.bend_poisson == Weave().bend_poisson);
  }
}

TEST_CASE("settings change a scene before it is read", "[scene]") {
  const std::string text =
      cloth + "[[cloth]]\nmesh = \"b.obj\"\nname = \"skirt\"\nbend = 1\n" + sphere + "radius = 1\n";
  const auto with = [&](const char* setting) { return read(text, {parse_setting(setting)}); };
  CHECK(with("cloth.0.bend=5 uN.m").cloths[0].fabric.bend == Approx(5e-6));
  CHECK(with("cloth.0.bend=\"5 uN.m\"").cloths[0].fabric.bend == Approx(5e-6));
  CHECK(with("cloth.sheet.bend=2e-6").cloths[0].fabric.bend == Approx(2e-6));
  CHECK(with("cloth.skirt.bend=2e-6").cloths[1].fabric.bend == Approx(2e-6));
  CHECK(with("cloth.1.neighbour_weighting=true").cloths[1].fabric.neighbour_weighting);
  CHECK(with("simulation.tolerance=1e-4").simulation.step.tolerance == Approx(1e-4));
  CHECK(with("simulation.gravity=[0, 0, -1]").simulation.gravity[2] == -1);
  CHECK(with("obstacle.sphere.friction=0.5").obstacles[0].obstacle.friction.kinetic == 0.5);
  CHECK(with("obstacle.0.friction={static = 0.5, kinetic = 0.4}").obstacles[0].obstacle.friction.statics ==
        0.5);
  CHECK(with("cloth.0.pins=[{vertices = [3]}]").cloths[0].pins.size() == 1);
  CHECK(
      read("[cloth]\nmesh = \"a.obj\"\n", {parse_setting("cloth.0.damping=0.1")}).cloths[0].fabric.damping ==
      0.1);
}

TEST_CASE("a mistake in a setting names the setting", "[scene]") {
  const auto message_of = [&](const char* setting, const char* message) {
    INFO(setting);
    CHECK_THROWS_WITH(read(cloth, {parse_setting(setting)}), StartsWith("--set") && Contains(message));
  };
  message_of("cloth.0.bend=5 uN", "--set cloth.0.bend: bend = \"5 uN\": expected a bending rigidity");
  message_of("cloth.0.bent=5", "unknown key 'bent'");
  message_of("cloth.3.bend=5", "there is no '3' in the list");
  message_of("cloth.skirt.bend=5", "it has, from 0: sheet");
  message_of("obstacle.0.friction=1", "there is no [[obstacle]]");
  message_of("simulation.duration=-1", "greater than zero");
  message_of("cloth..bend=1", "empty part");
  message_of("cloth.0.mesh.x=1", "has no parts");
  message_of("simulation.tolerance=1e-30", "which round-off leaves");
  message_of("cloth.0.area_density=1e400", "is not a finite number");
  message_of("cloth.0.translate=[0, 1e400, 0]", "is not a finite number");
  message_of("pair.0.friction=0.5", "there is no [[pair]]");
  message_of("rope.0.bend=0.5", "there is no [[rope]]");
  message_of("tolerance=1", "unknown key");
  message_of("tolerance", "expected PATH=VALUE");
  message_of("=3", "expected PATH=VALUE");
  message_of("simulation.gravity=[0, -1", "[0, -1 is not TOML");
  message_of("cloth.0.pins=[{vertices = [3]]", "is not TOML");
  message_of("cloth.0.bend=\"5 uN.m", "is not TOML");
}

TEST_CASE("what is given twice by different words is refused, and a refinement is not", "[scene]") {
  using Words = std::vector<std::string>;
  const auto settings = [](const Words& words) {
    std::vector<Setting> all;
    for (const std::string& word : words) all.push_back(parse_setting(word));
    return all;
  };
  const auto refused = [&](const std::vector<Setting>& all, const char* message) {
    CHECK_THROWS_WITH(read(cloth, all), Contains(message) && Contains("give one of them"));
  };
  refused(settings({"cloth.0.bend=5 uN.m", "cloth.sheet.bend=6 uN.m"}),
          "--set cloth.sheet.bend: --set cloth.0.bend");
  std::vector<Setting> with_option = settings({"simulation.duration=1"});
  with_option.push_back({"simulation.duration", "2", "--duration"});
  refused(with_option, "--duration: --set simulation.duration");
  for (const Words& words : {Words{"cloth.0.bend=5 uN.m", "cloth.0.bend=6 uN.m"},
                             Words{"simulation={duration = 1}", "simulation.duration=2"},
                             Words{"cloth.0.bend=5 uN.m", "cloth.0.stretch=600"}})
    CHECK_NOTHROW(read(cloth, settings(words)));
}
