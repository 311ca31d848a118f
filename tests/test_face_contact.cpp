// Faces of the cloth against corners and rims of bodies: the force and its derivatives, and that nothing
// sharp comes through between the vertices.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "mesh/triangles/generate.h"
#include "solver/assembly/assembly.h"
#include "solver/forces/face_contact_force.h"
#include "tests/same_bits.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double margin = 4e-3;  // m

std::vector<ClothFace> faces_of(const TriangleMesh& mesh, double stiffness = 500) {
  std::vector<ClothFace> faces;
  for (const Triangle& t : mesh.triangles) faces.push_back({{t[0], t[1], t[2]}, stiffness});
  return faces;
}

// A cloth of coarse triangles, with its faces.
struct CoarseCloth {
  TriangleMesh mesh;
  System system;
  Constraints constraints;
  State state;

  CoarseCloth(TriangleMesh m, const Vec3& lift, bool with_faces = true, const Vec3& g = {0, -9.81, 0})
      : mesh(std::move(m)), system(masses(mesh, fabric())), state(at_rest(mesh)) {
    for (int i = 0; i < state.particles(); ++i) state.x.segment<3>(3 * i) += lift;
    system.add(noh_jung(mesh, fabric()));
    system.add(Gravity{g});
    if (!with_faces) return;
    constraints.add_faces(faces_of(mesh));
    system.add(face_contact_force(constraints));
  }
  static Fabric fabric() { return {.area_density = 0.2, .stretch = 500, .bend = 1e-5, .damping = 5e-3}; }

  // The least distance of points spread over all triangles, the vertices and edges among them.
  double lowest() const {
    constexpr int n = 12;
    double least = 1e300;
    for (const Triangle& t : mesh.triangles)
      for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j) {
          const double a = static_cast<double>(i) / n, b = static_cast<double>(j) / n;
          const Vec3 p = a * state.x.segment<3>(3 * t[0]) + b * state.x.segment<3>(3 * t[1]) +
                         (1 - a - b) * state.x.segment<3>(3 * t[2]);
          for (const MovingBody& body : constraints.bodies()) least = std::min(least, body.distance(p));
        }
    return least;
  }
};

// A flat sheet of 30 cm in three kinds of triangles: squares cut in two, equilateral and irregular ones.
constexpr std::array kinds = {0, 1, 2};
TriangleMesh flat_sheet(int n, int kind) {
  if (kind == 1) return equilateral_sheet(n, n, 0.3 / (n - 1));
  TriangleMesh mesh = grid(n, n, 0.3, 0.3);
  const VecX off = random_vector(3 * mesh.vertex_count(), 0.25 * 0.3 / (n - 1), static_cast<unsigned>(n));
  for (int v = 0; kind == 2 && v < mesh.vertex_count(); ++v)
    mesh.positions[v] += Vec3(off[3 * v], 0, off[3 * v + 2]);
  return mesh;
}

Mat3 on_its_corner() {  // of a cube, (1, 1, 1) up
  return Eigen::Quaterniond::FromTwoVectors(Vec3(1, 1, 1), Vec3::UnitY()).toRotationMatrix();
}

}  // namespace

