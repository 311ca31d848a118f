// Fabric files: where they are looked for, what they say of themselves, and how their mistakes are told.
#include <catch2/catch.hpp>
#include <string>

#include "app/base/toml_file.h"
#include "app/scene/fabrics.h"
#include "tests/mistakes.h"
#include "tests/workshop.h"

using namespace drape;
using namespace drape::test;
using app::NamedFabric;
using Catch::Contains;
using Catch::StartsWith;

namespace {

const std::string plain =
    "area_density = \"200 g/m^2\"\nbend = \"30 uN.m\"\n";  // two lines: the next one is line 3

double bend_of_run(const Workshop& shop, const std::string& words, const std::string& before = "") {
  const Outcome run = shop.drape(words + " --duration 0.02 --out o --quiet", before);
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  return shop.json("o/run.json")["cloths"][0]["fabric"]["bend"].get<double>();
}

}  // namespace

TEST_CASE("a fabric file is found beside its scene, and from the folder in which drop is run", "[scene]") {
  const Workshop shop;
  std::filesystem::create_directories(shop.path / "scenes/mine");
  shop.write("scenes/mine/wool.toml", plain);
  shop.write("scenes/s.toml", "[[cloth]]\nmesh = \"../sheet.obj\"\nfabric = \"mine/wool.toml\"\n");
  CHECK(bend_of_run(shop, "simulate scenes/s.toml") == Approx(30e-6));
  CHECK(bend_of_run(shop, "drop sheet.obj --fabric scenes/mine/wool.toml") == Approx(30e-6));
  const Outcome away = shop.drape("check scenes/s.toml", "mv scenes/mine mine &&");
  CHECK(away.exit_code == 2);
  CHECK_THAT(
      away.err,
      Contains("scenes/s.toml:3: fabric = \"mine/wool.toml\": there is no file scenes/mine/wool.toml"));
  CHECK_THAT(shop.drape("drop sheet.obj --fabric none.toml").err,
             StartsWith("error: --fabric: fabric = \"none.toml\": there is no file none.toml"));
}

TEST_CASE("a fabric wrinkles finer than its mesh, unless its file or the scene says otherwise", "[scene]") {
  const Workshop shop;
  shop.write("plain.toml", plain);
  shop.write("stiff.toml", plain + "compression = 1\n");
  const auto compression = [&](const std::string& words) {
    const Outcome run = shop.drape("drop sheet.obj --duration 0.02 --out o --quiet " + words);
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    return shop.json("o/run.json")["cloths"][0]["fabric"]["weave"]["compression"].get<double>();
  };
  CHECK(compression("--fabric cotton-broad") == app::usual_compression);
  CHECK(compression("--fabric plain.toml") == app::usual_compression);
  CHECK(compression("--fabric stiff.toml") == 1);
  CHECK(compression("--fabric plain.toml --set cloth.0.compression=0.4") == Approx(0.4));
  // Springs say that they leave it out where somebody asked for it.
  const std::string springs =
      "drop sheet.obj --fabric plain.toml --duration 0.02 --out o --set cloth.0.model=noh-jung";
  CHECK_THAT(shop.drape(springs).err, !Contains("compression"));
  CHECK_THAT(shop.drape(springs + " --set cloth.0.compression=0.4").err, Contains("leaves out compression"));
}

TEST_CASE("edges too long for the folds of a fabric are told, with what helps", "[scene]") {
  const Workshop shop;
  const auto warning = [&](double edge,
                           const std::string& words) {  // edge in bending lengths of polyester-plain
    const TriangleMesh sheet = grid(13, 13, 12 * edge * 7.38e-3, 12 * edge * 7.38e-3);
    shop.write("s.obj", format_obj(sheet, sheet.positions));
    const Outcome run = shop.drape("drop s.obj --fabric polyester-plain --duration 0.02 --out o " + words);
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    return run.err;
  };
  const std::string all = "--set cloth.0.compression=1", advice = "set compression = 0.1";
  CHECK_THAT(warning(0.95, all), !Contains("folds come out too stiff"));
  CHECK_THAT(warning(1.05, all), Contains("longer than the bending length") && Contains(advice));
  CHECK_THAT(warning(1.45, ""), !Contains("folds come out too stiff"));
  CHECK_THAT(warning(1.55, ""), Contains("one and a half times the bending length") &&
                                    Contains("subdivide the mesh") && !Contains(advice));
}

