// Laws of the lines in OBJ files: in order, under their names, kept by a round trip, members of their groups.
#include <catch2/catch.hpp>

#include "tests/obj.h"

using namespace drape;
using namespace drape::test;

TEST_CASE("lines come in order under their names", "[obj]") {
  const std::string text = kSquare +
                           "f 1 2 3\nf 1 3 4\ng panel.hem\nl 3 1 2\ng panel.ring left\nl 4 3 2 4\n"
                           "g panel.hem\nl 2 4\no curves\nl 1/1 -1\nl 4 2 # ends here\nl 1 3\nl 9 1\n"
                           "vt 0 0\n";
  const TriangleMesh mesh = parse_obj(text, "lines.obj");
  const std::vector<Polyline> lines = polylines(mesh);
  REQUIRE(lines.size() == 5);
  CHECK(lines[0].name == "panel.hem");
  CHECK(lines[0].vertices == std::vector<int>{2, 0, 1});
  CHECK(lines[1].name == "panel.ring");  // the first of its names
  CHECK(lines[1].vertices == std::vector<int>{3, 2, 1, 3});
  CHECK(lines[2].name == "panel.hem");  // goes on where the first ended, but another line stands between
  CHECK(lines[2].vertices == std::vector<int>{1, 3});
  CHECK(lines[3].name == "curves");
  CHECK(lines[3].vertices == std::vector<int>{0, 3, 1});  // two lines, end to end
  CHECK(lines[4].vertices == std::vector<int>{0, 2});
  CHECK(group(mesh, "panel.hem") == std::vector<int>{0, 1, 2, 3});
  CHECK(group(mesh, "panel.ring") == std::vector<int>{1, 2, 3});
  require_round_trip(text);
  CHECK(polylines(TriangleMesh{}).empty());
  CHECK(polylines(parse_obj(kTriangle + "f 1 2 3\nl 1 2\n", "nameless.obj")).front().name.empty());
}

TEST_CASE("a group has the vertices of its faces and of its lines", "[obj]") {
  const TriangleMesh mesh = parse_obj(kSquare + "g a\nf 1 2 3\nl 3 4\ng b\nl 1 2\n", "both.obj");
  CHECK(group(mesh, "a") == std::vector<int>{0, 1, 2, 3});
  CHECK(group(mesh, "b") == std::vector<int>{0, 1});
}
