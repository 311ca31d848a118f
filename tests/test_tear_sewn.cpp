// Sewn cloth that tears: before its seam is merged, across the seam afterwards, and along it.
#include <algorithm>
#include <catch2/catch.hpp>

#include "app/base/toml_file.h"
#include "app/recording/recording.h"
#include "app/run/run.h"
#include "solver/assembly/assembly.h"
#include "tests/folder.h"
#include "tests/same_bits.h"
#include "tests/tearing.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double limit = 0.3, h = 0.02;  // h [m]

// Two sheets that are sewn, which become one at the time `close` [s].
ClothPart sewn(ClothModel model, int nx, int nz, double gap, double close) {
  Fabric fabric{.area_density = 0.15, .stretch = 200, .bend = 1e-6};
  if (model != ClothModel::woven) fabric.damping = 0.05;
  ClothPart cloth{.mesh = parse_obj(two_sheets(nx, nz, h, gap), "two.obj"), .fabric = fabric, .model = model};
  SeamPlan seam{.name = "near.side / far.side", .pairs = {}, .close = close};
  for (int i = 0; i < nx; ++i) seam.pairs.emplace_back((nz - 1) * nx + i, nz * nx + i);
  cloth.seams = {seam};
  cloth.tear = limit;
  return cloth;
}

// The triangles of a cloth between its particles.
TriangleMesh between(const Cloth& cloth) {
  TriangleMesh mesh = cloth.mesh;
  for (Triangle& t : mesh.triangles)
    for (int& v : t) v = cloth.embedding.particle(v) - cloth.first_particle;
  mesh.positions.resize(static_cast<std::size_t>(cloth.end_particle - cloth.first_particle));
  return mesh;
}

// What a cloth and its mesh have to agree in, whatever became of it.
void check_whole(const Assembly& all, std::size_t k = 0) {
  const Cloth& cloth = all.cloths[k];
  REQUIRE(cloth.embedding.vertices() == cloth.mesh.vertex_count());
  REQUIRE(cloth.end_particle <= all.state.particles());
  for (int v = 0; v < cloth.mesh.vertex_count(); ++v) {
    REQUIRE(cloth.embedding.particle(v) >= cloth.first_particle);
    REQUIRE(cloth.embedding.particle(v) < cloth.end_particle);
  }
  // What is written can be read, and is the mesh.
  const Folder folder;
  write_obj(folder.path / "torn.obj", cloth.mesh, cloth.embedding.positions(all.state.x));
  const TriangleMesh read = read_obj(folder.path / "torn.obj");
  CHECK(read.triangle_count() == cloth.mesh.triangle_count());
  CHECK(read.vertex_count() == cloth.mesh.vertex_count());
  CHECK(read.document->texcoords.size() == cloth.mesh.document->texcoords.size());
  REQUIRE(read.groups.size() == cloth.mesh.groups.size());
  for (std::size_t g = 0; g < read.groups.size(); ++g)
    CHECK(read.groups[g].vertices == cloth.mesh.groups[g].vertices);
}

}  // namespace

TEST_CASE(
    "a sewn cloth that tears keeps mass, momentum and centre of mass, before its seam is merged and after",
    "[tear][sewing]") {
  for (const ClothModel model : {ClothModel::noh_jung, ClothModel::woven})
    for (const bool merged : {false, true}) {
      INFO(static_cast<int>(model) << " " << merged);
      constexpr int nx = 9, nz = 5;
      Assembly all(Vec3::Zero());
      all.add(sewn(model, nx, nz, merged ? 0 : 1e-3, merged ? 0 : 1));
      all.use("implicit-euler", "cholmod");
      const int start = all.state.particles();
      if (merged) REQUIRE(all.advance(1e-6).done);
      REQUIRE(all.state.particles() == (merged ? start - nx : start));
      const Vec3 diagonal = Vec3(1, 0, 1).normalized();
      for (int i = 0; i < all.state.particles(); ++i)  // it flies apart along a diagonal, and to one side
        all.state.v.segment<3>(3 * i) =
            Vec3(2, 1, 0) + 1000 * (diagonal.dot(all.state.x.segment<3>(3 * i)) - 0.1) * diagonal;
      int tears = 0;
      for (int step = 0; step < 60; ++step) {
        const std::vector<double> before = all.system->masses();
        const StepReport report = all.advance(0.0005);
        REQUIRE(report.done);
        if (report.torn == 0) continue;
        ++tears;
        const State &was = all.outgrown.back(), &is = all.state;
        const std::vector<double>& after = all.system->masses();
        check_kept(before, was, after, is);
        check_whole(all);
      }
      CHECK(tears >= 2);
    }
}

