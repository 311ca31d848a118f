// The files a run writes: their bytes, and that none appears before it is complete.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include "app/base/atomic_file.h"
#include "app/base/pc2.h"
#include "app/recording/run_json.h"
#include "app/recording/steps_csv.h"
#include "app/simulation/measure.h"
#include "mesh/base/errors.h"
#include "mesh/base/hash.h"
#include "mesh/triangles/generate.h"
#include "tests/folder.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

}  // namespace

TEST_CASE("a point cache has the layout that Blender reads", "[output]") {
  const Folder folder;
  std::vector<Vec3> x = {{1, 2, 3}, {-4, 0.1, 1e-9}};
  {
    Pc2Writer cache(folder.path / "a.pc2", 2);
    cache.add(x);
    for (Vec3& point : x) point *= 2;
    cache.add(x);
    cache.add(x);
    cache.close();
    CHECK_FALSE(fs::exists(folder.path / "a.pc2"));
    cache.keep();
  }
  const std::string bytes = content(folder.path / "a.pc2");
  REQUIRE(bytes.size() == 32 + 3 * 2 * 12);
  CHECK(std::string(bytes.data(), 12) == std::string("POINTCACHE2\0", 12));
  CHECK(at<std::int32_t>(bytes, 12) == 1);  // version
  CHECK(at<std::int32_t>(bytes, 16) == 2);  // points
  CHECK(at<float>(bytes, 20) == 0.0f);      // first frame
  CHECK(at<float>(bytes, 24) == 1.0f);      // sample rate
  CHECK(at<std::int32_t>(bytes, 28) == 3);  // samples
  CHECK(at<float>(bytes, 32) == 1.0f);
  CHECK(at<float>(bytes, 32 + 16) == 0.1f);
  CHECK(at<float>(bytes, 32 + 24 + 12) == -8.0f);
}

TEST_CASE("a file appears only when it is complete", "[output]") {
  const Folder folder;
  const fs::path path = folder.path / "a.txt";
  {
    AtomicFile file(path);
    file.write("half");
  }
  CHECK(folder.files().empty());
  {
    AtomicFile file(path);
    file.write("whole");
    CHECK_FALSE(fs::exists(path));
    file.keep();
  }
  CHECK(content(path) == "whole");
  {
    AtomicFile file(path);
    file.write("another");
  }
  CHECK(content(path) == "whole");
  CHECK(folder.files().size() == 1);
}

TEST_CASE("a write that fails leaves nothing behind and says why", "[output]") {
  const Folder folder;
  CHECK_THROWS_WITH(AtomicFile(folder.path / "none" / "a.txt"),
                    Contains("a.txt: cannot write: No such file or directory"));
  fs::create_directory(folder.path / "d");
  CHECK_THROWS_WITH(AtomicFile(folder.path / "d"), Contains("Is a directory"));
  CHECK(folder.files().size() == 1);
}

TEST_CASE("a row of steps.csv has a number for every column", "[output]") {
  const Folder folder;
  {
    StepsWriter steps(folder.path / "steps.csv");
    StepRow row;
    row.step = 1;
    row.elastic_energy = std::numeric_limits<double>::max();
    row.kinetic_energy = -std::numeric_limits<double>::denorm_min();
    steps.add(row);
    steps.keep();
  }
  std::ifstream file(folder.path / "steps.csv");
  std::string header, row, more;
  std::getline(file, header);
  std::getline(file, row);
  CHECK_FALSE(std::getline(file, more));
  CHECK(header.starts_with(
      "step,time,newton_iterations,linear_iterations,residual,contacts,kinetic_energy,elastic_energy,"
      "gravity_energy,max_speed,max_edge_strain,assemble_ms,solve_ms,collide_ms,step_ms"));
  CHECK(std::count(header.begin(), header.end(), ',') == std::count(row.begin(), row.end(), ','));
}

TEST_CASE("run.json stays valid with names that are not UTF-8 and numbers that are not finite", "[output]") {
  RunRecord record;
  record.scene = "a\xFF\"b\\\n";
  record.max_speed = std::numeric_limits<double>::infinity();
  const std::string text = run_json(record);
  CHECK_THAT(text, Contains("\"max_speed\": null") && Contains("\\\"b\\\\\\n"));
}

TEST_CASE("the course of an energy knows its largest rise above what it had been", "[output]") {
  RunRecord record;
  record.energy.begin(2);
  for (const double energy : {1.0, 1.5, 0.5, 0.75}) record.energy.add(energy);
  CHECK(record.energy.start == 2);
  CHECK(record.energy.end == 0.75);
  CHECK(record.energy.largest_rise == 0.5);
  CHECK_THAT(run_json(record), Contains("\"energy\"") && Contains("\"largest_rise\": 0.5"));
}

TEST_CASE("measures of a state", "[output]") {
  Cloth cloth;
  cloth.edges = {{1, 2, 0.5}, {2, 3, 2.0}};  // behind another cloth's particle
  VecX x(12);
  x << 9, 9, 9, 0, 0, 0, 0.5, 0, 0, 0.5, 2, 0;
  CHECK(largest_strain({cloth}, x) == 0);
  x *= 1.25;
  CHECK(largest_strain({cloth}, x) == Approx(0.25));
  x *= 0.5;
  CHECK(largest_strain({Cloth(), cloth}, x) == 0);

  VecX v = VecX::Zero(6);
  v.tail<3>() = Vec3(3, 0, -4);
  CHECK(max_speed(v) == Approx(5));

  State state{0, VecX::Zero(3), VecX::Zero(3)};
  const std::string hash = state_hash(state);
  CHECK(hash.size() == 16);
  state.v[2] = -0.0;  // another bit
  CHECK(state_hash(state) != hash);

  const Distribution d = distribution({5, 1, 2, 3, 4});
  CHECK(d.median == 3);
  CHECK(d.max == 5);
  CHECK(d.mean == Approx(3));
  CHECK(distribution({}).max == 0);
}

TEST_CASE("hashes are those that FNV-1a is known by", "[output]") {
  const auto hash = [](const std::string& text) { return Fnv1a().add_all(text); };
  CHECK(hash("").text() == "cbf29ce484222325");
  CHECK(hash("a").text() == "af63dc4c8601ec8c");
  CHECK(hash("foobar").value() == 0x85944171f73967e8u);
  CHECK(Fnv1a().add("foo", 3).add("bar", 3).text() == hash("foobar").text());
}
