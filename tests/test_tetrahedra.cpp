// Laws of bodies of tetrahedra: volumes, surfaces, counts, and Gmsh's files in all four kinds, read and
// refused.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <numeric>
#include <random>
#include <set>
#include <sstream>

#include "mesh/lattice/solid.h"
#include "mesh/tetrahedra/msh.h"
#include "mesh/tetrahedra/tetrahedral_mesh.h"
#include "mesh/triangles/topology.h"
#include "tests/folder.h"
#include "tests/mistakes.h"
#include "tests/places.h"

using namespace drape;

namespace {

// nx x ny x nz cubes of edge 1, each of six tetrahedra round its diagonal, sheared a little.
TetrahedralMesh cubes(int nx, int ny, int nz) {
  TetrahedralMesh mesh;
  const auto at = [&](int x, int y, int z) { return x + (nx + 1) * (y + (ny + 1) * z); };
  for (int z = 0; z <= nz; ++z)
    for (int y = 0; y <= ny; ++y)
      for (int x = 0; x <= nx; ++x) mesh.positions.push_back({x + 0.1 * y, y - 0.2 * z, z + 0.3 * x});
  std::array<int, 3> axes = {0, 1, 2};
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) do {
          std::array<int, 3> c = {x, y, z};
          Tetrahedron t{at(x, y, z)};
          for (std::size_t k = 0; k < 3; ++k) {
            ++c[static_cast<std::size_t>(axes[k])];
            t[k + 1] = at(c[0], c[1], c[2]);
          }
          if (volume_of(mesh, t) < 0) std::swap(t[1], t[2]);
          mesh.tetrahedra.push_back(t);
        } while (std::next_permutation(axes.begin(), axes.end()));
  mesh.groups = {{"body", {}}, {"floor", {}}};
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    mesh.groups[0].vertices.push_back(v);
    if (v < (nx + 1) * (ny + 1)) mesh.groups[1].vertices.push_back(v);
  }
  return mesh;
}

TetrahedralMesh rabbit() { return read_msh(test::source_dir() + "/data/meshes/rabbit.msh"); }

double volume(const TetrahedralMesh& mesh) {
  double sum = 0;
  for (const Tetrahedron& t : mesh.tetrahedra) sum += volume_of(mesh, t);
  return sum;
}

}  // namespace

TEST_CASE("volumes, surface and counts of a body of tetrahedra agree", "[tetrahedra]") {
  for (const TetrahedralMesh& mesh : {cubes(1, 1, 1), cubes(3, 2, 4), cubes(6, 5, 3), rabbit()}) {
    std::vector<int> vertices;
    const TriangleMesh surface = surface_of(mesh, vertices);
    // The surface is closed, has its normals outwards (a volume of the other sign would be subtracted) and
    // bounds the same.
    for (const Edge& e : edges(surface)) CHECK((e.triangles == 2 && e.forward == 1));
    double by_surface = 0;
    for (const Triangle& t : surface.triangles)
      by_surface += surface.positions[t[0]].cross(surface.positions[t[1]]).dot(surface.positions[t[2]]) / 6;
    CHECK(by_surface == Approx(volume(mesh)).epsilon(1e-12));
    CHECK(solid_of(surface).volume == Approx(volume(mesh)).epsilon(1e-12));
    const std::vector<double> shares = vertex_volumes(mesh);
    CHECK(std::accumulate(shares.begin(), shares.end(), 0.0) == Approx(volume(mesh)).epsilon(1e-12));
    // Euler's number of a body without holes is 1, and of its surface 2.
    const auto faces = (4 * mesh.tetrahedra.size() + surface.triangles.size()) / 2;
    CHECK(mesh.positions.size() + faces == edges_of(mesh).size() + mesh.tetrahedra.size() + 1);
    CHECK(surface.positions.size() + surface.triangles.size() == edges(surface).size() + 2);
    CHECK(vertices.size() == surface.positions.size());
    CHECK(std::is_sorted(vertices.begin(), vertices.end()));
    for (std::size_t k = 0; k < vertices.size(); ++k)
      CHECK(surface.positions[k] == mesh.positions[vertices[k]]);
    for (const VertexGroup& group : surface.groups) {
      const auto same = [&](const VertexGroup& g) { return g.name == group.name; };
      const auto whole = std::find_if(mesh.groups.begin(), mesh.groups.end(), same);
      for (const int v : group.vertices)
        CHECK(std::binary_search(whole->vertices.begin(), whole->vertices.end(), vertices[v]));
    }
    CHECK(overlapping(mesh) == std::pair(-1, -1));
  }
  const TetrahedralMesh box = cubes(3, 2, 4);
  CHECK(volume(box) == Approx(24 * (Mat3() << 1, 0.1, 0, 0, 1, -0.2, 0.3, 0, 1).finished().determinant()));
  std::vector<int> vertices;
  CHECK(surface_of(box, vertices).triangles.size() == 2 * 2 * (3 * 2 + 2 * 4 + 3 * 4));
}

