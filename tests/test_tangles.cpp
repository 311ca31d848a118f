// Cloth that starts through itself comes apart.
#include <functional>
#include <random>

#include "mesh/base/threads.h"
#include "mesh/distance/triangle_crossings.h"
#include "mesh/obj/obj.h"
#include "solver/assembly/assembly.h"
#include "tests/folder.h"
#include "tests/integrators.h"
#include "tests/sheets.h"
#include "tests/workshop.h"

using namespace drape;
using namespace drape::test;
using Catch::Contains;

namespace {

struct Start {
  const char* name;
  double size;  // m, of the upper sheet
  std::function<double(double, double)> height;
};

std::vector<Start> starts() {
  return {
      {"half of it is below", 0.36, [](double x, double z) { return 0.2 * x + 0.02 * z + 0.0007; }},
      {"a bump reaches through", 0.36,
       [](double x, double z) { return 0.02 - 0.035 * std::exp(-(x * x + z * z) / 0.004); }},
      {"a corner reaches through", 0.2, [](double x, double z) { return 0.5 * (x + z) + 0.0613; }},
      {"waves", 0.36, [](double x, double z) { return 0.004 * std::sin(31 * x + 0.3) * std::sin(27 * z); }},
  };
}

struct Tangled : Assembly {
  Tangled(const std::vector<TriangleMesh>& meshes, ClothModel model,
          std::vector<std::optional<int>> layers = {})
      : Assembly(Vec3::Zero()) {
    layers.resize(meshes.size());
    for (const TriangleMesh& mesh : meshes) {
      const int first = static_cast<int>(places_.size());
      for (const Triangle& t : mesh.triangles)
        triangles_.push_back({first + t[0], first + t[1], first + t[2]});
      places_.insert(places_.end(), mesh.positions.begin(), mesh.positions.end());
      add(ClothPart{.mesh = mesh,
                    .fabric = {.area_density = 0.2, .stretch = 200, .bend = 1e-5, .damping = 0.002},
                    .model = model,
                    .imperfection = 0,
                    .self_contact = SelfContactOptions{
                        .thickness = 1e-3, .friction = 0.3, .layer = layers[cloths.size()]}});
    }
  }
  double height_of(std::size_t k) const {  // mean, m
    double sum = 0;
    for (int i = cloths[k].first_particle; i < cloths[k].end_particle; ++i) sum += state.x[3 * i + 1];
    return sum / (cloths[k].end_particle - cloths[k].first_particle);
  }
  int crossings(bool as_floats = false) const {
    std::vector<Vec3> places = unstacked(state.x);
    if (as_floats)
      for (Vec3& p : places) p = p.cast<float>().cast<double>();
    return crossing_count(crossing_contours(places, triangles_));
  }
  Vec3 centre() const { return mean_of(state.x); }
  Vec3 mean_velocity() const { return mean_of(state.v); }

 private:
  Vec3 mean_of(const VecX& of) const {
    Vec3 sum = Vec3::Zero();
    double mass = 0;
    for (int i = 0; i < state.particles(); ++i) {
      sum += system->masses()[i] * of.segment<3>(3 * i);
      mass += system->masses()[i];
    }
    return sum / mass;
  }
  std::vector<Triangle> triangles_;
  std::vector<Vec3> places_;
};

Tangled two_sheets(const Start& start, int n, Kind kind, ClothModel model = ClothModel::woven) {
  const TriangleMesh lower =
      bent(n + 3, Kind::squares, 0.4, [](double x, double z) { return 0.0003 * std::sin(7 * x + 3 * z); });
  return Tangled({lower, bent(n, kind, start.size, start.height)}, model);
}

StepOptions usual() { return {.tolerance = 1e-7, .contact_tolerance = 1e-5}; }

}  // namespace

TEST_CASE("two sheets that pass through each other come apart, and stay so", "[self-contact]") {
  for (const Start& start : starts())
    for (int n : {11, 16, 23})
      for (Kind kind : kinds) {
        INFO(start.name << ", " << n << " vertices a side, kind " << static_cast<int>(kind));
        Tangled two = two_sheets(start, n, kind);
        two.use("implicit-euler", "auto", usual());
        const int at_start = two.crossings();
        REQUIRE(at_start > 3);
        const Vec3 centre = two.centre();
        int most = 0, clean = 0;
        for (int k = 0; k < 700 && clean < 20; ++k) {
          const StepReport report = two.integrator->advance(two.state, 0.01);
          REQUIRE(report.done);
          const int now = two.crossings();
          CHECK((report.tangled > 0) == (now > 0));
          if (clean > 0) REQUIRE(two.crossings(true) == 0);
          most = std::max(most, now);
          clean += now == 0;
        }
        CHECK(clean == 20);
        CHECK(most <= at_start + at_start / 4 + 8);
        CHECK(two.mean_velocity().norm() < 1e-3);
        CHECK((two.centre() - centre).norm() < 1e-3);
      }
}

