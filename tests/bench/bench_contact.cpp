// What contact costs, on a bumpy ball of 27 k triangles, 1.2 m across:
//   a distance to it, the level set against the exact distance to its mesh, at random points near the surface
//   and far from it (or to the OBJ file that is named);
//   a step of a sheet of 10 k vertices that falls on it: detection and constraints against the linear solve.
//   drape_bench_contact [BODY.obj [VOXEL in m]]
// Every figure is the median of several repeats, in which one thread and two take turns;
// points from a fixed seed.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "mesh/base/parallel.h"
#include "mesh/level_set/level_set.h"
#include "mesh/obj/obj.h"
#include "solver/forces/face_contact_force.h"
#include "tests/bench/bench.h"
#include "tests/shapes.h"

namespace {

using namespace drape;
using namespace drape::bench;

TriangleMesh bumpy_ball() {
  TriangleMesh mesh = test::lat_long_sphere(117, 116, 1, Vec3::Zero());
  for (Vec3& x : mesh.positions) {
    const double polar = std::acos(x.z()), round = std::atan2(x.y(), x.x());
    x *= 0.6 * (1 + 0.08 * std::sin(polar) * std::sin(7 * round) * std::sin(6 * polar));
  }
  return mesh;
}

constexpr int points = 200000;

// Every point is `off(random)` away from a random vertex.
template <class Off>
std::vector<Vec3> near(const TriangleMesh& mesh, const Off& off) {
  test::Random random;
  std::vector<Vec3> all;
  all.reserve(points);
  for (int i = 0; i < points; ++i)
    all.push_back(mesh.positions[random.below(mesh.vertex_count())] + off(random));
  return all;
}

// ns a query, for every number of threads.
template <class Body>
std::vector<double> cost(const Body& body, const std::vector<Vec3>& at,
                         const std::vector<int>& thread_counts) {
  std::vector<std::vector<double>> ns(thread_counts.size());
  std::vector<SurfacePoint> answers(at.size());
  for (int repeat = 0; repeat < 9; ++repeat)
    for (std::size_t t = 0; t < thread_counts.size(); ++t) {
      set_threads(thread_counts[t]);
      const double start = now_ms();
      for_chunks(static_cast<int>(at.size()), [&](int begin, int end) {
        for (int i = begin; i < end; ++i) answers[i] = body.closest(at[i]);
      });
      if (repeat > 0) ns[t].push_back(1e6 * (now_ms() - start) / points);
    }
  std::vector<double> medians;
  medians.reserve(ns.size());
  for (const std::vector<double>& values : ns) medians.push_back(median(values));
  return medians;
}

void bench_body(const TriangleMesh& mesh, const std::string& name, double voxel) {
  const int most = threads();
  const std::vector<int> thread_counts = most > 1 ? std::vector{1, 2} : std::vector{1};
  const double start = now_ms();
  const LevelSet level_set = LevelSet::from_mesh(mesh, {.voxel = voxel});
  const double build_ms = now_ms() - start, h = level_set.voxel();
  const SurfaceDistance exact(mesh);
  const LevelSetError error = *level_set.error();
  std::printf(
      "%s: %d triangles; level set with voxels of %.2f mm: %ld of them, %.1f MB, made in %.0f ms;\n"
      "error at most %.2f voxels, rms %.3f\n",
      name.c_str(), mesh.triangle_count(), 1e3 * h, level_set.voxels(),
      static_cast<double>(level_set.bytes()) / 1e6, build_ms, error.largest / h, error.rms / h);
  std::printf("%-34s %8s %14s %14s %8s\n", "ns a query", "threads", "level set", "exact mesh", "ratio");
  const auto row = [&](const char* where, const std::vector<Vec3>& at) {
    const std::vector<double> grid = cost(level_set, at, thread_counts),
                              tree = cost(exact, at, thread_counts);
    for (std::size_t t = 0; t < grid.size(); ++t)
      std::printf("%-34s %8d %14.1f %14.1f %8.1f\n", t ? "" : where, thread_counts[t], grid[t], tree[t],
                  tree[t] / grid[t]);
  };
  const double band = level_set.band();
  row("in the band, at random",
      near(mesh, [&](test::Random& r) -> Vec3 { return band * r(0, 1) * r.direction(); }));
  row("0.1 to 0.5 m away, at random",
      near(mesh, [](test::Random& r) -> Vec3 { return r(0.1, 0.5) * r.direction(); }));
  set_threads(most);
}

// 1.5 m x 1.5 m, 10 k vertices, 0.2 kg/m^2, stretch 1000 N/m, falls on the ball from 3 cm
// above and drapes over it.
struct FallingSheet {
  TriangleMesh mesh;
  System system;
  Constraints constraints;
  State state;

