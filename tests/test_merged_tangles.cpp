// Sewn cloth that starts through itself: what a merged seam leaves of it is as if the cloth had started in
// one.
#include <catch2/catch.hpp>
#include <cmath>

#include "constraints/contact_step.h"
#include "solver/system/state.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double size = 0.4, thickness = 2e-3;  // m

struct Sheet {
  VecX x;
  std::vector<Triangle> triangles;
};

// In a step in which the last layer falls on what is below.
std::vector<SelfContact> contacts_of(Constraints& constraints, const VecX& x, int layer) {
  const std::vector<double> masses(static_cast<std::size_t>(x.size() / 3), 1e-3);
  VecX v = VecX::Zero(x.size());
  for (int i = 2 * layer; i < x.size() / 3; ++i) v[3 * i + 1] = -3;
  [[maybe_unused]] const ContactStep step = constraints.begin_step(x, v, masses, 0, 1e-3, Foresight::none);
  return constraints.self().touching();
}

void add_faces(Constraints& constraints, const std::vector<Triangle>& triangles) {
  std::vector<SelfFace> faces;
  for (const Triangle& t : triangles) faces.push_back({t, thickness, 0.3});
  constraints.add_self_faces(faces);
}

// Three sheets of n x n vertices above each other. The last lies this gap [m] above the second, but for a
// dent in the middle, which may reach through.
Sheet three_layers(int n, Kind kind, double gap, double dent) {
  Sheet all;
  std::vector<Vec3> places;
  for (int k = 0; k < 3; ++k) {
    const TriangleMesh mesh = bent(n, kind, size, [k, gap, dent](double x, double z) {
      return k == 0 ? 0.1 : k == 1 ? 0.0 : gap - dent * std::exp(-(x * x + z * z) / 1.5e-3);
    });
    const int first = static_cast<int>(places.size());
    places.insert(places.end(), mesh.positions.begin(), mesh.positions.end());
    for (const Triangle& t : mesh.triangles)
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  all.x = stacked(places);
  return all;
}

// The first rows of all become that of the first.
std::vector<int> seam_of(int n, int layer) {
  std::vector<int> particle_of;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < layer; ++i) particle_of.push_back(i < n ? i : k * (layer - n) + i);
  return particle_of;
}

Sheet merged(const Sheet& sewn, const std::vector<int>& particle_of) {
  Sheet one;
  one.x.resize(3 * (1 + particle_of.back()));
  for (std::size_t i = particle_of.size(); i-- > 0;)
    one.x.segment<3>(3 * particle_of[i]) = sewn.x.segment<3>(3 * static_cast<int>(i));
  for (Triangle t : sewn.triangles) {
    for (int& v : t) v = particle_of[static_cast<std::size_t>(v)];
    one.triangles.push_back(t);
  }
  return one;
}

}  // namespace

TEST_CASE("a cloth whose seam is merged has the contacts of one that starts so", "[self-contact][sewing]") {
  for (const Kind kind : kinds)
    for (const int n : {10, 13, 17}) {
      INFO(static_cast<int>(kind) << ", " << n);
      const Sheet sewn = three_layers(n, kind, 4e-4, 6e-3);
      const int layer = static_cast<int>(sewn.x.size() / 9);
      const std::vector<int> particle_of = seam_of(n, layer);
      const Sheet one = merged(sewn, particle_of);
      Constraints at_once, later;
      add_faces(at_once, one.triangles);
      add_faces(later, sewn.triangles);
      contacts_of(at_once, one.x, layer);
      contacts_of(later, sewn.x, layer);
      REQUIRE(later.self().tangled() > 3);
      later.merge(particle_of);
      // How thick cloth is depends on whether it started in a tangle, also when that has come apart.
      const VecX apart = merged(three_layers(n, kind, 1.1 * thickness, 0), particle_of).x;
      const std::vector<SelfContact> expected = contacts_of(at_once, apart, layer),
                                     found = contacts_of(later, apart, layer);
      REQUIRE(found.size() == expected.size());
      int thin = 0, wrong = 0;
      for (std::size_t k = 0; k < found.size(); ++k) {
        CHECK(found[k].who.v == expected[k].who.v);
        wrong += found[k].thickness != expected[k].thickness;
        thin += found[k].thickness < 0.5 * thickness;
      }
      CHECK(wrong == 0);
      CHECK(thin > 0);
      CHECK(static_cast<std::size_t>(thin) < found.size());
    }
}
