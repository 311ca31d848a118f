// Laws of the sets that are clusters: every particle is in one, and wrong ones are refused.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "mesh/base/errors.h"
#include "mesh/triangles/generate.h"
#include "tests/clusters.h"

using namespace drape;
using namespace drape::test;

TEST_CASE("cells, faces and tetrahedra each make a set", "[clusters]") {
  for (const Lattice& lattice :
       {box_lattice({3, 4, 5}, {0.1, 0.2, 0.3}), filled_lattice(sphere(2, 0.5), 0.13, "ball")}) {
    const ParticleSets sets = sets_of_cells(lattice);
    CHECK(static_cast<long>(sets.size()) == std::count(lattice.filled.begin(), lattice.filled.end(), 1));
    std::vector<double> eighths(lattice.positions.size(), 0);
    for (const std::vector<int>& set : sets) {
      CHECK(std::set<int>(set.begin(), set.end()).size() == 8);
      Vec3 middle = Vec3::Zero();
      for (const int i : set) eighths[i] += lattice.spacing.prod() / 8, middle += lattice.positions[i] / 8;
      for (const int i : set)
        CHECK(((lattice.positions[i] - middle).cwiseAbs() - lattice.spacing / 2).norm() < 1e-12);
    }
    for (std::size_t i = 0; i < eighths.size(); ++i) CHECK(eighths[i] == Approx(lattice.volumes[i]));
  }
  const TriangleMesh sheet = grid(5, 4, 1, 1);
  CHECK(sets_of_faces(sheet).size() == sheet.triangles.size());
  CHECK(sets_of({{0, 1, 2, 3}, {1, 2, 3, 9}}) == ParticleSets{{0, 1, 2, 3}, {1, 2, 3, 9}});
}

TEST_CASE("n sets hold every particle, and overlap where springs join them", "[clusters]") {
  const Lattice lattice = box_lattice({9, 7, 5}, {0.1, 0.1, 0.1});
  std::vector<std::pair<int, int>> pairs;
  for (const LatticePair& p : lattice.structural) pairs.emplace_back(p.i, p.j);
  for (const int n : {1, 2, 7, 30, lattice.particle_count()}) {
    const ParticleSets own = overlapping_sets(lattice.positions, pairs, n, 0, "body");
    std::vector<int> set_of(lattice.positions.size(), -1);
    std::vector<Vec3> centres;
    REQUIRE(own.size() == static_cast<std::size_t>(n));
    for (std::size_t c = 0; c < own.size(); ++c) {
      REQUIRE(!own[c].empty());
      centres.push_back(Vec3::Zero());
      for (const int i : own[c]) {
        CHECK(std::exchange(set_of[i], static_cast<int>(c)) == -1);
        centres.back() += lattice.positions[i] / static_cast<double>(own[c].size());
      }
    }
    for (std::size_t i = 0; i < set_of.size(); ++i) {
      REQUIRE(set_of[i] >= 0);
      for (const Vec3& c : centres)  // no centre is nearer than its own
        CHECK((lattice.positions[i] - centres[set_of[i]]).norm() <=
              (lattice.positions[i] - c).norm() + 1e-12);
    }
    const ParticleSets grown = overlapping_sets(lattice.positions, pairs, n, 1, "body");
    for (const auto& [i, j] : pairs)
      for (const int c : {set_of[i], set_of[j]})
        for (const int k : {i, j}) CHECK(std::binary_search(grown[c].begin(), grown[c].end(), k));
    CHECK(grown == overlapping_sets(lattice.positions, pairs, n, 1, "body"));
  }
}

TEST_CASE("no set stays empty, whatever the cloud", "[clusters]") {
  Random random(16);
  for (int k = 0; k < 20000; ++k) {
    std::vector<Vec3> places;
    const int particles = 6 + static_cast<int>(random.between(0, 30));
    for (int i = 0; i < particles; ++i)  // clumps and lone ones
      places.push_back(std::pow(10, random.between(-2, 1)) * random.vector());
    const int n = 2 + static_cast<int>(random.between(0, 0.6 * particles));
    const ParticleSets sets = overlapping_sets(places, {}, n, 0, "body");
    std::size_t members = 0;
    for (const std::vector<int>& set : sets) {
      REQUIRE(!set.empty());
      members += set.size();
    }
    REQUIRE(members == places.size());
  }
}

TEST_CASE("wrong clusters are refused in one line", "[clusters]") {
  using Catch::Matchers::Equals;
  const std::vector<Vec3> places = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  CHECK_THROWS_WITH(overlapping_sets(places, {}, 0, 1, "soft 'a'"),
                    Equals("soft 'a': clusters = 0, but at least 1 is needed"));
  CHECK_THROWS_WITH(
      overlapping_sets(places, {}, 4, 1, "soft 'a'"),
      Equals("soft 'a': 4 clusters of 4 particles at 3 places; a cluster needs a place of its own"));
  CHECK(overlapping_sets(places, {}, 3, 0, "a").size() == 3);
  const VecX rest = VecX::LinSpaced(12, 0, 1);
  const std::vector<double> masses = {1, 1, 1, 0};
  const auto refuses = [&](const ParticleSets& sets, const std::string& what) {
    CHECK_THROWS_WITH(Clusters(sets, masses, rest, "soft 'a'"), Equals("soft 'a': cluster " + what));
    CHECK_THROWS_AS(Clusters(sets, masses, rest, "soft 'a'"), InputError);
  };
  refuses({{0, 1, 2}, {0, 1}}, "1 has 2 particles, but a shape needs at least 3; ask for fewer clusters");
  refuses({{0, 1, 4}}, "0 names particle 4, but there are 4, from 0");
  refuses({{0, -1, 2}}, "0 names particle -1, but there are 4, from 0");
  refuses({{0, 1, 0}}, "0 names particle 0 twice");
  refuses({{0, 1, 3}}, "0 has particle 3, whose mass is not positive");
}
