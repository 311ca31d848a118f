// What a run tells of itself at its end, and what it leaves of an earlier one in the same folder.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <set>
#include <string>

#include "mesh/obj/obj.h"
#include "mesh/triangles/generate.h"
#include "tests/desk.h"

using namespace drape;
using namespace drape::test;
namespace fs = std::filesystem;

namespace {

// A small sheet above a ball; the words go into the tables of the simulation and of the ball.
struct Stage : Folder {
  Stage() {
    const TriangleMesh sheet = grid(4, 4, 0.2, 0.2);
    write_obj(path / "sheet.obj", sheet, sheet.positions);
  }
  Outcome run(const std::string& of_run, const std::string& centre, const std::string& options = "",
              const std::string& of_cloth = "") const {
    write("s.toml", "[simulation]\nframe_rate = 10\n" + of_run +
                        "\n[[cloth]]\nname = \"sheet\"\nmesh = \"sheet.obj\"\nfabric = \"cotton-poplin\"\n" +
                        of_cloth + "\n[[obstacle]]\nshape = \"sphere\"\nradius = 0.1\ncentre = " + centre +
                        "\n");
    return drape("simulate s.toml --out o " + options);
  }
  std::set<std::string> of_frames() const {
    std::set<std::string> found;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path / "o")) {
      const fs::path ending = entry.path().extension();
      if (ending == ".pc2" || ending == ".npy") found.insert(entry.path().filename().string());
    }
    return found;
  }
};

bool has(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

}  // namespace

TEST_CASE("cloth that falls past all bodies is told of, and no other", "[output]") {
  const Stage stage;
  const auto told = [&](const Outcome& outcome) {
    REQUIRE(outcome.exit_code == 0);
    const std::string words = "nothing touched a body", record = content(stage.path / "o/run.json");
    CHECK(has(record, words) == has(outcome.err, words));
    CHECK_FALSE((has(outcome.err, words) && has(outcome.out, "longer duration")));
    return has(record, words);
  };
  const std::string beside = "[3, -0.3, 0]", below = "[0, -0.3, 0]";
  CHECK(told(stage.run("duration = 0.4", beside)));
  CHECK_FALSE(told(stage.run("duration = 0.4", below)));
  CHECK_FALSE(told(stage.run("duration = 0.1", beside)));  // it has fallen by less than its size
  CHECK_FALSE(told(stage.run("duration = 0.4\ngravity = [0, 0, 0]", beside)));
  CHECK_FALSE(told(stage.run("duration = 0.4", beside, "", "pins = [{ vertices = [0, 3] }]")));
  // Up, and away from what is below.
  CHECK(told(stage.run("duration = 0.4\ngravity = [0, 9.81, 0]", below)));
}

TEST_CASE("halves of files of a program that was killed are taken away, and nothing else", "[output]") {
  const Stage stage;
  REQUIRE(stage.run("duration = 0.1", "[3, 0, 0]", "--quiet").exit_code == 0);
  // No process has a number above 2^22 on Linux; that of this program is alive.
  const std::string dead = "o/.sheet.pc2.99999999.part",
                    alive = "o/.sheet.pc2." + std::to_string(getpid()) + ".part";
  const std::set<std::string> others = {".part", ".sheet.pc2.x.part", "sheet.pc2.99999999.part",
                                        ".sheet.99999999"};
  for (const std::string& name : others) stage.write("o/" + name, "mine");
  for (const std::string& name : {dead, alive}) stage.write(name, "half");
  REQUIRE(stage.run("duration = 0.1", "[3, 0, 0]", "--quiet").exit_code == 0);
  CHECK_FALSE(fs::exists(stage.path / dead));
  CHECK(fs::exists(stage.path / alive));
  for (const std::string& name : others) CHECK(fs::exists(stage.path / "o" / name));
}

TEST_CASE("a name that is not UTF-8 is refused", "[cli]") {
  const Stage stage;
  const Outcome outcome = stage.drape("drop \"$(printf 'm\\351sh.obj')\" --out o");
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "word 2 of the command is not UTF-8"));
}

TEST_CASE("of two pins that move otherwise the first one counts, which is told", "[output]") {
  const Stage stage;
  const auto told = [&](const std::string& pins) {
    const Outcome outcome = stage.run("duration = 0.1", "[3, 0, 0]", "", "pins = [" + pins + "]");
    REQUIRE(outcome.exit_code == 0);
    return has(outcome.err, "vertex 3 of sheet is held by the pins of");
  };
  const std::string still = "{ vertices = [0, 3] }",
                    moves = "{ vertices = [3], motion = { velocity = [1, 0, 0] } }",
                    apart = "{ vertices = [2], motion = { velocity = [1, 0, 0] } }";
  CHECK(told(still + ", " + moves));
  CHECK(told(moves + ", " + still));
  CHECK(told(moves + ", " + moves));
  CHECK_FALSE(told(still + ", " + still));
  CHECK_FALSE(told(still + ", " + apart));
}

TEST_CASE("a run leaves no frames of an earlier one that it did not write itself", "[output]") {
  const Stage stage;
  const auto frames = [&](const std::string& kind) {
    REQUIRE(stage.run("duration = 0.2", "[3, 0, 0]", "--quiet --frames " + kind).exit_code == 0);
    return stage.of_frames();
  };
  const std::set<std::string> fields = {"sheet.contact.npy", "sheet.strain.npy", "sheet.velocity.npy"};
  std::set<std::string> all = fields;
  all.insert("sheet.pc2");
  CHECK(frames("pc2") == all);
  CHECK(frames("obj") == fields);
  CHECK(frames("none").empty());
  CHECK(frames("pc2") == all);
  CHECK(frames("none").empty());
}
