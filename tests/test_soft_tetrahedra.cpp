// Soft bodies of tetrahedra, by springs along their edges and by clusters: what a modulus means, and how they
// move.
#include <catch2/catch.hpp>

#include "mesh/tetrahedra/msh.h"
#include "solver/forces/cluster_force.h"
#include "solver/forces/cluster_sets.h"
#include "solver/forces/tetrahedra_springs.h"
#include "tests/same_bits.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double Y = 2e4;  // Pa
const SoftMaterial material{.density = 300, .young = Y, .damping = 0.05};

TetrahedralMesh rabbit() { return read_msh(source_dir() + "/data/meshes/rabbit.msh"); }

double volume(const TetrahedralMesh& mesh) {
  double sum = 0;
  for (const Tetrahedron& t : mesh.tetrahedra) sum += volume_of(mesh, t);
  return sum;
}

struct Body {
  TetrahedralMesh mesh;
  System system;
  Constraints constraints;
  State state;

  Body(TetrahedralMesh m, const std::string& kind)
      : mesh(std::move(m)),
        system(masses(mesh, material)),
        state{0, stacked(mesh.positions), VecX::Zero(3 * mesh.vertex_count())} {
    if (kind == "links")
      system.add(soft_body(mesh, material));
    else
      system.add(clusters(kind));
    system.add(Gravity{});
  }
  std::unique_ptr<Force> clusters(const std::string& kind) const {
    const ParticleSets sets =
        kind == "tetrahedra" ? sets_of(mesh.tetrahedra)
                             : overlapping_sets(mesh.positions, edges_of(mesh), std::stoi(kind), 1, "body");
    Clusters all(sets, system.masses(), state.x, "body");
    const double k = cluster_stiffness(all, Y, material.density);
    return std::make_unique<ClusterForce>(std::move(all), k);
  }
  std::unique_ptr<Integrator> pbd(int substeps) {
    StepOptions options;
    options.projection.substeps = substeps;
    return make_integrator("pbd", system, constraints, make_linear_solver("mpcg"), options);
  }
};

constexpr std::array kinds = {"links", "tetrahedra", "1", "12"};

}  // namespace

TEST_CASE("a body that swells stores what its modulus says", "[soft]") {
  for (const char* kind : kinds) {
    INFO(kind);
    const Body body(rabbit(), kind);
    constexpr double e = 1e-4;
    // Of springs the solid of Poisson's ratio 1/4, 9/2 K e^2 with K = 2/3 Y; of clusters three times Y e^2 /
    // 2.
    const double expected = (kind == std::string("links") ? 3 : 1.5) * Y * e * e * volume(body.mesh);
    CHECK(body.system.elastic_energy((1 + e) * body.state.x) == Approx(expected).epsilon(1e-3));
  }
}

TEST_CASE("springs along the edges of a body resist by its modulus, whatever the direction", "[soft]") {
  const Body body(rabbit(), "links");
  constexpr double e = 1e-4;
  for (const Vec3& n : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 1, 0), Vec3(1, -2, 3)}) {
    const Vec3 along = n.normalized();
    VecX x = body.state.x;
    for (int i = 0; i < body.mesh.vertex_count(); ++i)
      x.segment<3>(3 * i) += e * along.dot(body.state.x.segment<3>(3 * i)) * along;
    INFO(along.transpose());
    CHECK(body.system.elastic_energy(x) ==
          Approx(0.6 * Y * e * e * volume(body.mesh)).epsilon(0.08));  // the mesh has a grain
  }
}

TEST_CASE("the force of clusters is the slope of their energy", "[soft]") {
  for (const char* kind : {"tetrahedra", "12"}) {
    const Body body(rabbit(), kind);
    const VecX x = body.state.x + random_vector(body.state.x.size(), 0.004, 3),
               way = random_vector(x.size(), 1, 4);
    constexpr double s = 1e-7;
    const Force& force = *body.system.forces()[0];
    VecX f = VecX::Zero(x.size());
    force.add_force(x, VecX::Zero(x.size()), f);
    const double slope = (force.energy(x + s * way) - force.energy(x - s * way)) / (2 * s);
    INFO(kind);
    CHECK(-f.dot(way) == Approx(slope).epsilon(1e-5));
  }
}

