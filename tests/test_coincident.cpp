// Layers that start at exactly one place: they come apart, and never pass through each other.
#include <array>
#include <catch2/catch.hpp>

#include "mesh/distance/triangle_crossings.h"
#include "solver/assembly/assembly.h"
#include "solver/assembly/coincident.h"
#include "tests/integrators.h"
#include "tests/sheets.h"
#include "tests/together.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double r = 1e-3;  // m

TriangleMesh wavy(int n, Kind kind) {
  return bent(n, kind, 0.2, [](double x, double z) { return 0.006 * std::sin(40 * x) + 0.02 + 0.1 * z; });
}

// `layers` copies of a sheet, as cloths of their own or as one mesh, over a floor.
struct Copies : Assembly {
  Copies(const TriangleMesh& sheet, int layers, bool one_mesh) {
    constraints->add(Obstacle{.shape = Plane{}, .friction = 0.3});
    all = together(std::vector<TriangleMesh>(static_cast<std::size_t>(layers), sheet));
    for (int k = 0; k < (one_mesh ? 1 : layers); ++k)
      add(ClothPart{.mesh = one_mesh ? all : sheet,
                    .fabric = {.area_density = 0.2, .stretch = 500, .bend = 1e-5, .damping = 0.002},
                    .model = ClothModel::woven,
                    .self_contact = SelfContactOptions{.thickness = r, .friction = 0.3}});
    use("implicit-euler", "auto", {.tolerance = 1e-4});
  }
  int crossings() const { return crossing_count(crossing_contours(unstacked(state.x), all.triangles)); }

  TriangleMesh all;
};

// The sheet cut along the middle; its two sides joined by triangles of no area, or not: as programs leave
// meshes that they take apart along seams.
TriangleMesh with_cut(TriangleMesh mesh, bool joined) {
  const std::vector<Triangle> whole = mesh.triangles;
  const auto right = [&](const Triangle& t) {
    return mesh.positions[t[0]][0] + mesh.positions[t[1]][0] + mesh.positions[t[2]][0] > 1e-9;
  };
  std::vector<int> copy(mesh.positions.size(), -1);
  std::vector<char> on_the_left(mesh.positions.size(), 0);
  for (const Triangle& t : whole)
    if (!right(t))
      for (int v : t) on_the_left[v] = 1;
  for (Triangle& t : mesh.triangles) {
    if (!right(t)) continue;
    for (int& v : t) {
      if (!on_the_left[v]) continue;
      if (copy[v] < 0) {
        copy[v] = mesh.vertex_count();
        mesh.positions.push_back(Vec3(mesh.positions[v]));
      }
      v = copy[v];
    }
  }
  for (const Triangle& t : whole)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (!joined || right(t) || copy[a] < 0 || copy[b] < 0) continue;
      mesh.triangles.push_back({b, a, copy[a]});
      mesh.triangles.push_back({b, copy[a], copy[b]});
    }
  return mesh;
}

// With its vertices in the reverse order, so that those that are doubled come first and last.
TriangleMesh backwards(TriangleMesh mesh) {
  std::ranges::reverse(mesh.positions);
  for (Triangle& t : mesh.triangles)
    for (int& v : t) v = mesh.vertex_count() - 1 - v;
  return mesh;
}

}  // namespace

