// How stiff the springs between layers of cloth are: as their load asks for, whatever the load does.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "solver/assembly/assembly.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double thickness = 1e-3;  // m

Assembly pile_on(const Obstacle& floor, int layers, int n, Kind kind, ClothModel model = ClothModel::noh_jung,
                 double size = 0.1) {
  Assembly pile{Vec3(0, -9.81, 0)};
  for (int k = 0; k < layers; ++k) {
    const TriangleMesh mesh =
        bent(n + k % 3, kind, size, [&](double, double) { return 2e-3 + thickness * k; });
    pile.add({.mesh = mesh,
              .fabric = {.area_density = 0.2, .stretch = 200, .bend = 1e-5, .damping = 0.002},
              .model = model,
              .imperfection = 0,
              .self_contact = SelfContactOptions{.thickness = thickness, .friction = 0.3}});
  }
  pile.constraints->add(floor);
  pile.use("implicit-euler", "auto", {.tolerance = 1e-4});
  return pile;
}

Obstacle floor_along(const std::vector<Keyframe>& path) {
  return {.shape = Plane{}, .friction = 0.5, .margin = 2e-3, .motion = Motion::keyframes(path, Vec3::Zero())};
}

// The stiffness of the contacts that bear something [N/m].
std::map<Encounter, double> stiffnesses(const Assembly& pile) {
  std::map<Encounter, double> found;
  for (const SelfContact& c : pile.constraints->self().pushed())
    if (c.before > 0) found[c.who] = c.stiff;
  return found;
}

double sum_of_stiffnesses(const Assembly& pile) {
  double sum = 0;
  for (const auto& [who, stiff] : stiffnesses(pile)) sum += stiff;
  return sum;
}

}  // namespace

TEST_CASE("contacts whose load swings stay as stiff as the load asked for", "[self-contact]") {
  constexpr double swings_by = 3, omega = 2 * std::numbers::pi;  // m/s^2, rad/s
  std::vector<Keyframe> path;
  for (double t = 0; t < 4; t += 0.02)
    path.push_back({.time = t, .translate = {0, swings_by / (omega * omega) * (1 - std::cos(omega * t)), 0}});
  for (Kind kind : kinds)
    for (int n : {4, 6, 8}) {
      INFO(n << " vertices along an edge, kind " << static_cast<int>(kind));
      Assembly pile = pile_on(floor_along(path), 8, n, kind);
      while (pile.state.time < 2) REQUIRE(pile.advance(0.01).done);
      std::map<Encounter, double> before = stiffnesses(pile);
      int bearing = 0, changed = 0;
      while (pile.state.time < 3) {
        REQUIRE(pile.advance(0.01).done);
        std::map<Encounter, double> now = stiffnesses(pile);
        for (const auto& [who, stiff] : now) {
          const auto was = before.find(who);
          if (was == before.end()) continue;
          ++bearing;
          changed += std::abs(stiff - was->second) > 1e-3 * was->second;
        }
        before = std::move(now);
      }
      CHECK(changed < 0.01 * bearing);  // that of a few contacts swings by more
    }
}

TEST_CASE("contacts become softer again when their load is gone", "[self-contact]") {
  // The floor rises ever faster, so that the layers weigh three times as much, and then as fast as it is.
  constexpr double rests = 1.5, rises = 0.5, more = 20;  // s, s, m/s^2
  std::vector<Keyframe> path;
  for (double t = 0; t < 4; t += 0.02) {
    const double since = std::max(0.0, t - rests), up = std::min(since, rises);
    path.push_back({.time = t, .translate = {0, 0.5 * more * up * up + more * up * (since - up), 0}});
  }
  for (Kind kind : kinds)
    for (int n : {4, 6, 8}) {
      INFO(n << " vertices along an edge, kind " << static_cast<int>(kind));
      Assembly pile = pile_on(floor_along(path), 8, n, kind);
      const auto until = [&](double time) {
        while (pile.state.time < time) REQUIRE(pile.advance(0.01).done);
        return sum_of_stiffnesses(pile);
      };
      const double at_rest = until(rests), heavy = until(rests + rises), later = until(rests + rises + 1.5);
      CHECK(heavy > 2.3 * at_rest);
      CHECK(later < 1.05 * at_rest);
    }
}

TEST_CASE("a blow to contacts that were eased is no load that comes back", "[self-contact]") {
  // The upper half of a light pile gets a blow from above. One pile was heavy before, and had become soft
  // again.
  constexpr double heavy = 100, light = 5, blow = 6;  // m/s^2, m/s^2, m/s
  for (Kind kind : kinds)
    for (int n : {4, 6, 8}) {
      INFO(n << " vertices along an edge, kind " << static_cast<int>(kind));
      const auto stiffness_after = [&](double weight_at_first) {
        Assembly pile = pile_on({.shape = Plane{}, .friction = 0.5, .margin = 2e-3}, 4, n, kind);
        const auto weigh = [&](double g, double until) {
          pile.system->add(gravity({0, -g, 0}));
          while (pile.state.time < until) REQUIRE(pile.advance(0.01).done);
          return sum_of_stiffnesses(pile);
        };
        weigh(weight_at_first, 1);
        const double soft = weigh(light, 2);
        for (int i = pile.cloths[2].first_particle; i < pile.state.particles(); ++i)
          pile.state.v[3 * i + 1] -= blow;
        CHECK(weigh(light, 2.01) > 1.5 * soft);
        return weigh(light, 4);
      };
      CHECK(stiffness_after(heavy) < 1.1 * stiffness_after(light));
    }
}

