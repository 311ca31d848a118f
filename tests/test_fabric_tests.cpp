// The virtual tests of a laboratory: their specimens, what they measure with, and the fabrics they are given.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "app/scene/laboratory.h"
#include "app/textile/elastica.h"
#include "app/textile/measurements.h"
#include "app/textile/shadow.h"
#include "app/textile/virtual_tests.h"
#include "mesh/triangles/topology.h"
#include "tests/folder.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

namespace {

constexpr double pi = 3.14159265358979323846;

double area_of(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += triangle_area(mesh, t);
  return area;
}

// A fabric that differs in every direction.
Fabric directed() {
  Fabric fabric{.area_density = 0.15, .stretch = 800, .bend = 12e-6};
  fabric.weave = {.stretch_weft = 400, .shear = 60, .poisson = 0.15, .bend_weft = 5e-6, .bend_bias = 6e-6};
  return fabric;
}

const Value& value(const Values& values, const std::string& quantity) {
  for (const Value& v : values)
    if (v.quantity == quantity) return v;
  throw std::logic_error("no value " + quantity);
}

}  // namespace

TEST_CASE("the chord of a heavy strip stands as the master curve of the elastica says", "[fabric-tests]") {
  for (const std::vector<double>& row : reference_table("cantilever_master.csv"))
    if (row[0] > 0.01 && row[0] < 900)
      CHECK(gamma_of_chord(row[5] * pi / 180) == Approx(row[0]).epsilon(2e-5));
  CHECK(std::cbrt(gamma_of_chord(standard_chord_angle)) == Approx(2).epsilon(2e-4));
}

TEST_CASE("specimens have the size that they are cut to, and are held where the clamps are",
          "[fabric-tests]") {
  for (double edge : {0.01, 0.006}) {
    const Specimen strip = strip_between_clamps(0.2, 0.05, edge);
    CHECK(area_of(strip.mesh) == Approx(0.2 * 0.05));
    CHECK(static_cast<double>(strip.held.size()) >= 0.05 / edge);
    CHECK(static_cast<double>(strip.moved.size()) >= 0.05 / edge);

    const Specimen overhang = overhanging_strip(0.06, 0.03, edge);
    double at_edge = 0;  // the middle of the vertices that are held
    for (int i : overhang.held) {
      const double x = overhang.mesh.positions[static_cast<std::size_t>(i)].x();
      CHECK(std::abs(x) < 0.5 * edge);
      at_edge += x;
    }
    CHECK(std::abs(at_edge) < 1e-12);
    CHECK(area_of(overhang.mesh) == Approx((0.06 + 0.4 * edge) * 0.03));

    const Specimen disc = disc_on_plate(0.15, 0.09, edge);
    const double inner = 0.09 - 0.4 * edge;
    CHECK(area_of(disc.mesh) == Approx(pi * (0.15 * 0.15 - inner * inner)).epsilon(0.01));
    double mean = 0;
    for (int i : disc.held)
      mean += disc.mesh.positions[static_cast<std::size_t>(i)].norm() / static_cast<double>(disc.held.size());
    CHECK(mean == Approx(0.09).epsilon(1e-6));
    for (const Edge& e : edges(disc.mesh)) CHECK(e.triangles <= 2);
  }
}

TEST_CASE("a shadow has the area, the nodes and the amplitude of what casts it", "[fabric-tests]") {
  const TriangleMesh round = disc(40, 0.12);
  Shadow shadow(0.09, 0.16);
  CHECK(shadow.area() == Approx(pi * 0.09 * 0.09).epsilon(1e-3));
  shadow.add(round.triangles, round.positions);
  const double once = shadow.area();
  CHECK(once == Approx(area_of(round)).epsilon(1e-3));
  shadow.add(round.triangles, round.positions);  // what is folded casts one shadow
  CHECK(shadow.area() == once);
  CHECK(waves(shadow.outline(), 0.003).nodes == 0);

  for (int nodes : {1, 2, 5, 9}) {
    TriangleMesh wavy = round;
    for (Vec3& x : wavy.positions) {
      const double angle = std::atan2(x.z(), x.x());
      x *= 1 + 0.1 * std::cos(nodes * angle + 0.3);
      x.y() = 0.05 * std::sin(nodes * angle);  // height casts no shadow
    }
    Shadow waved(0.03, 0.16);
    waved.add(wavy.triangles, wavy.positions);
    const Waves found = waves(waved.outline(), 0.003);
    CHECK(found.nodes == nodes);
    CHECK(found.amplitude == Approx(0.012).epsilon(0.03));
    CHECK(waves(waved.outline(), 0.03).nodes == 0);
  }
}

