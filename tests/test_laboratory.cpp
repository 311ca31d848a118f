// What laboratories print, as keys of a fabric: the parameters that follow, and what is refused.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "app/base/toml_file.h"
#include "app/scene/fabrics.h"
#include "app/scene/scene.h"
#include "solver/forces/membrane.h"
#include "solver/forces/woven.h"
#include "tests/mistakes.h"
#include "tests/workshop.h"

using namespace drape;
using namespace drape::app;
using Catch::Contains;

namespace {

const std::string density = "area_density = \"200 g/m^2\"\n";  // one line: the next one is line 2

NamedFabric read(const std::string& text) {
  return read_fabric_file(parse_toml(density + text, "f.toml"), "f.toml");
}

// All that a fabric's forces are made of.
std::vector<double> numbers(const Fabric& f) {
  const Membrane::Common m = membrane_of(f);
  const PlateStiffness p = plate_of(f);
  return {f.area_density, m.warp, m.weft, m.shear, m.cross, p.warp, p.weft, p.cross, p.twist};
}

void check_same(const std::string& one, const std::string& other) {
  INFO(one << " and " << other);
  const std::vector<double> a = numbers(read(one).fabric), b = numbers(read(other).fabric);
  for (std::size_t k = 0; k < a.size(); ++k) CHECK(a[k] == Approx(b[k]).epsilon(1e-12));
}

}  // namespace

TEST_CASE("a fabric whose bending length is given bends under its own weight within that length", "[scene]") {
  const Fabric f = read("bending_length = { warp = \"2.1 cm\", weft = \"17 mm\", bias = 0.0205 }\n").fabric;
  const auto length = [&](double bend) { return std::cbrt(bend / (9.80665 * f.area_density)); };
  CHECK(length(f.bend) == Approx(0.021));
  CHECK(length(*f.weave.bend_weft) == Approx(0.017));
  CHECK(length(*f.weave.bend_bias) == Approx(0.0205));
  CHECK_FALSE(has_directions(read("bending_length = \"2 cm\"\n").fabric));
}

TEST_CASE("every way to give a quantity gives the same fabric", "[scene]") {
  check_same("bending_length = \"2 cm\"\n", "overhang = \"4 cm\"\n");
  check_same("bending_length = \"2 cm\"\n", "fast = { C = \"20 mm\" }\n");
  check_same("bending_length = { warp = \"2 cm\", weft = \"1 cm\" }\n",
             "overhang = { warp = \"40 mm\", weft = \"20 mm\" }\n");
  check_same("kes = { B = \"0.1 gf.cm^2/cm\" }\n", "bend = \"9.80665 uN.m\"\n");
  check_same(
      "kes = { B = { warp = \"0.1 gf.cm^2/cm\", weft = \"0.05 gf.cm^2/cm\", bias = \"0.07 gf.cm^2/cm\" } }\n",
      "bend = { warp = \"9.80665 uN.m\", weft = \"4.903325 uN.m\", bias = \"6.864655 uN.m\" }\n");
  check_same("kes = { G = \"1 gf/(cm.deg)\", EMT = { warp = \"5 %\", weft = \"10 %\" } }\n",
             "stretch = { warp = 9806.65, weft = 4903.325, shear = 56.18796561619688 }\n");
  check_same("kes = { G = { warp = \"40 N/(m.rad)\", weft = \"60 N/(m.rad)\" } }\n",
             "kes = { G = \"50 N/(m.rad)\" }\n");
  check_same("stretch = 700\nkes = { G = \"50 N/(m.rad)\" }\n", "stretch = { warp = 700, shear = 50 }\n");
  check_same("fast = { E5 = \"1 %\" }\n", "stretch = 490.3325\n");
  check_same("fast = { E20 = \"2 %\" }\n", "stretch = 980.665\n");
  check_same("fast = { E100 = \"4 %\" }\n", "stretch = 2451.6625\n");
  check_same(
      "fast = { E5 = { warp = \"0.5 %\", weft = \"1 %\" }, E20 = { warp = \"2 %\", weft = \"2.5 %\" }, E100 "
      "= \"9 %\" }\n",
      "stretch = { warp = 980.665, weft = 980.665 }\n");
  check_same("fast = { EB5 = \"5 %\" }\n", "fast = { G = \"24.516625 N/m\" }\n");
  check_same("fast = { G = \"24 N/m\", E100 = \"4 %\" }\n", "stretch = { warp = 2451.6625, shear = 24 }\n");
}

