// The search for what could meet: it misses nothing, whatever moves, and does not begin again for what moves
// elsewhere.
#include "constraints/encounters.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>
#include <random>
#include <set>

#include "mesh/base/threads.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::internal;
using namespace drape::test;

namespace {

constexpr double edge = 0.01, gap = 0.003;  // m

// Sheets of n x n vertices, one above the other. The upper one of two may be a body: then its pairs with the
// lower one count, without those of a vertex of the lower one.
struct Sheets {
  Sheets(Kind kind, int n, double distance, bool on_body = false, int sheets = 2) : body(on_body) {
    const TriangleMesh sheet = bent(n, kind, edge * (n - 1), [](double, double) { return 0.0; });
    half = sheet.vertex_count();
    for (int k = 0; k < sheets; ++k) {
      for (const Vec3& at : sheet.positions) places.push_back(at + k * Vec3(0.002, distance, 0.001));
      for (const Triangle& t : sheet.triangles)
        triangles.push_back({k * half + t[0], k * half + t[1], k * half + t[2]});
    }
    x.resize(3 * vertices());
    for (int i = 0; i < vertices(); ++i) x.segment<3>(3 * i) = places[i];
    encounters.set(triangles, {}, vertices(), body ? triangles.size() / 2 : triangles.size(), x);
  }

  int vertices() const { return static_cast<int>(places.size()); }
  bool upper(int vertex) const { return vertex >= half; }
  // Every vertex with every triangle, and every edge with every other, that have no vertex in common.
  std::vector<Encounter> all_pairs() const {
    std::vector<Encounter> pairs;
    std::set<std::pair<int, int>> edges;
    for (const Triangle& t : triangles)
      for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
    for (const Triangle& t : triangles)
      for (int v = 0; v < vertices(); ++v)
        if (v != t[0] && v != t[1] && v != t[2] && (!body || (upper(v) && !upper(t[0]))))
          pairs.push_back({.v = {v, t[0], t[1], t[2]}, .edges = false});
    for (const auto& [a, b] : edges)
      for (const auto& [c, d] : edges)
        if (a < c && a != d && b != c && b != d && (!body || upper(a) != upper(c)))
          pairs.push_back({.v = {a, b, c, d}, .edges = true});
    return pairs;
  }

  std::vector<Encounter> select(const VecX& x_new, double within = gap, long* looks = nullptr) {
    REQUIRE(encounters.follow(x, x_new, within));
    return ask(
        Encounters::Kind::both, x_new, within, [&](const Encounter&) { return within; }, looks);
  }
  // Of a motion that was followed.
  template <class GapOf>
  std::vector<Encounter> ask(Encounters::Kind part, const VecX& x_new, double within, const GapOf& gap_of,
                             long* looks = nullptr, const std::vector<double>* limits = nullptr) {
    std::vector<Encounter> found;
    const auto look = [&](const Encounter& e, const FourPoints& start, const FourPoints& end,
                          const Vec3& likely) {
      if (looks) ++*looks;
      return approach(e.edges, start, end, within, likely);
    };
    for (const Meeting& m : encounters.select(part, x, x_new, within, gap_of, look, limits)) {
      found.push_back(m.who);
      std::array<int, 4>& v = found.back().v;
      if (m.who.edges && v[0] > v[2]) v = {v[2], v[3], v[0], v[1]};  // as all_pairs() names it
    }
    return found;
  }
  void go(const VecX& x_new) {
    encounters.went(x, x_new);
    x = x_new;
  }

