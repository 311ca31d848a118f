// What dirty meshes have, under woven cloth: triangles without area, which must not let the cloth open.
#include <catch2/catch.hpp>

#include "solver/assembly/assembly.h"
#include "solver/forces/woven.h"
#include "tests/dense.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

struct Dirty {
  const char* name;
  TriangleMesh mesh;
  int held, a, b;  // `held` belongs on the edge from a to b
  double s;        // at a + s (b - a)
};

// Two sheets of 10 x 10 cm, joined along a line by triangles without area; pins hold the first at vertices 0
// and 1.
std::vector<Dirty> dirty_meshes() {
  std::vector<Dirty> all;
  TriangleMesh twice;  // every vertex of the joint twice, at the same place
  twice.positions = {{0, 0, 0},   {0, 0, 0.1},   {0.1, 0, 0}, {0.1, 0, 0.1},
                     {0.1, 0, 0}, {0.1, 0, 0.1}, {0.2, 0, 0}, {0.2, 0, 0.1}};
  twice.triangles = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}, {4, 5, 6}, {5, 7, 6}};
  all.push_back({"vertices twice", twice, 4, 2, 3, 0});
  all.push_back({"vertices twice, the other one", twice, 5, 3, 2, 0});
  TriangleMesh middle;  // a vertex in the middle of an edge that does not know it
  middle.positions = {{0, 0, 0},      {0, 0, 0.1}, {0.1, 0, 0},  {0.1, 0, 0.1},
                      {0.1, 0, 0.03}, {0.2, 0, 0}, {0.2, 0, 0.1}};
  middle.triangles = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {2, 4, 5}, {4, 3, 6}, {4, 6, 5}};
  all.push_back({"a vertex on an edge", middle, 4, 2, 3, 0.3});
  TriangleMesh point = twice;  // a triangle whose corners are all at one place
  point.positions.push_back({0.1, 0, 0});
  point.triangles.push_back({2, 4, 8});
  point.triangles.push_back({8, 5, 6});
  all.push_back({"a triangle at one place", point, 8, 2, 3, 0});
  return all;
}

}  // namespace

TEST_CASE("a triangle without area holds the cloth together", "[woven]") {
  for (const Dirty& dirty : dirty_meshes())
    for (const Vec3& warp : {Vec3(1, 0, 0), Vec3(0, 0, 1)}) {
      INFO(dirty.name << ", warp along " << warp.transpose());
      Assembly all({0, -9.81, 0});
      Fabric fabric{.area_density = 0.2, .stretch = 500, .bend = 1e-5};
      fabric.weave.compression = 0.1;
      ClothPart part{.mesh = dirty.mesh, .fabric = fabric, .model = ClothModel::woven};
      part.warp = warp;
      all.add(part);
      all.constraints->pin({0, 1});
      all.use("implicit-euler", "mpcg+block-ic0", {.tolerance = 1e-8});
      double widest = 0;
      const auto at = [&](int v) { return Vec3(all.state.x.segment<3>(3 * v)); };
      for (int step = 0; step < 100; ++step) {
        REQUIRE(all.advance(0.01).done);
        widest =
            std::max(widest, (at(dirty.held) - (1 - dirty.s) * at(dirty.a) - dirty.s * at(dirty.b)).norm());
      }
      CHECK(widest < 1e-3);
      CHECK(at(6).y() < -0.1);  // it hangs
    }
}

TEST_CASE("the force that holds is minus the slope of its energy, and moves nothing as a whole",
          "[woven][forces]") {
  for (const Dirty& dirty : dirty_meshes()) {
    INFO(dirty.name);
    std::unique_ptr<Force> hold;
    for (std::unique_ptr<Force>& force : woven(dirty.mesh, dirty.mesh, Fabric{}))
      if (force->name() == "hold") hold = std::move(force);
    REQUIRE(hold);
    const VecX rest = stacked(dirty.mesh.positions), still = VecX::Zero(rest.size());
    CHECK(hold->energy(rest) < 1e-25);
    const VecX x = rest + random_vector(rest.size(), 0.02, 3);
    VecX f = still;
    hold->add_force(x, still, f);
    Vec3 sum = Vec3::Zero();
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      VecX up = x, down = x;
      up[k] += 1e-6;
      down[k] -= 1e-6;
      CHECK(f[k] == Approx((hold->energy(down) - hold->energy(up)) / 2e-6).margin(1e-7));
      sum[k % 3] += f[k];
    }
    CHECK(sum.norm() < 1e-12 * f.norm());
    // It is linear: a step is right at once, and its matrix is that of the force.
    System system(std::vector<double>(static_cast<std::size_t>(dirty.mesh.vertex_count()), 1.0));
    std::vector<std::unique_ptr<Force>> alone;
    alone.push_back(std::move(hold));
    system.add(std::move(alone));
    const Force& force = *system.forces()[0];
    BlockMatrix A = system.matrix();
    A.set_to_mass(std::vector<double>(system.masses().size(), 0.0));
    const VecX y = random_vector(rest.size(), 0.01, 8);
    VecX b = still, ended = still;
    const double c = 0.1;
    force.add_linearised(x, still, y, c, Stiffness::tangent, A, b);
    force.add_force(x + y, still, ended);
    CHECK((b - c * ended).norm() < 1e-13 * (1 + b.norm()));
    CHECK((dense(A) / (c * c) * y + ended - f).norm() < 1e-12 * (1 + f.norm()));
  }
}
