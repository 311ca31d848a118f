// What `drape export` refuses, and that it leaves nothing behind when it fails.
#include <catch2/catch.hpp>
#include <set>

#include "app/export/files.h"
#include "app/recording/run_files.h"
#include "exported.h"
#include "mesh/base/errors.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {
const std::string& cloth = exported_cloth;
}

TEST_CASE("an export that fails leaves nothing behind", "[export]") {
  const Folder folder;
  {
    ExportFiles files(folder.path / "a/b", {"x.mdd", "y.mdd"}, false, folder.path);
    files.write("x.mdd", "1");
    files.write("y.mdd", "2");
    CHECK_FALSE(fs::exists(folder.path / "a/b/x.mdd"));
  }
  CHECK(folder.files().empty());
  {
    ExportFiles files(folder.path / "a/b", {"x.mdd", "y.mdd"}, false, folder.path);
    files.write("x.mdd", "1");
    files.write("y.mdd", "2");
    files.keep();
  }
  CHECK(folder.files("a/b") == std::set<std::string>{"x.mdd", "y.mdd"});
  // A file that grows beyond what the system allows.
  const Exported exported;
  for (const std::string format : {"gltf", "csv", "vtk"}) {
    const Outcome outcome = exported.exported("run", format, "", "ulimit -f 4;");
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Contains("cannot write: File too large"));
    CHECK_FALSE(fs::exists(exported.path / format));
  }
}

TEST_CASE("exports replace nothing unless they are told to", "[export]") {
  const Exported folder;
  REQUIRE(folder.drape("export run --to ply").exit_code == 0);
  folder.refused("run --to ply", "_0001.ply: is there already; --force replaces it");
  REQUIRE(folder.drape("export run --to ply --every 3 --force").exit_code == 0);
  CHECK(fs::exists(folder.path / "run/export" / (cloth + "_0002.ply")));
  // The file belonged to the longer sequence before.
  CHECK_FALSE(fs::exists(folder.path / "run/export" / (cloth + "_0003.ply")));
  CHECK_FALSE(fs::exists(folder.path / "run/export" / (cloth + "_0006.ply")));
  CHECK(fs::exists(folder.path / "run/export/box.ply"));
  // What the run wrote is never replaced.
  const std::string box = folder.file("run/bodies/box.obj");
  folder.refused("run --to obj -o run/bodies --force", "_0001.obj: is a name of the run's own files");
  CHECK(folder.file("run/bodies/box.obj") == box);
  CHECK(folder.drape("export run --to mdd -o run").exit_code == 0);  // beside the point caches
  folder.refused("run --to obj -o run", "_0001.obj: is a name of the run's own files");
}

TEST_CASE("the names of a run's own files are spared, however they are written", "[export]") {
  const Folder folder;
  const fs::path run = folder.path / "run";
  for (const char* below : {"bodies", "fields", "frames", "export"}) fs::create_directories(run / below);
  fs::create_directory_symlink(run, folder.path / "link");
  for (const fs::path& root : {run, run / ".", run / "export/..", folder.path / "link"}) {
    for (const char* own : {"run.json", "steps.csv", "bodies.csv", "sheet.obj", "sheet.pc2", "bodies/box.obj",
                            "fields/sheet.strain.npy", "frames/sheet_0001.obj"}) {
      INFO(root / own);
      CHECK(is_of_run(root / own, run));
      CHECK(is_of_run(root / own, folder.path / "link"));
      CHECK_FALSE(is_of_run(root / own, run / "export"));
    }
    for (const char* free :
         {"view.html", "picture.png", "sheet.csv", "export/run.json", "export/sheet.obj"}) {
      INFO(root / free);
      CHECK_FALSE(is_of_run(root / free, run));
    }
  }
  // A link in the run is what would be replaced.
  folder.write("elsewhere", "");
  fs::create_symlink(folder.path / "elsewhere", run / "run.json");
  CHECK(is_of_run(run / "run.json", run));
}

TEST_CASE("no two files of an export have the same name", "[export]") {
  const Exported folder;
  const std::string scene = content(folder.path / "scene.toml");
  const auto named = [&](const std::string& body) {
    std::string other = scene;
    other.replace(other.find("name = \"box\""), 12, "name = \"" + body + "\"");
    other.replace(other.find("'a & \"b\" <c> é'"), exported_cloth.size() + 2, "'sheet'");
    folder.write("scene.toml", other);
    REQUIRE(folder.drape("simulate scene.toml --out twins --quiet").exit_code == 0);
  };
  named("sheet_0001");
  for (const std::string format : {"obj", "ply", "vtk"}) {
    folder.refused("twins --to " + format + " -o out", "two files of this export would have this name");
    CHECK_FALSE(fs::exists(folder.path / "out"));
  }
  for (const std::string format : {"mdd", "gltf", "usda", "csv"})
    CHECK(folder.exported("twins", format).exit_code == 0);
  // One that goes on where the sequence ends is no leftover of a longer one.
  fs::remove_all(folder.path / "twins");
  named("sheet_0007");
  for (int times = 0; times < 2; ++times) REQUIRE(folder.exported("twins", "ply", "--force").exit_code == 0);
  CHECK(folder.files("ply").count("sheet_0006.ply") == 1);
  CHECK(folder.files("ply").count("sheet_0007.ply") == 1);
}

TEST_CASE("when the last file cannot take its place, those before it give theirs back", "[export]") {
  const Folder folder;
  folder.write("x.mdd", "old");
  {
    ExportFiles files(folder.path, {"new.mdd", "x.mdd", "y.mdd"}, true, folder.path / "run");
    for (const char* name : {"new.mdd", "x.mdd", "y.mdd"}) files.write(name, "new");
    fs::create_directories(folder.path / "y.mdd/full");
    CHECK_THROWS_WITH(files.keep(), Contains("y.mdd: cannot write"));
  }
  CHECK(folder.files() == std::set<std::string>{"x.mdd", "y.mdd"});
  CHECK(content(folder.path / "x.mdd") == "old");
  fs::remove_all(folder.path / "y.mdd");
  {
    ExportFiles files(folder.path, {"x.mdd"}, true, folder.path / "run");
    files.write("x.mdd", "new");
    files.keep();
  }
  CHECK(folder.files() == std::set<std::string>{"x.mdd"});
  CHECK(content(folder.path / "x.mdd") == "new");
}

TEST_CASE("exports refuse what they cannot do", "[export]") {
  const Exported folder;
  folder.refused("run --to mmd", "there is no such format; did you mean 'mdd'?");
  folder.refused("none --to mdd", "none");
  folder.refused("run --to mdd --every 0", "--every");
  folder.write("file", "");
  folder.refused("run --to mdd -o file", "file: is a file; a folder is needed");
  folder.refused("run --to mdd -o file/below", "file/below: cannot be made: Not a directory");
  CHECK(folder.files().count("file") == 1);

  fs::copy(folder.path / "run", folder.path / "cut", fs::copy_options::recursive);
  fs::resize_file(folder.path / "cut" / (cloth + ".pc2"), 700);
  folder.refused("cut --to mdd", ".pc2");
  CHECK_FALSE(fs::exists(folder.path / "cut/export"));
  fs::copy(folder.path / "run", folder.path / "blind", fs::copy_options::recursive);
  fs::remove(folder.path / "blind/run.json");
  folder.refused("blind --to gltf -o out", "run.json");
  fs::create_directory(folder.path / "empty");
  folder.refused("empty --to csv -o out", "empty");
  CHECK_FALSE(fs::exists(folder.path / "out"));
}