  FallingSheet(const Shape& body, const Motion& motion)
      : mesh(grid(100, 100, 1.5, 1.5)), system(lumped_mass(mesh, 0.2)) {
    for (Vec3& x : mesh.positions) x.y() += 0.65;
    state = at_rest(mesh);
    Fabric fabric;
    fabric.area_density = 0.2;
    fabric.stretch = 1000;
    fabric.bend = 1e-5;
    fabric.damping = 0.005;
    system.add(noh_jung(mesh, fabric));
    system.add(Gravity{});
    constraints.add(Obstacle{.shape = body, .friction = 0.3, .motion = motion});
    std::vector<ClothFace> faces;
    for (const Triangle& t : mesh.triangles) faces.push_back({{t[0], t[1], t[2]}, fabric.stretch});
    constraints.add_faces(faces);
    system.add(face_contact_force(constraints));
  }
};

void bench_fall(const std::string& name, const Shape& body, const Motion& motion) {
  const int most = threads();
  const std::vector<int> thread_counts = most > 1 ? std::vector{1, 2} : std::vector{1};
  struct Samples {
    std::vector<double> assemble, solve, collide, touching;
  };
  FallingSheet sheet(body, motion);
  ImplicitEuler stepper(sheet.system, sheet.constraints, make_linear_solver("mpcg"));
  std::vector<Samples> fall(thread_counts.size()), drape(thread_counts.size());
  for (int k = 0; k < 140; ++k) {
    const auto turn = static_cast<std::size_t>(k) % thread_counts.size();
    set_threads(thread_counts[turn]);
    const StepReport r = stepper.advance(sheet.state, 0.01);
    Samples& s = (k < 40 ? fall : drape)[turn];
    s.assemble.push_back(r.assemble_ms);
    s.solve.push_back(r.solve_ms);
    s.collide.push_back(r.collide_ms);
    s.touching.push_back(r.contacts);
  }
  const auto rows = [&](const char* when, const std::vector<Samples>& samples) {
    for (std::size_t t = 0; t < samples.size(); ++t) {
      const Samples& s = samples[t];
      const double solve = median(s.solve), collide = median(s.collide);
      std::printf("%-24s %-8s %8d %9.0f %12.2f %10.2f %11.2f %16.2f\n", t ? "" : name.c_str(), t ? "" : when,
                  thread_counts[t], median(s.touching), median(s.assemble), solve, collide, collide / solve);
    }
  };
  rows("falls", fall);
  rows("drapes", drape);
  std::fflush(stdout);
  set_threads(most);
}

void bench_falls() {
  const auto surface = std::make_shared<SurfaceDistance>(bumpy_ball());
  std::printf("\n%-24s %-8s %8s %9s %12s %10s %11s %16s\n", "10 k vertices on", "", "threads", "touching",
              "assemble ms", "solve ms", "contact ms", "contact / solve");
  bench_fall("mesh at rest", MeshBody(surface), {});
  bench_fall("mesh, turning 1 rad/s", MeshBody(surface),
             Motion::constant(Vec3::Zero(), Vec3::UnitY(), Vec3::Zero()));
  const TriangleMesh ball = bumpy_ball();
  auto frames = std::make_shared<MeshFrames>();
  frames->add(0, ball.positions);
  std::vector<Vec3> swollen = ball.positions;
  for (Vec3& x : swollen) x = 1.05 * x + Vec3(0.1 * x.y(), 0, 0);
  frames->add(1, swollen);
  bench_fall("mesh that deforms", DeformingBody{std::make_shared<SurfaceDistance>(ball), frames}, {});
  bench_fall("its level set",
             std::make_shared<const LevelSet>(LevelSet::from_mesh(bumpy_ball(), {.voxel = 0.005})), {});
}

}  // namespace

int main(int argc, char** argv) {
  const double voxel = argc > 2 ? std::atof(argv[2]) : 0;
  if (argc > 1)
    bench_body(drape::read_obj(argv[1]), argv[1], voxel);
  else
    bench_body(bumpy_ball(), "bumpy ball", voxel);
  if (argc == 1) bench_falls();
  return 0;
}