TEST_CASE("a quantity is given once", "[scene]") {
  const std::vector<std::vector<std::string>> ways = {
      {"bend = 1e-5", "bend_spring = 1e-8", "bending_length = \"2 cm\"", "overhang = \"4 cm\"",
       "kes = { B = \"0.1 gf.cm^2/cm\" }", "fast = { C = \"2 cm\" }"},
      {"stretch = 500", "stretch_spring = 500", "kes = { EMT = \"5 %\" }", "fast = { E100 = \"4 %\" }"},
      {"stretch = { warp = 500, shear = 50 }", "kes = { G = \"50 N/(m.rad)\" }", "fast = { G = \"50 N/m\" }"},
  };
  for (const std::vector<std::string>& way : ways)
    for (std::size_t i = 0; i < way.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        INFO(way[i] << " and " << way[j]);
        CHECK_THROWS_WITH(read(way[j] + "\n" + way[i] + "\n"),
                          Catch::StartsWith("f.toml:") && Contains("not both") &&
                              Contains("docs/fabrics.md") && !Contains("\n"));
      }
}

TEST_CASE("mistakes in what a laboratory gave are told with their line", "[scene]") {
  const test::Mistake table[] = {
      {"bending_length = \"2 kg\"\n", "f.toml:2:", "expected a length"},
      {"bending_length = 0\n", "f.toml:2:", "greater than zero"},
      {"bending_length = { weft = \"2 cm\" }\n", "f.toml:2:", "'warp' is missing"},
      {"bending_length = { warp = \"2 cm\", wef = \"2 cm\" }\n", "f.toml:2:", "did you mean 'weft'?"},
      {"bending_length = { warp = \"2 cm\", bias = \"1 cm\" }\n",
       "f.toml:2:", "bending_length.bias: comes to 1.961 uN.m"},
      {"kes = 3\n", "f.toml:2:", "expected a table such as"},
      {"kes = { B = 0.118 }\n",
       "f.toml:2:", "has no unit; expected a bending rigidity with its unit such as \"0.118 gf.cm^2/cm\""},
      {"kes = { EMT = \"5\" }\n", "f.toml:2:", "has no unit"},
      {"kes = { EMT = \"0 %\" }\n", "f.toml:2:", "greater than zero"},
      {"kes = { G = \"0.8 gf/cm.deg\" }\n", "f.toml:2:", "is not per angle: write gf/(cm.deg)"},
      {"kes = { 2HB = \"0.1 gf\" , EMT = \"5 m\" }\n", "f.toml:2:", "expected an extension"},
      {"fast = { E5 = \"3 %\", E20 = \"2 %\" }\n", "f.toml:2:", "expected more than E5"},
      {"fast = { E5 = \"1 %\", E20 = \"3 %\", E100 = \"2 %\" }\n", "f.toml:2:", "expected more than E20"},
      {"fast = { E5 = \"3 %\", E100 = \"2 %\" }\n", "f.toml:2:", "expected more than E5"},
      {"fast = { E5 = { warp = \"1 %\", weft = \"2 %\" }, E20 = { warp = \"3 %\", weft = \"2 %\" } }\n",
       "f.toml:2:", "expected more than E5"},
      {"bending_length = 21\n", "f.toml:2:", "comes to 21 m; expected up to 50 cm"},
      {"overhang = { warp = \"4 cm\", weft = \"2 m\" }\n",
       "f.toml:2:", "comes to 2 m; expected up to 100 cm"},
      {"measured_cantilever = { length = 100, droop = 60 }\n", "f.toml:2:", "expected up to 50 cm"},
      {"measured_bias_extension = { length = \"10 cm\", width = 50, load = \"5 N/m\", extension = \"1 %\" "
       "}\n",
       "f.toml:2:", "expected up to 100 cm"},
      {"measured_picture_frame = { side = 100, shear = \"5 deg\", force = \"1 N\" }\n",
       "f.toml:2:", "expected up to 100 cm"},
      {"B = 0.1\n", "f.toml:2:", "docs/fabrics.md"},
      {"2HB = 0.1\n", "f.toml:2:", "kes = { 2HB = "},
      {"G = 0.1\n", "f.toml:2:", "docs/fabrics.md"},
      {"EMT = 4\n", "f.toml:2:", "docs/fabrics.md"},
      {"E100 = 4\n", "f.toml:2:", "fast = { E100 = "},
      {"drape_coefficient = 45\n", "f.toml:2:", "measured_drape = { coefficient = "},
      {"kes = { LT = 0.6 }\n", "f.toml:2:", "no model takes it"},
      {"kes = { C = \"2 cm\" }\n", "f.toml:2:", "fast = { C = "},
      {"bend = { bending_length = \"2 cm\" }\n", "f.toml:2:", "bending_length = \"2.1 cm\""},
      {"stretch = { EMT = \"2 %\" }\n", "f.toml:2:", "kes = { EMT = "},
      {"assumed = [\"bend\"]\n", "f.toml:2:", "the file does not give bend; it gives area_density"},
      {"bend = 1e-5\nmeasured = [\"bend\"]\nassumed = [\"bend\"]\n",
       "f.toml:4:", "stands in two of the lists"},
      {"bend = { warp = 1e-5 }\nmeasured = [\"bend.warp\"]\nassumed = [\"bend\"]\n",
       "f.toml:4:", "stands in two of the lists"},
  };
  test::check_mistakes(table, [](const std::string& text) { return read(text); });
  const auto scene = [](const std::string& text) {
    return read_scene(parse_toml("[[cloth]]\nmesh = \"a.obj\"\n" + text, "s.toml"), {}, "folder", "s.toml");
  };
  CHECK_THROWS_WITH(scene("EMT = 4\n"), Catch::StartsWith("s.toml:3:") && Contains("docs/fabrics.md"));
  CHECK_THROWS_WITH(
      read_scene(parse_toml("bending_length = 0.02\n", "s.toml"), {}, "folder", "s.toml"),
      Catch::StartsWith("s.toml:1:") && Contains("in [[cloth]] or in a fabric file; see docs/fabrics.md"));
  CHECK_THROWS_WITH(scene("kes = { B = \"0.1 gf.cm^2/cm\" }\nbend = 1e-5\n"),
                    Catch::StartsWith("s.toml:3: kes.B = "));
}

