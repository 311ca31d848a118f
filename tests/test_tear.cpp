// Laws of meshes that are cut along edges: no triangle changes, vertices part where fans do, what is written
// has the new borders.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "mesh/base/errors.h"
#include "mesh/obj/obj.h"
#include "mesh/obj/obj_tear.h"
#include "mesh/triangles/generate.h"
#include "mesh/triangles/tear.h"
#include "mesh/triangles/topology.h"
#include "tests/places.h"
#include "tests/tangled.h"

using namespace drape;
using namespace drape::test;

namespace {

std::vector<TriangleMesh> all_meshes() {
  std::vector<TriangleMesh> meshes = {
      grid(2, 2, 1, 1),
      grid(7, 5, 1, 2),
      equilateral_sheet(6, 7, 0.1),
      disc(5, 1),
      sphere(2, 1),
      tube(7, 4, 1, 2),
      mesh_of(5, {{0, 1, 2}, {0, 3, 4}}),             // a bow tie
      mesh_of(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}),  // three triangles at an edge
      mesh_of(4, {{0, 1, 2}, {2, 1, 0}, {1, 2, 3}})};
  for (unsigned seed = 0; seed < 15; ++seed)
    meshes.push_back(tangle(9, 5 + 3 * static_cast<int>(seed), seed));
  return meshes;
}

std::vector<CutEdge> edges_with(const TriangleMesh& mesh, double share, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<CutEdge> cuts;
  for (const Edge& e : edges(mesh))
    if (std::uniform_real_distribution<double>(0, 1)(random) < share) cuts.emplace_back(e.a, e.b);
  return cuts;
}

std::vector<CutEdge> path(const std::vector<int>& vertices) {
  std::vector<CutEdge> cuts;
  for (std::size_t k = 1; k < vertices.size(); ++k) cuts.emplace_back(vertices[k - 1], vertices[k]);
  return cuts;
}