// A small sheet lies above a large one, but for the larger part of it: by weight the smaller part would
// follow.
TEST_CASE("of two layers that cross the higher one comes out above, whichever part is lighter",
          "[self-contact]") {
  for (int n : {10, 16, 23})
    for (Kind kind : kinds)
      for (int sign : {1, -1}) {
        INFO(n << " vertices along an edge, kind " << static_cast<int>(kind) << ", slope " << sign);
        const TriangleMesh lower = bent(n, kind, 0.4, [](double, double) { return 0.0; }),
                           upper = bent(n, kind, 0.2, [&](double x, double z) {
                             return sign * (0.2 * x + 0.03 * z) - 0.007 + 0.0003;
                           });
        Tangled two({lower, upper}, ClothModel::noh_jung, {1, 2});
        REQUIRE(two.crossings() > 0);
        two.use("implicit-euler", "auto", usual());
        for (int k = 0; k < 600 && two.crossings() > 0; ++k)
          REQUIRE(two.integrator->advance(two.state, 0.01).done);
        CHECK(two.crossings() == 0);
        CHECK(two.height_of(1) > two.height_of(0));
      }
}

TEST_CASE("sheets at one and the same place come apart in the order of their layers", "[self-contact]") {
  for (int n : {8, 13})
    for (const auto& order : std::vector<std::vector<std::optional<int>>>{{0, 1, 2}, {5, 9, 7}}) {
      const TriangleMesh sheet = bent(n, Kind::irregular, 0.2, [](double, double) { return 0.0; });
      Tangled three({sheet, sheet, sheet}, ClothModel::woven, order);
      three.use("implicit-euler", "auto", usual());
      for (int k = 0; k < 100; ++k) REQUIRE(three.integrator->advance(three.state, 0.01).done);
      CHECK(three.crossings() == 0);
      CHECK(three.crossings(true) == 0);
      for (std::size_t a : {0, 1, 2})
        for (std::size_t b : {0, 1, 2})
          if (order[a] > order[b]) CHECK(three.height_of(a) > three.height_of(b) + 0.8e-3);
    }
}

TEST_CASE("tangles come apart with any integrator, and with the same bits on any number of threads",
          "[self-contact]") {
  const Start bump = starts()[1];
  for (const std::string name : {"implicit-euler", "bdf2", "symplectic-euler"}) {
    INFO(name);
    Tangled two = two_sheets(bump, 12, Kind::irregular, ClothModel::noh_jung);
    const double h = name == "symplectic-euler" ? 2e-4 : 0.01;
    two.use(name, "auto", usual());
    for (int k = 0; k * h < 0.6; ++k) REQUIRE(two.integrator->advance(two.state, h).done);
    CHECK(two.crossings() == 0);
  }
  std::vector<VecX> ends;
  const int before = threads();
  for (int count : {1, 2, 7}) {
    set_threads(count);
    Tangled two = two_sheets(bump, 23, Kind::irregular);
    two.use("implicit-euler", "auto", usual());
    for (int k = 0; k < 6; ++k) REQUIRE(two.integrator->advance(two.state, 0.01).done);
    ends.push_back(two.state.x);
  }
  set_threads(before);
  CHECK(ends[0] == ends[1]);
  CHECK(ends[0] == ends[2]);
}

// Its two neighbours hold it: a spring that becomes stiffer, because it is pressed in, is pressed in as
// before.
TEST_CASE("a layer between two that do not give way does not make contacts ever stiffer", "[self-contact]") {
  std::vector<TriangleMesh> meshes;
  for (double height : {0.0, 0.0006, 0.0012})
    meshes.push_back(bent(8, Kind::irregular, 0.1, [&](double, double) { return height; }));
  Tangled three(meshes, ClothModel::woven);
  for (std::size_t k : {0, 2})
    for (int i = three.cloths[k].first_particle; i < three.cloths[k].end_particle; ++i)
      three.constraints->pin(i);
  three.use("implicit-euler", "auto", usual());
  double early = 0;
  for (int k = 0; k < 60; ++k) {
    REQUIRE(three.integrator->advance(three.state, 0.01).done);
    const double energy = three.system->contact_energy(three.state.x);
    if (k == 20) early = energy;
    if (k > 20) REQUIRE(energy <= 2 * early);
  }
  CHECK(early > 0);
  CHECK(three.state.v.lpNorm<Eigen::Infinity>() < 1e-3);
}

