// What `drape export` refuses, and that it leaves nothing behind when it fails.
#include <catch2/catch.hpp>
#include <set>

#include "app/export/files.h"
#include "exported.h"
#include "mesh/obj.h"

using namespace drape;
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
  CHECK_FALSE(
      fs::exists(folder.path / "run/export" / (cloth + "_0003.ply")));  // of the longer sequence before
  CHECK_FALSE(fs::exists(folder.path / "run/export" / (cloth + "_0006.ply")));
  CHECK(fs::exists(folder.path / "run/export/box.ply"));
  // What the run wrote is never replaced.
  const std::string box = folder.file("run/bodies/box.obj");
  folder.refused("run --to obj -o run/bodies --force", "box.obj: is a file of the run itself");
  CHECK(folder.file("run/bodies/box.obj") == box);
  CHECK(folder.drape("export run --to mdd -o run").exit_code == 0);  // beside the point caches
}

TEST_CASE("exports refuse what they cannot do", "[export]") {
  const Exported folder;
  folder.refused("run --to mmd", "there is no such format; did you mean 'mdd'?");
  folder.refused("none --to mdd", "none");
  folder.refused("run --to mdd --every 0", "--every");
  folder.write("file", "");
  folder.refused("run --to mdd -o file", "file: is a file; -o names a folder");
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