bool names_twice(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// The parts of the triangles round a vertex by walks over edges that are not cut: an independent way to what
// should part.
std::vector<std::set<int>> parts_round(const TriangleMesh& mesh, int vertex, const std::set<CutEdge>& cut) {
  std::set<int> left;
  const auto has = [&](int t, int v) {
    return std::find(mesh.triangles[t].begin(), mesh.triangles[t].end(), v) != mesh.triangles[t].end();
  };
  for (int t = 0; t < mesh.triangle_count(); ++t)
    if (!names_twice(mesh.triangles[t]) && has(t, vertex)) left.insert(t);
  std::vector<std::set<int>> parts;
  while (!left.empty()) {
    std::set<int> part, front = {*left.begin()};
    while (!front.empty()) {
      const int t = *front.begin();
      front.erase(front.begin()), left.erase(t), part.insert(t);
      for (const int s : left) {
        bool together = true, joined = false;
        for (const int v : mesh.triangles[t]) {
          together = together && has(s, v);
          joined =
              joined || (v != vertex && has(s, v) && !cut.count({std::min(v, vertex), std::max(v, vertex)}));
        }
        if (together || joined) front.insert(s);
      }
    }
    parts.push_back(part);
  }
  return parts;
}

int euler(const TriangleMesh& mesh) {
  return mesh.vertex_count() - static_cast<int>(edges(mesh).size()) + mesh.triangle_count();
}
int pieces(const TriangleMesh& mesh) {
  const std::vector<int> piece = connected_pieces(mesh);
  return 1 + *std::max_element(piece.begin(), piece.end());
}
double area(const TriangleMesh& mesh) {
  const std::vector<double> areas = vertex_areas(mesh);
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

}  // namespace

TEST_CASE("triangles keep their corners, and vertices part where fans do", "[tear]") {
  for (const TriangleMesh& mesh : all_meshes()) {
    for (const double share : {0.05, 0.3, 0.7, 1.0}) {
      const std::vector<CutEdge> cuts = edges_with(mesh, share, 3);
      const std::set<CutEdge> cut(cuts.begin(), cuts.end());
      const TornMesh torn = tear(mesh, cuts);
      REQUIRE(torn.mesh.triangles.size() == mesh.triangles.size());
      REQUIRE(torn.mesh.positions.size() == mesh.positions.size() + torn.copy_of.size());
      const auto source = [&](int v) {
        return v < mesh.vertex_count() ? v : torn.copy_of[v - mesh.vertex_count()];
      };
      for (int v = 0; v < torn.mesh.vertex_count(); ++v)
        CHECK(torn.mesh.positions[v] == mesh.positions[source(v)]);
      for (int t = 0; t < mesh.triangle_count(); ++t)
        for (int k = 0; k < 3; ++k) CHECK(source(torn.mesh.triangles[t][k]) == mesh.triangles[t][k]);
      CHECK(area(torn.mesh) == Approx(area(mesh)).epsilon(1e-13));
      CHECK(std::is_sorted(torn.copy_of.begin(), torn.copy_of.end()));
      for (int v = 0; v < mesh.vertex_count(); ++v) {
        const bool at_cut = std::any_of(cuts.begin(), cuts.end(),
                                        [&](const CutEdge& e) { return e.first == v || e.second == v; });
        std::set<int> used;
        const std::vector<std::set<int>> parts = parts_round(mesh, v, cut);
        for (const std::set<int>& part : parts) {
          std::set<int> numbers;
          for (const int t : part)
            for (int k = 0; k < 3; ++k)
              if (mesh.triangles[t][k] == v) numbers.insert(torn.mesh.triangles[t][k]);
          CHECK(numbers.size() == 1);
          if (used.empty()) CHECK(*numbers.begin() == v);  // the part with the lowest triangle
          used.insert(numbers.begin(), numbers.end());
        }
        CHECK(used.size() == (at_cut || parts.empty() ? parts.size() : 1));
      }
    }
  }
}

TEST_CASE("nothing is cut: the same mesh; all is cut: three vertices for each triangle", "[tear]") {
  for (const TriangleMesh& mesh : all_meshes()) {
    const TornMesh same = tear(mesh, {});
    CHECK(same.copy_of.empty());
    CHECK(same.mesh.triangles == mesh.triangles);
    TriangleMesh plain = mesh;  // without equal triangles and those that name a vertex twice
    plain.triangles.clear();
    for (const int t : counted_triangles(mesh)) plain.triangles.push_back(mesh.triangles[t]);
    std::set<int> lone;
    for (int v = 0; v < plain.vertex_count(); ++v) lone.insert(v);
    for (const Triangle& t : plain.triangles)
      for (const int v : t) lone.erase(v);
    const TornMesh all = tear(plain, edges_with(plain, 2, 1));
    CHECK(all.mesh.positions.size() == 3 * plain.triangles.size() + lone.size());
    CHECK(counted_triangles(tear(mesh, edges_with(mesh, 2, 1)).mesh).size() == plain.triangles.size());
    CHECK(tear(all.mesh, edges_with(all.mesh, 2, 1)).copy_of.empty());
  }
}

TEST_CASE("Euler's number changes as a cut of its kind changes it", "[tear]") {
  struct Case {
    TriangleMesh mesh;
    std::vector<int> walk;
    int copies, euler, pieces, loops;  // what it changes
  };
  const TriangleMesh sheet = grid(9, 9, 1, 1);
  const std::vector<Case> cases = {
      {sheet, {40, 41}, 0, 0, 0, 0},                              // one inner edge
      {sheet, {39, 40, 41}, 1, -1, 0, 1},                         // a slit
      {sheet, {38, 39, 40, 41, 42}, 3, -1, 0, 1},                 // a longer one
      {sheet, {36, 37, 38, 39}, 3, 0, 0, 0},                      // from the border
      {sheet, {36, 37, 38, 39, 40, 41, 42, 43, 44}, 9, 1, 1, 1},  // from border to border
      {sheet, {30, 31, 32, 41, 50, 49, 48, 39, 30}, 8, 0, 1, 2},  // round
      {sheet, {0, 1, 2}, 0, 0, 0, 0},                             // along the border
      {tube(8, 5, 1, 1), {16, 17, 18, 19, 20, 21, 22, 23, 16}, 8, 0, 1, 2},
      {tube(8, 5, 1, 1), {0, 8, 16, 24, 32}, 5, 1, 0, -1}};
  for (const Case& c : cases) {
    const TornMesh torn = tear(c.mesh, path(c.walk));
    CHECK(static_cast<int>(torn.copy_of.size()) == c.copies);
    CHECK(euler(torn.mesh) - euler(c.mesh) == c.euler);
    CHECK(pieces(torn.mesh) - pieces(c.mesh) == c.pieces);
    CHECK(static_cast<int>(boundary_loops(torn.mesh).size()) -
              static_cast<int>(boundary_loops(c.mesh).size()) ==
          c.loops);
  }
}

TEST_CASE("the order and direction of the cuts do not matter, nor whether they come at once", "[tear]") {
  std::mt19937 random(5);
  for (const TriangleMesh& mesh : {grid(7, 5, 1, 2), sphere(2, 1), disc(5, 1)}) {
    std::vector<CutEdge> cuts = edges_with(mesh, 0.4, 2);
    const TornMesh torn = tear(mesh, cuts);
    std::shuffle(cuts.begin(), cuts.end(), random);
    for (auto& [a, b] : cuts)
      if (random() % 2) std::swap(a, b);
    cuts.push_back(cuts.front());
    const TornMesh again = tear(mesh, cuts);
    CHECK(again.mesh.triangles == torn.mesh.triangles);
    CHECK(again.copy_of == torn.copy_of);
    CHECK(tear(torn.mesh, {}).mesh.triangles == torn.mesh.triangles);
  }
}

TEST_CASE("a mesh whose vertices are sewn to one has a copy of each for every part that its corners fall to",
          "[tear]") {
  unsigned seed = 100;
  for (const TriangleMesh& mesh : all_meshes()) {
    const std::vector<CutEdge> cuts = edges_with(mesh, 0.4, ++seed);
    const TornTriangles torn = torn_triangles(mesh, cuts), same = divided_triangles(mesh, torn.triangles);
    CHECK(same.triangles == torn.triangles);
    CHECK(same.copy_of == torn.copy_of);

    TriangleMesh sewn = mesh;  // vertex v is sewn to another one
    for (Triangle& t : sewn.triangles)
      for (int& v : t) v /= 2;
    const std::vector<Triangle> parts = torn_triangles(sewn, edges_with(sewn, 0.4, seed)).triangles;
    const TornTriangles divided = divided_triangles(mesh, parts);
    std::map<int, std::pair<int, int>> of;  // vertex -> the vertex that it was, and its part
    std::set<std::pair<int, int>> known;
    for (std::size_t t = 0; t < parts.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::pair own(mesh.triangles[t][k], parts[t][k]);
        known.insert(own);
        CHECK(of.try_emplace(divided.triangles[t][k], own).first->second == own);
      }
    CHECK(known.size() == of.size());
    for (std::size_t k = 0; k < divided.copy_of.size(); ++k)
      CHECK(of.at(mesh.vertex_count() + static_cast<int>(k)).first == divided.copy_of[k]);
  }
}

TEST_CASE("a cut that is no edge is refused", "[tear]") {
  const TriangleMesh mesh = grid(4, 4, 1, 1);
  for (const CutEdge& cut : {CutEdge{15, 0}, {0, 0}, {3, 99}, {-1, 2}})
    CHECK_THROWS_AS(tear(mesh, {cut}), InputError);
  CHECK_THROWS_WITH(tear(mesh, {{15, 0}}),
                    "cut between the vertices 0 and 15 (from 0): no edge of the mesh joins them");
}

namespace {

// The place and the texture coordinate of every corner of every face, with the group and material lines
// before it.
std::vector<std::string> corners_of(const TriangleMesh& mesh) {
  const ObjDocument& d = *mesh.document;
  std::vector<std::string> list;
  for (const ObjCorner& c : d.corners) {
    const Vec3& x = mesh.positions[c.v];
    list.push_back(std::to_string(x[0]) + " " + std::to_string(x[1]) + " " + std::to_string(x[2]) + " / " +
                   (c.vt < 0 ? "" : std::string(d.texcoords[c.vt])) +
                   (d.vertex_extras.empty() ? "" : " / " + std::string(d.vertex_extras[c.v])));
  }
  return list;
}

}  // namespace

TEST_CASE("the written OBJ has the new borders, with uv, groups and materials kept", "[tear]") {
  for (const std::string name :
       {"flag.obj", "pocket.obj", "net.obj", "sheet-958.obj", "tee.obj", "reef-knot.obj"}) {
    const TriangleMesh mesh = read_obj(test::source_dir() + "/data/meshes/" + name);
    for (const double share : {0.02, 0.3}) {
      const TornMesh torn = tear(mesh, edges_with(mesh, share, 4));
      const TriangleMesh back = parse_obj(format_obj(torn.mesh, torn.mesh.positions), name);
      CHECK(back.positions == torn.mesh.positions);
      CHECK(back.document->corners == torn.mesh.document->corners);
      CHECK(back.document->face_start == torn.mesh.document->face_start);
      CHECK(back.document->statements == torn.mesh.document->statements);
      REQUIRE(back.groups.size() == torn.mesh.groups.size());
      for (std::size_t g = 0; g < back.groups.size(); ++g) {
        CHECK(back.groups[g].name == torn.mesh.groups[g].name);
        CHECK(back.groups[g].vertices == torn.mesh.groups[g].vertices);
      }
      const auto whole = std::make_pair(mesh.document->face_count(), torn.mesh.document->face_count());
      CHECK(whole.first <= whole.second);
      if (whole.first == whole.second) CHECK(corners_of(torn.mesh) == corners_of(mesh));
      // What was a corner is one, at the same place with the same uv, and there are no others.
      const std::vector<std::string> before = corners_of(mesh), after = corners_of(torn.mesh);
      CHECK(std::set<std::string>(before.begin(), before.end()) ==
            std::set<std::string>(after.begin(), after.end()));
      for (const Triangle& t : torn.mesh.triangles)
        for (const int v : t) CHECK((v >= 0 && v < torn.mesh.vertex_count()));
    }
  }
}

namespace {

// Two rows of quads, group a below and b above, joined along the line from 4 to 6:  7 8 9 / 4 5 6 / 1 2 3, from 1.
const std::string two_rows =
    "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 0 2 0\nv 1 2 0\nv 2 2 0\nvt 0 0\nvt 1 1\n"
    "g a\nusemtl red\nf 1/1 2/2 5/1 4/2\nf 2/1 3/2 6/1 5/2\ng b\nusemtl blue\nf 4/2 5/1 8/2 7/1\nf 5/1 6/2 "
    "9/1 8/2\n";

std::vector<std::vector<int>> lines_after(const std::string& lines, const std::vector<CutEdge>& cuts) {
  const TriangleMesh mesh = parse_obj(two_rows + lines, "rows.obj");
  std::vector<std::vector<int>> found;
  for (const Polyline& line : polylines(tear(mesh, cuts).mesh)) {
    CHECK(line.name == "seam");
    found.push_back(line.vertices);
  }
  return found;
}

}  // namespace

TEST_CASE("a cut between two groups parts the groups, and polygons beside it stay whole", "[tear]") {
  const TriangleMesh mesh = parse_obj(two_rows, "rows.obj");
  const TornMesh torn = tear(mesh, {{3, 4}, {5, 4}});
  CHECK(torn.copy_of == std::vector<int>{3, 4, 5});
  CHECK(torn.mesh.document->face_count() == 4);
  CHECK(torn.mesh.groups[0].vertices == std::vector<int>{0, 1, 2, 3, 4, 5});
  CHECK(torn.mesh.groups[1].vertices == std::vector<int>{6, 7, 8, 9, 10, 11});
  const std::string text = format_obj(torn.mesh, torn.mesh.positions);
  CHECK_THAT(text, Catch::Contains("g b\nusemtl blue\nf 10/2 11/1 8/2 7/1\nf 11/1 12/2 9/1 8/2\n"));
  // A cut along the diagonals of two polygons makes triangles of these and leaves the others whole.
  const TornMesh through = tear(mesh, {{0, 4}, {4, 8}});
  CHECK(through.copy_of == std::vector<int>{0, 4, 8});
  CHECK_THAT(format_obj(through.mesh, through.mesh.positions),
             Catch::Contains("g a\nusemtl red\nf 1/1 2/2 5/1\nf 10/1 11/1 4/2\nf 2/1 3/2 6/1 5/2\n"
                             "g b\nusemtl blue\nf 4/2 11/1 8/2 7/1\nf 5/1 6/2 9/1\nf 11/1 12/1 8/2\n"));
  const TornMesh other = tear(mesh, {{2, 4}, {4, 6}});
  CHECK_THAT(format_obj(other.mesh, other.mesh.positions),
             Catch::Contains("f 1/1 2/2 5/1 4/2\nf 2/1 3/2 5/2\nf 10/2 6/1 11/2\ng b\nusemtl blue\n"
                             "f 4/2 5/1 7/1\nf 11/1 8/2 12/1\nf 11/1 6/2 9/1 8/2\n"));
}

TEST_CASE("what stands after a vertex stands after its copies", "[tear]") {
  const TriangleMesh mesh =
      parse_obj("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 1 1 0\nf 1 2 3\nf 3 2 4\n", "colours.obj");
  const TornMesh torn = tear(mesh, {{1, 2}});
  CHECK(torn.copy_of == std::vector<int>{1, 2});
  CHECK_THAT(format_obj(torn.mesh, torn.mesh.positions),
             Catch::Contains("v 1 1 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\nf 6 5 4\n"));
}

TEST_CASE("a line along a cut stays on its left, and one across it is cut in two", "[tear]") {
  const std::vector<CutEdge> along = {{3, 4}, {4, 5}};  // copies: 9, 10, 11 of the upper row
  using Lines = std::vector<std::vector<int>>;
  CHECK(lines_after("g seam\nl 4 5 6\n", {}) == Lines{{3, 4, 5}});
  CHECK(lines_after("g seam\nl 4 5 6\n", along) == Lines{{9, 10, 11}});
  CHECK(lines_after("g seam\nl 6 5 4\n", along) == Lines{{5, 4, 3}});
  CHECK(lines_after("g seam\nl 4 5\nl 5 6\n", along) == Lines{{9, 10, 11}});
  CHECK(lines_after("g seam\nl 1 4 7\n", along) == Lines{{0, 3}, {9, 6}});  // along a border, across the cut
  CHECK(lines_after("g seam\nl 2 5 8\n", along) == Lines{{1, 4}, {10, 7}});
  CHECK(lines_after("g seam\nl 1 3\n", along) == Lines{{0, 2}});          // no edge: its own vertices
  CHECK(lines_after("g seam\nl 4 5 6\n", {{3, 4}}) == Lines{{9, 4, 5}});  // a tip keeps one vertex
  const TriangleMesh mesh = parse_obj(two_rows + "g seam\nl 4/1 5/2 6/1\n", "rows.obj");
  CHECK_THAT(format_obj(tear(mesh, along).mesh, tear(mesh, along).mesh.positions),
             Catch::Contains("\nl 10/1 11/2 12/1"));
}
