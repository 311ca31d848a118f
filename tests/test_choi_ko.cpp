// The grid of quads found in a mesh, and the springs of Choi & Ko on it.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>
#include <set>

#include "mesh/obj/obj.h"
#include "solver/forces/buckling_spring.h"
#include "solver/forces/choi_ko.h"
#include "solver/forces/noh_jung.h"
#include "solver/system/system.h"

using namespace drape;
using Catch::Contains;

namespace {

using Faces = std::vector<std::vector<int>>;

// The faces of nx x nz vertices, x fastest.
Faces grid_faces(int nx, int nz) {
  Faces faces;
  for (int j = 0; j + 1 < nz; ++j)
    for (int i = 0; i + 1 < nx; ++i) {
      const int v = j * nx + i;
      faces.push_back({v, v + nx, v + nx + 1, v + 1});
    }
  return faces;
}

std::vector<Vec3> grid_points(int nx, int nz, double a, double b) {
  std::vector<Vec3> points;
  for (int j = 0; j < nz; ++j)
    for (int i = 0; i < nx; ++i) points.emplace_back(a * i, 0, b * j);
  return points;
}

TriangleMesh mesh_of(const std::vector<Vec3>& points, const Faces& faces) {
  std::string text;
  char line[100];
  for (const Vec3& x : points) {
    std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", x.x(), x.y(), x.z());
    text += line;
  }
  for (const auto& face : faces) {
    text += "f";
    for (int v : face) text += " " + std::to_string(v + 1);
    text += "\n";
  }
  return parse_obj(text, "grid.obj");
}

TriangleMesh sheet(int nx, int nz, double a = 1, double b = 1) {
  return mesh_of(grid_points(nx, nz, a, b), grid_faces(nx, nz));
}

using Pairs = std::set<std::pair<int, int>>;
Pairs ends(const std::vector<QuadGrid::Straight>& list) {
  Pairs pairs;
  for (const auto& s : list) pairs.insert({s.a, s.c});
  return pairs;
}

// sum_e k_e l_e^2 t t t t over the connections that begin at one vertex inside, as C11, C22, C12.
Vec3 affine(const std::vector<StretchConnection>& all, const std::vector<Vec3>& x, int centre) {
  Vec3 C = Vec3::Zero();
  for (const StretchConnection& s : all) {
    if (s.i != centre && s.j != centre) continue;
    const Vec3 d = x[s.j] - x[s.i];
    const double l2 = d.squaredNorm(), tx = d.x() * d.x() / l2, tz = d.z() * d.z() / l2;
    C += 0.5 * s.k * l2 * Vec3(tx * tx, tz * tz, tx * tz);  // each connection belongs to both its ends
  }
  return C;
}

}  // namespace

TEST_CASE("a grid of quads has its rows and diagonals, whatever the order of vertices and faces",
          "[choi-ko]") {
  const int nx = 7, nz = 5;
  const QuadGrid plain = quad_grid(sheet(nx, nz));
  Pairs rows, diagonals;
  for (int j = 0; j < nz; ++j)
    for (int i = 0; i < nx; ++i) {
      const int v = j * nx + i;
      if (i + 2 < nx) rows.insert({v, v + 2});
      if (j + 2 < nz) rows.insert({v, v + 2 * nx});
      if (i + 2 < nx && j + 2 < nz) diagonals.insert({v, v + 2 * nx + 2});
      if (i >= 2 && j + 2 < nz) diagonals.insert({v, v + 2 * nx - 2});
    }
  CHECK(plain.quads.size() == static_cast<std::size_t>((nx - 1) * (nz - 1)));
  CHECK(ends(plain.rows) == rows);
  CHECK(ends(plain.diagonals) == diagonals);
  for (const auto& s : plain.rows) CHECK(s.a + s.c == 2 * s.m);
  for (const auto& s : plain.diagonals) CHECK(s.a + s.c == 2 * s.m);

  std::mt19937 random(7);
  for (int round = 0; round < 5; ++round) {
    std::vector<int> number(static_cast<std::size_t>(nx * nz));
    std::iota(number.begin(), number.end(), 0);
    std::shuffle(number.begin(), number.end(), random);
    Faces faces = grid_faces(nx, nz);
    std::shuffle(faces.begin(), faces.end(), random);
    for (auto& face : faces) {
      std::rotate(face.begin(), face.begin() + static_cast<std::ptrdiff_t>(random() % 4), face.end());
      if (random() % 2 == 0) std::reverse(face.begin(), face.end());  // wound either way
      for (int& v : face) v = number[v];
    }
    const std::vector<Vec3> points = grid_points(nx, nz, 1, 1);
    std::vector<Vec3> placed(points.size());
    for (std::size_t v = 0; v < points.size(); ++v) placed[number[v]] = points[v];
    const QuadGrid shuffled = quad_grid(mesh_of(placed, faces));
    const auto renamed = [&](const Pairs& pairs) {
      Pairs out;
      for (const auto& [a, c] : pairs) out.insert(std::minmax(number[a], number[c]));
      return out;
    };
    CHECK(ends(shuffled.rows) == renamed(rows));
    CHECK(ends(shuffled.diagonals) == renamed(diagonals));
    CHECK(shuffled.rows.size() == plain.rows.size());
  }
}

