// `drape fit`: the file that it makes is the fabric that was measured, and says where each number is from.
#include <catch2/catch.hpp>
#include <string>

#include "app/scene/fabrics.h"
#include "solver/forces/membrane.h"
#include "solver/forces/woven.h"
#include "tests/folder.h"

using namespace drape;
using namespace drape::test;
using app::NamedFabric;
using Catch::Contains;

namespace {

const std::string sheets[] = {
    "area_density = \"180 gsm\"\nbending_length = { warp = \"2.1 cm\", weft = \"1.7 cm\" }\n",
    ("area_density = 0.2\noverhang = \"4 cm\"\nkes = { EMT = { warp = \"3.5 %\", weft = \"21 %\" }, G = "
     "\"0.8 "
     "gf/(cm.deg)\", "
     "2HB = { warp = \"0.12 gf.cm/cm\", weft = \"0.1 gf.cm/cm\" }, 2HG = \"2 gf/cm\" }\nassumed = "
     "[\"kes.G\"]\n"),
    ("description = \"a \\\"fine\\\" wool\"\narea_density = \"15 mg/cm^2\"\nfast = { C = { warp = \"19 mm\", "
     "weft = \"16 mm\", "
     "bias = \"17 mm\" }, E5 = \"0.4 %\", E20 = \"1.5 %\", E100 = \"4 %\", EB5 = \"3.2 %\" }\n"),
    ("area_density = 0.1\nkes = { B = \"0.1 gf.cm^2/cm\" }\nstretch = { warp = 600, poisson = 0.1 "
     "}\nviscosity = { bend = \"5 ms\" "
     "}\nmeasured_drape = { coefficient = \"45 %\", nodes = 6 }\ndamping = 0.01\n"),
    ("area_density = 0.1\nbend = { warp = 1e-5, poisson = 0.2 }\nstretch_spring = 300\nassumed = "
     "[\"bend.poisson\", \"stretch_spring\"]\n"),
    "area_density = 0.1\n",
};

std::vector<double> numbers(const Fabric& f) {
  const Membrane::Common m = membrane_of(f);
  const PlateStiffness p = plate_of(f);
  return {f.area_density, m.warp,  m.weft,  m.shear,   m.cross,           p.warp,
          p.weft,         p.cross, p.twist, f.damping, f.weave.bend_time, f.stretch_spring.value_or(0)};
}

}  // namespace

TEST_CASE("drape fit writes the fabric that was measured, in six digits and with a mark for each number",
          "[scene]") {
  const Folder folder;
  for (const std::string& sheet : sheets) {
    INFO(sheet);
    folder.write("measured.toml", sheet);
    const Outcome made = folder.drape("fit made.toml --from measured.toml --force");
    INFO(made.err << content(folder.path / "made.toml"));
    REQUIRE(made.exit_code == 0);
    const NamedFabric one = app::load_fabric("measured.toml", folder.path),
                      other = app::load_fabric("made.toml", folder.path);
    const std::vector<double> a = numbers(one.fabric), b = numbers(other.fabric);
    for (std::size_t k = 0; k < a.size(); ++k) CHECK(b[k] == Approx(a[k]).epsilon(5e-5));
    CHECK(listed(other.unmarked) == "(none)");
    CHECK(other.description == one.description);
    CHECK(other.tests.drape.has_value() == one.tests.drape.has_value());
    CHECK(other.record.bending_hysteresis.has_value() == one.record.bending_hysteresis.has_value());
    CHECK(other.record.shear_hysteresis.has_value() == one.record.shear_hysteresis.has_value());
    CHECK(folder.drape("fit --from measured.toml").out == content(folder.path / "made.toml"));
  }
}

TEST_CASE("drape fit names the formula of each number and what nobody measured", "[scene]") {
  const Folder folder;
  const auto fitted = [&](const std::string& sheet) {
    folder.write("m.toml", sheet);
    return folder.drape("fit --from m.toml").out;
  };
  CHECK_THAT(
      fitted(sheets[0]),
      Contains("# Made by `drape fit` from m.toml.") &&
          Contains("area_density = \"180 g/m^2\"  # given as area_density = \"180 gsm\"") &&
          Contains("B = g area_density c^3, g = 9.80665 m/s^2, bending_length = { warp = \"2.1 cm\"") &&
          Contains("stretch = \"500 N/m\"  # nobody gave it: the program's default") &&
          Contains("measured = [\"area_density\"]") &&
          Contains("converted = [\"bend.warp\", \"bend.weft\"]") && Contains("assumed = [\"stretch\"]"));
  CHECK_THAT(fitted(sheets[1]), Contains("the secant 490.3325 N/m / EMT, kes.EMT = ") &&
                                    Contains("assumed = [\"stretch.shear\"]") &&
                                    Contains("measured = [\"area_density\", \"kes.2HB\", \"kes.2HG\"]"));
  CHECK_THAT(fitted(sheets[2]),
             Contains("the slope 14.709975 N/m / (E20 - E5)") && Contains("G = 4.903325 N/m / (4 EB5)"));
}

TEST_CASE("drape fit overwrites nothing unless it is told to", "[scene]") {
  const Folder folder;
  folder.write("m.toml", sheets[0]);
  folder.write("there.toml", "mine");
  struct Mistake {
    const char *words, *said;
  };
  const Mistake table[] = {
      {"fit there.toml --from m.toml", "there.toml: is there already; --force replaces it"},
      {"fit m.toml --from m.toml --force", "m.toml: is the file that is read"},
      {"fit made.txt --from m.toml", "made.txt: expected a name that ends in .toml"},
      {"fit made.toml", "--from is required"},
      {"fit made.toml --from none.toml", "none.toml: no such file"},
      {"fit made.toml --from there.toml", "there.toml:1: is not TOML"},
      {"fit no/made.toml --from m.toml", "no/made.toml"}};
  for (const Mistake& mistake : table) {
    INFO(mistake.words);
    const Outcome run = folder.drape(mistake.words);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.err, Contains(mistake.said));
  }
  CHECK(content(folder.path / "there.toml") == "mine");
  CHECK(folder.files() == std::set<std::string>{"m.toml", "there.toml"});
}
