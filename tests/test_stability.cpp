// The limits of the step against closed forms: the amplification of a vibration, the highest frequency by
// Lanczos' method, and the longest steps at which runs are stable.
#include <catch2/catch.hpp>

#include "solver/forces/linear_spring.h"
#include "solver/stability/stability.h"
#include "tests/desk.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

namespace {

const Tableau& tableau(std::string_view name) {
  for (const Tableau& t : tableaux())
    if (t.name == name) return t;
  throw std::logic_error("no such tableau");
}

using Springs = std::vector<PairForce<LinearSpring>::Element>;

// Springs of one strength, damped along them, at rest.
struct Net {
  System system;
  Constraints constraints;
  State rest;

  Net(const std::vector<Vec3>& x, double m, Springs springs, double k_d)
      : system(std::vector<double>(x.size(), m)),
        rest{0, stacked(x), VecX::Zero(3 * static_cast<int>(x.size()))} {
    for (auto& s : springs) s.rest.L = (x[s.particles[0]] - x[s.particles[1]]).norm();
    system.add(std::make_unique<PairForce<LinearSpring>>(std::move(springs), k_d));
  }
  Spectrum spectrum(int count = 6) { return stiffest_modes(system, constraints, rest, count); }

  // Does it still after so many steps, when it shakes a little?
  bool stays_calm(std::string_view name, double h, int steps) {
    State state = rest;
    state.v = random_vector(state.v.size(), 1e-7, 3);
    for (int i : constraints.pinned()) state.v.segment<3>(3 * i).setZero();
    const double start = system.kinetic_energy(state.v);
    auto stepper = make_integrator(name, system, constraints, make_linear_solver("mpcg"));
    for (int n = 0; n < steps; ++n)
      if (!stepper->advance(state, h).done) return false;
    return system.kinetic_energy(state.v) + system.elastic_energy(state.x) < 1e3 * start;
  }
};

Net chain(int links, double k, double m, double k_d = 0) {
  std::vector<Vec3> x;
  Springs springs;
  for (int i = 0; i <= links; ++i) x.emplace_back(i, 0, 0);
  for (int i = 0; i < links; ++i) springs.push_back({i, i + 1, {0, k}});
  Net net(x, m, springs, k_d);
  net.constraints.pin({0, links});
  return net;
}

// 2-d: structural springs k and both diagonals d; its rim is held.
Net square(int side, double k, double d, double m) {
  std::vector<Vec3> x;
  Springs springs;
  std::vector<int> rim;
  for (int i = 0; i < side * side; ++i) {
    const int u = i % side, w = i / side;
    x.emplace_back(u, 0, w);
    if (u == 0 || w == 0 || u == side - 1 || w == side - 1) rim.push_back(i);
    if (u + 1 < side) springs.push_back({i, i + 1, {0, k}});
    if (w + 1 < side) springs.push_back({i, i + side, {0, k}});
    if (u + 1 < side && w + 1 < side) {
      springs.push_back({i, i + side + 1, {0, d}});
      springs.push_back({i + 1, i + side, {0, d}});
    }
  }
  Net net(x, m, springs, 0);
  net.constraints.pin(rim);
  return net;
}

Net cube(int n, double k, double m, double k_d) {
  const Lattice lattice = box_lattice({n, n, n}, Vec3::Ones());
  Springs springs;
  for (const auto* pairs : {&lattice.structural, &lattice.shear, &lattice.bend})
    for (const LatticePair& p : *pairs) springs.push_back({p.i, p.j, {0, k}});
  return Net(lattice.positions, m, springs, k_d);
}

}  // namespace

TEST_CASE("step limits of one vibration are the closed ones", "[stability]") {
  for (const double w : {0.3, 10.0, 7e4}) {
    const Mode undamped{w * w, 0};
    CHECK(step_limit(tableau("explicit-euler"), undamped) == 0);
    CHECK(step_limit(tableau("midpoint"), undamped) == 0);
    CHECK(step_limit(tableau("symplectic-euler"), undamped) * w == Approx(2).epsilon(1e-6));
    CHECK(step_limit(tableau("rk4"), undamped) * w == Approx(std::sqrt(8.0)).epsilon(1e-6));
    CHECK(step_limit(tableau("sb-implicit"), undamped) * w == Approx(1).epsilon(1e-6));
    for (const double zeta : {0.01, 0.2, 0.7}) {
      const Mode damped{w * w, 2 * zeta * w};
      CHECK(step_limit(tableau("explicit-euler"), damped) * w == Approx(2 * zeta).epsilon(1e-9));
      CHECK(step_limit(tableau("symplectic-euler"), damped) * w ==
            Approx(2 * (std::sqrt(1 + zeta * zeta) - zeta)).epsilon(1e-9));
    }
    const Mode slow{w * w, 5 * w};  // two real roots; of the faster: 2, 2 and 2.7853 over it
    const double root = w * (2.5 + std::sqrt(2.5 * 2.5 - 1));
    CHECK(step_limit(tableau("explicit-euler"), slow) * root == Approx(2).epsilon(1e-9));
    CHECK(step_limit(tableau("midpoint"), slow) * root == Approx(2).epsilon(1e-9));
    CHECK(step_limit(tableau("sb-implicit"), slow) * root == Approx(1).epsilon(1e-9));
    CHECK(step_limit(tableau("rk4"), slow) * root == Approx(2.785293563).epsilon(1e-8));
  }
  CHECK(std::isinf(step_limit(tableau("rk4"), Mode{0, 0})));
}

TEST_CASE("rk4 bears longer steps than midpoint, however a vibration is damped", "[stability]") {
  for (double zeta = 0; zeta < 8; zeta += 0.037) {
    const Mode mode{1, 2 * zeta};
    CHECK(step_limit(tableau("rk4"), mode) > 1.05 * step_limit(tableau("midpoint"), mode));
  }
}