TEST_CASE("a sewn strip that is pulled apart tears in two, before its seam is merged and after",
          "[tear][sewing]") {
  for (const ClothModel model : {ClothModel::noh_jung, ClothModel::woven})
    for (const char* integrator : {"implicit-euler", "pbd"})
      for (const bool merged : {false, true}) {
        INFO(static_cast<int>(model) << " " << integrator << " " << merged);
        constexpr int nx = 7, nz = 8;
        Assembly all(Vec3::Zero());
        all.add(sewn(model, nx, nz, 5e-3, merged ? 0.1 : 10));
        std::vector<int> ends[2];
        for (int i = 0; i < nx; ++i) ends[0].push_back(i), ends[1].push_back((2 * nz - 1) * nx + i);
        all.constraints->pin(ends[0]);
        all.constraints->pin_along(
            ends[1], Motion::constant({0, 0, 1}, Vec3::Zero(), Vec3::Zero(), 0.3, 0.45), all.state.x);
        all.use(integrator, "cholmod", {.newton_iterations = 3});
        const double mass = sum(all.system->masses());
        while (all.state.time < 0.8) REQUIRE(all.advance(0.005).done);
        const Cloth& cloth = all.cloths[0];
        CHECK(cloth.seams.empty() == merged);
        check_whole(all);
        // Sheets that are only stitched are two pieces to begin with.
        CHECK(pieces(between(cloth)) == (merged ? 2 : 3));
        CHECK(largest_strain(all.cloths, all.state.x) <= limit);
        CHECK(sum(all.system->masses()) == Approx(mass).epsilon(1e-13));
        CHECK(cloth.tearing->cuts == nx - 1);
      }
}

TEST_CASE("a seam that was merged rips along itself, and the vertices of its two sides part",
          "[tear][sewing]") {
  constexpr int nx = 5, nz = 3;
  Assembly all(Vec3::Zero());
  all.add(sewn(ClothModel::noh_jung, nx, nz, 0, 0));
  all.use("implicit-euler", "cholmod");
  REQUIRE(all.advance(1e-6).done);
  REQUIRE(all.cloths[0].seams.empty());
  const int vertices = all.cloths[0].mesh.vertex_count(), particles = all.state.particles();
  REQUIRE(particles == vertices - nx);
  std::vector<int> still, moved;  // all but the seam, which so is what is stretched
  for (int v = 0; v < nx * (nz - 1); ++v) still.push_back(all.cloths[0].embedding.particle(v));
  for (int v = nx * (nz + 1); v < vertices; ++v) moved.push_back(all.cloths[0].embedding.particle(v));
  all.constraints->pin(still);
  all.constraints->pin_along(moved, Motion::constant({0, 0, 1}, Vec3::Zero(), Vec3::Zero(), 0, 0.03),
                             all.state.x);
  all.use("implicit-euler", "cholmod");
  while (all.state.time < 0.3) REQUIRE(all.advance(0.002).done);
  const Cloth& cloth = all.cloths[0];
  CHECK(cloth.tearing->cuts == nx - 1);
  CHECK(cloth.tearing->copy_of.empty());
  CHECK(cloth.mesh.vertex_count() == vertices);
  CHECK(all.state.particles() == vertices);
  CHECK(pieces(between(cloth)) == 2);
  check_whole(all);
  for (int i = 0; i < nx; ++i) {
    const int near = cloth.embedding.particle((nz - 1) * nx + i), far = cloth.embedding.particle(nz * nx + i);
    CHECK(near != far);
    CHECK(all.state.x[3 * far + 2] > all.state.x[3 * near + 2] + 0.01);
  }
}

