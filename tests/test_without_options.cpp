// The program as it behaves where the optional parts of the library were not installed when it was built.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/folder.h"

using namespace drape::test;

namespace {

Outcome run(const Folder& folder, const std::string& words) {
  return folder.shell("'" + program_without_options() + "' " + words);
}

const std::string flag = "simulate '" + source_dir() + "/data/scenes/flag.toml' --duration 0.03 --out o ";

}  // namespace

TEST_CASE("a build without optional parts offers nothing that needs them", "[cli]") {
  const Folder folder;
  const std::string list = run(folder, "list").out;
  for (const char* there : {"implicit-euler", "bdf2", "mpcg+block-ic0", "ppcg+multigrid", "eigen-ldlt"})
    CHECK(list.find(there) != std::string::npos);
  for (const std::string missing : {"cholmod", "sundials", "kinsol", "cvode", "arkode"})
    CHECK(list.find(missing) == std::string::npos);
  for (const std::string words : {"--linear-solver cholmod", "--linear-solver sundials-pcg",
                                  "--integrator cvode-bdf", "--integrator newton-kinsol"}) {
    INFO(words);
    const Outcome refused = run(folder, flag + words);
    CHECK(refused.exit_code == 2);
    CHECK(refused.err.find("known are: ") != std::string::npos);
    CHECK(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
  }
  const Outcome grid = run(folder, "level-set '" + source_dir() + "/data/meshes/body.obj' -o body.vdb");
  CHECK(grid.exit_code == 2);
  CHECK(grid.err.find("install libopenvdb-dev") != std::string::npos);
  CHECK(folder.files().empty());
}

TEST_CASE("what a build takes by default does not depend on its optional parts", "[cli]") {
  const Folder without, with;
  REQUIRE(run(without, flag + "--quiet").exit_code == 0);
  REQUIRE(with.drape(flag + "--quiet").exit_code == 0);
  const std::string frame = content(without.path / "o/flag.obj");
  CHECK_FALSE(frame.empty());
  CHECK(content(with.path / "o/flag.obj") == frame);
}

TEST_CASE("a build without Bullet refuses bodies that would meet by it, and runs all others",
          "[meeting][cli]") {
  const Folder folder;
  const std::string scene = source_dir() + "/data/scenes/boxes-stack.toml";
  const Outcome refused = run(folder, "simulate '" + scene + "' --duration 0.01 --out o");
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find(
            "a box and a box, of which one has a mass: this build is without the library by which such "
            "bodies meet") != std::string::npos);
  CHECK(refused.err.find("apt install libbullet-dev") != std::string::npos);
  CHECK(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
  CHECK(folder.files().empty());
  const std::string ball = source_dir() + "/data/scenes/sheet-torn.toml";  // a ball over a plane
  CHECK(run(folder, "simulate '" + ball + "' --duration 0.01 --out o --quiet").exit_code == 0);
}