TEST_CASE("grids with holes, holes that touch, and tubes are grids", "[choi-ko]") {
  const int n = 7;
  const QuadGrid whole = quad_grid(sheet(n, n));
  Faces faces = grid_faces(n, n);
  faces.erase(faces.begin() + 3 * (n - 1) + 3);  // inside
  const QuadGrid holed = quad_grid(mesh_of(grid_points(n, n, 1, 1), faces));
  CHECK(ends(holed.rows) == ends(whole.rows));  // what goes along the rim stays
  CHECK(ends(holed.diagonals).size() == ends(whole.diagonals).size() - 4);

  faces.erase(faces.begin() + 2 * (n - 1) + 2);  // its corner neighbour: the holes touch
  CHECK_NOTHROW(quad_grid(mesh_of(grid_points(n, n, 1, 1), faces)));

  const int around = 8, along = 4;
  std::vector<Vec3> points;
  Faces tube;
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * 3.14159265358979323846 * i / around;
      points.emplace_back(std::cos(angle), j, std::sin(angle));
      const int v = j * around + i, next = j * around + (i + 1) % around;
      if (j + 1 < along) tube.push_back({v, next, next + around, v + around});
    }
  const QuadGrid closed = quad_grid(mesh_of(points, tube));
  CHECK(ends(closed.rows).size() == static_cast<std::size_t>(around * along + around * (along - 2)));
  CHECK(ends(closed.diagonals).size() == static_cast<std::size_t>(2 * around * (along - 2)));
}

TEST_CASE("what is no regular grid of quads is refused with its place", "[choi-ko]") {
  const std::vector<Vec3> points = grid_points(3, 3, 1, 1);
  Faces faces = grid_faces(3, 3);
  faces[2] = {3, 6, 7};
  CHECK_THROWS_WITH(quad_grid(mesh_of(points, faces)), Contains("face 3") && Contains("3 corners"));
  std::vector<Vec3> cube = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                            {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const Faces box = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {2, 3, 7, 6}, {1, 2, 6, 5}, {0, 3, 7, 4}};
  CHECK_THROWS_WITH(quad_grid(mesh_of(cube, box)), Contains("vertex 0") && Contains("3 quads"));
  cube.push_back({0, 2, 0}), cube.push_back({1, 2, 0});
  const Faces fin = {{0, 1, 2, 3}, {2, 3, 7, 6}, {3, 2, 9, 8}};
  CHECK_THROWS_WITH(quad_grid(mesh_of(cube, fin)), Contains("vertices 2 and 3") && Contains("3 quads"));
  TriangleMesh triangles;
  triangles.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangles.triangles = {{0, 1, 2}};
  CHECK_THROWS_WITH(quad_grid(triangles), Contains("triangles"));
}

TEST_CASE("the springs of a grid are the membrane: isotropic, of the fabric's stiffness", "[choi-ko]") {
  const double Y = 800;
  for (const auto& [a, b] : {std::pair(0.1, 0.1), std::pair(0.15, 0.1), std::pair(0.08, 0.1)}) {
    const TriangleMesh mesh = sheet(7, 7, a, b);
    const Connections c = choi_ko_connections(mesh, mesh, {.stretch = Y});
    const Vec3 C = affine(c.stretch, mesh.positions, 3 * 7 + 3) / (a * b);
    CHECK(C[0] == Approx(9.0 / 8 * Y));  // Y / (1 - 1/9)
    CHECK(C[1] == Approx(9.0 / 8 * Y));
    CHECK(C[2] == Approx(3.0 / 8 * Y));
    if (a != b) continue;
    std::set<double> constants;
    for (const StretchConnection& s : c.stretch) constants.insert(std::round(s.k / Y * 1e6) / 1e6);
    CHECK(constants == std::set<double>{0.375, 0.75});  // sides on the rim: half of 3/4; diagonals 3/8
  }
}

