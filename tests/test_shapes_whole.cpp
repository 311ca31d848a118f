// Laws of what is said of a shape as a whole, over a list of shapes: its mesh lies on its surface, its box
// holds the mesh, its mass is that of what is inside.
#include <catch2/catch.hpp>

#include "mesh/lattice/solid.h"
#include "mesh/triangles/generate.h"
#include "tests/shapes.h"

using namespace drape;
using namespace drape::test;

namespace {

// What is inside a shape by its distance alone, of density 1: cubes of side h, those that the surface passes
// by shares.
Solid counted(const Shape& shape, double h) {
  const Eigen::AlignedBox3d box = bounds_of(shape);
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (double x = box.min().x() + h / 2; x < box.max().x() + h; x += h)
    for (double y = box.min().y() + h / 2; y < box.max().y() + h; y += h)
      for (double z = box.min().z() + h / 2; z < box.max().z() + h; z += h) {
        const Vec3 at(x, y, z);
        const double share = std::clamp(0.5 - closest(shape, at).distance / h, 0.0, 1.0) * h * h * h;
        volume += share;
        first += share * at;
        second += share * at * at.transpose();
      }
  const Vec3 centre = first / volume;
  second -= volume * centre * centre.transpose();
  return {volume, centre, second.trace() * Mat3::Identity() - second};
}

// int f(rho, z) dz over the axis of a plate, rho its radius at the height z, found by its distance alone.
template <class F>
double over_axis(const Plate& plate, const F& f) {
  constexpr int slices = 4000;
  const double h = plate.height / slices;
  double sum = 0;
  for (int k = 0; k < slices; ++k) {
    const double z = -plate.height / 2 + (k + 0.5) * h;
    double inside = 0, outside = 2 * plate.radius;
    for (int halving = 0; halving < 55; ++halving) {
      const double rho = 0.5 * (inside + outside);
      (closest(plate, {rho, z, 0}).distance < 0 ? inside : outside) = rho;
    }
    sum += h * f(inside, z);
  }
  return sum;
}

}  // namespace