TEST_CASE("a woven fabric passes its tests in every direction as it was asked to", "[fabric-tests]") {
  const Fabric fabric = directed();
  for (double edge : {0.01, 0.007, 0.005}) {
    CAPTURE(edge);
    const double coarse = std::pow(edge / 0.005, 2);
    for (const Value& v : cantilever_test(fabric, ClothModel::woven, edge)) {
      CAPTURE(v.quantity);
      const bool rigidity = v.quantity.starts_with("bending rigidity");
      CHECK(v.found.at(0) == Approx(*v.asked).epsilon((rigidity ? 0.05 : 0.02) * coarse));
    }
    for (const Value& v : tensile_test(fabric, ClothModel::woven, edge))
      if (v.asked) {
        CAPTURE(v.quantity);
        CHECK(v.found.at(0) == Approx(*v.asked).epsilon(0.01));
      }
    const Values shear = shear_test(fabric, ClothModel::woven, edge);
    CHECK(value(shear, "shear modulus, between clamps").found.at(0) == Approx(60).epsilon(0.02));
    CHECK(value(shear, "shear modulus, picture frame").found.at(0) == Approx(60).epsilon(5e-4));
  }
}

TEST_CASE("a stiff disc on the plate sags as a clamped annular plate does", "[fabric-tests]") {
  // w = K area_density g R^4 / D at the rim of a plate clamped at 9 cm and free at 15 cm [Kirchhoff].
  for (const auto& [poisson, K] : {std::pair{0.0, 0.00383351}, std::pair{0.3, 0.00350753}})
    for (double edge : {0.012, 0.008, 0.005}) {
      CAPTURE(poisson, edge);
      Fabric fabric{.area_density = 0.15, .stretch = 500, .bend = 1e-2};
      fabric.weave.bend_poisson = poisson;
      const Specimen disc = disc_on_plate(0.15, 0.09, edge);
      Rig rig(disc, {fabric, ClothModel::woven, 0}, {0, -standard_gravity, 0},
              [](const Vec3& x) { return x; });
      REQUIRE(rig.settle(1, 1e-9, 400));
      double sum = 0;
      int rim = 0;
      for (int i = 0; i < disc.mesh.vertex_count(); ++i)
        if (disc.mesh.positions[static_cast<std::size_t>(i)].norm() > 0.15 * (1 - 1e-9)) {
          sum -= rig.place(i).y();
          ++rim;
        }
      const double expected = K * 0.15 * standard_gravity * std::pow(0.15, 4) / 1e-2;
      CHECK(sum / rim == Approx(expected).epsilon(0.03));
    }
}

TEST_CASE("the red circle of a shadow's picture has the area of the shadow that was measured",
          "[fabric-tests]") {
  constexpr double plate = 0.09, specimen = 0.15, reach = 1.05 * specimen;
  const auto red = [](const drawing::Pixel& p) { return p[0] > p[1] + 50; };
  const drawing::Image none = Shadow(plate, reach).picture(specimen);
  CHECK(std::none_of(none.pixels.begin(), none.pixels.end(), red));
  for (double coefficient : {0.0, 0.25, 0.83}) {
    const drawing::Image image = Shadow(plate, reach).picture(specimen, coefficient);
    double mean = 0;
    int count = 0;
    for (int i = 0; i < image.width; ++i)
      for (int j = 0; j < image.height; ++j)
        if (red(image.at(i, j))) {
          const double cell = 2 * reach / image.width;  // m
          mean += cell * std::hypot(i + 0.5 - 0.5 * image.width, j + 0.5 - 0.5 * image.height);
          ++count;
        }
    REQUIRE(count > 0);
    mean /= count;
    const double share = (mean * mean - plate * plate) / (specimen * specimen - plate * plate);
    CHECK(share == Approx(coefficient).margin(0.01));
  }
}

