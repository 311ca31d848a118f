// `drape fit` by virtual tests: measurements of a known fabric give the fabric back, and what cannot be known
// is said.
#include <catch2/catch.hpp>
#include <cmath>

#include "app/textile/elastica.h"
#include "app/textile/fitting.h"
#include "app/textile/least_squares.h"
#include "app/textile/single_tests.h"
#include "mesh/base/errors.h"
#include "solver/forces/woven.h"
#include "tests/folder.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;

namespace {

constexpr double pi = 3.14159265358979323846;

Fabric directed() {
  Fabric fabric{.area_density = 0.15, .stretch = 800, .bend = 12e-6};
  fabric.weave = {.stretch_weft = 400, .shear = 60, .poisson = 0.15, .bend_weft = 5e-6, .bend_bias = 6e-6};
  return fabric;
}

// The fabric as a file has it that says nothing of bend and shear.
NamedFabric unknown(const Fabric& fabric) {
  NamedFabric named;
  named.name = "unknown.toml";
  named.fabric = fabric;
  named.fabric.bend = Fabric().bend;
  named.fabric.weave.shear.reset();
  named.fabric.weave.bend_weft.reset();
  named.fabric.weave.bend_bias.reset();
  return named;
}

const auto silent = [](const std::string&) {};

double droop(const Fabric& fabric, double angle, double length, double edge) {
  return -hanging_tip({fabric, ClothModel::woven, angle}, length, edge).y();
}

}  // namespace

TEST_CASE("least squares are found, also where the residuals end", "[fitting]") {
  // r = (exp(x0) - 3, exp(x0 + x1) - 6, ...): least at x = (ln 3, ln 2); no residuals beyond x0 = 1.2.
  int asked = 0;
  const Residuals residuals = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r) {
    ++asked;
    r << std::exp(x[0]) - 3, std::exp(x[0] + x[1]) - 6, std::exp(-x[1]) - 0.5;
    return x[0] < 1.2;
  };
  const LeastSquares found = least_squares(residuals, 2, 3, 0.2, 100);
  CHECK(found.x[0] == Approx(std::log(3.0)).margin(0.005));
  CHECK(found.x[1] == Approx(std::log(2.0)).margin(0.005));
  CHECK(found.residuals.norm() < 0.05);
  CHECK(asked < 100);
  CHECK_THAT(found.ended, Contains("the last step") || Contains("no smaller"));

  const LeastSquares cut_short = least_squares(residuals, 2, 3, 0.2, 3);
  CHECK_THAT(cut_short.ended, Contains("as many rounds as are allowed"));
  const Residuals none = [](const Eigen::VectorXd&, Eigen::VectorXd&) { return false; };
  CHECK_THROWS_AS(least_squares(none, 1, 1, 0.2, 9), std::runtime_error);
}

TEST_CASE("single virtual tests give what theory says", "[fitting]") {
  const Fabric fabric = directed();
  for (const auto& [shear, edge] : {std::pair{0.01, 0.02}, std::pair{0.1, 0.02}, std::pair{0.4, 0.01}}) {
    const double force = frame_force(fabric, 0.1, shear, edge);
    CHECK(shear_of_frame(0.1, shear, force) == Approx(60).epsilon(1e-6));
    if (shear < 0.02) CHECK(force == Approx(std::sqrt(2.0) * 60 * 0.1 * shear).epsilon(0.01));
  }
  // A narrow strip along the warp takes Y times the strain.
  CHECK(strip_load({fabric, ClothModel::woven, 0}, 0.2, 0.04, 1e-3, 0.01) == Approx(0.8).epsilon(0.01));
  for (const std::vector<double>& row : reference_table("cantilever_master.csv"))
    if (row[0] > 0.01 && row[0] < 900) CHECK(gamma_of_droop(row[2]) == Approx(row[0]).epsilon(1e-4));
}

