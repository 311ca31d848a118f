// Laws of the integrator "pbd": what one projection keeps, what many of them come to, and what its stiffness
// means.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "solver/assembly/assembly.h"
#include "solver/forces/buckling_spring.h"
#include "solver/forces/cluster_force.h"
#include "solver/forces/cluster_sets.h"
#include "solver/forces/linear_spring.h"
#include "solver/forces/self_contact_force.h"
#include "solver/forces/tension_spring.h"
#include "solver/forces/woven.h"
#include "tests/same_bits.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

namespace {

StepOptions projected(int substeps, int iterations, Links links = Links::compliance, double alpha = 1) {
  StepOptions options;
  options.projection = {.substeps = substeps, .iterations = iterations, .links = links, .alpha = alpha};
  return options;
}

std::unique_ptr<Integrator> pbd(System& system, Constraints& constraints, const StepOptions& options) {
  return make_integrator("pbd", system, constraints, make_linear_solver("mpcg"), options);
}

Vec3 momentum(const System& system, const VecX& v) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < system.particles(); ++i)
    sum += system.masses()[static_cast<std::size_t>(i)] * v.segment<3>(3 * i);
  return sum;
}

Vec3 angular_momentum(const System& system, const VecX& x, const VecX& v) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < system.particles(); ++i)
    sum += system.masses()[static_cast<std::size_t>(i)] *
           Vec3(x.segment<3>(3 * i)).cross(Vec3(v.segment<3>(3 * i)));
  return sum;
}

// A link between two particles of different masses, in some direction, of length l where it should have 1.
template <class Spring>
struct Link {
  System system{{0.3, 0.7}};
  Constraints constraints;
  State state{0, VecX::Zero(6), VecX::Zero(6)};
  Vec3 n = Vec3(0.3, -0.8, 0.5).normalized();

  explicit Link(double l) {
    system.add(std::make_unique<PairForce<Spring>>(
        std::vector<typename PairForce<Spring>::Element>{{{0, 1}, {1.0, 50.0}}}));
    system.add(Gravity{Vec3::Zero()});
    state.x.head<3>() = Vec3(2, 1, -3);
    state.x.tail<3>() = state.x.head<3>() + l * n;
  }
  double length() const { return (state.x.head<3>() - state.x.tail<3>()).norm(); }
  double after(Links links, double alpha) {
    REQUIRE(pbd(system, constraints, projected(1, 1, links, alpha))->advance(state, 0.01).done);
    return length();
  }
};

// Everything that a cloth or a soft body is made of, in flight and out of its rest shape.
struct Flight {
  std::string name;
  System system;
  State state;
};

Flight flight(const std::string& name, System system, const std::vector<Vec3>& positions) {
  Flight f{name, std::move(system), {0, stacked(positions), {}}};
  f.system.add(Gravity{Vec3::Zero()});
  f.state.x += random_vector(f.state.x.size(), 0.01, 5);
  f.state.v = random_vector(f.state.x.size(), 1, 6);
  return f;
}

// n: vertices along an edge of the cloth.
std::vector<Flight> flights(Kind kind, int n = 6) {
  std::vector<Flight> all;
  const TriangleMesh mesh = bent(n, kind, 0.4, [](double x, double z) { return 0.1 * x * x - 0.2 * x * z; });
  const auto cloth = [&](const std::string& name, std::vector<std::unique_ptr<Force>> forces) {
    System system(lumped_mass(mesh, 0.2));
    system.add(std::move(forces));
    all.push_back(flight(name, std::move(system), mesh.positions));
  };
  cloth("springs", noh_jung(mesh, {.stretch = 100, .bend = 1e-4}));
  for (const DampingKind damping : {DampingKind::relative, DampingKind::axial})
    cloth("damped springs",
          noh_jung(mesh, {.stretch = 100, .bend = 1e-4, .damping = 0.01, .damping_kind = damping}));
  for (const Bending bending : {Bending::plate, Bending::hinges, Bending::quadratic_hinges}) {
    Fabric fabric{.stretch = 100, .bend = 1e-4};
    fabric.weave.bending = bending;
    cloth("woven", woven(mesh, mesh, fabric));
    fabric.weave.stretch_time = fabric.weave.shear_time = 0.02;
    fabric.weave.bend_time = 0.02;
    cloth("damped woven", woven(mesh, mesh, fabric));
    if (bending == Bending::quadratic_hinges) continue;
    fabric.weave.rest_angle = 1;
    cloth("woven that rests bent", woven(mesh, mesh, fabric));
  }
  const Lattice cube = box_lattice({4, 3, 3}, Vec3::Constant(0.1));
  const SoftMaterial soft{.young = 2e3, .damping = 0.1};
  System system(masses(cube, soft));
  system.add(soft_body(cube, soft));
  all.push_back(flight("soft", std::move(system), cube.positions));
  return all;
}

}  // namespace