TEST_CASE("a soft body falls as any body does, and turns on", "[soft][pbd]") {
  for (const char* kind : kinds) {
    Body body(rabbit(), kind);
    Vec3 centre = Vec3::Zero();
    double mass = 0;
    for (int i = 0; i < body.mesh.vertex_count(); ++i) {
      mass += body.system.masses()[static_cast<std::size_t>(i)];
      centre += body.system.masses()[static_cast<std::size_t>(i)] *
                body.mesh.positions[static_cast<std::size_t>(i)];
    }
    centre /= mass;
    const Vec3 spin(1, 2, 0.5);
    const auto turning = [&] {
      Vec3 L = Vec3::Zero(), c = Vec3::Zero();
      for (int i = 0; i < body.mesh.vertex_count(); ++i)
        c += body.system.masses()[static_cast<std::size_t>(i)] / mass * body.state.x.segment<3>(3 * i);
      for (int i = 0; i < body.mesh.vertex_count(); ++i)
        L += body.system.masses()[static_cast<std::size_t>(i)] *
             Vec3(body.state.x.segment<3>(3 * i) - c).cross(Vec3(body.state.v.segment<3>(3 * i)));
      return L;
    };
    for (int i = 0; i < body.mesh.vertex_count(); ++i)
      body.state.v.segment<3>(3 * i) = spin.cross(Vec3(body.state.x.segment<3>(3 * i) - centre));
    const Vec3 before = turning();
    auto stepper = body.pbd(20);
    for (int n = 0; n < 20; ++n) REQUIRE(stepper->advance(body.state, 0.01).done);
    Vec3 fallen = -centre;
    for (int i = 0; i < body.mesh.vertex_count(); ++i)
      fallen += body.system.masses()[static_cast<std::size_t>(i)] / mass * body.state.x.segment<3>(3 * i);
    INFO(kind);
    CHECK((fallen - Vec3(0, -0.5 * 9.81 * 0.2 * (0.2 + 0.0005), 0)).norm() < 1e-9);
    CHECK((turning() - before).norm() < 0.02 * before.norm());
  }
}

TEST_CASE("a soft body stays where it stands on the floor", "[soft][pbd]") {
  for (const char* kind : kinds) {
    Body body(rabbit(), kind);
    double lowest = 1, highest = -1;
    for (const Vec3& x : body.mesh.positions)
      lowest = std::min(lowest, x[1]), highest = std::max(highest, x[1]);
    body.constraints.add(Obstacle{.shape = Plane{{0, lowest - 0.01, 0}, {0, 1, 0}}, .friction = 0.5});
    auto stepper = body.pbd(20);
    for (int n = 0; n < 400; ++n) REQUIRE(stepper->advance(body.state, 0.01).done);
    double up = -1, down = 1;
    for (int i = 0; i < body.mesh.vertex_count(); ++i)
      up = std::max(up, body.state.x[3 * i + 1]), down = std::min(down, body.state.x[3 * i + 1]);
    double mass = 0;
    for (const double m : body.system.masses()) mass += m;
    const double speed = std::sqrt(2 * body.system.kinetic_energy(body.state.v) / mass);
    INFO(kind << ", " << speed << " m/s");
    CHECK(speed < 0.2);  // thin ears swing on: only damping would stop them
    CHECK(down > lowest - 0.01);
    CHECK(up - down > 0.8 * (highest - lowest));
  }
}

TEST_CASE("clusters have no matrix: implicit integrators say so, explicit ones take them", "[soft]") {
  Body body(rabbit(), "12");
  CHECK_THROWS_WITH(
      make_integrator("implicit-euler", body.system, body.constraints, make_linear_solver("mpcg")),
      Catch::Contains("'clusters' has no stiffness") && Catch::Contains("pbd"));
  auto stepper =
      make_integrator("symplectic-euler", body.system, body.constraints, make_linear_solver("mpcg"));
  CHECK(stepper->advance(body.state, 1e-4).done);
  Body springs(rabbit(), "links");
  SoftMaterial kinds_of_springs = material;
  kinds_of_springs.young.reset();
  CHECK_THROWS_WITH(soft_body(springs.mesh, kinds_of_springs), Catch::Contains("takes young"));
}

TEST_CASE("a body of clusters has the same bits on any number of threads", "[soft][pbd]") {
  check_same_bits([] {
    const Lattice block = box_lattice({16, 16, 16}, Vec3::Constant(0.02));  // 4096 particles, 3375 cells
    const std::vector<double> own = masses(block, material);
    System system(own);
    Clusters clusters(sets_of_cells(block), own, stacked(block.positions), "block");
    system.add(std::make_unique<ClusterForce>(std::move(clusters), 1e5));
    system.add(Gravity{});
    Constraints constraints;
    constraints.pin({0, 1, 2});
    State state{0, stacked(block.positions), random_vector(3 * block.particle_count(), 0.1, 2)};
    StepOptions options;
    options.projection.substeps = 3;
    auto stepper = make_integrator("pbd", system, constraints, make_linear_solver("mpcg"), options);
    for (int n = 0; n < 2; ++n) REQUIRE(stepper->advance(state, 0.01).done);
    return state;
  });
}