TEST_CASE("strips, a frame and a strip in the bias give back the fabric that they were cut from",
          "[fitting]") {
  constexpr double edge = 0.015;
  Fabric fabric = directed();
  fabric.bend = 60e-6;
  fabric.weave.bend_weft = 25e-6;
  fabric.weave.bend_bias = 30e-6;
  NamedFabric named = unknown(fabric);
  Directions droops{droop(fabric, 0, 0.06, edge), droop(fabric, pi / 2, 0.06, edge),
                    droop(fabric, pi / 4, 0.06, edge)};
  named.tests.cantilevers = {{0.06, droops}};
  named.tests.frames = {{0.1, 0.15, frame_force(fabric, 0.1, 0.15, edge)}};
  named.tests.bias_extensions = {
      {0.1, 0.06, strip_load({fabric, ClothModel::woven, pi / 4}, 0.1, 0.06, 0.04, edge), 0.04}};
  CHECK(parameters_to_fit(named) == Names{"bend.warp", "bend.weft", "bend.bias", "stretch.shear"});

  std::string said;
  const Fitting fitting =
      fit_fabric(named, {}, {.edge = edge}, [&](const std::string& line) { said += line; });
  INFO(fitting_text(fitting, "unknown.toml") << said);
  CHECK(fitting.met());
  CHECK(fitting.fabric.bend == Approx(60e-6).epsilon(0.01));
  CHECK(*fitting.fabric.weave.bend_weft == Approx(25e-6).epsilon(0.01));
  CHECK(*fitting.fabric.weave.bend_bias == Approx(30e-6).epsilon(0.01));
  CHECK(*fitting.fabric.weave.shear == Approx(60).epsilon(0.01));
  CHECK(fitting.comparisons.size() == 5);
  CHECK(fitting.tests < 250);
  CHECK_THAT(said, Contains("droop of 6 cm, weft"));

  const Fitting again = fit_fabric(named, {}, {.edge = edge}, silent);
  CHECK(again.fabric.bend == fitting.fabric.bend);
  CHECK(again.fabric.weave.shear == fitting.fabric.weave.shear);

  // What the fabric's file gives stays.
  named.record.given["bend"] = "bend = ...";
  named.fabric.bend = 60e-6;
  const Fitting shear = fit_fabric(named, {}, {.edge = edge}, silent);
  CHECK(shear.parameters.size() == 1);
  CHECK(shear.fabric.bend == 60e-6);
}

// Fits the coefficient of a simulated test of the fabric, in the same machine.
void fit_drape(const Fabric& fabric, const SpecimenOptions& specimens, double share) {
  NamedFabric named = unknown(fabric);
  const DrapeTest test{.radius = 0.15, .repeats = specimens.repeats};
  const Values values =
      drape_test(fabric, ClothModel::woven, specimens.edge, test, [](int, const Shadow&) {});
  double sum = 0;
  for (double one : values[0].found) sum += one;
  named.tests.drape = MeasuredDrape{.coefficient = sum / specimens.repeats};
  const Fitting fitting = fit_fabric(named, {}, specimens, silent);
  INFO(fitting_text(fitting, "unknown.toml"));
  CHECK(fitting.met());
  REQUIRE(fitting.parameters.size() == 1);
  CHECK(fitting.parameters[0].name == "bend");
  CHECK(fitting.fabric.bend == Approx(fabric.bend).epsilon(share));
  CHECK_THAT(fitting_text(fitting, "f"), Contains("the same along warp and weft"));
}

TEST_CASE("a drape coefficient gives back the rigidity of its fabric", "[fitting]") {
  fit_drape({.area_density = 0.15, .stretch = 500, .bend = 60e-6}, {.edge = 0.02, .repeats = 1}, 0.1);
}

// Minutes: asked for by name only.
TEST_CASE("drape coefficients of a fine mesh give back the rigidity of their fabric", "[.fitting-long]") {
  for (double bend : {4e-6, 12e-6, 30e-6})
    fit_drape({.area_density = 0.15, .stretch = 500, .bend = bend}, {.edge = 0.01, .repeats = 2}, 0.1);
}

TEST_CASE("drape fit marks what virtual tests gave, once", "[fitting]") {
  const Folder folder;
  const std::string sheet =
      "area_density = \"150 g/m^2\"\nstretch = { warp = \"600 N/m\", poisson = 0.2 }\n"
      "measured_cantilever = [{ length = \"10 cm\", droop = { warp = \"6 cm\", weft = \"8 cm\" } },\n"
      "                       { length = \"8 cm\", droop = \"3.5 cm\" }]\n"
      "measured_picture_frame = { side = \"10 cm\", shear = \"5 deg\", force = \"0.6 N\" }\n";
  folder.write("m.toml", sheet);
  const Outcome made = folder.drape("fit made.toml --from m.toml --mesh 15mm");
  INFO(made.out << made.err);
  REQUIRE(made.exit_code == 0);
  CHECK_THAT(made.out, Contains("droop of 10 cm, warp: measured 6 ± 0.6 cm, found") &&
                           Contains("virtual tests in") && Contains("wrote made.toml"));
  const std::string text = content(folder.path / "made.toml");
  CHECK_THAT(text, Contains("# fitted: droop of 10 cm, warp") &&
                       Contains("force of the frame at 5 deg 0.6") &&
                       Contains("fitted = [\"stretch.shear\", \"bend.warp\", \"bend.weft\"]") &&
                       Contains("measured = [\"area_density\", \"stretch.warp\", \"stretch.poisson\", "
                                "\"measured_cantilever\", \"measured_picture_frame\"]"));
  const NamedFabric named = load_fabric("made.toml", folder.path);
  CHECK(named.unmarked.empty());
  CHECK(named.fitted.size() == 3);
  CHECK(named.tests.cantilevers.size() == 2);
  CHECK(parameters_to_fit(named).empty());

  const Outcome again = folder.drape("fit --from made.toml");
  CHECK(again.exit_code == 0);
  CHECK(again.err.empty());
  CHECK_THAT(again.out, Contains("fitted = [\"stretch.shear\", \"bend.warp\", \"bend.weft\"]"));
  const Outcome printed = folder.drape("fit --from m.toml --mesh 15mm --quiet");
  CHECK(printed.err.empty());
  CHECK(printed.out == text);
}