TEST_CASE("a link has its length after one projection, and a slack one stays", "[pbd]") {
  for (const double l : {0.2, 0.9, 1.0, 1.4, 3.0}) {
    INFO("l = " << l);
    CHECK(Link<LinearSpring>(l).after(Links::length, 1) == Approx(1).epsilon(1e-14));
    CHECK(Link<TensionSpring>(l).after(Links::length, 1) == Approx(std::min(l, 1.0)).epsilon(1e-14));
    for (const double alpha : {0.0, 0.3, 0.8})
      CHECK(Link<LinearSpring>(l).after(Links::length, alpha) == Approx(l + alpha * (1 - l)).epsilon(1e-14));
    CHECK(Link<TensionSpring>(l).after(Links::squared_length, 1) <= std::max(l, 1.0));
  }
}

TEST_CASE("both forms of a link agree to second order", "[pbd]") {
  double before = 0;
  for (const double strain : {0.08, 0.04, 0.02, 0.01}) {
    const double apart = std::abs(Link<LinearSpring>(1 + strain).after(Links::squared_length, 1) - 1);
    if (before > 0) CHECK(std::log2(before / apart) == Approx(2).margin(0.1));
    before = apart;
  }
}

TEST_CASE("a spring alone ends its step as the closed form says, whatever the iterations", "[pbd]") {
  const double k = 50, h = 0.01, W = 1 / 0.3 + 1 / 0.7;
  for (const int iterations : {1, 2, 7})
    for (const double l : {0.6, 1.4}) {
      Link<LinearSpring> link(l);
      REQUIRE(pbd(link.system, link.constraints, projected(1, iterations))->advance(link.state, h).done);
      CHECK(link.length() - 1 == Approx((l - 1) / (1 + h * h * W * k)).epsilon(1e-12));
    }
}

TEST_CASE("a projection keeps momentum and angular momentum to round-off", "[pbd]") {
  for (const Links links : {Links::compliance, Links::length, Links::squared_length})
    for (const double l : {0.4, 1.7}) {
      Link<LinearSpring> link(l);
      link.after(links, 0.7);
      CHECK(momentum(link.system, link.state.v).norm() < 1e-13 * link.state.v.norm());
      CHECK(angular_momentum(link.system, link.state.x, link.state.v).norm() < 1e-13 * link.state.v.norm());
    }
}

TEST_CASE("momentum stays in every model, whatever the iterations", "[pbd]") {
  for (const Kind kind : kinds)
    for (const Links links : {Links::compliance, Links::length, Links::squared_length})
      for (Flight& f : flights(kind)) {
        INFO(f.name << ", links " << static_cast<int>(links));
        Constraints free;
        const Vec3 P = momentum(f.system, f.state.v);
        auto stepper = pbd(f.system, free, projected(5, 2, links, 0.7));
        for (int n = 0; n < 5; ++n) REQUIRE(stepper->advance(f.state, 0.01).done);
        CHECK((momentum(f.system, f.state.v) - P).norm() < 1e-11 * f.state.v.norm() * f.system.masses()[0]);
      }
}

TEST_CASE("with many iterations it is implicit Euler", "[pbd]") {
  for (const Kind kind : kinds)
    for (const int size : {4, 6, 8})
      for (Flight& f : flights(kind, size)) {
        INFO(f.name << ", " << size);
        f.system.add(Gravity{});
        Constraints pinned;
        pinned.pin({0, size - 1});
        State by_newton = f.state, by_turns = f.state;
        auto newton =
            make_integrator("implicit-euler", f.system, pinned, make_linear_solver("eigen-ldlt"),
                            {.newton_iterations = 200, .newton_tolerance = 1e-12, .tolerance = 1e-13});
        REQUIRE(newton->advance(by_newton, 0.004).done);
        Constraints again;
        again.pin({0, size - 1});
        const StepReport report = pbd(f.system, again, projected(1, 3000))->advance(by_turns, 0.004);
        REQUIRE(report.done);
        CHECK(report.residual < 1e-6);
        CHECK((by_newton.x - by_turns.x).cwiseAbs().maxCoeff() < 1e-8);
      }
}