TEST_CASE("the force of a face's contact is the gradient of its energy, and its blocks the derivative",
          "[faces]") {
  TriangleMesh one;
  one.positions = {{-0.1, 0, -0.08}, {0.12, 0.001, -0.07}, {0.01, -0.002, 0.13}};
  one.triangles = {{0, 2, 1}};
  System system(std::vector<double>(3, 0.01));
  Constraints constraints;
  constraints.add(Obstacle{
      .shape = Box{{0.02, -0.105, 0.01}, {0.1, 0.1, 0.1}, on_its_corner()}, .friction = 0.4, .margin = 0.04});
  constraints.add_faces(faces_of(one));
  system.add(face_contact_force(constraints));
  const State state = at_rest(one);
  // It comes from above: what begins at the body is not pushed.
  const VecX fall = stacked({{0, -1, 0}, {0, -1, 0}, {0, -1, 0}}), v = random_vector(9, 0.1, 3) + fall;
  const VecX above = state.x - 0.01 * fall;
  ContactStep contacts = constraints.begin_step(above, v, system.masses(), 0, 0.01);
  system.begin_step({0, 0.01, above, v});
  REQUIRE(constraints.faces().touching().size() == 1);
  contacts.settle_faces(state.x, v);
  const FaceContact& contact = constraints.faces().touching()[0];
  REQUIRE(contact.active);
  CHECK(contact.weights.sum() == Approx(1));
  CHECK(contact.push > 0);

  const Force& force = *system.forces()[0];
  const auto force_at = [&](const VecX& x, const VecX& velocity) {
    VecX f = VecX::Zero(9);
    force.add_force(x, velocity, f);
    return f;
  };
  BlockMatrix A = system.matrix();
  const double c = 0.01, e = 1e-6;
  A.set_to_mass({0, 0, 0});
  VecX b = VecX::Zero(9);
  const VecX y = random_vector(9, 1e-3, 4);
  force.add_linearised(state.x, v, y, c, Stiffness::tangent, A, b);
  Eigen::MatrixXd K(9, 9), D(9, 9);
  VecX gradient(9);
  const VecX still = VecX::Zero(9);
  for (int k = 0; k < 9; ++k) {
    const VecX d = e * VecX::Unit(9, k);
    gradient[k] = (force.energy(state.x + d) - force.energy(state.x - d)) / (2 * e);
    K.col(k) = -(force_at(state.x + d, v) - force_at(state.x - d, v)) / (2 * e);
    D.col(k) = -(force_at(state.x, v + d) - force_at(state.x, v - d)) / (2 * e);
  }
  // Without friction's part, which is no gradient: f(x, v) - f_friction = -dE/dx.
  const VecX friction =
      force_at(state.x + 1e3 * stacked({contact.normal, contact.normal, contact.normal}), v);
  CHECK((force_at(state.x, v) - friction + gradient).norm() < 1e-6 * gradient.norm());
  CHECK((b - c * (force_at(state.x, v) - K * y)).norm() < 1e-6 * b.norm());
  Eigen::MatrixXd whole(9, 9);
  for (int k = 0; k < 9; ++k) {
    VecX rows, product(9), column(9);
    rows.resize(9);
    to_rows(A.pattern(), VecX(VecX::Unit(9, k)), rows);
    A.multiply(rows, product);
    to_particles(A.pattern(), product, column);
    whole.col(k) = column;
  }
  CHECK((whole - c * D - c * c * K).norm() < 1e-6 * whole.norm());
  // Friction rubs against the slip with mu N.
  Vec3 rub = Vec3::Zero();
  for (int k = 0; k < 3; ++k) rub += friction.segment<3>(3 * k);
  CHECK(rub.norm() == Approx(0.4 * contact.push));
  CHECK(rub.dot(contact.slip_at(v)) < 0);
}

TEST_CASE("a corner that comes up under a coarse triangle lifts it and does not come through", "[faces]") {
  TriangleMesh one;
  one.positions = {{-0.2, 0, -0.2}, {0.25, 0, -0.2}, {0, 0, 0.25}};
  one.triangles = {{0, 2, 1}};
  for (const std::string& name :
       {std::string("implicit-euler"), std::string("bdf2"), std::string("newton-kinsol")}) {
    for (double speed : {0.05, 1.0}) {
      INFO(name << " " << speed);
      CoarseCloth cloth(one, {0, 0.1, 0}, true, Vec3::Zero());
      const Box cube{{0, 0, 0}, {0.1, 0.1, 0.1}, on_its_corner()};  // its corner at 0.0866
      cloth.constraints.add(Obstacle{.shape = cube,
                                     .friction = 0.5,
                                     .margin = margin,
                                     .motion = Motion::constant({0, speed, 0}, Vec3::Zero(), Vec3::Zero())});
      auto stepper = make_integrator(name, cloth.system, cloth.constraints, make_linear_solver("mpcg"));
      for (int n = 0; n < 60; ++n) {
        REQUIRE(stepper->advance(cloth.state, 0.01).done);
        REQUIRE(cloth.lowest() > 0);
      }
      double height = 0;
      for (int i = 0; i < 3; ++i) height += cloth.state.x[3 * i + 1] / 3;
      CHECK(height > 0.0866 + 0.6 * speed - 0.03);  // it tilts
    }
  }
}