TEST_CASE("tetrahedra that overlap are found", "[tetrahedra]") {
  TetrahedralMesh mesh = cubes(1, 1, 1);
  mesh.positions.push_back({0.3, 0.4, 0.5});
  mesh.tetrahedra.push_back(mesh.tetrahedra[3]);
  CHECK(overlapping(mesh) == std::pair(3, 6));
  Tetrahedron& last = mesh.tetrahedra.back();  // another top on an outer face, on the inner side of it
  std::vector<int> vertices;
  const Triangle outer = surface_of(cubes(1, 1, 1), vertices).triangles[0];
  last = {outer[0], outer[2], outer[1], 8};
  if (volume_of(mesh, last) < 0) std::swap(last[0], last[1]);
  CHECK(overlapping(mesh).second == 6);
  // A face with one tetrahedron on each side, and a third one.
  const TetrahedralMesh three = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 1, 1}},
                                 {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}},
                                 {}};
  CHECK(overlapping(three) == std::pair(1, 2));
}

TEST_CASE("the rabbit is whole and well shaped", "[tetrahedra]") {
  const TetrahedralMesh mesh = rabbit();
  CHECK(mesh.vertex_count() == 950);
  CHECK(mesh.tetrahedra.size() == 3630);
  REQUIRE(mesh.groups.size() == 3);
  CHECK(mesh.groups[0].vertices.size() == 950);
  for (const int v : mesh.groups[1].vertices) CHECK(mesh.positions[v][1] > 0.18);  // ears
  for (const int v : mesh.groups[2].vertices) CHECK(mesh.positions[v][1] < 0.03);  // feet
  for (const Tetrahedron& t : mesh.tetrahedra)
    for (int k = 0; k < 4; ++k)
      for (int l = 0; l < k; ++l) {  // between the faces opposite corners k and l
        const auto normal = [&](int without) {
          std::vector<Vec3> p;
          for (int i = 0; i < 4; ++i)
            if (i != without) p.push_back(mesh.positions[t[i]]);
          const Vec3 n = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
          return Vec3(n.dot(mesh.positions[t[without]] - p[0]) > 0 ? -n : n);
        };
        CHECK(std::acos(-normal(k).dot(normal(l))) > 19 * M_PI / 180);
      }
}

namespace {

// A .msh file of the mesh as Gmsh would write it: node numbers with gaps and out of order, a node that
// nothing has, points, lines and triangles besides, sections that are not read.
class Writer {
 public:
  Writer(bool version_4, bool binary) : v4_(version_4), binary_(binary) {}

  std::string write(const TetrahedralMesh& mesh) {
    text_ = "$MeshFormat\n" + std::string(v4_ ? "4.1 " : "2.2 ") + (binary_ ? "1 8\n" : "0 8\n");
    if (binary_) raw<std::int32_t>(1), text_ += "\n";
    text_ += "$EndMeshFormat\n$Comments\nanything $Nodes\n$EndComments\n";
    text_ += "$PhysicalNames\n2\n2 5 \"floor\"\n3 7 \"body\"\n$EndPhysicalNames\n";
    if (v4_) entities();
    nodes(mesh);
    elements(mesh);
    return text_ + "$Periodic\n0\n$EndPeriodic\n";
  }
  static int number(const TetrahedralMesh& mesh, int v) { return 3 * (mesh.vertex_count() - v) + 1; }

 private:
  template <class T>
  void raw(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof value);
    text_.append(bytes, sizeof value);
  }
  void integer(long long value) {
    if (binary_) return raw(static_cast<std::int32_t>(value));
    text_ += std::to_string(value) + " ";
  }
  void size(long long value) {
    if (binary_) return raw(static_cast<std::int64_t>(value));
    text_ += std::to_string(value) + " ";
  }
  void real(double value) {
    if (binary_) return raw(value);
    std::ostringstream digits;
    digits.precision(17);
    digits << value;
    text_ += digits.str() + " ";
  }
  void line() {
    if (!binary_) text_ += "\n";
  }