TEST_CASE("static sag is that of the implicit solver to one percent, whatever the iterations", "[pbd]") {
  const auto sag = [](const std::string& integrator, const TriangleMesh& mesh, const StepOptions& options) {
    Sheet sheet(mesh, {.area_density = 0.2, .stretch = 60, .bend = 1e-4, .damping = 0.02});
    std::vector<int> edge;
    for (int i = 0; i < mesh.vertex_count(); ++i)
      if (mesh.positions[static_cast<std::size_t>(i)][0] < -0.19) edge.push_back(i);
    sheet.constraints.pin(edge);
    auto stepper =
        make_integrator(integrator, sheet.system, sheet.constraints, make_linear_solver("mpcg"), options);
    for (int n = 0; n < 400; ++n) REQUIRE(stepper->advance(sheet.state, 0.01).done);
    double lowest = 0;
    for (int i = 0; i < mesh.vertex_count(); ++i) lowest = std::min(lowest, sheet.state.x[3 * i + 1]);
    return -lowest;
  };
  for (const Kind kind : kinds)
    for (const int n : {5, 7, 9}) {
      const TriangleMesh mesh = bent(n, kind, 0.4, [](double, double) { return 0; });
      const double implicit = sag("implicit-euler", mesh, {});
      for (const auto& [substeps, iterations] : {std::pair{20, 1}, {20, 4}, {5, 40}}) {
        INFO(n << ", " << substeps << " substeps of " << iterations);
        CHECK(sag("pbd", mesh, projected(substeps, iterations)) == Approx(implicit).epsilon(0.01));
      }
    }
}

// An element that hardly lets its strain change in a substep would keep what those before it have left wrong.
TEST_CASE("a woven sheet that hangs does so however much it resists fast strains", "[pbd]") {
  for (const Kind kind : kinds)
    for (const int n : {9, 17, 25})
      for (const bool clusters : {false, true})
        for (const double time : {1e-3, 1e-2, 1.0}) {
          CAPTURE(static_cast<int>(kind), n, clusters, time);
          const TriangleMesh mesh = bent(n, kind, 0.2, [](double, double) { return 0; });
          Assembly sheet(Vec3(9.81, 0, 0));
          Fabric fabric{.area_density = 0.15, .stretch = 500, .bend = 1e-6};
          fabric.weave.stretch_time = fabric.weave.shear_time = time;
          sheet.add(
              ClothPart{.mesh = mesh, .fabric = fabric, .model = ClothModel::woven, .clusters = clusters});
          std::vector<int> edge;
          double left = 0, right = 0;
          for (const Vec3& x : mesh.positions) left = std::min(left, x[0]), right = std::max(right, x[0]);
          for (int i = 0; i < mesh.vertex_count(); ++i)
            if (mesh.positions[static_cast<std::size_t>(i)][0] < left + 0.3 * 0.2 / (n - 1))
              edge.push_back(i);
          sheet.pin(PinVertices{edge});
          sheet.use("pbd", "mpcg");
          for (int step = 0; step < 30; ++step) REQUIRE(sheet.advance(0.01).done);
          double lowest = left, fastest = sheet.state.v.cwiseAbs().maxCoeff();
          for (int i = 0; i < mesh.vertex_count(); ++i) lowest = std::max(lowest, sheet.state.x[3 * i]);
          CHECK(lowest - right < 0.03 * (right - left));
          CHECK(fastest < 0.2);
        }
}