TEST_CASE(
    "vertices that edges of no length join are one point of cloth that meets cloth, and those that are "
    "welded",
    "[self-contact]") {
  enum Way { whole, joined, at_one_place };
  struct Sort {
    ClothModel model;
    double rest_angle;
  };
  for (const auto& [model, rest_angle] :
       {Sort{ClothModel::noh_jung, 0}, Sort{ClothModel::woven, 0}, Sort{ClothModel::woven, 1}})
    for (const Kind kind : kinds)
      for (const int n : {7, 11, 16}) {
        INFO(n << " vertices along an edge, kind " << static_cast<int>(kind) << ", model "
               << static_cast<int>(model) << ", rest angle " << rest_angle);
        const TriangleMesh sheet =
            bent(n, kind, 0.2, [](double x, double) { return 0.03 + 0.01 * std::cos(30 * x); });
        Fabric fabric{.area_density = 0.2, .stretch = 500, .bend = 1e-5, .damping = 0.002};
        fabric.weave.rest_angle = rest_angle;
        std::array<double, 3> energy{}, at_start{}, heaviest{};
        for (const Way way : {whole, joined, at_one_place}) {
          const TriangleMesh mesh = backwards(way == whole ? sheet : with_cut(sheet, way == joined));
          REQUIRE((mesh.vertex_count() > sheet.vertex_count()) == (way != whole));
          Assembly all;
          all.constraints->add(Obstacle{.shape = Sphere{{0, -0.05, 0}, 0.06}, .friction = 0.3});
          all.add(ClothPart{.mesh = mesh,
                            .fabric = fabric,
                            .model = model,
                            .imperfection = 0,
                            .weld = way == at_one_place,
                            .self_contact = SelfContactOptions{.thickness = r, .friction = 0.3}});
          all.use("implicit-euler", "auto", {.tolerance = 1e-4});
          REQUIRE(all.state.particles() == sheet.vertex_count());
          const std::vector<double>& masses = all.system->masses();
          heaviest[way] = *std::max_element(masses.begin(), masses.end());
          VecX moved = all.state.x;
          for (int i = 0; i < all.state.particles(); ++i) {
            const Vec3 x = all.state.x.segment<3>(3 * i);
            moved.segment<3>(3 * i) =
                x + 0.01 * Vec3(std::sin(30 * x[2]), std::sin(40 * x[0]), std::cos(35 * x[0]));
          }
          at_start[way] = all.system->stored_energy(all.state.x);
          energy[way] = all.system->stored_energy(moved);
          for (int k = 0; k < 15; ++k) REQUIRE(all.advance(0.01).done);
          CHECK(largest_strain(all.cloths, all.state.x) < 0.05);
          const std::vector<Vec3> end = all.cloths[0].embedding.positions(all.state.x);
          CHECK(crossing_count(crossing_contours(end, all.cloths[0].mesh.triangles)) == 0);
        }
        CHECK(energy[whole] > 1e-6);
        for (const Way way : {joined, at_one_place}) {
          CHECK(heaviest[way] == Approx(heaviest[whole]).epsilon(1e-12));
          CHECK(energy[way] == Approx(energy[whole]).epsilon(1e-7));
          CHECK(at_start[way] == Approx(at_start[whole]).epsilon(1e-5).margin(1e-15));
        }
      }
}

TEST_CASE("pins, ropes and other parts keep their places where vertices become one", "[self-contact]") {
  const TriangleMesh sheet = bent(7, Kind::squares, 0.2, [](double, double) { return 0.02; }),
                     cut = with_cut(sheet, false);
  const int copy = cut.vertex_count() - 1,
            v = static_cast<int>(std::ranges::find(cut.positions, cut.positions[copy]) -
                                 cut.positions.begin());
  REQUIRE(v < copy);
  Assembly all;
  const Fabric fabric{.area_density = 0.2, .stretch = 500, .bend = 1e-5};
  all.add(ClothPart{.mesh = cut, .fabric = fabric, .weld = true});
  TriangleMesh beside = sheet;
  for (Vec3& x : beside.positions) x[0] += 1;
  all.add(ClothPart{.mesh = beside, .fabric = fabric});
  const Vec3 end = cut.positions[copy];
  all.add(
      RopePart{.points = {end, end - Vec3(0, 0.1, 0)}, .material = {.mass_per_length = 0.1}, .first = copy});
  all.pin(PinVertices{{0}}, 0);
  all.pin(PinVertices{{0, 3}}, 1);
  all.use("implicit-euler", "auto");
  const auto particle = [&](std::size_t k, int vertex) { return all.cloths[k].embedding.particle(vertex); };
  CHECK(all.state.particles() == 2 * sheet.vertex_count() + 1);
  CHECK(particle(0, v) == particle(0, copy));
  CHECK(particle(2, 0) == particle(0, v));
  CHECK(particle(1, 0) == sheet.vertex_count());
  const State before = all.state;
  for (int k = 0; k < 10; ++k) REQUIRE(all.advance(0.01).done);
  for (const int i : {particle(0, 0), particle(1, 0), particle(1, 3)})
    CHECK(all.state.x.segment<3>(3 * i) == before.x.segment<3>(3 * i));
  CHECK((all.state.x - before.x).norm() > 0.01);
}