TEST_CASE("a drape coefficient depends on the ratio of rigidity to weight, not on the size of things",
          "[fabric-tests]") {
  const Fabric fabric{.area_density = 0.12, .stretch = 500, .bend = 11e-6};
  Fabric larger = fabric;  // all lengths times s: B times s^3, Y times s
  constexpr double s = 1.2;
  larger.bend *= s * s * s;
  larger.stretch *= s;
  DrapeTest test{.repeats = 1};
  std::vector<double> shadows;
  const auto each = [&](int, const Shadow& shadow) { shadows.push_back(shadow.area()); };
  const Values one = drape_test(fabric, ClothModel::woven, 0.015, test, each);
  test.plate_radius *= s;
  test.radius *= s;
  const Values other = drape_test(larger, ClothModel::woven, 0.015 * s, test, each);
  const double coefficient = one[0].found.at(0);
  CHECK(coefficient > 0.5);
  CHECK(coefficient < 0.95);
  CHECK(other[0].found.at(0) == Approx(coefficient).margin(0.03));
  REQUIRE(shadows.size() == 2);
  CHECK(shadows[0] == Approx((coefficient * (0.15 * 0.15 - 0.09 * 0.09) + 0.09 * 0.09) * pi).epsilon(5e-3));
  // The same specimens a second time.
  CHECK(drape_test(fabric, ClothModel::woven, 0.015, {.repeats = 1}, each)[0].found == one[0].found);
}

TEST_CASE("every repeat of a drape test has a mesh of its own, of the same size", "[fabric-tests]") {
  const DrapeTest test;
  const double edge = 0.015;
  std::vector<double> longest;
  for (int repeat = 0; repeat < 4; ++repeat) {
    const Specimen disc = draped_disc(test, edge, repeat);
    const TriangleMesh& mesh = disc.mesh;
    const std::set<int> held(disc.held.begin(), disc.held.end());  // two rings, apart by more than an edge
    double most = 0, rim = 0;
    for (const Edge& e : edges(mesh))
      if (!held.contains(e.a) && !held.contains(e.b))
        most = std::max(most, (mesh.positions[static_cast<std::size_t>(e.a)] -
                               mesh.positions[static_cast<std::size_t>(e.b)])
                                  .norm());
    for (const Vec3& x : mesh.positions) rim = std::max(rim, x.norm());
    CHECK(most <= edge * (1 + 1e-9));
    CHECK(most > 0.8 * edge);
    CHECK(rim == Approx(test.radius));
    for (double other : longest) CHECK(std::abs(most - other) > 1e-6 * edge);
    longest.push_back(most);
  }
  CHECK(draped_disc(test, edge, 2).mesh.positions == draped_disc(test, edge, 2).mesh.positions);
}

TEST_CASE("test-fabric prints a table and writes it, with the shadows", "[fabric-tests]") {
  Folder folder;
  const Outcome outcome =
      folder.drape("test-fabric cotton-broad --mesh 15mm --tests cantilever,drape --repeats 2 --out o");
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  CHECK_THAT(outcome.out, Catch::Contains("bending length, warp") && Catch::Contains("drape coefficient") &&
                              Catch::Contains(" ± ") && Catch::Contains("15 mm mesh"));
  CHECK(folder.files("o") ==
        std::set<std::string>{"test-fabric.json", "drape-15mm-1.png", "drape-15mm-2.png"});
  const auto json = nlohmann::json::parse(content(folder.path / "o/test-fabric.json"));
  REQUIRE(json["rows"].size() == 9);
  const auto& row = json["rows"][0];
  CHECK(row["si_unit"] == "m");
  CHECK(row["asked"].get<double>() == Approx(0.0212).epsilon(1e-3));
  CHECK(row["results"][0]["mesh"] == 0.015);
  CHECK(json["rows"][6]["results"][0]["values"].size() == 2);
}