TEST_CASE("laboratory numbers of a cloth replace those of its fabric, for its own weight", "[scene]") {
  const test::Folder folder;
  folder.write(
      "f.toml",
      density + "bend = { warp = 1e-5, weft = 2e-5 }\nkes = { G = \"50 N/(m.rad)\", 2HB = \"1 mN\" }\n");
  const std::string cloth =
      "[[cloth]]\nmesh = \"a.obj\"\nmodel = \"woven\"\nwarp = [1, 0, 0]\nfabric = \"f.toml\"\n";
  const auto entry = [&](const std::string& more) {
    return read_scene(parse_toml(cloth + more, "s.toml"), {}, folder.path, "s.toml").cloths[0];
  };
  const ClothEntry other = entry("area_density = 0.1\nbending_length = \"2 cm\"\n");
  CHECK(other.fabric.bend == Approx(9.80665 * 0.1 * 8e-6));
  CHECK_FALSE(other.fabric.weave.bend_weft);
  CHECK(other.fabric.weave.shear == 50.0);
  CHECK(other.fabric_record.given.at("bend") == "bending_length = \"2 cm\"");
  CHECK(other.fabric_record.given.at("area_density") == "area_density = 0.1");
  CHECK(other.fabric_record.given.at("shear") == "kes.G = \"50 N/(m.rad)\"");
  CHECK(other.fabric_record.bending_hysteresis->warp == Approx(1e-3));
  // Replaces all of stretch, as stretch would, but not the shear that was measured for itself.
  const ClothEntry pulled = entry("kes = { EMT = \"10 %\" }\n");
  CHECK(pulled.fabric.stretch == Approx(4903.325));
  CHECK(pulled.fabric.weave.shear == 50.0);
  CHECK(pulled.fabric_record.given.at("shear") == "kes.G = \"50 N/(m.rad)\"");
  CHECK(pulled.fabric.weave.bend_weft == 2e-5);
}