TEST_CASE("a vertex that meets a free body, and sticks, takes Bullet's impulse", "[pbd]") {
  constexpr double m_A = 0.3;
  for (const double m_B : {0.1, 2.0})
    for (const Vec3& place : {Vec3(0, 0.1, 0), Vec3(0.06, 0.1, -0.03)}) {
      System system({m_A});
      system.add(Gravity{Vec3::Zero()});
      const Mat3 inertia = m_B * Vec3(0.004, 0.005, 0.006).asDiagonal();
      Constraints constraints;
      constraints.add(Obstacle{.shape = Box{.centre = Vec3::Zero(), .size = Vec3::Constant(0.2)},
                               .friction = 1000,
                               .margin = 0,
                               .rigid = RigidBody{.mass = m_B, .inertia = inertia, .gravity = Vec3::Zero()}});
      State state{0, place, Vec3(0.4, -1, 0.2)};
      REQUIRE(pbd(system, constraints, projected(1, 1))->advance(state, 1e-4).done);
      const ReactingBody& body = *constraints.bodies()[0].reacting();
      Mat3 r;
      r << 0, -place[2], place[1], place[2], 0, -place[0], -place[1], place[0], 0;
      const Mat3 K = Mat3::Identity() / m_A - r * inertia.inverse() * r + Mat3::Identity() / m_B;
      const Vec3 F = K.inverse() * Vec3(0.4, -1, 0.2);  // F dt
      INFO(m_B << " kg at " << place.transpose());
      CHECK((body.momentum() - F).norm() < 2e-3 * F.norm());
      CHECK((m_A * (Vec3(0.4, -1, 0.2) - state.v) - body.momentum()).norm() < 1e-12);
      CHECK((body.angular_momentum() - place.cross(F)).norm() < 2e-3 * F.norm());
    }
}

TEST_CASE("a chain that hangs from a body gives it its weight, and momentum stays", "[pbd]") {
  for (const double m_B : {0.05, 1.0, 100.0})
    for (const int iterations : {1, 5}) {
      Chain chain(8, 0.4, 0.2, 100, {0, -1, 0});
      chain.system.add(Gravity{});
      chain.constraints.add(Obstacle{.shape = Sphere{{0, 0.05, 0}, 0.05},
                                     .margin = 0,
                                     .rigid = RigidBody{.mass = m_B,
                                                        .inertia = 1e-3 * m_B * Mat3::Identity(),
                                                        .centre = {0, 0.05, 0},
                                                        .gravity = Vec3::Zero()}});
      chain.constraints.pin_to_body({0}, 0, chain.state.x);
      auto stepper = pbd(chain.system, chain.constraints, projected(4, iterations));
      const ReactingBody& body = *chain.constraints.bodies()[0].reacting();
      for (int n = 0; n < 50; ++n) REQUIRE(stepper->advance(chain.state, 0.01).done);
      const Vec3 all = body.momentum() + momentum(chain.system, chain.state.v);
      INFO(m_B << " kg, " << iterations << " iterations");
      // The end of the chain is counted with the body that carries it.
      CHECK((all - 0.5 * 0.2 * Vec3(0, -9.81, 0)).norm() < 1e-6);  // the body has no weight
      CHECK((chain.state.x.head<3>() - body.centre() + Vec3(0, 0.05, 0)).norm() < 1e-9);
    }
}

TEST_CASE("two sheets come to rest on each other and on the floor", "[pbd]") {
  for (const Kind kind : kinds) {
    TriangleMesh lower = bent(7, kind, 0.3, [](double, double) { return 0.002; }), upper = lower;
    const int n = lower.vertex_count();
    for (const Vec3& x : upper.positions) lower.positions.push_back(x + Vec3(0.011, 0.003, 0.007));
    for (const Triangle& t : upper.triangles) lower.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
    Sheet both(lower, {.area_density = 0.2, .stretch = 100, .bend = 1e-5, .damping = 0.01});
    std::vector<SelfFace> faces;
    for (std::size_t t = 0; t < lower.triangles.size(); ++t)
      faces.push_back({lower.triangles[t], 1e-3, 0.3, t < upper.triangles.size() ? 0 : 1});
    both.constraints.add_self_faces(faces);
    both.constraints.add(Obstacle{.shape = Plane{}, .friction = 0.3, .margin = 2e-3});
    both.system.add(self_contact_force(both.constraints));
    auto stepper = pbd(both.system, both.constraints, projected(10, 1));
    for (int k = 0; k < 150; ++k) REQUIRE(stepper->advance(both.state, 0.01).done);
    CHECK(max_speed(both.state) < 2e-3);
    for (int i = n; i < 2 * n; ++i) {
      CHECK(both.state.x[3 * i + 1] > 0.002 + 0.0009);
      CHECK(both.state.x[3 * i + 1] < 0.002 + 0.001 + 1e-4);
    }
  }
}

