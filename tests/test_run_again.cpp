// What a run tells of cloth that missed its bodies and of pins that disagree, and what it leaves of an
// earlier run in the same folder.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
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
      if (ending == ".pc2" || ending == ".npy" || ending == ".csv" ||
          entry.path().parent_path().filename() == "frames")
        found.insert(entry.path().filename().string());
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
  const std::string young = "o/.sheet.obj.99999999.part";  // may be of another machine
  const std::set<std::string> others = {".part",
                                        ".5.part",
                                        ".sheet.pc2.x.part",
                                        "sheet.pc2.99999999.part",
                                        ".sheet.99999999",
                                        ".notes.99999999-draft.part"};
  const auto hours_ago = [&](const std::string& name) {
    fs::last_write_time(stage.path / name, fs::file_time_type::clock::now() - std::chrono::hours(2));
  };
  for (const std::string& name : others) {
    stage.write("o/" + name, "mine");
    hours_ago("o/" + name);
  }
  for (const std::string& name : {dead, alive, young}) stage.write(name, "half");
  for (const std::string& name : {dead, alive}) hours_ago(name);
  REQUIRE(stage.run("duration = 0.1", "[3, 0, 0]", "--quiet").exit_code == 0);
  CHECK_FALSE(fs::exists(stage.path / dead));
  CHECK(fs::exists(stage.path / alive));
  CHECK(fs::exists(stage.path / young));
  for (const std::string& name : others) CHECK(fs::exists(stage.path / "o" / name));
}

TEST_CASE("a name that is not UTF-8 is refused", "[cli]") {
  const Stage stage;
  const Outcome outcome = stage.drape("drop \"$(printf 'm\\351sh.obj')\" --out o");
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "word 2 of the command is not UTF-8"));
}

TEST_CASE("of two pins that may move otherwise the first one counts, which is told", "[output]") {
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
  const std::string moves = "[3, 0, 0]\nmotion = { velocity = [1, 0, 0] }";
  const auto run = [&](const std::string& kind, const std::string& ball) {
    REQUIRE(stage.run("duration = 0.2", ball, "--quiet --frames " + kind).exit_code == 0);
    return stage.of_frames();
  };
  const std::set<std::string> none = {"steps.csv"};
  std::set<std::string> fields = none, caches, objs, posed;
  fields.insert({"sheet.contact.npy", "sheet.strain.npy", "sheet.velocity.npy"});
  caches = objs = fields;
  caches.insert("sheet.pc2");
  objs.insert({"sheet_0001.obj", "sheet_0002.obj", "sheet_0003.obj"});
  posed = caches;
  posed.insert("bodies.csv");
  CHECK(run("pc2", moves) == posed);
  CHECK(run("pc2", "[3, 0, 0]") == caches);
  CHECK(run("obj", "[3, 0, 0]") == objs);
  CHECK(run("none", moves) == none);
  CHECK(run("obj", "[3, 0, 0]") == objs);
  CHECK(run("pc2", moves) == posed);
  CHECK(run("none", "[3, 0, 0]") == none);
}

TEST_CASE("a run takes nothing away from a folder in which there was no run", "[output]") {
  for (const std::string frames : {"pc2", "obj", "none"}) {
    const Stage stage;
    const std::set<std::string> mine = {"bodies.csv", "steps.txt", "frames/sheet_0007.obj",
                                        "fields/sheet.velocity.npy"};
    fs::create_directories(stage.path / "o/frames");
    fs::create_directories(stage.path / "o/fields");
    for (const std::string& file : mine) stage.write("o/" + file, "mine");
    REQUIRE(stage.run("duration = 0.1", "[0, -5, 0]", "--quiet --frames " + frames).exit_code == 0);
    for (const std::string& file : mine) {
      INFO(frames << ", " << file);
      const bool written = frames != "none" && file == "fields/sheet.velocity.npy";
      CHECK((content(stage.path / "o" / file) == "mine") == !written);
    }
  }
}

TEST_CASE("a run whose frames appear one by one begins without those of an earlier one", "[output]") {
  const Stage stage;
  const std::string moves = "[3, 0, 0]\nmotion = { velocity = [1, 0, 0] }";
  REQUIRE(stage.run("duration = 0.2", moves, "--quiet").exit_code == 0);
  REQUIRE(stage.of_frames().size() == 6);
  stage.write("kill.toml", content(stage.path / "s.toml"));
  stage.drape("simulate kill.toml --duration 100000 --out o --quiet --frames obj", "timeout -s KILL 3");
  std::set<std::string> left = stage.of_frames();
  CHECK_FALSE(fs::exists(stage.path / "o/run.json"));
  for (const char* name : {"steps.csv", "bodies.csv", "sheet.pc2", "sheet.velocity.npy"}) {
    INFO(name);
    CHECK(left.count(name) == 0);
  }
  CHECK(left.count("sheet_0001.obj") == 1);
}

TEST_CASE("what a scene is made from is not removed with an earlier run's files", "[output]") {
  const Stage stage;
  fs::create_directory(stage.path / "o");
  stage.write("o/bodies.csv", "time,x,y,z\n0,0,0,0\n1,1,0,0\n");
  const Outcome outcome =
      stage.run("duration = 0.1", "[3, 0, 0]\nmotion = { poses = \"o/bodies.csv\" }", "--frames none");
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "the scene is made from it"));
  CHECK(fs::exists(stage.path / "o/bodies.csv"));
}