TEST_CASE("what cannot be fitted is said in one line, and nothing is written", "[fitting]") {
  const Folder folder;
  const std::string plain = "area_density = 0.15\n", strip = "length = \"10 cm\", droop = \"5 cm\"";
  struct Mistake {
    std::string sheet, words, said;
    int exit_code = 2;
  };
  const Mistake table[] = {
      {plain + "measured_drape = { coefficient = 0.5 }\n", "--parameters bend.warp,bend.weft",
       "1 measurement for 2 parameters (bend.warp, bend.weft)"},
      {plain, "--parameters bend", "no measurement for 1 parameters"},
      {plain, "--mesh 10mm", "formulas give what it measured"},
      {plain + "bend = 1e-5\nmeasured_drape = { coefficient = 0.5 }\n", "--parameters bend",
       "gives it already"},
      {plain + "measured_drape = { coefficient = 0.5 }\n", "--parameters bend,bend.warp",
       "is the same along warp"},
      {plain + "measured_drape = { coefficient = 0.5 }\n", "--parameters bend.weft",
       "is fitted beside bend.warp"},
      {plain + "measured_drape = { coefficient = 0.5 }\n", "--parameters shear",
       "there is no such parameter"},
      {plain + "measured_drape = { coefficient = 0.5 }\n", "--parameters bend,bend", "name it once"},
      {plain + "measured_drape = { coefficient = 0.5 }\n", "--mesh 30mm", "from 1 mm to 20 mm"},
      {plain + "measured_drape = { coefficient = 0.5 }\n", "--mesh 10mm,5mm", "--mesh"},
      {plain + "measured_drape = { coefficient = 0.5, specimen = \"20 cm\" }\n", "",
       "too coarse for the 10 mm"},
      {plain + "measured_drape = { coefficient = 0.5, specimen = \"20 mm\" }\n", "", "from 20 cm to 40 cm"},
      {plain + "measured_drape = { coefficient = 0.5, plate = \"20 mm\" }\n", "", "from 5 cm to 30 cm"},
      {plain + "measured_drape = { coefficient = 0.5, plate = \"30 cm\" }\n", "", "as wide as the disc"},
      {plain + "bend_spring = 1e-7\nmeasured_picture_frame = { side = 0.1, shear = 0.1, force = 1 }\n", "",
       "a specimen needs stretch and bend per width"},
      {plain + "measured_cantilever = { length = \"3 cm\", droop = \"1 cm\" }\n", "",
       "too coarse for a strip of 3 cm"},
      {plain + "measured_cantilever = { length = \"3 cm\", droop = \"4 cm\" }\n", "", "m.toml:2:"},
      {plain + "measured_cantilever = { length = \"3 cm\" }\n", "", "'droop' is missing"},
      {plain + "measured_cantilever = 3\n", "", "expected tables"},
      {plain + "measured_picture_frame = { side = 0.1, shear = 5, force = 1 }\n", "", "at most 45 degrees"},
      {plain + "measured_bias_extension = { length = 0.1, width = 0.05, load = 5, extension = 0.1 }\n", "",
       "has no unit"},
      {plain + "measured_cantilever = [{ " + strip + " }, { " + strip + " }]\n",
       "--parameters bend.warp,bend.weft", "nothing measured depends on bend.weft"},
      {plain + "measured_cantilever = { length = \"10 cm\", droop = { warp = \"5 cm\", bias = \"5 cm\" } }\n",
       "--parameters bend.bias,bend.warp,bend.weft", "2 measurements for 3 parameters"},
      {plain + "measured_cantilever = [{ length = \"10 cm\", droop = \"1 cm\" },\n"
               "  { length = \"10 cm\", droop = \"9 cm\" }]\n",
       "", "error: no bend fits: at best, with bend ", 1}};
  for (const Mistake& mistake : table) {
    folder.write("m.toml", mistake.sheet);
    const Outcome run = folder.drape("fit made.toml --from m.toml --quiet " + mistake.words);
    INFO(mistake.sheet << mistake.words << "\n" << run.err);
    CHECK(run.exit_code == mistake.exit_code);
    CHECK_THAT(run.err, Contains(mistake.said));
    CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
    CHECK(folder.files() == std::set<std::string>{"m.toml"});
  }
}