TEST_CASE("a sheet on a slope of cloth sticks below its friction and slides as Coulomb says above it",
          "[pbd]") {
  constexpr double mu = 0.3;
  for (const double slope : {0.2, 0.5}) {
    TriangleMesh lower = grid(9, 9, 0.5, 0.5), upper = grid(5, 5, 0.2, 0.2);
    const int n = lower.vertex_count();
    for (const Vec3& x : upper.positions) lower.positions.push_back(x + Vec3(0.01, 0.00099, 0.02));
    std::vector<SelfFace> faces;
    for (const Triangle& t : lower.triangles) faces.push_back({t, 1e-3, mu, 0});
    for (const Triangle& t : upper.triangles) {
      lower.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
      faces.push_back({lower.triangles.back(), 1e-3, mu, 1});
    }
    Sheet both(lower, {.area_density = 0.2, .stretch = 100, .bend = 1e-5, .damping = 0.01});
    const double angle = std::atan(slope);
    both.system.add(Gravity{9.81 * Vec3(std::sin(angle), -std::cos(angle), 0)});
    for (int i = 0; i < n; ++i) both.constraints.pin(i);
    both.constraints.add_self_faces(faces);
    both.system.add(self_contact_force(both.constraints));
    auto stepper = pbd(both.system, both.constraints, projected(10, 2));
    for (int k = 0; k < 20; ++k) REQUIRE(stepper->advance(both.state, 0.01).done);
    double along = 0;
    for (int i = n; i < n + 25; ++i) along += both.state.v[3 * i] / 25;
    INFO("slope " << slope);
    if (slope < mu)
      CHECK(std::abs(along) < 1e-3);
    else
      CHECK(along == Approx(9.81 * (std::sin(angle) - mu * std::cos(angle)) * 0.2).epsilon(0.03));
  }
}

TEST_CASE("a cluster that hangs from a body gives it its weight, and momentum stays", "[pbd]") {
  for (const double m_B : {0.5, 100.0})
    for (const int iterations : {1, 4}) {
      const Lattice cube = box_lattice({3, 3, 3}, Vec3::Constant(0.05));
      const SoftMaterial soft{.density = 300, .young = 1e5};
      const std::vector<double> own = masses(cube, soft);
      System system(own);
      Clusters clusters(sets_of_cells(cube), own, stacked(cube.positions), "cube");
      const double k = cluster_stiffness(clusters, *soft.young, soft.density);
      system.add(std::make_unique<ClusterForce>(std::move(clusters), k));
      system.add(Gravity{});
      State state{0, stacked(cube.positions), VecX::Zero(3 * cube.particle_count())};
      Constraints constraints;
      constraints.add(Obstacle{.shape = Sphere{{0, 0.2, 0}, 0.05},
                               .margin = 0,
                               .rigid = RigidBody{.mass = m_B,
                                                  .inertia = 1e-2 * m_B * Mat3::Identity(),
                                                  .centre = {0, 0.2, 0},
                                                  .gravity = Vec3::Zero()}});
      std::vector<int> top;
      for (int i = 0; i < cube.particle_count(); ++i)
        if (cube.positions[static_cast<std::size_t>(i)][1] > 0.04) top.push_back(i);
      constraints.pin_to_body(top, 0, state.x);
      auto stepper = pbd(system, constraints, projected(10, iterations));
      for (int n = 0; n < 20; ++n) REQUIRE(stepper->advance(state, 0.01).done);
      const Vec3 all = constraints.bodies()[0].reacting()->momentum() + momentum(system, state.v);
      double mass = 0;  // the body has no weight
      for (const double m : own) mass += m;
      INFO(m_B << " kg, " << iterations << " iterations");
      CHECK((all - 0.2 * mass * Vec3(0, -9.81, 0)).norm() < 5e-3 * mass);
    }
}

