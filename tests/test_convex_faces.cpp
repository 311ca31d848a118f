// The flat faces of convex bodies, and bodies that rest on them however they are turned.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "constraints/contact_step.h"
#include "constraints/convex_faces.h"
#include "mesh/triangles/generate.h"
#include "solver/system/state.h"
#include "tests/shapes.h"

using namespace drape;
using namespace drape::internal;
using namespace drape::test;

namespace {

// Each triangle in four, so many times.
TriangleMesh subdivided(TriangleMesh mesh, int times) {
  for (; times > 0; --times) {
    TriangleMesh fine;
    fine.positions = mesh.positions;
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), fine.vertex_count());
      if (fresh) fine.positions.push_back((mesh.positions[a] + mesh.positions[b]) / 2);
      return at->second;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle& t : {Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}})
        fine.triangles.push_back(t);
    }
    mesh = fine;
  }
  return mesh;
}

std::vector<Mat3> turns(int count) {
  std::vector<Mat3> all = {Mat3::Identity()};
  // Faces with sides that are square to the x axis of their plane but for rounding.
  for (const auto& [z, x] : {std::pair(5.0, 5.0), {10, 10}, {45, 30}, {30, 20}})
    all.emplace_back(Eigen::AngleAxisd(z * M_PI / 180, Vec3::UnitZ()) *
                     Eigen::AngleAxisd(x * M_PI / 180, Vec3::UnitX()));
  for (int k = 1; k < count; ++k) {
    const Eigen::Quaterniond q(std::cos(1.3 * k), std::sin(2.1 * k), std::cos(3.7 * k + 1),
                               std::sin(0.7 * k));
    all.push_back(q.normalized().toRotationMatrix());
  }
  return all;
}

// As a file of `digits` digits after the point has it, in metres.
TriangleMesh turned(TriangleMesh mesh, const Mat3& R, double digits) {
  const double unit = std::pow(10, -digits);
  for (Vec3& x : mesh.positions) {
    x = R * x;
    if (digits > 0) x = unit * (x / unit).array().round();
  }
  return mesh;
}

// With a vertex that belongs to no triangle.
TriangleMesh with_stray_vertex(TriangleMesh mesh, const Vec3& x) {
  mesh.positions.insert(mesh.positions.begin(), x);
  for (Triangle& t : mesh.triangles)
    for (int& v : t) ++v;
  return mesh;
}

}  // namespace

TEST_CASE("a box of triangles has six faces of four corners, however it is turned and divided",
          "[shapes][meeting]") {
  const Vec3 size(0.2, 0.15, 0.3);
  for (const Mat3& R : turns(8))
    for (const int times : {0, 2, 3})
      for (const double digits : {0, 7}) {
        const TriangleMesh mesh = turned(subdivided(box_mesh(size), times), R, digits);
        INFO(times << " times, " << digits << " digits, turned by\n" << R);
        const std::vector<ConvexFace> faces = convex_faces(mesh);
        REQUIRE(faces.size() == 6);
        for (const ConvexFace& face : faces) {
          const Vec3 n = R.transpose() * face.normal;
          int axis = 0;
          CHECK(n.cwiseAbs().maxCoeff(&axis) == Approx(1).margin(1e-5));
          CHECK(face.offset == Approx(size[axis] / 2).margin(1e-6));
          if (digits == 0) REQUIRE(face.corners.size() == 4);
          Vec3 area = Vec3::Zero();
          const auto at = [&](std::size_t k) {
            return mesh.positions[face.corners[k % face.corners.size()]];
          };
          for (std::size_t k = 0; k < face.corners.size(); ++k) area += at(k).cross(at(k + 1)) / 2;
          CHECK(area.dot(face.normal) == Approx(size.prod() / size[axis]).epsilon(1e-4));
        }
        for (const ConvexFace& face : faces)
          for (const Vec3& x : mesh.positions) CHECK(face.normal.dot(x) <= face.offset + 4e-7);
      }
}

TEST_CASE("every triangle of a round mesh is a face", "[shapes][meeting]") {
  const TriangleMesh ball = sphere(2, 0.1);
  const std::vector<ConvexFace> faces = convex_faces(ball);
  CHECK(static_cast<int>(faces.size()) == ball.triangle_count());
  for (const ConvexFace& face : faces) CHECK(face.corners.size() == 3);
}

TEST_CASE("a brick rests on a ground that is turned in any way as on one that lies level", "[meeting]") {
  const Vec3 slab(2, 0.1, 1), brick(0.1, 0.05, 0.1);
  for (const Mat3& R : turns(8))
    for (const int times : {-1, 0, 1, 3})
      for (const double h : {0.01, 0.005}) {
        INFO("ground divided " << times << " times, step " << h << " s, turned by\n" << R);
        Constraints constraints;
        const TriangleMesh mesh = turned(subdivided(box_mesh(slab), std::max(times, 0)), R, 6);
        const Vec3 under_brick = (slab[1] / 2 + 0.01) * R.col(1) + 0.15 * R.col(0);
        if (times < 0)
          constraints.add(
              {.shape = Box{.centre = Vec3::Zero(), .size = slab, .rotation = R}, .friction = 0.3});
        else
          constraints.add({.shape = body(with_stray_vertex(mesh, under_brick)), .friction = 0.3});
        const Vec3 up = R.col(1),
                   start = (slab[1] + brick[1] + 0.002) / 2 * up + 0.15 * R.col(0) + 0.013 * R.col(2);
        Obstacle falling{.shape = Box{.centre = start, .size = brick, .rotation = R}, .friction = 0.3};
        falling.rigid = RigidBody{.mass = 0.5,
                                  .inertia = uniform_solid(falling.shape, 0.5)->inertia,
                                  .centre = start,
                                  .gravity = -9.81 * up};
        constraints.add(falling);
        State state;
        for (int done = 0; done < std::lround(0.5 / h); ++done) {
          ContactStep contacts = constraints.begin_step(state.x, state.v, {}, done * h, h);
          do {
            contacts.receive(state.v, state.v, state.x);
          } while (contacts.move_bodies(0));
          contacts.finish(state.x, state.v);
        }
        const ReactingBody& fallen = *constraints.bodies()[1].reacting();
        const double flat = times < 0 ? 1e-6 : 3e-6;  // a file of six digits is no flatter
        CHECK(up.dot(fallen.centre()) ==
              Approx((slab[1] + brick[1]) / 2 + BodyMeeting::rest_gap).margin(flat));
        CHECK((fallen.centre() - start - up * up.dot(fallen.centre() - start)).norm() < 1e-3);
        CHECK(fallen.velocity().norm() < 1e-3);
      }
}
