// Soft bodies in motion: they fall on a plane, a tilted plane, a ball and into a bowl by every integrator and
// make no energy; steps allocate nothing and have the same bits on any number of threads.
#include <functional>

#include "tests/allocations.h"
#include "tests/integrators.h"
#include "tests/same_bits.h"

using namespace drape;
using namespace drape::test;

namespace {

// A cube of n^3 particles, 30 cm wide and turned a little, in the air.
struct Cube {
  System system;
  Constraints constraints;
  State state;

  explicit Cube(int n, double height = 0.5, double damping = 0.3)
      : Cube(box_lattice({n, n, n}, Vec3::Constant(0.3 / (n - 1))), height, damping) {}

  Cube(const Lattice& lattice, double height, double damping) : system(masses(lattice, material(damping))) {
    system.add(soft_body(lattice, material(damping)));
    system.add(Gravity{});
    state = {0, moved_rigidly(stacked(lattice.positions), rotation(0.5, {1, 0.3, 0.2}), {0, height, 0}),
             VecX::Zero(3 * lattice.particle_count())};
  }

  static SoftMaterial material(double damping) {
    return {.density = 200, .young = {}, .structural = 1500, .shear = 800, .bend = 300, .damping = damping};
  }

  void add_faces(const Lattice& lattice) {
    std::vector<int> particles;
    std::vector<ClothFace> faces;
    for (const Triangle& t : surface_of(lattice, particles).triangles)
      faces.push_back({{particles[t[0]], particles[t[1]], particles[t[2]]}, 1500});
    constraints.add_faces(faces);
  }

  double energy() const {  // J
    return system.elastic_energy(state.x) + system.kinetic_energy(state.v) + system.gravity_energy(state.x);
  }
  double mass() const {
    double sum = 0;
    for (double m : system.masses()) sum += m;
    return sum;
  }
};

struct Terrain {
  const char* name;
  Shape shape;
};

std::vector<Terrain> terrains() {
  return {{"plane", Plane{{0, 0, 0}, {0, 1, 0}}},
          {"tilted plane", Plane{{0, 0, 0}, Vec3(0.35, 1, 0).normalized()}},
          {"sphere", Sphere{{0.05, -0.4, 0}, 0.4}},
          {"bowl", Bowl{.centre = {-0.1, 0.6, 0}, .radius = 0.6, .thickness = 0.05}}};
}

}  // namespace

TEST_CASE("a soft cube falls on the terrains of the soft-cube report by every integrator and makes no energy",
          "[soft]") {
  for (const Terrain& terrain : terrains())
    for (const Method& method : methods()) {
      for (const bool rebounds : {false, true}) {
        if (rebounds && (method.contact || !is_explicit(method.name))) continue;
        // Of damped vibrations sb-implicit bears the shortest steps.
        const double h = method.name == "sb-implicit" ? 5e-4 : 1e-3;
        INFO(method.label << " on the " << terrain.name << (rebounds ? ", restitution 0" : ""));
        Cube cube(4, 0.35, 1.8);  // within the limits of explicit-euler (damping / stiffness) and sb-implicit
        cube.constraints.add(
            Obstacle{.shape = terrain.shape, .friction = 0.3, .margin = 0.004, .restitution = 0});
        StepOptions options = method.options();
        if (rebounds) options.contact = ContactMode::restitution;
        auto stepper =
            make_integrator(method.name, cube.system, cube.constraints, make_linear_solver("mpcg"), options);
        const double start = cube.energy(), weight = cube.mass() * 9.81;
        double most = -1e300, lowest = start;
        int contacts = 0;
        for (int k = 1; k * h <= 0.4; ++k) {
          const StepReport report = stepper->advance(cube.state, h);
          INFO("step " << k << ": " << report.failure.what);
          REQUIRE(report.done);
          contacts = std::max(contacts, report.contacts);
          // What explicit Euler makes in a free fall: m g^2 h t / 2.
          const double own = method.name == "explicit-euler" ? 0.5 * weight * 9.81 * h * k * h : 0;
          most = std::max(most, cube.energy() - own - start);
          lowest = std::min(lowest, cube.energy());
        }
        CHECK(contacts > 0);
        CHECK(lowest < start - 0.1 * weight * 0.1);  // the impact took some
        // Of the energy of the fall; adaptive methods to their tolerance.
        CHECK(most < (order_of(method.name) == 0 ? 1e-3 : 1e-9) * weight);
      }
    }
}

TEST_CASE("a soft cube comes to rest on a plane, and its particles stay out of it", "[soft]") {
  const Lattice lattice = box_lattice({5, 5, 5}, Vec3::Constant(0.075));
  Cube cube(lattice, 0.4, 3);
  cube.add_faces(lattice);
  cube.constraints.add(Obstacle{.shape = Sphere{{0, -0.4, 0}, 0.4}, .friction = 0.6, .margin = 0.004});
  cube.constraints.add(Obstacle{.shape = Plane{{0, -0.4, 0}, {0, 1, 0}}, .friction = 0.6, .margin = 0.004});
  auto stepper = make_integrator("implicit-euler", cube.system, cube.constraints, make_linear_solver("mpcg"));
  for (int k = 0; k < 600; ++k) {
    REQUIRE(stepper->advance(cube.state, 0.01).done);
    for (double depth : cube.constraints.penetration(cube.state.x)) REQUIRE(depth < 1e-9);
  }
  CHECK(max_speed(cube.state) < 0.02);
}

TEST_CASE("a soft body's step allocates nothing after the first", "[soft]") {
  if (!counts_allocations()) {
    WARN("skipped: allocations are not counted under the sanitizers");
    return;
  }
  const ThreadsRestored restored;
  for (const int t : {1, 2})
    for (const char* name : {"implicit-euler", "symplectic-euler"}) {
      set_threads(t);
      Cube cube(16, 0.25);  // more particles than one thread takes alone
      cube.constraints.add(Obstacle{.shape = Plane{}});
      auto stepper = make_integrator(name, cube.system, cube.constraints, make_linear_solver("mpcg"));
      const double h = name[0] == 'i' ? 0.01 : 2e-4;
      stepper->advance(cube.state, h);
      stepper->advance(cube.state, h);
      const long before = allocations();
      bool done = true;
      for (int n = 0; n < 8; ++n) done = stepper->advance(cube.state, h).done && done;
      const long used = allocations() - before;
      CHECK(done);
      INFO(name << ", " << t << " threads");
      CHECK(used == 0);
    }
}

TEST_CASE("a soft body has the same bits on any number of threads", "[soft]") {
  for (const char* name : {"implicit-euler", "rk4"})
    check_same_bits([&] {
      Cube cube(16, 0.25);
      cube.constraints.add(Obstacle{.shape = Plane{}});
      auto stepper =
          make_integrator(name, cube.system, cube.constraints, make_linear_solver("mpcg+block-ic0"));
      for (int n = 0; n < 6; ++n) REQUIRE(stepper->advance(cube.state, name[0] == 'i' ? 0.01 : 2e-4).done);
      return cube.state;
    });
  const TriangleMesh ball = drape::sphere(3, 0.3);
  Lattice first;
  const ThreadsRestored restored;
  for (int t : {1, 2, 7}) {
    set_threads(t);
    const Lattice lattice = filled_lattice(ball, 0.04, "ball");
    if (t == 1) first = lattice;
    CHECK(same_bits(stacked(lattice.positions), stacked(first.positions)));
  }
}