TEST_CASE("every built-in fabric says of each of its numbers whether it was measured", "[scene]") {
  const Names names = fabric_names();
  REQUIRE(names.size() >= 7);
  for (const std::string& name : names) {
    INFO(name);
    const NamedFabric named = load_fabric(name);
    CHECK_FALSE(named.description.empty());
    CHECK_FALSE(named.source.empty());
    CHECK(listed(named.unmarked) == "(none)");
    CHECK(named.fabric.area_density > 0.05);
    CHECK(named.fabric.area_density < 0.5);
    CHECK(named.fabric.bend > 1e-7);
    CHECK(named.fabric.bend < 1e-4);
    CHECK(std::find(named.assumed.begin(), named.assumed.end(), "stretch") != named.assumed.end());
  }
}

TEST_CASE("the built-in fabrics have the numbers of their sources", "[scene]") {
  struct Row {
    const char* name;
    double density, warp, weft, shear, drape;  // kg/m^2, N m, N m, N/m, -
  };
  const Row rows[] = {{"cotton-broad", 0.1238, 1.15718e-05, 0, 50, 0.829},
                      {"polyester-tropical", 0.1165, 7.55112e-06, 0, 50, 0.507},
                      {"polyester-twill", 0.13517, 1.95e-06, 6.1e-07, 41, 0.223},
                      {"polyester-plain", 0.08366, 8.5e-07, 3.3e-07, 46, 0.228},
                      {"wool-polyester-twill", 0.1787, 2.14e-06, 2e-06, 50, 0.349},
                      {"polyester-elastane-plain", 0.242, 3.22e-06, 3.88e-06, 57, 0.443}};
  for (const Row& row : rows) {
    INFO(row.name);
    const NamedFabric named = load_fabric(row.name);
    CHECK(named.fabric.area_density == Approx(row.density));
    CHECK(named.fabric.bend == Approx(row.warp));
    CHECK(named.fabric.weave.bend_weft.value_or(0) == Approx(row.weft));
    CHECK(named.fabric.weave.shear.value_or(0) == Approx(row.shear));
    REQUIRE(named.tests.drape);
    CHECK(named.tests.drape->coefficient == Approx(row.drape));
  }
  CHECK(load_fabric("cotton-broad").tests.drape->nodes == 2.0);
  CHECK(load_fabric("polyester-tropical").tests.drape->nodes == 5.0);
  CHECK(load_fabric("cotton-broad").record.bending_hysteresis->warp == Approx(0.124 * 9.80665e-3));
}

TEST_CASE("hysteresis = true makes friction of the width that a laboratory gave, of a woven cloth",
          "[scene]") {
  const auto read_cloth = [](const std::string& text) {
    return read_scene(parse_toml("[[cloth]]\nmesh = \"a.obj\"\nwarp = [1, 0, 0]\nmodel = \"woven\"\n" + text,
                                 "s.toml"),
                      {}, "folder", "s.toml")
        .cloths[0]
        .fabric;
  };
  const double gf = 9.80665e-3;
  const std::string kes = "kes = { 2HB = { warp = \"0.12 gf.cm/cm\", weft = \"0.1 gf.cm/cm\" } }\n";
  const Fabric both = read_cloth(kes + "hysteresis = true\n");
  CHECK(both.weave.bend_friction == Approx(0.06 * gf));
  CHECK(both.weave.bend_friction_weft.value() == Approx(0.05 * gf));
  const Fabric one = read_cloth("fabric = \"cotton-broad\"\nhysteresis = true\n");
  CHECK(one.weave.bend_friction == Approx(0.5 * 1.21602e-3));
  CHECK_FALSE(one.weave.bend_friction_weft);
  CHECK(read_cloth(kes + "hysteresis = false\n").weave.bend_friction == 0);
  CHECK(read_cloth(kes).weave.bend_friction == 0);
  const test::Mistake table[] = {
      {"hysteresis = true\n", "s.toml:5:", "kes = { 2HB = \"0.12 gf.cm/cm\" }, and the fabric has none"},
      {kes + "hysteresis = 1\n", "s.toml:6:", "hysteresis"},
      {kes + "bend = 0\nhysteresis = true\n", "s.toml:7:", "needs its bending rigidity"},
  };
  test::check_mistakes(table, read_cloth);
  CHECK_THROWS_WITH(
      read_scene(parse_toml("[[cloth]]\nmesh = \"a.obj\"\n" + kes + "hysteresis = true\n", "s.toml"), {},
                 "folder", "s.toml"),
      Catch::StartsWith("s.toml:4: hysteresis") && Contains("goes with model = \"woven\""));
}