  bool body;
  int half = 0;
  std::vector<Vec3> places;
  std::vector<Triangle> triangles;
  VecX x;
  Encounters encounters;
};

// What each vertex does in a step [m].
Vec3 motion(int kind, const Sheets& two, int i, int step, double shake) {
  const bool upper = i >= two.half;
  const Vec3 tremble = 1e-4 * shake * Vec3(1, -0.5, 0.7);
  if (kind == 0) return tremble;
  if (kind == 5) return 30 * tremble;                      // every vertex for itself: the sheets crumple
  if (kind == 1) return tremble + Vec3(0.05, -0.1, 0.02);  // all go far, as one
  if (kind == 2) return tremble + (upper ? Vec3(0.004, 0, 0.002) : Vec3(0, 0, 0));  // one slides on the other
  if (kind == 3) return tremble + (upper && step % 8 < 4 ? -1 : 1) * Vec3(0, 0.002, 0);  // and comes and goes
  return tremble +
         (i == 0 ? Vec3((step % 2 == 0 ? 1 : -1) * Vec3(0.01, 0.03, 0)) : Vec3(0, 0, 0));  // a corner flaps
}

bool come_near(const Encounter& e, const FourPoints& start, const FourPoints& end, double within) {
  for (int axis = 0; axis < 3; ++axis) {  // most are far apart, which is seen at once
    double lower[2] = {1e9, 1e9}, upper[2] = {-1e9, -1e9};
    for (std::size_t c = 0; c < 4; ++c) {
      const std::size_t side = c < (e.edges ? 2u : 1u) ? 0 : 1;
      lower[side] = std::min({lower[side], start[c][axis], end[c][axis]});
      upper[side] = std::max({upper[side], start[c][axis], end[c][axis]});
    }
    if (lower[0] - upper[1] > within || lower[1] - upper[0] > within) return false;
  }
  constexpr int looks = 8;
  for (int k = 0; k <= looks; ++k) {
    FourPoints at;
    for (std::size_t c = 0; c < 4; ++c) at[c] = start[c] + (1.0 * k / looks) * (end[c] - start[c]);
    if (nearest(e.edges, at).distance < within) return true;
  }
  return false;
}

// How many of the pairs come within this distance on the way to x_new, and were not found.
long missed(const Sheets& sheets, const std::vector<Encounter>& pairs, const VecX& x_new, double within,
            const std::set<Encounter>& found) {
  return std::count_if(pairs.begin(), pairs.end(), [&](const Encounter& e) {
    return come_near(e, corners(sheets.x, e), corners(x_new, e), within) && found.count(e) == 0;
  });
}

// Goes from place to place with the sheets, and looks whether the search misses something on the way.
struct Walk {
  explicit Walk(Sheets& of) : sheets(of), pairs(of.all_pairs()), fewest(pairs.size()) {}

  void go(const VecX& x_new) {
    const std::vector<Encounter> selected = sheets.select(x_new);
    const std::set<Encounter> found(selected.begin(), selected.end());
    CHECK(found.size() == selected.size());
    CHECK(missed(sheets, pairs, x_new, 0.99 * gap, found) == 0);
    fewest = std::min(fewest, found.size());
    most = std::max(most, found.size());
    sheets.go(x_new);
  }

  Sheets& sheets;
  std::vector<Encounter> pairs;
  std::size_t fewest, most = 0;  // that were found in a step
};

}  // namespace

TEST_CASE("the search for what could meet misses nothing, and tells each pair once", "[approach]") {
  for (const Kind kind : kinds)
    for (const int n : {3, 5, 8})
      for (const bool body : {false, true})
        for (int moves = 0; moves < 6; ++moves) {
          INFO("mesh " << static_cast<int>(kind) << ", " << n << " vertices along an edge, motion " << moves
                       << (body ? ", on a body" : ""));
          Sheets two(kind, n, 0.002, body);
          const std::vector<Encounter> pairs = two.all_pairs();
          std::mt19937 random(5);
          std::uniform_real_distribution<double> number(-1, 1);
          for (int step = 0; step < 6; ++step) {
            VecX x_new = two.x;
            const double within = step % 3 == 2 ? 1.5 * gap : gap;
            if (step == 5) {  // the cloth was taken elsewhere
              for (int i = 0; i < two.half; ++i) two.x[3 * i + 1] += 0.001;
              two.encounters.forget();
            }
            // The end of the motion changes with every solve of a step.
            for (int solve = 0; solve < 3; ++solve) {
              for (int i = 0; i < 2 * two.half; ++i)
                x_new.segment<3>(3 * i) =
                    two.x.segment<3>(3 * i) +
                    motion(moves, two, i, step, number(random)) * (solve == 0 ? 1.5 : 1);
              const std::vector<Encounter> selected = two.select(x_new, within);
              const std::set<Encounter> found(selected.begin(), selected.end());
              CHECK(found.size() == selected.size());
              long far = 0;
              for (const Encounter& e : selected)
                far += !come_near(e, corners(two.x, e), corners(x_new, e), 1.3 * within);
              CHECK(missed(two, pairs, x_new, 0.99 * within, found) == 0);
              CHECK(far == 0);
            }
            if (step < 3) x_new *= step == 1 ? 1 / 0.15 : 0.15;  // goes elsewhere than was followed
            two.go(x_new);
          }
        }
}