TEST_CASE("a contact whose load comes back when it is eased is not eased as far again", "[self-contact]") {
  // Stands for what would snap where a contact gives way: the pile is light until its springs are down to a
  // share of what they were, and is then heavy for a while. Springs that forget go up and down eight times in
  // this time.
  constexpr double heavy = 100, light = 5, gives_way = 0.6, for_a_while = 0.3;  // m/s^2, m/s^2, -, s
  for (Kind kind : kinds)
    for (int n : {4, 6, 8}) {
      INFO(n << " vertices along an edge, kind " << static_cast<int>(kind));
      Assembly pile = pile_on({.shape = Plane{}, .friction = 0.5, .margin = 2e-3}, 4, n, kind);
      const auto weigh = [&](double g, double until) {
        pile.system->add(gravity({0, -g, 0}));
        while (pile.state.time < until) REQUIRE(pile.advance(0.01).done);
        return sum_of_stiffnesses(pile);
      };
      const double stiff = weigh(heavy, 1);
      int came_back = 0;
      while (pile.state.time < 6) {
        const double now = weigh(light, pile.state.time + 0.01);
        if (now > gives_way * stiff) continue;
        ++came_back;
        CHECK(weigh(heavy, pile.state.time + for_a_while) > 0.9 * stiff);
      }
      CHECK(came_back >= 1);
      CHECK(came_back <= 2);
    }
}

TEST_CASE("a body that comes to lie on two layers is not thrown off", "[self-contact]") {
  const Vec3 size(0.1, 0.05, 0.1);
  const std::array models = {ClothModel::noh_jung, ClothModel::woven};
  const std::array masses = {0.2, 1.0, 5.0};
  std::size_t run = 0;
  for (const Kind kind : kinds)
    for (const int n : {13, 19, 25})
      for (const double above : {0.0, 5e-3}) {  // m, from where it falls
        const ClothModel model = models[run % models.size()];
        const double mass = masses[run++ % masses.size()];
        INFO("model " << static_cast<int>(model) << ", kind " << static_cast<int>(kind) << ", " << n
                      << " vertices along an edge, " << mass << " kg from " << above << " m");
        Assembly pile = pile_on(floor_along({{.time = 0}}), 2, n, kind, model, 0.3);
        const double lies = 4e-3 + thickness + 0.5 * size[1];
        const Vec3 place(0, lies + above, 0);
        const UniformSolid solid = uniform_solid(Box{.centre = place, .size = size}, mass).value();
        pile.constraints->add(
            {.shape = Box{.centre = place, .size = size},
             .friction = 0.5,
             .margin = 2e-3,
             .rigid = RigidBody{.mass = mass, .inertia = solid.inertia, .centre = solid.centre}});
        double highest = 0, height = above;
        for (int k = 0; k < 20; ++k) {
          REQUIRE(pile.advance(0.01).done);
          height = pile.constraints->bodies()[1].reacting()->centre()[1] - lies;
          highest = std::max(highest, height);
        }
        CHECK(highest < above + 0.5 * thickness);
        CHECK(height > -thickness);
      }
}

TEST_CASE("a pile at rest is not thrown up by shorter steps, nor let down by longer ones", "[self-contact]") {
  constexpr double usual = 0.01, weight_of_layer = 9.81 * 0.2 * 0.01;
  for (const Kind kind : kinds)
    for (const int layers : {2, 5, 8})
      for (const double pieces : {4.0, 64.0}) {
        INFO("kind " << static_cast<int>(kind) << ", " << layers << " layers, steps of a " << pieces << "th");
        Assembly pile = pile_on(floor_along({{.time = 0}}), layers, 5, kind);
        const auto fastest = [&] {
          double most = 0;
          for (int i = 0; i < pile.state.particles(); ++i)
            most = std::max(most, pile.state.v.segment<3>(3 * i).norm());
          return most;
        };
        while (pile.state.time < 1.5) REQUIRE(pile.advance(usual).done);
        const double rests = pile.system->total_energy(pile.state);
        for (const double h : {usual / pieces, usual}) {
          double energy = rests, least = rests, speed = 0;
          for (int k = 0; k < 64; ++k) {
            REQUIRE(pile.advance(h).done);
            energy = std::max(energy, pile.system->total_energy(pile.state));
            least = std::min(least, pile.system->total_energy(pile.state));
            speed = std::max(speed, fastest());
          }
          INFO("steps of " << h << " s");
          // Lifted by what it is compressed, at most.
          CHECK(energy - rests < 0.1 * weight_of_layer * layers * layers * thickness);
          CHECK(rests - least < 0.1 * weight_of_layer * layers * layers * thickness);
          CHECK(speed < 0.15);
        }
        CHECK(fastest() < 5e-3);
      }
}

TEST_CASE("a layer that starts too near comes to its thickness as soon in steps of any length",
          "[self-contact]") {
  constexpr double starts = 0.2 * thickness;
  for (const Kind kind : kinds)
    for (const int n : {4, 6, 8})
      for (const double h : {0.01, 0.002, 0.0002}) {
        INFO("kind " << static_cast<int>(kind) << ", " << n << " vertices along an edge, steps of " << h
                     << " s");
        Assembly pile = pile_on(floor_along({{.time = 0}}), 2, n, kind);
        const int upper = pile.cloths[1].first_particle;
        for (int i = upper; i < pile.state.particles(); ++i) pile.state.x[3 * i + 1] -= thickness - starts;
        while (pile.state.time < 0.06 - 0.5 * h) REQUIRE(pile.advance(h).done);
        double height = 0;
        for (int i = upper; i < pile.state.particles(); ++i)
          height += (pile.state.x[3 * i + 1] - 2e-3) / (pile.state.particles() - upper);
        CHECK(height > 0.8 * thickness);
      }
}