TEST_CASE("a shape's mesh lies on its surface and its box holds it closely", "[shapes]") {
  for (const Case& c : cases()) {
    INFO(name(c.shape));
    const TriangleMesh mesh = mesh_of(c.shape);
    const Eigen::AlignedBox3d box = bounds_of(c.shape);
    Random r;
    for (int i = 0; i < 1000; ++i) CHECK(box.exteriorDistance(c.on_surface(r)) < 1e-14);
    if (mesh.positions.empty()) {
      CHECK(name(c.shape) == "plane");
      continue;
    }
    Eigen::AlignedBox3d of_mesh;
    for (const Vec3& x : mesh.positions) {
      CHECK(std::abs(closest(c.shape, x).distance) < 1e-12);
      CHECK(box.exteriorDistance(x) < 1e-12);
      of_mesh.extend(x);
    }
    CHECK((box.sizes() - of_mesh.sizes()).maxCoeff() < 0.005 * box.sizes().maxCoeff());
    CHECK(box.contains(middle_of(c.shape)));
    const Mat3 axes = axes_of(c.shape);
    CHECK((axes.transpose() * axes - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-14);
    CHECK(axes.determinant() > 0);
  }
}

TEST_CASE("a plane's box ends where the plane does", "[shapes]") {
  CHECK(bounds_of(Plane{{1, 2, 3}, {0, 2, 0}}).max().y() == 2);
  CHECK(std::isinf(bounds_of(Plane{{1, 2, 3}, {0, 2, 0}}).min().y()));
  CHECK(bounds_of(Plane{{1, 2, 3}, {0, 0, -1}}).min().z() == 3);
  CHECK(std::isinf(bounds_of(Plane{{1, 2, 3}, {0, 1, 1}}).max().y()));
}

TEST_CASE("a shape's mass is spread over what is inside it", "[shapes]") {
  constexpr double mass = 3;
  int solids = 0;
  for (const Case& c : cases()) {
    INFO(name(c.shape));
    const auto solid = uniform_solid(c.shape, mass);
    if (!can_react(c.shape)) CHECK_FALSE(solid);
    if (!solid) continue;
    ++solids;
    const Solid grid = counted(c.shape, 0.03), mesh = solid_of(mesh_of(c.shape));
    for (const Solid& other : {grid, mesh}) {
      CHECK(solid->volume == Approx(other.volume).epsilon(0.005));
      CHECK((solid->centre - other.centre).norm() < 1e-3);
      const Mat3 inertia = mass / other.volume * other.inertia;
      CHECK((solid->inertia - inertia).cwiseAbs().maxCoeff() < 0.006 * inertia.maxCoeff());
    }
  }
  CHECK(solids >= 7);
}

TEST_CASE("a plate's moments are those of its slices, and of the ball and the rod that it can be",
          "[shapes]") {
  constexpr double mass = 2;
  for (const auto& [radius, height, rim] : {std::array{0.5, 0.3, 0.1},
                                            {0.5, 0.3, 0.15},
                                            {0.2, 0.9, 0.2},
                                            {0.2, 0.9, 0.15},
                                            {0.5, 0.3, 0.0},
                                            {0.09, 0.02, 0.005}}) {
    INFO(radius << " m, " << height << " m, " << rim << " m");
    const Plate plate{.radius = radius, .height = height, .rim = rim};
    const UniformSolid solid = *uniform_solid(plate, mass);
    const double volume = over_axis(plate, [](double rho, double) { return pi * rho * rho; });
    const double along = over_axis(plate, [](double rho, double) { return pi / 2 * std::pow(rho, 4); });
    const double second = over_axis(plate, [](double rho, double z) { return pi * rho * rho * z * z; });
    CHECK(solid.volume == Approx(volume).epsilon(1e-5));
    CHECK(solid.inertia(1, 1) == Approx(mass / volume * along).epsilon(1e-5));  // the axis is y
    CHECK(solid.inertia(0, 0) == Approx(mass / volume * (along / 2 + second)).epsilon(1e-5));
    CHECK(solid.inertia(2, 2) == Approx(solid.inertia(0, 0)));
  }
  const Plate round{.centre = {1, 2, 3}, .radius = 0.3, .height = 0.6, .rim = 0.3};
  const UniformSolid ball = *uniform_solid(Sphere{{1, 2, 3}, 0.3}, mass);
  CHECK((uniform_solid(round, mass)->inertia - ball.inertia).norm() < 1e-14);
  CHECK(uniform_solid(round, mass)->volume == Approx(ball.volume));
  const Plate rod{.radius = 0.3, .height = 1.6, .rim = 0.3, .axis = {1, 0, 2}};
  const Vec3 half = 0.5 * rod.axis.normalized();
  const UniformSolid capsule = *uniform_solid(Capsule{-half, half, 0.3}, mass);
  CHECK((uniform_solid(rod, mass)->inertia - capsule.inertia).norm() < 1e-14);
  CHECK(uniform_solid(rod, mass)->volume == Approx(capsule.volume));
}

TEST_CASE("a level set weighs as its mesh does, wherever it stands", "[shapes]") {
  const TriangleMesh mesh = capsule(48, 0.2, 0.6);
  const Mat3 rotation = some_rotation();
  const Vec3 translate(1, -2, 3);
  const LevelSetBody grid =
      std::make_shared<const LevelSet>(LevelSet::from_mesh(mesh).moved(rotation, translate));
  const UniformSolid solid = *uniform_solid(Shape(grid), 3);
  const Solid exact = solid_of(mesh);
  CHECK(solid.volume == Approx(exact.volume).epsilon(0.005));
  CHECK((solid.centre - rotation * exact.centre - translate).norm() < 1e-3);
  const Mat3 inertia = 3 / exact.volume * rotation * exact.inertia * rotation.transpose();
  CHECK((solid.inertia - inertia).cwiseAbs().maxCoeff() < 0.005 * inertia.maxCoeff());
  for (const Vec3& x : mesh.positions) CHECK(bounds_of(Shape(grid)).contains(rotation * x + translate));
  CHECK((middle_of(Shape(grid)) - translate).norm() < 1e-12);
}
