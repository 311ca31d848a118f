// Poses of a body from CSV: columns in any order and unit, and every mistake with its line.
#include <catch2/catch.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "app/scene/pose_csv.h"
#include "tests/mistakes.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

namespace {

constexpr double pi = std::numbers::pi;

std::vector<Keyframe> poses(const std::string& text) {
  return poses_of(parse_csv(text, "poses.csv"), "poses.csv");
}

}  // namespace

TEST_CASE("the columns of poses have units and any order", "[motion]") {
  const std::vector<Keyframe> turns = poses("rz,z,y,x,time,rx [deg],ry [deg]\n1,2,3,4,5,90,720\n");
  REQUIRE(turns.size() == 1);
  CHECK(turns[0].time == 5);
  CHECK(turns[0].translate == Vec3(4, 3, 2));
  CHECK((turns[0].rotation - Vec3(pi / 2, 4 * pi, 1)).norm() < 1e-14);
  const std::vector<Keyframe> places = poses("time [min],x,y,z\n1,0,0,0\n2,0,0,1\n");
  CHECK(places[1].time == 120);
  CHECK(places[1].rotation.isZero(0));
}

TEST_CASE("a mistake in a file of poses is told with its line", "[motion]") {
  const std::string head = "time,x,y,z\n0,0,0,0\n", turning = "time,x,y,z,qw,qx,qy,qz\n";
  const Mistake table[] = {
      {"", "poses.csv:", "at least one pose"},
      {"time,x,y,z\n", "poses.csv:1:", "at least one pose"},
      {"# a\n\ntime,x,y\n0,0,0\n", "poses.csv:3:", "of the columns x, y, z some are missing"},
      {"x,y,z\n0,0,0\n", "poses.csv:1:", "expected a header with the columns time, x, y, z"},
      {"0,0,0,0\n1,0,0,0\n", "poses.csv:1:", "unknown column '0'"},
      {"tme,x,y,z\n0,0,0,0\n", "poses.csv:1:", "did you mean 'time'?"},
      {"time;x;y;z\n0;0;0;0\n", "poses.csv:1:", "separated by commas"},
      {"time,x,x,y,z\n0,0,0,0,0\n", "poses.csv:1:", "two columns 'x'"},
      {"time [mm],x,y,z\n0,0,0,0\n", "poses.csv:1:", "column 'time [mm]': expected a time"},
      {"time [ms,x,y,z\n0,0,0,0\n", "poses.csv:1:", "a unit stands in [ ]"},
      {"time [blurb],x,y,z\n0,0,0,0\n", "poses.csv:1:", "'blurb' is not a unit"},
      {"time,x,y,z,qw,qx,qy\n0,0,0,0,1,0,0\n",
       "poses.csv:1:", "of the columns qw, qx, qy, qz some are missing"},
      {"time,x,y,z,qw,qx,qy,qz,rx,ry,rz\n0,0,0,0,1,0,0,0,0,0,0\n", "poses.csv:1:", "given twice"},
      {"time,x,y,z,rx,ry,rz\n0,0,0,0,0,0,0\n1,0,0,0,0,90,0\n",
       "poses.csv:3:", "turn by 90 rad, which is more than a whole turn; name the unit in the header"},
      {head + "1,0,0\n", "poses.csv:3:", "has 3 cells, the header has 4"},
      {head + "1,0,0,0,\n", "poses.csv:3:", "has 5 cells"},
      {head + "\n\n1,0,abc,0\n", "poses.csv:5:", "y = \"abc\": expected a finite number"},
      {head + "1,0,,0\n", "poses.csv:3:", "y = \"\": expected a finite number"},
      {head + "1,0,nan,0\n", "poses.csv:3:", "finite number"},
      {head + "1,0,1e999,0\n", "poses.csv:3:", "finite number"},
      {head + "1,0,3 mm,0\n", "poses.csv:3:", "y = \"3 mm\""},
      {head + "1,0,\"0,0\n", "poses.csv:3:", "quotation mark"},
      {head + "1,0,0\"0,0\n", "poses.csv:3:", "quotation mark"},
      {head + "2,0,0,0\n1,0,0,0\n", "poses.csv:4:", "keyframes out of order: 1 s comes after 2 s"},
      {head + "0,0,0,0\n", "poses.csv:3:", "keyframes out of order: 0 s comes after 0 s"},
      {turning + "0,0,0,0,0.5,0,0,0\n", "poses.csv:2:", "the length of a unit quaternion is 1, not 0.5"},
      {turning + "0,0,0,0,0,0,0,0\n", "poses.csv:2:", "quaternion"},
  };
  check_mistakes(table, poses);
}