TEST_CASE("the highest frequency is that of chain and square lattice", "[stability]") {
  const double k = 50, d = 20, m = 0.02;
  for (const int links : {2, 3, 20, 61}) {
    const double omega = 2 * std::sqrt(k / m) * std::sin(0.5 * M_PI * (links - 1) / links);
    CHECK(chain(links, k, m).spectrum().omega() == Approx(omega).epsilon(1e-7));
  }
  const double endless = std::sqrt(4 * (k + d) / m);
  const double found = square(40, k, d, m).spectrum().omega();
  CHECK(found < endless * (1 + 1e-9));
  CHECK(found == Approx(endless).epsilon(0.005));
  // A pair: sqrt(2 k / m); nothing that vibrates.
  Net pair({{0, 0, 0}, {1, 0, 0}}, m, {{0, 1, {0, k}}}, 0);
  CHECK(pair.spectrum().omega() == Approx(std::sqrt(2 * k / m)).epsilon(1e-9));
  Net loose({{0, 0, 0}, {1, 0, 0}}, m, {}, 0);
  CHECK(loose.spectrum().modes.empty());
}

TEST_CASE("damping of one strength is proportional, and a mode has its share", "[stability]") {
  const double k = 50, m = 0.02, k_d = 0.03;
  const Spectrum s = chain(20, k, m, k_d).spectrum(4);
  CHECK(s.proportional);
  REQUIRE(s.modes.size() == 4);
  for (const Mode& mode : s.modes) CHECK(mode.d == Approx(k_d / k * mode.omega2).epsilon(1e-6));
  Net mixed({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, m, {{0, 1, {0, k}}, {1, 2, {0, 3 * k}}}, k_d);
  CHECK_FALSE(mixed.spectrum(3).proportional);
}

TEST_CASE("runs bear the step that theory says, to 2 %", "[stability]") {
  struct Case {
    const char* what;
    Net net;
  };
  const double k = 50, m = 0.02;
  for (const double zeta : {0.0, 0.1, 0.6}) {  // of the highest frequency
    const double k_d = zeta * std::sqrt(k * m);
    Case cases[] = {{"chain", chain(20, k, m, k_d)}, {"cube", cube(5, k, m, 0.5 * k_d)}};
    for (Case& c : cases) {
      const Spectrum spectrum = c.net.spectrum();
      CHECK(spectrum.proportional);
      for (const Tableau& t : tableaux()) {
        const double limit = step_limit(t, spectrum);
        INFO(t.name << ", " << c.what << ", zeta " << zeta << ", limit " << limit);
        if (limit == 0) {
          CHECK_FALSE(c.net.stays_calm(t.name, 1 / spectrum.omega(), 2000));
          continue;
        }
        CHECK(c.net.stays_calm(t.name, 0.98 * limit, 2000));
        CHECK_FALSE(c.net.stays_calm(t.name, 1.02 * limit, 40000));  // explicit Euler grows slowly
      }
      CHECK(c.net.stays_calm("implicit-euler", 50 / spectrum.omega(), 50));  // has none
    }
  }
}

TEST_CASE("drape stability: table, JSON and CSV of one search", "[stability]") {
  Desk desk;
  desk.write("s.toml",
             "[simulation]\nduration = 4\ntime_step = 0.001\ngravity = [0, 0, 0]\n[[soft]]\n"
             "particles = [3, 3, 3]\nspacing = 0.1\nmass = 0.27\nequal_masses = true\n"
             "structural = 40\nshear = 40\nbend = 40\ndamping = 0.2\n");
  CHECK(desk.said(desk.drape(
            "stability s.toml --out o --integrators "
            "symplectic-euler,explicit-euler,rk4,sb-implicit,implicit-euler --growth 1000 --quiet")) == 0);
  const JsonValue found = JsonValue::parse(content(desk.path / "o/stability.json"));
  CHECK(found["proportional_damping"] == true);
  REQUIRE(found["rows"].size() == 5);
  for (const JsonValue& row : found["rows"]) {
    INFO(row.dump());
    if (row["integrator"] == "implicit-euler") {
      CHECK(row["limited"] == false);
      CHECK(row["largest_stable_step"] == Approx(0.4));
      CHECK(row["theory"].is_null());
      continue;
    }
    CHECK(row["limited"] == true);
    CHECK(row["largest_stable_step"].get<double>() == Approx(row["theory"].get<double>()).epsilon(0.03));
    CHECK(row["runs"].get<int>() > 3);
  }
  check_same_table(content(desk.path / "o/stability.csv"), found["rows"]);
  for (const auto& [words, message] : {std::pair{"stability", "SCENE is required"},
                                       {"stability none.toml", "none.toml: no such file"},
                                       {"stability s.toml --integrators rk5", "there is no integrator 'rk5'"},
                                       {"stability s.toml --integrator bdf2", "give --integrators"},
                                       {"stability s.toml --time-step 5ms", "give --longest and --shortest"},
                                       {"stability s.toml --time '2 m'", "--time 2 m"},
                                       {"stability s.toml --time 0", "--time 0"},
                                       {"stability s.toml --longest 9", "--longest 9: is longer than a run"},
                                       {"stability s.toml --shortest 1", "--shortest"},
                                       {"stability s.toml --longest 1ns", "give --shortest, too"},
                                       {"stability s.toml --precision 3", "--precision 3"}}) {
    INFO(words);
    CHECK(desk.said(desk.drape(words)) == 2);
    CHECK_THAT(desk.err, Catch::StartsWith("error: ") && Catch::Contains(message));
    CHECK(count(desk.err, "\n") == 1);
  }
}