TEST_CASE("a grid that is rolled up has the fabric's bending energy, whichever way it is rolled",
          "[choi-ko]") {
  const double B = 2e-5, R = 2.0;
  for (const auto& [a, b] : {std::pair(0.02, 0.02), std::pair(0.03, 0.02)}) {
    const int n = 13;
    const TriangleMesh mesh = sheet(n, n, a, b);
    const Connections c = choi_ko_connections(mesh, mesh, {.bend = B});
    for (double direction : {0.0, 0.3, 0.785, 1.2, 1.5707963}) {
      // Rolled onto a cylinder about an axis in the plane: u runs round it.
      const Vec3 along(std::cos(direction), 0, std::sin(direction)), axis(-along.z(), 0, along.x());
      const auto rolled = [&](int v) {
        const Vec3& x = mesh.positions[v];
        const double u = x.dot(along) / R;
        return Vec3(R * std::sin(u) * along + R * (1 - std::cos(u)) * Vec3::UnitY() + x.dot(axis) * axis);
      };
      // What belongs to the vertex in the middle: connections over it. Their links keep their lengths, and
      // the angle between them is the cylinder's.
      const int m = n / 2 * n + n / 2;
      double energy = 0;
      for (const BendConnection& s : c.bend) {
        const auto at = [&](int v) { return mesh.positions[v]; };
        if ((0.5 * (at(s.i) + at(s.j)) - at(m)).norm() > 1e-9) continue;
        const Vec3 one = (rolled(s.i) - rolled(m)).normalized(), two = (rolled(s.j) - rolled(m)).normalized();
        const double l = ((at(s.i) - at(m)).norm() * one - (at(s.j) - at(m)).norm() * two).norm();
        energy += BucklingSpring::energy(BucklingSpring::rest(s.L, s.k_b, 1e12), l);
      }
      CHECK(energy / (a * b) == Approx(B / (2 * R * R)).epsilon(1e-3));
    }
  }
}

TEST_CASE("a grid's springs as the paper has them, its masses, and no force at rest", "[choi-ko]") {
  const TriangleMesh mesh = sheet(6, 5, 0.1, 0.1);
  const Fabric fabric{.area_density = 0.2, .stretch_spring = 200, .bend_spring = 1e-7};
  const Connections c = choi_ko_connections(mesh, mesh, fabric);
  CHECK(c.stretch.size() == 5 * 5 + 6 * 4 + 2 * 20);
  CHECK(c.bend.size() == 4 * 5 + 6 * 3 + 2 * 4 * 3);
  for (const StretchConnection& s : c.stretch) CHECK(s.k == 200);
  for (const BendConnection& s : c.bend) CHECK(s.k_b == 1e-7);
  const std::vector<double> mass = choi_ko_mass(mesh, mesh, 0.2);
  CHECK(std::accumulate(mass.begin(), mass.end(), 0.0) == Approx(0.2 * 0.5 * 0.4));
  CHECK(mass[0] == Approx(0.2 * 0.0025));
  CHECK(mass[7] == Approx(0.2 * 0.01));
  System system(mass);
  system.add(choi_ko(mesh, fabric));
  CHECK(system.force(stacked(mesh.positions), VecX::Zero(90)).norm() < 1e-12);
}

TEST_CASE("a rest shape of its own decides lengths and masses", "[choi-ko]") {
  const TriangleMesh mesh = sheet(4, 4, 0.1, 0.1), rest = sheet(4, 4, 0.2, 0.1);
  const Connections c = choi_ko_connections(mesh, rest, {}), of_rest = choi_ko_connections(rest, rest, {});
  REQUIRE(c.stretch.size() == of_rest.stretch.size());
  for (std::size_t k = 0; k < c.stretch.size(); ++k) {
    CHECK(c.stretch[k].L == of_rest.stretch[k].L);
    CHECK(c.stretch[k].k == of_rest.stretch[k].k);
  }
  CHECK(choi_ko_mass(mesh, rest, 0.2) == choi_ko_mass(rest, rest, 0.2));
  CHECK(longest_cell(mesh, rest) == Approx(2));
  TriangleMesh cut = rest;
  cut.positions.push_back(Vec3(9, 9, 9));
  cut.triangles[0][0] = 16;
  CHECK_THROWS_WITH(choi_ko_connections(mesh, cut, {}), Contains("several places"));
}

TEST_CASE("a model of springs takes the means of warp and weft", "[choi-ko][fabric]") {
  const TriangleMesh mesh = sheet(6, 6, 0.04, 0.05);
  const Fabric directed{.area_density = 0.1,
                        .stretch = 600,
                        .bend = 2e-6,
                        .weave = {.stretch_weft = 400, .shear = 9, .bend_weft = 6e-6, .bend_bias = 7e-6}},
      mean{.area_density = 0.1, .stretch = 500, .bend = 4e-6};
  for (const auto& connections : {noh_jung_connections, choi_ko_connections}) {
    const Connections one = connections(mesh, mesh, directed), other = connections(mesh, mesh, mean);
    REQUIRE(one.bend.size() == other.bend.size());
    for (std::size_t k = 0; k < one.bend.size(); ++k) CHECK(one.bend[k].k_b == other.bend[k].k_b);
    REQUIRE(one.stretch.size() == other.stretch.size());
    for (std::size_t k = 0; k < one.stretch.size(); ++k) CHECK(one.stretch[k].k == other.stretch[k].k);
    CHECK(limp_below(one, directed) == limp_below(other, mean));
  }
}