TEST_CASE("the search misses nothing of a sheet that is wound up, and unwound, again and again",
          "[approach]") {
  for (const Kind kind : kinds)
    for (const double length : {1.5, 4.0, 15.0}) {  // steps in a radian of the winding
      INFO("mesh " << static_cast<int>(kind) << ", " << length);
      Sheets sheet(kind, 9, 0, false, 1);
      Walk walk(sheet);
      std::mt19937 random(5);
      std::uniform_real_distribution<double> tremble(-2e-4, 2e-4);
      for (int step = 0; step < std::max(24.0, 14 * length); ++step) {
        const double bent = std::max(0.0, 1.2 * std::sin(step / length));  // radians in an edge
        const double radius = edge / std::max(bent, 1e-3);
        const bool along_x = static_cast<int>(step / length / (2 * std::numbers::pi)) % 2 == 0;
        VecX x_new = sheet.x;
        for (int i = 0; i < sheet.vertices(); ++i) {
          const double x = sheet.places[i].x(), z = sheet.places[i].z(), s = (along_x ? x : z) / radius;
          const Vec3 at(radius * std::sin(s), radius * (1 - std::cos(s)), along_x ? z : x);
          x_new.segment<3>(3 * i) = (along_x ? at : Vec3(at.z(), at.y(), at.x())) +
                                    Vec3(tremble(random), tremble(random), tremble(random));
        }
        walk.go(x_new);
      }
      CHECK(walk.most > 500);
      CHECK(10 * walk.fewest < walk.most);
    }
}

TEST_CASE("the search misses nothing of a sheet that was folded, lay flat for long, and shrinks",
          "[approach]") {
  for (const Kind kind : kinds)
    for (const double shrinks : {0.93, 0.97}) {  // in a step
      INFO("mesh " << static_cast<int>(kind) << ", by " << shrinks);
      Sheets sheet(kind, 9, 0, false, 1);
      Walk walk(sheet);
      const VecX flat = sheet.x;
      double size = 1;
      for (int step = 0; size > 0.2; ++step) {
        VecX x_new = size * flat;
        if (step == 1)
          for (int i = 0; i < sheet.vertices(); ++i) x_new[3 * i] = 0.1 * std::abs(x_new[3 * i]);
        if (step > 20) size *= shrinks;
        walk.go(x_new);
      }
      CHECK(walk.most > 500);
      CHECK(10 * walk.fewest < walk.most);
    }
}

TEST_CASE("the search finds the same where it knows that a body never moves", "[approach]") {
  for (const Kind kind : kinds)
    for (const double way : {0.0002, 0.003, 0.5}) {  // m, in a step
      INFO("mesh " << static_cast<int>(kind) << ", " << way << " m a step");
      constexpr double start = 0.03;  // m apart, so that no patch has triangles of both
      Sheets one(kind, 7, start, true), other(kind, 7, start, true);
      std::vector<char> still;
      for (int i = 0; i < one.vertices(); ++i) still.push_back(one.upper(i));
      other.encounters.set(other.triangles, {}, other.vertices(), other.triangles.size() / 2, other.x, still);
      std::mt19937 random(5);
      std::uniform_real_distribution<double> number(-1, 1);
      std::size_t found = 0;
      for (int step = 0; step < 24; ++step) {
        VecX x_new = one.x;  // the cloth comes near, goes away, and comes back
        if (step == 1)
          for (int i = 0; i < one.half; ++i) x_new[3 * i + 1] += start - 0.002;
        const double along = (step / 6) % 2 == 0 ? way : -way;
        for (int i = 0; i < one.half; ++i)
          x_new.segment<3>(3 * i) += Vec3(along, 0.3 * along, 0) + 1e-4 * number(random) * Vec3::Ones();
        const std::vector<Encounter> of_one = one.select(x_new);
        found += of_one.size();
        CHECK(of_one == other.select(x_new));
        one.go(x_new);
        other.go(x_new);
      }
      CHECK(found > 0);
    }
}

TEST_CASE("the search misses nothing of sheets that come near each other slowly, whichever way they face",
          "[approach]") {
  constexpr double way = 0.0007;                     // m, in a step
  for (const double start : {0.0075, 0.009, 0.012})  // m
    for (const Vec3& facing : {Vec3(0, 1, 0), Vec3(0, 1, 1), Vec3(1, 1, 1), Vec3(2, -1, 2)}) {
      const Kind kind = kinds[static_cast<std::size_t>(start / 0.002) % kinds.size()];
      INFO("mesh " << static_cast<int>(kind) << ", " << start << " m apart, facing " << facing.transpose());
      Sheets two(kind, 5, start);
      const Mat3 turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitY(), facing).toRotationMatrix();
      for (int i = 0; i < two.vertices(); ++i) two.x.segment<3>(3 * i) = turn * two.places[i];
      two.encounters.set(two.triangles, {}, two.vertices(), two.triangles.size(), two.x);
      Walk walk(two);
      for (int step = 0; step < 14; ++step) {
        VecX x_new = two.x;
        for (int i = two.half; i < two.vertices(); ++i) x_new.segment<3>(3 * i) -= way * facing.normalized();
        walk.go(x_new);
      }
    }
}