namespace {

// Springs that have no particle in common, from nothing to twice their length, some of whose ends are held.
template <class Spring>
void check_taken_at_once(const std::function<typename Spring::Rest(double L)>& rest) {
  using Law = AlongDistance<Spring>;
  constexpr int count = 203;
  const VecX numbers = random_vector(8 * count, 1, 11);
  std::vector<StencilLink<2, typename Spring::Rest>> links;
  std::vector<double> mobility;
  VecX start(6 * count);
  for (int k = 0; k < count; ++k) {
    const auto number = numbers.segment<8>(8 * k);
    const double L = 1.1 + number[0], l = k % 29 == 0 ? 0 : k % 31 == 0 ? L : L * (1 + number[1]);
    links.push_back({{2 * k, 2 * k + 1}, rest(L)});
    start.segment<3>(6 * k) = number.template segment<3>(2);
    const Vec3 n = Vec3(number.template segment<3>(5)).normalized();
    start.segment<3>(6 * k + 3) = start.segment<3>(6 * k) + l * n;
    mobility.push_back(k % 5 == 0 ? 0 : 1 + number[2]);
    mobility.push_back(k % 7 == 0 ? 0 : 2 + number[3]);
  }
  const ProjectionOptions options;
  VecX at_once = start, one_by_one = start;
  std::vector<Vec3> impulses(count), expected(count, Vec3::Zero());
  Substep together{0.01, start, mobility, at_once, options, true, false};
  Substep in_turn{0.01, start, mobility, one_by_one, options, true, false};
  Spring::relax_apart(links.data(), count, together, impulses.data());
  for (std::size_t k = 0; k < count; ++k) relax_pair<Law>(0.0, links[k], in_turn, expected[k]);
  CHECK((one_by_one - start).norm() > 1e-4);
  CHECK(at_once == one_by_one);
  for (std::size_t k = 0; k < count; ++k)
    if (mobility[2 * k] + mobility[2 * k + 1] > 0) CHECK(impulses[k] == expected[k]);
}

}  // namespace

TEST_CASE("springs taken four at a time move to the same bits as one by one", "[pbd]") {
  check_taken_at_once<LinearSpring>([](double L) { return LinearSpring::Rest{L, 300 * L}; });
  check_taken_at_once<TensionSpring>([](double L) { return TensionSpring::Rest{L, 300 * L}; });
  check_taken_at_once<BucklingSpring>([](double L) { return BucklingSpring::rest(L, 2 * L, 700); });
}

TEST_CASE("a step of pbd has the same bits on any number of threads", "[pbd]") {
  for (const bool is_woven : {false, true})
    check_same_bits([is_woven] {
      const TriangleMesh mesh = grid(130, 130, 1, 1);
      System system(lumped_mass(mesh, 0.2));
      const Fabric fabric{.area_density = 0.2, .stretch = 20, .bend = 1e-6};
      system.add(is_woven ? woven(mesh, mesh, fabric) : noh_jung(mesh, fabric));
      system.add(Gravity{});
      Constraints constraints;
      constraints.pin(0);
      State state = at_rest(mesh);
      auto stepper = pbd(system, constraints, projected(3, 2));
      for (int n = 0; n < 2; ++n) REQUIRE(stepper->advance(state, 0.01).done);
      return state;
    });
}

TEST_CASE("pbd says what it cannot take", "[pbd]") {
  Sheet sheet(grid(4, 4, 1, 1));
  CHECK_THROWS_WITH(pbd(sheet.system, sheet.constraints, projected(0, 1)), Catch::Contains("substeps"));
  CHECK_THROWS_WITH(pbd(sheet.system, sheet.constraints, projected(1, 1, Links::length, 1.5)),
                    Catch::Contains("alpha = 1.5"));
  const Fabric rubs = [] {
    Fabric fabric;
    fabric.weave.bend_friction = 1e-3;
    return fabric;
  }();
  System rubbing(lumped_mass(sheet.mesh, 0.2));
  rubbing.add(woven(sheet.mesh, sheet.mesh, rubs));
  CHECK_THROWS_WITH(pbd(rubbing, sheet.constraints, {}),
                    Catch::Contains("'bend friction' has no position-based"));
  StepOptions held;
  held.contact = ContactMode::constraint;
  CHECK_THROWS_WITH(pbd(sheet.system, sheet.constraints, held), Catch::Contains("restitution"));
}