TEST_CASE("a stitch stays with the vertex that keeps its number when that parts", "[tear][sewing]") {
  constexpr int nx = 3, nz = 3, middle = (nz - 1) * nx + 1;
  ClothPart cloth = sewn(ClothModel::noh_jung, nx, nz, 5e-3, 0.3);
  cloth.seams[0].pairs = {{middle - 1, middle + nx - 1}, {middle, middle + nx}};
  Assembly all(Vec3::Zero());
  all.add(std::move(cloth));
  for (const int side : {0, 2}) {  // of the near sheet, so that its middle is pulled apart
    std::vector<int> column;
    for (int j = 0; j < nz; ++j) column.push_back(j * nx + side);
    all.constraints->pin_along(
        column, Motion::constant({side - 1.0, 0, 0}, Vec3::Zero(), Vec3::Zero(), 0, 0.015), all.state.x);
  }
  all.use("implicit-euler", "cholmod");
  const int start = all.cloths[0].mesh.vertex_count();
  while (all.state.time < 0.2) REQUIRE(all.advance(0.002).done);
  const Cloth& torn = all.cloths[0];
  const std::vector<int>& copy_of = torn.tearing->copy_of;
  const auto copy = std::find(copy_of.begin(), copy_of.end(), middle);
  REQUIRE(copy != copy_of.end());
  REQUIRE(torn.seams.size() == 1);
  // What is known of the tear stays with its vertices when particles become one.
  const auto of_vertices = [&](const auto& by_particle) {
    std::vector<double> values;
    for (int v = 0; v < torn.mesh.vertex_count(); ++v) {
      const auto local = static_cast<std::size_t>(torn.embedding.particle(v) - torn.first_particle);
      values.push_back(local < by_particle.size() ? by_particle[local] : 0);
    }
    return values;
  };
  std::vector<double> at_cut, rests;
  while (!torn.seams.empty() && all.state.time < 1) {
    at_cut = of_vertices(torn.tearing->at_cut);
    rests = of_vertices(torn.tearing->rests_until);
    REQUIRE(all.advance(0.002).done);
  }
  CHECK(torn.seams.empty());
  for (const int p : {0, 1}) {  // of both sides of a stitch
    const auto near = static_cast<std::size_t>(middle - p), far = near + nx;
    at_cut[near] = at_cut[far] = std::max(at_cut[near], at_cut[far]);
    rests[near] = rests[far] = std::max(rests[near], rests[far]);
  }
  CHECK(at_cut == of_vertices(torn.tearing->at_cut));
  CHECK(rests == of_vertices(torn.tearing->rests_until));
  CHECK(*std::max_element(rests.begin(), rests.end()) > 0);
  check_whole(all);
  const int other = start + static_cast<int>(copy - copy_of.begin());
  CHECK(torn.embedding.particle(middle) == torn.embedding.particle(middle + nx));
  CHECK(torn.embedding.particle(other) != torn.embedding.particle(middle));
}

TEST_CASE(
    "a scene of sewn cloth that tears writes whole recordings, and has the same bits on any number of "
    "threads",
    "[tear][sewing]") {
  const Folder folder;
  constexpr int nx = 6, nz = 7;
  folder.write("two.obj", two_sheets(nx, nz, h, 0.005));
  const app::Scene scene = app::read_scene(
      app::parse_toml(
          "[simulation]\nduration = \"0.7 s\"\ntime_step = \"5 ms\"\nframe_rate = \"50 Hz\"\ngravity = [0, "
          "0, 0]\n"
          "[[cloth]]\nname = \"strip\"\nmesh = \"two.obj\"\ntear = \"30 %\"\nstretch = \"200 N/m\"\n"
          "self_contact = true\nseams = [{ curves = [\"near.side\", \"far.side\"], direction = \"same\", "
          "close = "
          "\"0.1 s\" }]\n"
          "pins = [{ box = [[-1, -1, -1], [1, 1, 0.001]] }, { box = [[-1, -1, 0.244], [1, 1, 1]], motion = { "
          "keyframes = [{ time = 0 }, { time = \"0.2 s\" }, { time = \"0.35 s\", translate = [0, 0, 0.15] }] "
          "} "
          "}]\n",
          "s.toml"),
      {}, folder.path, "s.toml");
  REQUIRE(app::run(scene, {folder.path / "out", app::Frames::pc2, true}) == 0);
  const app::Recording recording(folder.path / "out");
  CHECK(recording.missing().empty());
  const app::Json& cloth = recording.run()["cloths"].items()[0];
  const TriangleMesh mesh = read_obj(folder.path / "out/strip.obj");
  CHECK(cloth["particles"].number(0) == mesh.vertex_count());
  CHECK(cloth["torn"].number(0) == nx - 1);
  CHECK(recording.run()["crossings"]["end"].number(-1) == 0);
  const auto& copy_of = cloth["copy_of"].items();
  CHECK(mesh.vertex_count() == 2 * nx * nz + static_cast<int>(copy_of.size()));
  for (int f = 0; f < recording.frames(); ++f)
    CHECK(recording.positions(0, f).size() == mesh.positions.size());
  check_same_bits([&] {
    app::Simulation simulation = app::make_simulation(scene);
    while (simulation.state.time < 0.5) REQUIRE(simulation.advance(0.005).done);
    CHECK(simulation.cloths[0].tearing->cuts > 0);
    return simulation.state;
  });
}
