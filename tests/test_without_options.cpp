// The program as it behaves where the optional parts of the library were not installed when it was built.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <string>

#include "solver/integrators/integrator.h"
#include "tests/folder.h"

using namespace drape;
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
  const auto refuses = [&](const std::string& words, const std::string& hint) {
    INFO(words);
    const Outcome refused = run(folder, words);
    CHECK(refused.exit_code == 2);
    CHECK(refused.err.find(hint) != std::string::npos);
    CHECK(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
  };
  // What the program lacks is known by name, and by what to install for it.
  const std::string scene = "'" + source_dir() + "/data/scenes/flag.toml'";
  const std::string sundials = "install libsundials-dev and build again";
  const std::map<std::string, std::string> solvers = {
      {"cholmod", "install libsuitesparse-dev and build again"},
      {"sundials-pcg", sundials},
      {"sundials-pcg+multigrid", sundials},
      {"petsc", "install petsc-dev, configure with -DDRAPE_PETSC=ON and build again"}};
  for (const auto& [name, hint] : solvers) {
    refuses(flag + "--linear-solver " + name, hint);
    refuses("compare " + scene + " --solvers " + name + " --out o", hint);
  }
  const std::set<std::string> integrator_names = {"newton-kinsol", "cvode-bdf", "cvode-adams", "arkode-erk",
                                                  "arkode-dirk"};
  for (const std::string& name : integrator_names) {
    refuses(flag + "--integrator " + name, sundials);
    refuses("compare " + scene + " --integrators " + name + " --out o", sundials);
    refuses("stability " + scene + " --integrators " + name, sundials);
  }
  const auto listed = [&](std::string_view name) {
    return list.find("  " + std::string(name) + " ") != std::string::npos;
  };
  for (const LinearSolverInfo& info : linear_solvers()) {
    INFO(info.name);
    CHECK(listed(info.name) != (solvers.count(std::string(info.name)) == 1));
  }
  for (const IntegratorInfo& info : integrators()) {
    INFO(info.name);
    CHECK(listed(info.name) != (integrator_names.count(std::string(info.name)) == 1));
  }
  refuses(flag + "--linear-solver cholmot", "known are: ");
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