TEST_CASE("a garment that is dropped on the floor keeps its area", "[scene][reference]") {
  const Workshop shop;
  const auto kept = [&](const std::string& words) {
    const Outcome run =
        shop.drape("drop " + test::source_dir() +
                   "/data/meshes/tee.obj --onto plane --duration 0.7 --frames none --out o " + words);
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    return shop.json("o/run.json")["area_kept"].get<double>();
  };
  CHECK(kept("") > 0.97);
  CHECK(kept("--set cloth.0.model=noh-jung") < 0.9);  // it is a heap by then
}

TEST_CASE("$DRAPE_DATA adds fabrics to the built-in ones, and its own go before", "[scene]") {
  const Workshop shop;
  std::filesystem::create_directories(shop.path / "more/fabrics");
  shop.write("more/fabrics/felt.toml", "description = \"of mine\"\n" + plain);
  shop.write("more/fabrics/cotton-broad.toml", plain);
  const std::string data = "DRAPE_DATA=more";
  const Outcome listed = shop.drape("list fabrics", data);
  REQUIRE(listed.exit_code == 0);
  for (const char* name : {"felt", "of mine", "cotton-poplin", "polyester-twill"})
    CHECK_THAT(listed.out, Contains(name));
  CHECK(bend_of_run(shop, "drop sheet.obj --fabric felt", data) == Approx(30e-6));
  CHECK(bend_of_run(shop, "drop sheet.obj --fabric cotton-broad", data) == Approx(30e-6));
  CHECK(bend_of_run(shop, "drop sheet.obj --fabric cotton-poplin", data) == Approx(8e-6));
  CHECK(bend_of_run(shop, "drop sheet.obj --fabric cotton-broad") == Approx(11.5718e-6));
  // A file that cannot be read hides no other.
  shop.write("more/fabrics/broken.toml", "stretch =\n");
  const Outcome with_broken = shop.drape("list fabrics", data);
  CHECK(with_broken.exit_code == 0);
  CHECK_THAT(with_broken.out, Contains("cannot be read: more/fabrics/broken.toml:1: is not TOML"));
  CHECK(lines_of(with_broken.out) == lines_of(listed.out) + 1);
  CHECK(shop.drape("list fabrics", "DRAPE_DATA=none").exit_code == 0);
}

TEST_CASE("a mistake in a fabric file is told with its file and line", "[scene]") {
  const Folder folder;
  const std::string file = (folder.path / "f.toml").string();
  const auto read = [&](const std::string& text) {
    folder.write("f.toml", text);
    return app::load_fabric("f.toml", folder.path);
  };
  const Mistake table[] = {
      {"bend = 1e-5\n", file + ":1:", "'area_density' is missing"},
      {plain + "bent = 3\n", file + ":3:", "unknown key 'bent' in the fabric; did you mean 'bend'?"},
      {plain + "stretch = \"3 m\"\n", file + ":3:", "expected a membrane stiffness"},
      {plain + "assumed = \"bend\"\n", file + ":3:", "expected a list"},
      {plain + "measured_drape = 3\n", file + ":3:", "{ coefficient = \"45 %\", nodes = 6 }"},
      {plain + "measured_drape = { nodes = 3 }\n", file + ":3:", "'coefficient' is missing"},
      {plain + "measured_drape = { coefficient = 45 }\n", file + ":3:", "at most 1"},
      {plain + "measured_drape = { coefficient = \"45 m\" }\n", file + ":3:", "expected a share"},
  };
  check_mistakes(table, read);
  const NamedFabric named = read(plain + "measured_drape = { coefficient = \"45 %\", nodes = 6.5 }\n");
  REQUIRE(named.tests.drape);
  CHECK(named.tests.drape->coefficient == Approx(0.45));
  CHECK(named.tests.drape->nodes == 6.5);
  CHECK_FALSE(read(plain).tests.drape);
}