TEST_CASE("what a laboratory measured stands beside what the virtual tests find", "[fabric-tests]") {
  Folder folder;
  folder.write("mine.toml",
               "area_density = 0.15\nstretch = { warp = 500, shear = 60 }\nbend = 2e-4\n"
               "measured_cantilever = { length = \"10 cm\", droop = { warp = \"6 cm\", weft = \"8 cm\" } }\n"
               "measured_picture_frame = { side = \"10 cm\", shear = \"5 deg\", force = \"0.6 N\" }\n");
  const Outcome outcome = folder.drape("test-fabric mine.toml --mesh 20mm --tests cantilever,shear --out o");
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  std::map<std::string, nlohmann::json> measured;
  const auto json = nlohmann::json::parse(content(folder.path / "o/test-fabric.json"));
  for (const auto& row : json["rows"]) measured[row["quantity"]] = row["measured"];
  // `drape fit` finds 209 and 88 uN.m, and 46.6 N/m, with which strips and frame do the same.
  CHECK(measured.at("bending rigidity, warp").get<double>() == Approx(209e-6).epsilon(0.02));
  CHECK(measured.at("bending rigidity, weft").get<double>() == Approx(88e-6).epsilon(0.03));
  const double c = measured.at("bending length, warp").get<double>();
  CHECK(0.15 * 9.80665 * c * c * c == Approx(measured.at("bending rigidity, warp").get<double>()));
  CHECK(measured.at("bending length, bias").is_null());
  CHECK(measured.at("shear modulus, picture frame").get<double>() == Approx(46.6).epsilon(0.02));
  // A second strip that has another direction, and a strip in the bias in place of a frame: load / (4
  // extension).
  NamedFabric both = load_fabric("mine.toml", folder.path);
  both.tests.cantilevers.push_back({.length = 0.1, .droop = {.warp = 0.01, .weft = {}, .bias = 0.06}});
  CHECK(*measured_value(both, "bending rigidity, bias") == *measured_value(both, "bending rigidity, warp"));
  both.tests.frames.clear();
  both.tests.bias_extensions.push_back({.length = 0.1, .width = 0.05, .load = 5, .extension = 0.03});
  CHECK(*measured_value(both, "shear modulus, between clamps") == Approx(5 / 0.12));
  CHECK_FALSE(measured_value(both, "shear modulus, picture frame"));
}

TEST_CASE("what test-fabric cannot do is refused in one line", "[fabric-tests]") {
  Folder folder;
  folder.write("springs.toml", "area_density = 0.1\nstretch_spring = 100\n");
  for (const auto& [words, message] :
       {std::pair{"cotton", "there is no fabric 'cotton'"},
        {"cotton-broad --mesh 0.1mm", "from 1 mm to 20 mm"},
        {"cotton-broad --mesh 5kg", "expected a length"},
        {"cotton-broad --tests stretch", "there is no test"},
        {"cotton-broad --tests drape,drape", "name it once"},
        {"cotton-broad --mesh 10mm,10mm", "name it once"},
        {"polyester-twill --mesh 15mm --specimen 21cm", "too coarse for the 15 mm"},
        {"springs.toml", "a specimen needs stretch and bend per width"},
        {"cotton-broad --model choi-ko", "expected woven or noh-jung"},
        {"cotton-broad --repeats 1.5", "whole number"},
        {"cotton-broad --plate 2cm", "from 50 mm"},
        {"cotton-broad --plate 29cm", "is as wide as the disc of 254 mm"},
        {"cotton-broad --plate 25cm", "a smaller --plate"},
        {"cotton-broad --bending hinge", "there is no such bending"},
        {"cotton-broad --bending hinges --model noh-jung", "goes with --model woven"},
        {"cotton-broad --specimen 18cm", "from 200 mm"}}) {
    CAPTURE(words);
    const Outcome outcome = folder.drape(std::string("test-fabric ") + words);
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Catch::Contains(message));
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    CHECK(folder.files() == std::set<std::string>{"springs.toml"});
  }
}