  void entities() {
    text_ += "$Entities\n";
    for (const int count : {1, 0, 1, 1}) size(count);
    line();
    integer(4), real(0), real(0), real(0), size(0), line();  // a point without a group
    for (const int group : {5, 7}) {                         // a surface, a volume
      integer(group + 10);
      for (int k = 0; k < 6; ++k) real(k);
      size(1), integer(group), size(2), integer(-1), integer(2), line();
    }
    text_ += "\n$EndEntities\n";
  }

  void nodes(const TetrahedralMesh& mesh) {
    const int count = mesh.vertex_count();
    text_ += "$Nodes\n";
    if (!v4_) text_ += std::to_string(count + 1) + "\n";
    if (v4_) size(2), size(count + 1), size(2), size(3 * count + 1), line();
    if (v4_) integer(2), integer(15), integer(1), size(1), line(), size(2), line();
    if (!v4_) integer(2);
    real(9), real(9), real(9);
    if (v4_) real(0.5), real(0.5);  // parameters on a surface
    line();
    if (v4_) integer(3), integer(17), integer(0), size(count), line();
    for (int v = 0; v4_ && v < count; ++v) size(number(mesh, v)), line();
    for (int v = 0; v < count; ++v) {
      if (!v4_) integer(number(mesh, v));
      for (int k = 0; k < 3; ++k) real(mesh.positions[v][k]);
      line();
    }
    text_ += "\n$EndNodes\n";
  }

  void element(const TetrahedralMesh& mesh, int number_of_it, int type, int group,
               const std::vector<int>& vertices) {
    if (v4_) {
      size(number_of_it);
    } else if (binary_) {
      integer(number_of_it), integer(group), integer(group + 10);
    } else {
      integer(number_of_it), integer(type), integer(2), integer(group), integer(group + 10);
    }
    for (const int v : vertices) v4_ ? size(number(mesh, v)) : integer(number(mesh, v));
    line();
  }
  void block(int dimension, int type, int group, std::size_t count) {
    if (v4_)
      integer(dimension), integer(group + 10), integer(type), size(static_cast<long long>(count)), line();
    if (!v4_ && binary_) integer(type), integer(static_cast<long long>(count)), integer(2);
  }
  void elements(const TetrahedralMesh& mesh) {
    std::vector<int> on_surface;
    const TriangleMesh surface = surface_of(mesh, on_surface);
    const auto& floor = mesh.groups[1].vertices;
    std::vector<std::vector<int>> triangles;
    for (const Triangle& t : surface.triangles) {
      triangles.push_back({on_surface[t[0]], on_surface[t[1]], on_surface[t[2]]});
      for (const int v : triangles.back())
        if (!std::binary_search(floor.begin(), floor.end(), v)) {
          triangles.pop_back();
          break;
        }
    }
    const std::size_t count = 1 + triangles.size() + mesh.tetrahedra.size();
    text_ += "$Elements\n";
    if (!v4_) text_ += std::to_string(count) + "\n";
    if (v4_)
      size(3), size(static_cast<long long>(count)), size(1), size(static_cast<long long>(count)), line();
    int next = 1;
    block(0, 15, -6, 1);
    element(mesh, next++, 15, -6, {0});
    block(2, 2, 5, triangles.size());
    for (const std::vector<int>& t : triangles) element(mesh, next++, 2, 5, t);
    block(3, 4, 7, mesh.tetrahedra.size());
    for (const Tetrahedron& t : mesh.tetrahedra) element(mesh, next++, 4, 7, {t.begin(), t.end()});
    text_ += "\n$EndElements\n";
  }

  bool v4_, binary_;
  std::string text_;
};

void check_same(const TetrahedralMesh& a, const TetrahedralMesh& b) {
  CHECK(a.positions == b.positions);
  CHECK(a.tetrahedra == b.tetrahedra);
  REQUIRE(a.groups.size() == b.groups.size());
  for (std::size_t g = 0; g < a.groups.size(); ++g) {
    CHECK(a.groups[g].name == b.groups[g].name);
    CHECK(a.groups[g].vertices == b.groups[g].vertices);
  }
}

const bool kinds_of_file[4][2] = {
    {false, false}, {false, true}, {true, false}, {true, true}};  // version 4, binary

}  // namespace

TEST_CASE("a body is read the same from all four kinds of Gmsh's files", "[tetrahedra]") {
  for (const TetrahedralMesh& mesh : {cubes(1, 1, 1), cubes(3, 2, 4)})
    for (const auto& [version_4, binary] : kinds_of_file)
      check_same(parse_msh(Writer(version_4, binary).write(mesh), "a.msh"), mesh);
}