TEST_CASE("drape untangle: a mesh that crosses itself no more, all else as in the file", "[self-contact]") {
  const Folder folder;
  const TriangleMesh lower = bent(12, Kind::squares, 0.4, [](double, double) { return 0.0; }),
                     upper = bent(10, Kind::squares, 0.36, starts()[1].height);
  std::string text = "g lower\n";
  int first = 1;
  for (const TriangleMesh* mesh : {&lower, &upper}) {
    if (first > 1) text += "g upper\n";
    for (const Vec3& x : mesh->positions)
      text += "v " + std::to_string(100 * x[0]) + " " + std::to_string(100 * x[1]) + " " +
              std::to_string(100 * x[2]) + "\n";
    for (const Triangle& t : mesh->triangles)
      text += "f " + std::to_string(first + t[0]) + " " + std::to_string(first + t[1]) + " " +
              std::to_string(first + t[2]) + "\n";
    first += mesh->vertex_count();
  }
  folder.write("bad.obj", text);
  const Outcome good = folder.drape("untangle bad.obj --scale 0.01 -o good.obj");
  INFO(good.out << good.err);
  CHECK(good.exit_code == 0);
  CHECK_THAT(good.out, Contains("pairs at the start, none after "));
  const TriangleMesh before = read_obj(folder.path / "bad.obj"), after = read_obj(folder.path / "good.obj");
  CHECK(after.triangles == before.triangles);
  CHECK(crossing_count(crossing_contours(before.positions, before.triangles)) > 10);
  CHECK(crossing_contours(after.positions, after.triangles).empty());
  for (int i = 0; i < before.vertex_count(); ++i)  // cm
    CHECK((after.positions[static_cast<std::size_t>(i)] - before.positions[static_cast<std::size_t>(i)])
              .norm() < 4);
  CHECK_THAT(content(folder.path / "good.obj"), Contains("g upper"));

  const Outcome again = folder.drape("untangle good.obj --scale 0.01 -o same.obj");
  CHECK(again.exit_code == 0);
  const TriangleMesh same = read_obj(folder.path / "same.obj");
  for (std::size_t i = 0; i < same.positions.size(); ++i)  // in centimetres and back
    CHECK((same.positions[i] - after.positions[i]).norm() < 1e-12);

  const Outcome early = folder.drape("untangle bad.obj --scale 0.01 -o part.obj --duration '10 ms'");
  CHECK(early.exit_code == 1);
  CHECK_THAT(early.err, Contains("still cross; --duration ended before they came apart;"));

  // The same triangles without common vertices: nothing joins them but --weld.
  std::string loose;
  for (const Triangle& t : before.triangles)
    for (int v : t) {
      const Vec3& x = before.positions[static_cast<std::size_t>(v)];
      loose += "v " + std::to_string(x[0]) + " " + std::to_string(x[1]) + " " + std::to_string(x[2]) + "\n";
    }
  for (int k = 1; k < 3 * before.triangle_count(); k += 3)
    loose += "f " + std::to_string(k) + " " + std::to_string(k + 1) + " " + std::to_string(k + 2) + "\n";
  folder.write("loose.obj", loose);
  const Outcome apart = folder.drape("untangle loose.obj --scale 0.01 -o part.obj --duration '10 ms'");
  CHECK(apart.exit_code == 1);
  CHECK_THAT(apart.err, Contains("--weld joins them"));
  const Outcome welded = folder.drape("untangle loose.obj --scale 0.01 -o welded.obj --weld");
  INFO(welded.out << welded.err);
  CHECK(welded.exit_code == 0);
  CHECK(read_obj(folder.path / "welded.obj").vertex_count() == 3 * before.triangle_count());
  for (const char* words :
       {"untangle none.obj -o x.obj", "untangle bad.obj -o ./bad.obj", "untangle bad.obj -o x.txt",
        "untangle bad.obj -o nowhere/x.obj", "untangle bad.obj -o x.obj --thickness -1",
        "untangle bad.obj -o x.obj --duration '3 kg'", "untangle bad.obj -o x.obj --fabric tweed",
        "untangle scene.toml -o x.obj"}) {
    INFO(words);
    const Outcome bad = folder.drape(words);
    CHECK(bad.exit_code == 2);
    CHECK(std::count(bad.err.begin(), bad.err.end(), '\n') == 1);
  }
  CHECK(folder.files() ==
        std::set<std::string>{"bad.obj", "good.obj", "same.obj", "part.obj", "loose.obj", "welded.obj"});
}

TEST_CASE("drape untangle: layers at exactly one place come apart in their order", "[self-contact]") {
  const Folder folder;
  for (const Kind kind : kinds) {
    const TriangleMesh sheet = bent(8, kind, 0.2, [](double, double) { return 0.0; });
    std::string text;
    for (int copy = 0; copy < 2; ++copy) {
      text += copy == 0 ? "g inner\n" : "g outer\n";
      for (const Vec3& x : sheet.positions)
        text += "v " + std::to_string(x[0]) + " " + std::to_string(x[1]) + " " + std::to_string(x[2]) + "\n";
      for (const Triangle& t : sheet.triangles) {
        text += "f";
        for (int v : t) text += " " + std::to_string(copy * sheet.vertex_count() + v + 1);
        text += "\n";
      }
    }
    folder.write("twice.obj", text);
    REQUIRE(folder.drape("untangle twice.obj --layers inner,outer --thickness '1 mm' -o two.obj").exit_code ==
            0);
    const TriangleMesh two = read_obj(folder.path / "two.obj");
    const Vec3 normal =
        (sheet.positions[sheet.triangles[0][1]] - sheet.positions[sheet.triangles[0][0]])
            .cross(sheet.positions[sheet.triangles[0][2]] - sheet.positions[sheet.triangles[0][0]])
            .normalized();
    for (int i = 0; i < sheet.vertex_count(); ++i) {
      const double gap = normal.dot(two.positions[sheet.vertex_count() + i] - two.positions[i]);
      CHECK(gap > 0.5e-3);
      CHECK(gap < 1.5e-3);
    }
  }
}