TEST_CASE("what cannot be welded is told", "[self-contact]") {
  const TriangleMesh sheet = wavy(5, Kind::squares);
  const auto weld = [](const TriangleMesh& mesh, ClothModel model) {
    Assembly all;
    all.add(ClothPart{.mesh = mesh, .model = model, .weld = true});
  };
  CHECK_THROWS_WITH(weld(together({sheet, sheet}), ClothModel::noh_jung),
                    Catch::Contains("weld: 32 triangles lie on others"));
  CHECK_THROWS_WITH(weld(sheet, ClothModel::choi_ko), Catch::Contains("weld: the springs of \"choi-ko\""));
  CHECK_NOTHROW(weld(with_cut(sheet, false), ClothModel::noh_jung));
  // What is at exactly one place is no defect then; what nearly is stays one.
  TriangleMesh nearly = with_cut(sheet, false);
  CHECK(examine(nearly).defects.size() == 1);
  CHECK(examine(nearly, true).defects.empty());
  nearly.positions.back()[1] += 1e-12;
  CHECK(examine(nearly, true).defects.size() == 1);
}

TEST_CASE("copies of a sheet at exactly one place come apart in order and never cross", "[self-contact]") {
  for (const bool one_mesh : {false, true})
    for (int layers : {2, 4})
      for (int n : {7, 11, 16})
        for (Kind kind : kinds) {
          if ((one_mesh || layers > 2) && n > 7) continue;
          INFO(layers << " layers, " << n << " vertices along an edge, kind " << static_cast<int>(kind)
                      << (one_mesh ? ", one mesh" : ""));
          const TriangleMesh sheet = wavy(n, kind);
          Copies copies(sheet, layers, one_mesh);
          for (int k = 0; k < 60; ++k) {
            INFO("step " << k);
            REQUIRE(copies.advance(0.01).done);
            REQUIRE(copies.crossings() == 0);
          }
          const int count = sheet.vertex_count();
          for (int k = 1; k < layers; ++k) {  // the later copy is the upper one, by a thickness
            double apart = 0;
            for (int i = 0; i < count; ++i)
              apart +=
                  (copies.state.x[3 * (k * count + i) + 1] - copies.state.x[3 * ((k - 1) * count + i) + 1]) /
                  count;
            CHECK(apart == Approx(r).epsilon(0.25));
          }
        }
}

TEST_CASE("copies with and without a layer start apart", "[self-contact]") {
  using Layer = std::optional<int>;
  for (const std::vector<Layer>& layers :
       std::vector<std::vector<Layer>>{{1, {}}, {{}, {}, 1}, {{}, 1, {}}, {2, {}, {}, 1}}) {
    const TriangleMesh sheet = wavy(5, Kind::squares);
    Assembly all;
    for (const Layer& layer : layers)
      all.add(ClothPart{.mesh = sheet,
                        .imperfection = 0,
                        .self_contact = SelfContactOptions{.thickness = r, .layer = layer}});
    const int count = sheet.vertex_count(), cloths = static_cast<int>(layers.size());
    for (int k = 0; k < cloths; ++k)
      for (int l = 0; l < k; ++l)
        for (int i = 0; i < count; ++i)
          CHECK((all.state.x.segment<3>(3 * (k * count + i)) - all.state.x.segment<3>(3 * (l * count + i)))
                    .norm() > 2e-6);
  }
}

TEST_CASE("only triangles at exactly one place count as layers", "[self-contact]") {
  const TriangleMesh sheet = wavy(5, Kind::irregular);
  const auto below = [&](const TriangleMesh& mesh) { return internal::layers_below({}, mesh); };
  const auto all = [](int n, int value) { return std::vector<int>(static_cast<std::size_t>(n), value); };
  CHECK(below(sheet) == all(25, 0));
  std::vector<int> expected = all(25, 0);
  for (int k : {1, 2}) expected.insert(expected.end(), 25, k);
  CHECK(below(together({sheet, sheet, sheet})) == expected);
  TriangleMesh moved = sheet;
  for (Vec3& x : moved.positions) x[0] += 1e-9;
  CHECK(below(together({sheet, moved})) == all(50, 0));
  // Panels that share the places of a border, and a triangle that is there twice.
  TriangleMesh beside = sheet;
  double widest = 0;
  for (const Vec3& x : sheet.positions) widest = std::max(widest, x[0]);
  for (Vec3& x : beside.positions) x[0] = 2 * widest - x[0];
  CHECK(below(together({sheet, beside})) == all(50, 0));
  TriangleMesh twice = sheet;
  twice.triangles.push_back(twice.triangles.front());
  CHECK(below(twice) == all(25, 0));
}