TEST_CASE("a file that is cut short or damaged is refused or read, whatever the byte", "[tetrahedra]") {
  std::mt19937 random(3);
  for (const auto& [version_4, binary] : kinds_of_file) {
    const std::string text = Writer(version_4, binary).write(cubes(1, 1, 1));
    const std::size_t whole = text.find("\n$EndElements") + 13;
    for (std::size_t length = 0; length < whole; ++length) {
      INFO(length);
      REQUIRE_THROWS_AS(parse_msh(text.substr(0, length), "a.msh"), InputError);
    }
    for (int k = 0; k < 5000; ++k) {
      std::string damaged = text;
      damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
      try {
        const TetrahedralMesh mesh = parse_msh(damaged, "a.msh");
        for (const Tetrahedron& t : mesh.tetrahedra) REQUIRE(volume_of(mesh, t) > 0);
      } catch (const InputError& error) {
        REQUIRE(std::string(error.what()).substr(0, 6) == "a.msh:");
      }
    }
  }
}

namespace {

// Five nodes and two tetrahedra, version 2.2, with one line in place of another.
std::string changed(const std::string& from, const std::string& to) {
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 "
      "1\n$EndNodes\n"
      "$Elements\n2\n1 4 2 0 1 1 2 3 4\n2 4 2 0 1 2 3 4 5\n$EndElements\n";
  const std::size_t found = text.find(from);
  REQUIRE(found != text.npos);
  return text.replace(found, from.size(), to);
}

}  // namespace

TEST_CASE("a wrong body of tetrahedra is refused in one line that says where", "[tetrahedra]") {
  const std::string good = "1 0 0 0\n";
  CHECK(parse_msh(changed(good, good), "a.msh").tetrahedra.size() == 2);
  CHECK(parse_msh(changed(good, "1 1e-400 -0 .0\r\n"), "a.msh").positions[0] == Vec3::Zero());
  const std::vector<test::Mistake> mistakes = {
      {"", "a.msh: ", "the file is empty"},
      {"solid x\n", "a.msh:1: ", "does not begin with $MeshFormat"},
      {changed("2.2 0 8", "4 0 8"), "a.msh:2: ", "version 4 of the format; only 4.1 and 2.0 to 2.2 are read"},
      {changed("2.2 0 8", "2.2 1 4"), "a.msh:2: ", "numbers of 4 bytes; only 8 are read"},
      {changed("2.2 0 8\n", std::string("2.2 1 8\n\0\0\0\1\n", 13)),
       "a.msh: byte 20: ", "the order of another kind of machine"},
      {changed("1 0 0 0", "1 0 zero 0"), "a.msh:6: ", "coordinate y of node 1 'zero' is not a number"},
      {changed("1 0 0 0", "1 0 nan 0"), "a.msh:6: ", "coordinate y of node 1 is not a finite number"},
      {changed("1 0 0 0", "1 0 0 1e999"),
       "a.msh:6: ", "coordinate z of node 1 '1e999' is not a finite number"},
      {changed("1 0 0 0", "1.5 0 0 0"), "a.msh:6: ", "the number of a node '1.5' is not a whole number"},
      {changed("5 1 1 1", "4 1 1 1"), "a.msh: ", "node 4 is there twice"},
      {changed("\n5\n1 0", "\n4\n1 0"), "a.msh:10: ", "$EndNodes should stand here"},
      {changed("2 3 4 5\n", "2 3 4 6\n"),
       "a.msh:15: ", "tetrahedron 2 refers to node 6, which is not among the 5 nodes"},
      {changed("1 2 3 4\n", "2 1 3 4\n"),
       "a.msh:14: ", "tetrahedron 1 (nodes 2 1 3 4) is inverted, its volume is -0.167 m^3"},
      {changed("4 0 0 1", "4 1 1 0"), "a.msh:14: ", "tetrahedron 1 (nodes 1 2 3 4) is flat"},
      {changed("2 3 4 5\n", "2 3 4 4\n"), "a.msh:15: ", "(nodes 2 3 4 4) is flat"},
      {changed("5 1 1 1", "5 -1 0 0"), "a.msh:15: ", "is inverted"},
      {changed("2 4 2 0 1 2 3 4 5\n", "2 4 2 0 1 1 2 3 5\n"),
       "a.msh:15: ", "lies on the same side of a face as tetrahedron 1"},
      {changed("2 4 2 0 1 2 3 4 5\n", "2 11 2 0 1 2 3 4 5 1 1 1 1 1 1\n"),
       "a.msh:15: ", "a tetrahedron of 10 nodes (type 11)"},
      {changed("2 4 2 0 1 2 3 4 5\n", "2 5 2 0 1 1 2 3 4 5 1 2 3\n"),
       "a.msh:15: ", "a hexahedron of 8 nodes (type 5)"},
      {changed("2 4 2 0 1 2 3 4 5\n", "2 99 2 0 1 2 3 4 5\n"), "a.msh:15: ", "element type 99 is not known"},
      {changed("1 4 2 0 1 1 2 3 4\n2 4 2 0 1 2 3 4 5\n", "1 2 2 0 1 1 2 3\n2 2 2 0 1 2 3 4\n"),
       "a.msh: ", "holds no tetrahedra, only 2 triangles; mesh the volume"},
      {changed("$EndElements\n", ""), "a.msh:16: ", "the file ends where $EndElements is expected"},
      {changed("$Elements\n2\n1 4 2 0 1 1 2 3 4\n2 4 2 0 1 2 3 4 5\n$EndElements\n", ""),
       "a.msh: ", "holds no tetrahedra; mesh"},
      {changed("$Nodes", "Nodes"),
       "a.msh:4: ", "a section such as $Nodes should stand here, but 'Nodes' does"}};
  test::check_mistakes(mistakes, [](const std::string& text) { return parse_msh(text, "a.msh"); });
  CHECK_THROWS_WITH(read_msh("nowhere.msh"), "nowhere.msh: no such file");
  CHECK_THROWS_WITH(read_msh(test::source_dir()), Catch::EndsWith("is a directory; name a .msh file in it"));
  // An element that is written once for each of its groups counts once.
  CHECK(
      parse_msh(changed("$Elements\n2\n", "$Elements\n3\n7 4 2 9 1 2 3 4 5\n"), "a.msh").tetrahedra.size() ==
      2);
}