TEST_CASE("a run with hysteresis says so, and keeps its numbers", "[cli]") {
  const test::Workshop shop;
  shop.write(
      "rubs.toml",
      "[[cloth]]\nmesh = \"sheet.obj\"\nfabric = \"cotton-broad\"\nmodel = \"woven\"\nhysteresis = true\n");
  CHECK_THAT(shop.drape("check rubs.toml").out,
             Contains("note: cloth sheet: its threads rub when they are bent, 2HB 1.216 mN"));
  REQUIRE(shop.drape("simulate rubs.toml --duration 0.02 --out o --quiet").exit_code == 0);
  const test::Json weave = shop.json("o/run.json")["cloths"][0]["fabric"]["weave"];
  CHECK(weave["bend_friction_warp"].get<double>() == Approx(0.5 * 1.21602e-3));
  CHECK(weave["bend_friction_weft"].get<double>() == Approx(0.5 * 1.21602e-3));
  const test::Outcome springs = shop.drape("test-fabric cotton-broad --model noh-jung --hysteresis");
  CHECK(springs.exit_code == 2);
  CHECK_THAT(springs.err, Contains("--hysteresis") && Contains("--model woven"));
  CHECK_THAT(shop.drape("test-fabric cotton-broad --lowering 5cm").err, Contains("--lowering 5cm: "));
  shop.write("limp.toml", "area_density = 0.1\nbend = \"1 uN.m\"\n");
  CHECK_THAT(shop.drape("test-fabric limp.toml --hysteresis").err, Contains("2HB") && Contains("none"));
}

TEST_CASE("check, run.json and the notes say what was given and what a model leaves out", "[cli]") {
  const test::Workshop shop;
  shop.write(
      "f.toml",
      "description = \"of mine\"\narea_density = \"5.3 oz/yd^2\"\nbending_length = { warp = \"2 cm\", weft = "
      "\"1 cm\" }\nkes = { G = \"0.8 gf/(cm.deg)\", 2HB = \"0.1 gf.cm/cm\" }\nassumed = [\"kes.G\"]\n");
  const test::Outcome fabric = shop.drape("check f.toml");
  CHECK(fabric.exit_code == 0);
  for (const char* line :
       {"f.toml: of mine", "179.7 g/m^2, stretch 500 N/m, shear 44.95 N/m, bend 14.1 / 1.762 uN.m",
        ("as given: area_density = \"5.3 oz/yd^2\", bending_length = { warp = \"2 cm\", weft = \"1 cm\" }, "
         "kes.G = "),
        "2HB 0.9807 mN: friction of model = \"woven\" with hysteresis = true", "assumed: kes.G",
        "not said whether measured: area_density, bending_length.warp"})
    CHECK_THAT(fabric.out, Contains(line));
  shop.write("mine.toml", "[[cloth]]\nmesh = \"sheet.obj\"\nfabric = \"f.toml\"\nmodel = \"noh-jung\"\n");
  const test::Outcome scene = shop.drape("check mine.toml");
  CHECK_THAT(scene.out, Contains("179.7 g/m^2, stretch 500 N/m, bend 7.93 uN.m") && Contains("as given: ") &&
                            Contains("note: cloth sheet: model = \"noh-jung\" takes of its fabric") &&
                            Contains("the mean of warp and weft, and leaves out shear"));
  REQUIRE(shop.drape("simulate mine.toml --duration 0.02 --out o --quiet").exit_code == 0);
  const test::Json json = shop.json("o/run.json")["cloths"][0]["fabric"];
  CHECK(json["bend"].get<double>() == Approx(7.93e-6).epsilon(1e-3));
  CHECK(json["given"]["area_density"] == "area_density = \"5.3 oz/yd^2\"");
  CHECK(json["given"]["bend"] == "bending_length = { warp = \"2 cm\", weft = \"1 cm\" }");
}
