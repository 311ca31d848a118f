// What the guard of cloth against cloth leaves alone: pins, what lies on a body, and the motion that all
// share.
#include <random>

#include "constraints/self_contact.h"
#include "tests/integrators.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

namespace {

// Sheets that are told to go somewhere.
struct Guarded {
  explicit Guarded(const std::vector<TriangleMesh>& sheets) : sheet(sheets.front()) {
    std::vector<Vec3> places;
    std::vector<SelfFace> faces;
    for (const TriangleMesh& mesh : sheets) {
      const int first = static_cast<int>(places.size());
      places.insert(places.end(), mesh.positions.begin(), mesh.positions.end());
      for (const Triangle& t : mesh.triangles)
        faces.push_back({{first + t[0], first + t[1], first + t[2]}, 1e-3, 0.3});
    }
    step.h = 0.01;
    step.x = stacked(places);
    step.masses.assign(places.size(), 1e-4);
    step.held.assign(places.size(), 0);
    contacts.add(faces);
    x_new = step.x;
  }
  // A sheet of n x n vertices, and another one above it.
  explicit Guarded(int n)
      : Guarded({grid(n, n, 0.1, 0.1), moved(grid(n, n, 0.1, 0.1), {0.003, 0.004, 0.002})}) {}
  static TriangleMesh moved(TriangleMesh mesh, const Vec3& way) {
    for (Vec3& x : mesh.positions) x += way;
    return mesh;
  }
  int half() const { return sheet.vertex_count(); }
  void move(int particle, const Vec3& way) { x_new.segment<3>(3 * particle) += way; }
  Vec3 way(int particle) const { return (x_new - step.x).segment<3>(3 * particle); }
  void touch_body(int particle, const Vec3& normal = Vec3::UnitY(), bool clamped = false) {
    Contact contact{.particle = particle, .plane = {}};
    for (ContactPlane& plane : contact.plane) plane = {0, normal, 0, Vec3::Zero()};
    contact.planes = 1;
    contact.clamped = clamped;
    on_bodies.push_back(contact);
  }
  GuardReport guard() {
    step.v = (x_new - step.x) / step.h;
    v_new = step.v;
    contacts.begin_step(step, {}, 1e-3, SelfSprings{});
    return contacts.guard({}, on_bodies, true, x_new, v_new);
  }

  TriangleMesh sheet;
  StepMotion step;
  SelfContacts contacts;
  std::vector<Contact> on_bodies;
  VecX x_new, v_new;
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
      CHECK(two.guard().guarded > 0);
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
      if (pinned)
        two.step.held[i] = 1;
      else
        two.touch_body(i);
      two.move(two.half() + i, {0, -0.02, 0});
    }
    const GuardReport report = two.guard();
    CHECK(report.guarded > 0);
    CHECK(report.held == 0);  // a push cannot take away a way that is longer than the cloth is thick
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
  CHECK(carried.guard().guarded > 0);
  for (int i : {0, 6, 12}) CHECK((carried.x_new - asked).segment<3>(3 * i).norm() < 1e-15);
  for (int i = 0; i < carried.half(); ++i) CHECK((carried.way(carried.half() + i) - along).norm() < 0.02);

  Guarded led(5);  // a pin at rest, and one that is led into it
  led.step.held[0] = led.step.held[led.half()] = 1;
  for (int i = 0; i < led.half(); ++i) led.move(led.half() + i, {0, -0.02, 0});
  CHECK(led.guard().guarded > 0);
  CHECK(led.way(0).isZero(0));
}

TEST_CASE(
    "where one pair of a pile would pass, the guard moves a few particles, and those by less than a "
    "thickness",
    "[self-contact]") {
  enum class Lowest { free, pinned, on_a_body };
  const double gap = 1e-3, left = 1e-4;
  const int layers = 20;
  for (int n : {4, 6, 9})
    for (const Kind kind : kinds)
      for (const Lowest lowest : {Lowest::free, Lowest::pinned, Lowest::on_a_body}) {
        INFO(n << " vertices along an edge, kind " << static_cast<int>(kind) << ", lowest layer "
               << static_cast<int>(lowest));
        const TriangleMesh flat = bent(n, kind, 0.1, [](double, double) { return 0.0; });
        std::vector<TriangleMesh> all;
        for (int k = 0; k < layers; ++k)
          all.push_back(Guarded::moved(flat, k * Vec3(0.3 * gap, gap, 0.2 * gap)));
        Guarded pile(all);
        const int vertices = flat.vertex_count();
        for (std::size_t i = 0; i < pile.step.masses.size(); ++i)
          pile.step.masses[i] *= static_cast<double>(1 + i % 3);
        // All layers come down onto the lowest one, until `left` is between them.
        for (int k = 1; k < layers; ++k)
          for (int i = 0; i < vertices; ++i) pile.move(k * vertices + i, {0, -k * (gap - left), 0});
        if (lowest == Lowest::pinned) std::fill_n(pile.step.held.begin(), vertices, 1);
        if (lowest == Lowest::on_a_body)
          for (int i = 0; i < vertices; ++i) pile.touch_body(i);
        CHECK(pile.guard().guarded == 0);
        const int astray = vertices + vertices / 2 + n / 2;
        pile.move(astray, {0, -1.2 * left, 0});
        const VecX asked = pile.x_new;
        const GuardReport report = pile.guard();
        CHECK(report.guarded > 0);
        CHECK(report.guarded <= 8);
        CHECK(report.held == report.guarded);
        Vec3 lost = Vec3::Zero();
        for (int i = 0; i < layers * vertices; ++i) {
          const Vec3 change = (pile.x_new - asked).segment<3>(3 * i);
          CHECK(change.norm() < 0.3 * gap);
          CHECK(((pile.v_new - pile.step.v).segment<3>(3 * i) * pile.step.h - change).norm() < 1e-15);
          lost += pile.step.masses[i] * change;
          if (i < vertices && lowest != Lowest::free) CHECK(pile.way(i).isZero(0));
        }
        if (lowest == Lowest::free) CHECK(lost.norm() < 1e-15);
        CHECK(pile.x_new[3 * astray + 1] > 0);  // the lowest layer is at zero
      }
}

TEST_CASE("the guard pushes what touches a body off it, never into it, and not what is clamped",
          "[self-contact]") {
  for (int n : {4, 6})
    for (const bool above : {true, false})
      for (const bool clamped : {false, true})
        for (const Vec3& normal : {Vec3(0, 1, 0), Vec3(0.6, 0.8, 0), Vec3(0, -1, 0), Vec3(-0.6, -0.8, 0)}) {
          INFO(n << " vertices along an edge, " << (above ? "above" : "below") << ", clamped " << clamped
                 << ", normal " << normal.transpose());
          Guarded two(n);
          // One vertex of a sheet comes through the other sheet by 0.02 mm, where the sheets end 0.1 mm
          // apart.
          const double way = above ? -1 : 1;
          const int half = two.half(), first = above ? half : 0, astray = first + half / 2 + n / 2;
          for (int i = first; i < first + half; ++i) two.move(i, {0, way * 3.9e-3, 0});
          two.move(astray, {0, way * 1.2e-4, 0});
          two.touch_body(astray, normal, clamped);
          const VecX asked = two.x_new;
          const int pushed = two.guard().guarded;
          CHECK(pushed > 0);
          CHECK(pushed <= 8);
          const Vec3 change = (two.x_new - asked).segment<3>(3 * astray);
          const bool off = !clamped && normal[1] * way < 0;
          if (off) CHECK(change[1] * way < -1e-6);
          if (!off) CHECK(change.isZero(0));
        }
}