TEST_CASE("the search misses nothing of a pile that is pressed together and comes apart", "[approach]") {
  constexpr int sheets = 8, n = 5;
  for (const Kind kind : kinds)
    for (const double speed : {0.2, 0.6, 1.5}) {  // mm a step, of each sheet against the next
      INFO("mesh " << static_cast<int>(kind) << ", " << speed << " mm a step");
      Sheets pile(kind, n, 0.015, false, sheets);
      Walk walk(pile);
      std::mt19937 random(5);
      std::uniform_real_distribution<double> tremble(-1e-5, 1e-5);
      double distance = 15;  // mm
      const auto go = [&](double by) {
        VecX x_new = pile.x;
        for (int i = 0; i < pile.vertices(); ++i) {
          const int sheet = i / pile.half;
          x_new.segment<3>(3 * i) +=
              Vec3(tremble(random), 1e-3 * by * sheet + tremble(random), tremble(random));
        }
        walk.go(x_new);
        distance += by;
      };
      for (int time = 0; time < 2; ++time) {
        while (distance > 0.5) go(-std::min(speed, distance - 0.4));
        for (int k = 0; k < 8; ++k) go(0);
        while (distance < 8) go(1);
        for (int k = 0; k < 8; ++k) go(0);
      }
    }
}

TEST_CASE("the search misses nothing within limits of particles, which rise and fall", "[approach]") {
  for (const Kind kind : kinds)
    for (int moves = 0; moves < 6; ++moves)
      for (const double most : {0.3, 1.0, 2.0}) {  // of the limits, in gaps
        INFO("mesh " << static_cast<int>(kind) << ", motion " << moves << ", limits up to " << most);
        Sheets two(kind, 6, 0.002);
        const std::vector<Encounter> pairs = two.all_pairs();
        std::mt19937 random(5);
        std::uniform_real_distribution<double> number(-1, 1), share(0, 1);
        std::vector<double> limits(static_cast<std::size_t>(two.vertices()), 0.0);
        const auto gap_of = [&](const Encounter& e) {
          double least = gap;
          for (int v : e.v) least = std::min(least, limits[v]);
          return least;
        };
        long found_in_all = 0;
        for (int step = 0; step < 16; ++step) {
          VecX x_new = two.x;
          for (int i = 0; i < 2 * two.half; ++i)
            x_new.segment<3>(3 * i) += motion(moves, two, i, step, number(random));
          REQUIRE(two.encounters.follow(two.x, x_new, gap));
          for (int i = 0; i < two.vertices(); ++i)  // most stay for some steps
            if (step == 0 || (i + step) % 5 == 0) limits[i] = most * gap * share(random);
          const std::vector<Encounter> selected =
              two.ask(Encounters::Kind::edges, x_new, gap, gap_of, nullptr, &limits);
          const std::set<Encounter> found(selected.begin(), selected.end());
          found_in_all += static_cast<long>(found.size());
          long missed_edges = 0;
          for (const Encounter& e : pairs)
            missed_edges += e.edges && found.count(e) == 0 &&
                            come_near(e, corners(two.x, e), corners(x_new, e), 0.99 * gap_of(e));
          CHECK(missed_edges == 0);
          // Who asks for all in between, as the guard does, hears of all.
          const std::vector<Encounter> guarded =
              two.ask(Encounters::Kind::both, x_new, gap, [](const Encounter&) { return 0.5 * gap; });
          const std::set<Encounter> all(guarded.begin(), guarded.end());
          CHECK(missed(two, pairs, x_new, 0.49 * gap, all) == 0);
          two.go(x_new);
        }
        CHECK((moves == 2 || found_in_all > 0));
      }
}