TEST_CASE("a coarse cloth on a sharp table keeps off its rims and corners", "[faces]") {
  for (bool with_faces : {true, false}) {
    CoarseCloth cloth(grid(11, 11, 1, 1), {0.03, 0.12, 0.02}, with_faces);
    cloth.constraints.add(Obstacle{.shape = Box{{0, 0, 0}, {0.57, 0.2, 0.63}}, .margin = margin});
    ImplicitEuler stepper(cloth.system, cloth.constraints, make_linear_solver("mpcg"));
    double lowest = 1,
           speed = 0;  // the speed is the mean of the last 200 steps: a few coarse folds still snap
    for (int n = 0; n < 500; ++n) {
      REQUIRE(stepper.advance(cloth.state, 0.01).done);
      lowest = std::min(lowest, cloth.lowest());
      if (n >= 300) speed += max_speed(cloth.state) / 200;
    }
    if (with_faces) {
      CHECK(lowest > -margin);    // never, however it fell
      CHECK(cloth.lowest() > 0);  // and at rest clear of it
      CHECK(speed < 0.1);
    } else {
      CHECK(lowest < -margin);  // the vertices alone let it through: this is what the faces are for
    }
  }
}

TEST_CASE("a sheet that is thrown at a free body gives it what it loses, also where a step is cut short",
          "[faces]") {
  int rescues = 0, guarded = 0;  // the latter of 36 runs
  for (const ClothModel model : {ClothModel::woven, ClothModel::noh_jung})
    for (const int n : {7, 13, 25})
      for (const int kind : kinds)
        for (const double fall : {0.0, 9.81}) {
          INFO(n << " vertices along an edge, "
                 << "kind " << kind << ", " << (model == ClothModel::woven ? "woven" : "springs")
                 << ", g = " << fall);
          const double mass = 0.5;
          const Vec3 centre(0.17, -0.09, 0.14), speed(0, -2, 0.5), g(0, -fall, 0);
          Assembly both(g);
          both.add({.mesh = flat_sheet(n, kind),
                    .fabric = {.area_density = 0.2, .stretch = 500, .bend = 1e-5},
                    .model = model});
          both.constraints->add(Obstacle{
              .shape = Box{centre, {0.1, 0.08, 0.1}, on_its_corner()},
              .friction = 0.3,
              .margin = 2e-3,
              .rigid = RigidBody{
                  .mass = mass, .inertia = mass / 600 * Mat3::Identity(), .centre = centre, .gravity = g}});
          both.use("implicit-euler", "auto", {});
          for (int i = 0; i < both.state.particles(); ++i) both.state.v.segment<3>(3 * i) = speed;
          double cloth_mass = 0;
          for (const double m : both.system->masses()) cloth_mass += m;
          const auto momentum = [&] {
            Vec3 p = both.constraints->bodies()[0].reacting()->momentum();
            for (int i = 0; i < both.state.particles(); ++i)
              p += both.system->masses()[i] * both.state.v.segment<3>(3 * i);
            return p;
          };
          bool stopped = false;  // by what knows no momentum
          while (both.state.time < 0.0999) {
            const StepReport report = both.advance(0.01);
            REQUIRE(report.done);
            CHECK(report.converged);
            rescues += report.rescues;
            stopped = stopped || report.guarded > 0;
          }
          guarded += stopped;
          const Vec3 expected = cloth_mass * speed + (cloth_mass + mass) * both.state.time * g;
          CHECK((momentum() - expected).norm() < (stopped ? 2e-2 : 3e-4) * cloth_mass * speed.norm());
          // In steps of 1 ms it gets 0.003 to 0.007 m/s without gravity, and 0.013 where edges are longest.
          CHECK(both.constraints->bodies()[0].reacting()->velocity().norm() > 0.003);
        }
  CHECK(rescues > 3);
  CHECK(guarded <= 6);
}