namespace {

// The mesh with its vertices in the order of their places, and its tetrahedra in an order of their own.
TetrahedralMesh in_order(const TetrahedralMesh& mesh) {
  const auto before = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  TetrahedralMesh sorted = mesh;
  std::sort(sorted.positions.begin(), sorted.positions.end(), before);
  const auto place = [&](int v) {
    const auto found =
        std::lower_bound(sorted.positions.begin(), sorted.positions.end(), mesh.positions[v], before);
    return static_cast<int>(found - sorted.positions.begin());
  };
  for (Tetrahedron& t : sorted.tetrahedra) {
    for (int& v : t) v = place(v);
    std::sort(t.begin(), t.end());
  }
  std::sort(sorted.tetrahedra.begin(), sorted.tetrahedra.end());
  for (VertexGroup& group : sorted.groups) {
    for (int& v : group.vertices) v = place(v);
    std::sort(group.vertices.begin(), group.vertices.end());
  }
  return sorted;
}

}  // namespace

TEST_CASE("files that other programs write are read alike", "[tetrahedra]") {
  const test::Folder folder;
  folder.write("rabbit.msh", test::content(test::source_dir() + "/data/meshes/rabbit.msh"));
  folder.write("convert.py",
               "import meshio, sys\n"
               "mesh = meshio.read('rabbit.msh')\n"
               "body = meshio.Mesh(mesh.points, [('tetra', mesh.cells_dict['tetra'])])\n"
               "meshio.write('other.msh', body, file_format=sys.argv[1], binary=sys.argv[2] == 'binary')\n");
  const auto compare = [&](const std::string& command, const std::string& program, bool groups) {
    if (folder.shell(program).exit_code != 0) {
      WARN("skipped: '" + program + "' does not run here");
      return;
    }
    INFO(command);
    REQUIRE(folder.shell(command).exit_code == 0);
    TetrahedralMesh mesh = rabbit(), other = read_msh(folder.path / "other.msh");
    if (!groups) mesh.groups.clear(), other.groups.clear();
    check_same(in_order(other), in_order(mesh));  // gmsh numbers the nodes anew
  };
  for (const std::string format : {"gmsh22", "gmsh"})
    for (const std::string kind : {"binary", "text"})
      compare("/usr/bin/python3 convert.py " + format + " " + kind, "/usr/bin/python3 -c 'import meshio'",
              false);
  for (const std::string format : {"msh22", "msh41"})
    for (const std::string kind : {"", " -bin"})
      compare("gmsh rabbit.msh -save -format " + format + kind + " -o other.msh", "gmsh --version", true);
}