TEST_CASE("the search misses nothing of the parts and within the gaps that it is asked for", "[approach]") {
  for (const Kind kind : kinds)
    for (int moves = 0; moves < 6; ++moves) {
      INFO("mesh " << static_cast<int>(kind) << ", motion " << moves);
      Sheets two(kind, 6, 0.002);
      const std::vector<Encounter> pairs = two.all_pairs();
      std::mt19937 random(5);
      std::uniform_real_distribution<double> number(-1, 1);
      for (int step = 0; step < 12; ++step) {
        VecX x_new = two.x;
        for (int i = 0; i < 2 * two.half; ++i)
          x_new.segment<3>(3 * i) += motion(moves, two, i, step, number(random));
        REQUIRE(two.encounters.follow(two.x, x_new, gap));
        // The gap of two edges is another one in every step, and one that is seldom asked for comes near
        // meanwhile.
        const auto gap_of = [&](const Encounter& e) {
          return e.edges && (e.v[0] + e.v[1] + e.v[2] + e.v[3] + step) % 4 != 0 ? 0.3 * gap : gap;
        };
        const auto missed_of = [&](Encounters::Kind part, const auto& within) {
          const std::vector<Encounter> selected = two.ask(part, x_new, gap, within);
          const std::set<Encounter> found(selected.begin(), selected.end());
          long count = 0;
          for (const Encounter& e : pairs) {
            const bool asked = (static_cast<int>(part) & (e.edges ? 2 : 1)) != 0;
            count += !asked && found.count(e) != 0;
            count += asked && found.count(e) == 0 &&
                     come_near(e, corners(two.x, e), corners(x_new, e), 0.99 * within(e));
          }
          return count;
        };
        CHECK(missed_of(Encounters::Kind::vertices, gap_of) == 0);
        CHECK(missed_of(Encounters::Kind::edges, gap_of) == 0);
        CHECK(missed_of(Encounters::Kind::both, [](const Encounter&) { return 0.1 * gap; }) == 0);
        two.go(x_new);
      }
    }
}

TEST_CASE("what moves elsewhere, and what all do alike, does not make the search begin again", "[approach]") {
  for (const Kind kind : kinds)
    for (const int n : {12, 18, 24}) {
      INFO("mesh " << static_cast<int>(kind) << ", " << n << " vertices along an edge");
      Sheets two(kind, n, 0.004);  // farther apart than the gap: nothing has to be looked at twice
      std::vector<long> looks(6, 0);
      for (int step = 0; step < 6; ++step) {
        VecX x_new = two.x;
        for (int i = 0; i < 2 * two.half; ++i)
          x_new.segment<3>(3 * i) += Vec3(0.3, -1, 0.2) + motion(4, two, i, step, 0.01);
        two.select(x_new, gap, &looks[step]);
        two.go(x_new);
      }
      // Once all, and then again those of the patch that flaps.
      CHECK(looks[0] > 10 * two.half);
      for (int step = 1; step < 6; ++step) CHECK(looks[step] < looks[0] / 5);
    }
}

TEST_CASE("the search finds the same, in the same order, on any number of threads", "[approach]") {
  const int before = threads();
  std::vector<std::vector<Encounter>> found;
  for (const int count : {1, 2, 7}) {
    set_threads(count);
    Sheets two(Kind::irregular, 45, 0.002);  // large enough for more than one thread
    std::mt19937 random(6);
    std::uniform_real_distribution<double> number(-1, 1);
    found.emplace_back();
    for (int step = 0; step < 4; ++step) {
      VecX x_new = two.x;
      for (int i = 0; i < 2 * two.half; ++i)
        x_new.segment<3>(3 * i) += motion(3, two, i, step, 10 * number(random));
      const std::vector<Encounter> here = two.select(x_new);
      found.back().insert(found.back().end(), here.begin(), here.end());
      two.go(x_new);
    }
  }
  set_threads(before);
  CHECK(found[0].size() > 1000);
  CHECK(found[1] == found[0]);
  CHECK(found[2] == found[0]);
}

TEST_CASE("a search among cloth that has exploded gives up, and begins anew", "[approach]") {
  Sheets two(Kind::squares, 24, 0.004);
  const VecX sound = two.x;
  CHECK_FALSE(two.encounters.follow(VecX::Zero(sound.size()), VecX::Zero(sound.size()), gap));
  VecX broken = sound;
  broken[7] = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(two.encounters.follow(sound, broken, gap));
  const auto found = two.select(sound);
  Sheets fresh(Kind::squares, 24, 0.004);
  CHECK(found == fresh.select(sound));
}

TEST_CASE("particles that were moved from outside are looked at anew", "[approach]") {
  for (const Kind kind : kinds)
    for (const int n : {4, 8, 12}) {
      INFO("mesh " << static_cast<int>(kind) << ", " << n << " vertices along an edge");
      Sheets two(kind, n, 0.006);
      const VecX before = two.x;
      two.select(before);  // knows from now on that the sheets are 6 mm apart
      two.go(before);
      for (int i = 0; i < two.half; ++i) two.x[3 * i + 1] += 0.0035;
      two.encounters.forget();
      Sheets fresh(kind, n, 0.0025);
      CHECK(two.select(two.x).size() == fresh.select(fresh.x).size());
    }
}