TEST_CASE("what begins within the margin of a body comes out to it and gains no speed", "[faces]") {
  struct Start {
    int n, kind;
    double margin;  // m
  };
  std::vector<Start> starts;
  for (const int n : {4, 9, 17})
    for (const int kind : kinds)
      for (const double margin_of_body : {0.01, 0.05, 0.2}) starts.push_back({n, kind, margin_of_body});
  for (const std::string integrator : {"implicit-euler", "bdf2", "newton-kinsol", "pbd"})
    for (const auto& [n, kind, wide] : starts) {
      INFO(integrator << ", " << n << " vertices along an edge, kind " << kind << ", a margin of " << wide
                      << " m");
      CoarseCloth cloth(flat_sheet(n, kind), {0, 1e-3, 0});
      cloth.constraints.add(Obstacle{.shape = Plane{}, .margin = wide});
      const auto stepper =
          make_integrator(integrator, cloth.system, cloth.constraints, make_linear_solver("mpcg"));
      const double slowly = 0.25;  // m/s, recovery_speed
      for (int k = 0; k < 100; ++k) {
        REQUIRE(stepper->advance(cloth.state, 0.01).done);
        // Methods that answer contact after the motion have the last step of it as a speed.
        CHECK(max_speed(cloth.state) < (integrator == "pbd" ? slowly + 1e-6 : 1e-6));
        const double thrown = integrator == "pbd" ? slowly * slowly / (2 * 9.81) : 0;  // m
        CHECK(cloth.lowest() < std::min(wide + thrown, 1e-3 + slowly * cloth.state.time) + 1e-6);
      }
      CHECK(cloth.lowest() > 0.99 * wide);
    }
}

TEST_CASE("what lies flat is held by its vertices, and its faces touch nothing", "[faces]") {
  CoarseCloth cloth(grid(9, 9, 0.3, 0.3), {0, 0.05, 0});
  cloth.constraints.add(Obstacle{.shape = Plane{}, .margin = margin});
  ImplicitEuler stepper(cloth.system, cloth.constraints, make_linear_solver("mpcg"));
  for (int n = 0; n < 150; ++n) REQUIRE(stepper.advance(cloth.state, 0.01).done);
  for (const FaceContact& c : cloth.constraints.faces().touching()) CHECK_FALSE(c.active);
  for (int i = 0; i < cloth.state.particles(); ++i)
    CHECK(cloth.state.x[3 * i + 1] == Approx(margin).margin(1e-9));
}

TEST_CASE("faces give the same bits with 1, 2 and 7 threads", "[faces]") {
  check_same_bits([] {
    CoarseCloth cloth(grid(61, 61, 1, 1), {0.03, 0.11, 0.02});
    cloth.constraints.add(
        Obstacle{.shape = Box{{0, 0, 0}, {0.57, 0.2, 0.63}, rotation(0.3, {1, 1, 0})}, .margin = margin});
    ImplicitEuler stepper(cloth.system, cloth.constraints, make_linear_solver("mpcg"), {.tolerance = 1e-3});
    for (int n = 0; n < 25; ++n) REQUIRE(stepper.advance(cloth.state, 0.01).done);
    REQUIRE_FALSE(cloth.constraints.faces().touching().empty());
    return cloth.state;
  });
}
