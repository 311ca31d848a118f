// What the guard of cloth against cloth leaves alone: pins, what lies on a body, and the motion that all share.
#include <random>

#include "constraints/self_contact.h"
#include "tests/integrators.h"

using namespace drape;
using namespace drape::test;

namespace {

// A sheet of n x n vertices above another one, which are told to go somewhere.
struct Guarded {
  explicit Guarded(int n) : sheet(grid(n, n, 0.1, 0.1)) {
    std::vector<Vec3> places = sheet.positions;
    for (const Vec3& x : sheet.positions) places.push_back(x + Vec3(0.003, 0.004, 0.002));
    step.h = 0.01;
    step.x = stacked(places);
    step.masses.assign(places.size(), 1e-4);
    step.held.assign(places.size(), 0);
    std::vector<SelfFace> faces;
    for (int first : {0, sheet.vertex_count()})
      for (const Triangle& t : sheet.triangles)
        faces.push_back({{first + t[0], first + t[1], first + t[2]}, 1e-3, 0.3});
    contacts.add(faces);
    x_new = step.x;
  }
  int half() const { return sheet.vertex_count(); }
  void move(int particle, const Vec3& way) { x_new.segment<3>(3 * particle) += way; }
  Vec3 way(int particle) const { return (x_new - step.x).segment<3>(3 * particle); }
  int guard() {
    step.v = (x_new - step.x) / step.h;
    VecX v_new = step.v;
    contacts.begin_step(step, {}, 1e-3, implicit_kappa);
    return contacts.guard({}, on_bodies, true, x_new, v_new);
  }

  TriangleMesh sheet;
  StepMotion step;
  SelfContacts contacts;
  std::vector<Contact> on_bodies;
  VecX x_new;
};

}  // namespace

TEST_CASE("the guard keeps the momentum of what is free, and the motion that all have in common",
          "[self-contact]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int n : {3, 5, 8})
    for (const Vec3& common : {Vec3(0, 0, 0), Vec3(0.1, 0, 0), Vec3(0.3, -2, 0.5)}) {
      INFO(n << " vertices along an edge, all move by " << common.transpose());
      Guarded two(n);
      for (int i = 0; i < 2 * two.half(); ++i)
        two.move(i, common + 0.01 * Vec3(number(random), number(random), number(random)));
      const VecX asked = two.x_new;
      CHECK(two.guard() > 0);
      Vec3 lost = Vec3::Zero();
      for (int i = 0; i < 2 * two.half(); ++i) {
        lost += (two.x_new - asked).segment<3>(3 * i);
        CHECK((two.way(i) - common).norm() < 0.05);  // and not held up by all of it
      }
      CHECK(lost.norm() < 1e-9);
    }
}

TEST_CASE("the guard moves no pin, and nothing that lies on a body at rest", "[self-contact]") {
  for (const bool pinned : {true, false}) {
    INFO((pinned ? "pinned" : "on a body"));
    Guarded two(5);
    for (int i = 0; i < two.half(); ++i) {
      if (pinned) two.step.held[i] = 1;
      Contact contact{.particle = i, .plane = {}};
      for (ContactPlane& plane : contact.plane) plane = {0, Vec3::UnitY(), 0, Vec3::Zero()};
      contact.planes = pinned ? 0 : 1;
      two.on_bodies.push_back(contact);
      two.move(two.half() + i, {0, -0.02, 0});
    }
    CHECK(two.guard() > 0);
    for (int i = 0; i < two.half(); ++i) {
      CHECK(two.way(i).isZero(0));
      CHECK(two.way(two.half() + i)[1] > -0.0045);
    }
  }
  Guarded carried(5);  // three pins that are led the same way lead what would meet them
  const Vec3 along(0.1, 0.07, -0.03);
  for (int i = 0; i < carried.half(); ++i) {
    carried.move(i, along);
    carried.move(carried.half() + i, along + Vec3(0, -0.02, 0));
  }
  for (int i : {0, 6, 12}) carried.step.held[i] = 1;
  const VecX asked = carried.x_new;
  CHECK(carried.guard() > 0);
  for (int i : {0, 6, 12}) CHECK((carried.x_new - asked).segment<3>(3 * i).norm() < 1e-15);
  for (int i = 0; i < carried.half(); ++i) CHECK((carried.way(carried.half() + i) - along).norm() < 0.02);

  Guarded led(5);  // a pin at rest, and one that is led into it
  led.step.held[0] = led.step.held[led.half()] = 1;
  for (int i = 0; i < led.half(); ++i) led.move(led.half() + i, {0, -0.02, 0});
  CHECK(led.guard() > 0);
  CHECK(led.way(0).isZero(0));
}
