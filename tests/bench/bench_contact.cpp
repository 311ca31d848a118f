// What a distance to a body costs: the level set against the exact distance to its mesh, at random points
// near the surface and far from it. A bumpy ball of 27 k triangles, 1.2 m across, or the OBJ file that is
// named.
//   drape_bench_contact [BODY.obj [VOXEL in m]]
// Every figure is the median of several repeats, in which one thread and two take turns; points from a fixed
// seed.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "mesh/level_set.h"
#include "mesh/obj.h"
#include "mesh/parallel.h"
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
    all.push_back(mesh.positions[static_cast<std::size_t>(random.below(mesh.vertex_count()))] + off(random));
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
        for (int i = begin; i < end; ++i)
          answers[static_cast<std::size_t>(i)] = body.closest(at[static_cast<std::size_t>(i)]);
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

}  // namespace

int main(int argc, char** argv) {
  const double voxel = argc > 2 ? std::atof(argv[2]) : 0;
  if (argc > 1)
    bench_body(drape::read_obj(argv[1]), argv[1], voxel);
  else
    bench_body(bumpy_ball(), "bumpy ball", voxel);
  return 0;
}
