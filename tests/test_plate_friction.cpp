// Dry friction of a fabric's threads against bending: the loop of KES-FB2, what it leaves of a fold and of a
// droop, and that it makes no energy.
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "solver/assembly/assembly.h"
#include "solver/forces/woven.h"
#include "tests/allocations.h"
#include "tests/dense.h"
#include "tests/same_bits.h"
#include "tests/strips.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double B = 1e-5, H = 4e-4;  // N m, N

Fabric rubbing(double stretch = 500) {
  Fabric fabric{.area_density = 0.15, .stretch = stretch, .bend = B};
  fabric.weave.bend_friction = H;
  fabric.weave.bend_friction_onset = 0.1 * H / B;
  return fabric;
}

// A strip rolled to that curvature [1/m] about the z axis; its middle stays where it is.
VecX rolled(const TriangleMesh& mesh, double curvature, double middle) {
  std::vector<Vec3> all;
  for (const Vec3& x : mesh.positions) {
    const double s = x.x() - middle, angle = curvature * s;
    all.push_back(std::abs(angle) < 1e-9
                      ? Vec3(s, 0.5 * angle * s, x.z())
                      : Vec3(std::sin(angle), 1 - std::cos(angle), 0) / curvature + x.z() * Vec3::UnitZ());
  }
  return stacked(all);
}

// Moment [N] per width between the two halves of a rolled strip: what holds its right half.
double moment(const System& system, const VecX& x, double width) {
  const VecX f = system.force(x, VecX::Zero(x.size()));
  double torque = 0;
  for (Eigen::Index i = 0; i < x.size(); i += 3)
    if (x[i] > 1e-7) torque -= x[i] * f[i + 1] - x[i + 1] * f[i];
  return torque / width;
}

struct Loop {
  double width, slope;  // N at +100 and -100 1/m, the mean; N m between 50 and 150 1/m
  double gentle;        // N, the moment at 20 1/m of the strip that was flat
};

// As KES-FB2 measures it: bent to 250 1/m, to -250 1/m and to 250 1/m again.
Loop loop_of(const Strip& s, const Fabric& fabric, const Vec3& warp) {
  System system(masses(s.mesh, fabric));
  system.add(woven(s.mesh, s.mesh, fabric, warp));
  double low = 1e300, high = -1e300;
  for (const Vec3& x : s.mesh.positions) low = std::min(low, x.z()), high = std::max(high, x.z());
  const double middle = 0.5 * s.length;
  const auto bend_to = [&](double curvature) {
    const VecX x = rolled(s.mesh, curvature, middle);
    system.begin_step({0, 0.01, x, x, 0.01});
    const double M = moment(system, x, high - low);
    system.end_step(x);
    return M;
  };
  std::map<int, double> first, up, down;
  for (int k = 0; k <= 250; k += 10) first[k] = bend_to(k);
  for (int k = 240; k >= -250; k -= 10) down[k] = bend_to(k);
  for (int k = -240; k <= 250; k += 10) up[k] = bend_to(k);
  return {0.5 * (up[100] - down[100] + up[-100] - down[-100]), (up[150] - up[50]) / 100, first[20]};
}

// A sheet that has been bent to and fro, and friction alone as its force.
struct Rubbed {
  TriangleMesh mesh;
  std::shared_ptr<BendMemory> memory = std::make_shared<BendMemory>();
  std::unique_ptr<System> system;
  VecX x;

  explicit Rubbed(StripMesh kind) : mesh(strip(kind, 7, 5, 0.1).mesh) {
    Fabric fabric = rubbing(0);
    fabric.weave.bend_friction_weft = 0.4 * H;
    fabric.weave.bend_weft = 0.5 * B;
    system = std::make_unique<System>(masses(mesh, fabric));
    for (std::unique_ptr<Force>& force : woven(mesh, mesh, fabric, Vec3(1, 0, 0.3), 0, memory))
      if (force->name() == "bend friction") system->add(std::move(force));
    REQUIRE(system->forces().size() == 1);
    for (const double height : {0.0, 4.0, 2.5, 2.9}) {
      x = stacked(mesh.positions) + random_vector(3 * mesh.vertex_count(), 3e-4, 3);
      for (Eigen::Index i = 0; i < x.size(); i += 3)
        x[i + 1] += height * x[i] * x[i] + 0.4 * height * x[i] * x[i + 2];
      system->begin_step({0, 0.01, x, x, 0.01});
      if (height != 2.9) system->end_step(x);
    }
  }
  const Force& force() const { return *system->forces()[0]; }
  VecX push(const VecX& at) const {
    VecX f = VecX::Zero(at.size());
    force().add_force(at, f, f);
    return f;
  }
};

constexpr std::array three_meshes = {StripMesh::square, StripMesh::hexagonal, StripMesh::irregular};

}  // namespace

TEST_CASE("a strip bent to and fro shows the loop of KES-FB2: 2HB wide, with the slope B",
          "[woven][friction]") {
  for (StripMesh kind : strip_meshes)
    for (int cells : {12, 18, 24})
      for (double onset : {5.0, Weave().bend_friction_onset}) {
        const Strip s = strip(kind, cells, cells / 2, 0.012);
        INFO(name(kind) << ", " << cells << " cells, onset " << onset << " 1/m");
        Fabric even = rubbing(0);
        even.weave.bend_friction_onset = onset;
        Fabric directed = even;
        directed.weave.bend_weft = 0.4 * B;
        directed.weave.bend_friction_weft = 0.5 * H;
        const Loop warp = loop_of(s, directed, Vec3::UnitX()), weft = loop_of(s, directed, Vec3::UnitZ()),
                   bias = loop_of(s, even, Vec3(1, 0, 1));
        CHECK(warp.width == Approx(2 * H).epsilon(0.02));
        CHECK(warp.slope == Approx(B).epsilon(0.02));
        CHECK(weft.width == Approx(H).epsilon(0.02));
        CHECK(weft.slope == Approx(0.4 * B).epsilon(0.02));
        CHECK(bias.width == Approx(2 * H).epsilon(0.02));
        CHECK(bias.slope == Approx(B).epsilon(0.02));
        CHECK(bias.gentle == Approx(20 * B + H * std::min(1.0, 20 / onset)).epsilon(0.03));
      }
}

TEST_CASE("a rolled strip left alone stays rolled by H / B, and one without friction opens",
          "[woven][friction]") {
  const auto left = [](StripMesh kind, Fabric fabric) {
    const Strip s = strip(kind, 20, 5, 0.04);
    fabric.weave.bend_time = 0.2;  // it creeps open: nothing swings beyond
    Assembly all({0, 0, 0});
    all.add(ClothPart{.mesh = s.mesh, .fabric = fabric, .model = ClothModel::woven, .imperfection = 0});
    all.state.x = rolled(s.mesh, 100, 0.5 * s.length);
    all.use("implicit-euler", "mpcg+block-ic0", {.tolerance = 1e-10});
    for (int step = 0; step < 80; ++step) REQUIRE(all.advance(0.05).done);
    // The curvature of the circle through three vertices, seen along the axis of the roll.
    const auto near = [&](double at) {
      int best = 0;
      const auto off = [&](int v) {
        return std::abs(s.mesh.positions[static_cast<std::size_t>(v)].x() - at * s.length);
      };
      for (int i = 0; i < s.mesh.vertex_count(); ++i)
        if (off(i) < off(best)) best = i;
      return Vec3(all.state.x[3 * best], all.state.x[3 * best + 1], 0);
    };
    const Vec3 a = near(0.2), b = near(0.5), c = near(0.8);
    return 2 * (b - a).cross(c - a).norm() / ((b - a).norm() * (c - b).norm() * (c - a).norm());
  };
  for (StripMesh kind : three_meshes) {
    INFO(name(kind));
    Fabric fabric = rubbing();
    CHECK(left(kind, fabric) == Approx(H / B).epsilon(0.05));
    fabric.weave.bend_friction = 0.25 * H;
    CHECK(left(kind, fabric) == Approx(0.25 * H / B).epsilon(0.05));
    fabric.weave.bend_friction = 0;
    CHECK(left(kind, fabric) < 0.02 * H / B);
  }
}

TEST_CASE("a cantilever that sags comes to rest higher than one that was pulled down and let go",
          "[woven][friction]") {
  // Small deflections: at s from the tip the weight asks for the moment M = q s^2 / 2, and B kappa = M - m,
  // |m| <= H.
  const double L = 0.05, q = 0.15 * 9.81, most = 0.5 * q * L * L, holds = 0.2 * most, bend = 5e-4;
  const auto droop = [&](double (*curvature)(double M, double h)) {
    double sum = 0;
    constexpr int n = 2000;
    for (int k = 0; k < n; ++k) {
      const double s = L * (k + 0.5) / n;
      sum += curvature(0.5 * q * s * s, holds) / bend * s * L / n;
    }
    return sum;
  };
  const double above = droop([](double M, double h) { return std::max(0.0, M - h); });
  const double below = droop([](double M, double h) { return std::max(0.0, std::min(M + h, 2 * M - h)); });
  const double elastic = droop([](double M, double) { return M; });
  REQUIRE(above < 0.8 * elastic);
  REQUIRE(below > 1.1 * elastic);
  for (StripMesh kind : three_meshes) {
    const Strip s = strip(kind, 20, 4, L);
    Fabric fabric{.area_density = 0.15, .stretch = 500, .bend = bend};
    fabric.weave.bend_friction = holds;
    fabric.weave.bend_friction_onset = 0.1 * holds / bend;
    fabric.weave.bend_time = 0.05;
    const auto end = [&](double pull) {
      System system(masses(s.mesh, fabric));
      system.add(woven(s.mesh, s.mesh, fabric));
      Constraints constraints;
      constraints.pin(s.clamped);
      ImplicitEuler stepper(system, constraints, make_linear_solver("mpcg+block-ic0"), {.tolerance = 1e-10});
      State state = at_rest(s.mesh);
      const auto go = [&](double from, double to, int steps) {
        for (int k = 1; k <= steps; ++k) {
          system.add(gravity({0, -9.81 * (from + (to - from) * std::min(1.0, 1.5 * k / steps)), 0}));
          REQUIRE(stepper.advance(state, 0.03).done);
        }
      };
      go(0, pull, 60);
      if (pull != 1) go(pull, 1, 60);
      double height = 0;
      for (int i : s.tip) height -= state.x[3 * i + 1] / static_cast<double>(s.tip.size());
      return height;
    };
    INFO(name(kind) << ": " << end(1) << " of " << above << ", " << end(2) << " of " << below << " m");
    CHECK(end(1) == Approx(above).epsilon(0.08));
    CHECK(end(2) == Approx(below).epsilon(0.08));
  }
}

TEST_CASE("friction against bending has the laws of a force, and turns with the cloth",
          "[woven][friction][forces]") {
  for (StripMesh kind : three_meshes) {
    INFO(name(kind));
    const Rubbed r(kind);
    const VecX f = r.push(r.x);
    REQUIRE(f.norm() > 1e-6);
    double worst = 0;
    for (Eigen::Index k = 0; k < f.size(); ++k) {
      VecX up = r.x, down = r.x;
      up[k] += 1e-8;
      down[k] -= 1e-8;
      worst = std::max(worst, std::abs(f[k] + (r.force().energy(up) - r.force().energy(down)) / 2e-8));
    }
    CHECK(worst < 1e-4 * f.lpNorm<Eigen::Infinity>());
    Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
    const Mat3 R = rotation(2.1, Vec3(1, -2, 0.5));
    VecX turned = r.x, of_turned = f;
    for (Eigen::Index i = 0; i < f.size(); i += 3) {
      sum += f.segment<3>(i);
      torque += r.x.segment<3>(i).cross(f.segment<3>(i));
      turned.segment<3>(i) = R * r.x.segment<3>(i) + Vec3(0.3, 1, -2);
      of_turned.segment<3>(i) = R * f.segment<3>(i);
    }
    CHECK(sum.norm() < 1e-10 * f.norm());
    CHECK(torque.norm() < 1e-10 * f.norm());
    CHECK((r.push(turned) - of_turned).norm() < 1e-8 * f.norm());
    CHECK(r.force().energy(turned) == Approx(r.force().energy(r.x)));
  }
}

TEST_CASE(
    "the matrix of friction is positive semidefinite, and its right side the force at the end of the step",
    "[woven][friction][forces]") {
  for (Stiffness stiffness : {Stiffness::tangent, Stiffness::chord, Stiffness::majorant}) {
    const Rubbed r(StripMesh::irregular);
    const Eigen::Index n = r.x.size();
    const VecX y = random_vector(n, 1e-4, 5);
    BlockMatrix A = r.system->matrix();
    A.set_to_mass(std::vector<double>(static_cast<std::size_t>(n / 3), 0.0));
    VecX b = VecX::Zero(n);
    const double c = 0.1;
    r.force().add_linearised(r.x, VecX::Zero(n), y, c, stiffness, A, b);
    CHECK((b - c * r.push(r.x + y)).norm() < 1e-12 * b.norm());
    const Eigen::MatrixXd K = dense(A) / (c * c);
    CHECK((K - K.transpose()).norm() < 1e-14 * K.norm());
    CHECK(K.norm() > 1);
    CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues().minCoeff() > -1e-12 * K.norm());
    // Beyond the point that it touches, the energy lies below the parabola.
    if (stiffness == Stiffness::tangent) continue;
    for (unsigned seed = 1; seed < 6; ++seed) {
      const VecX d = random_vector(n, 1e-7, seed), at = r.x + y;
      const double parabola = r.force().energy(at) - r.push(at).dot(d) + 0.5 * d.dot(K * d);
      CHECK(r.force().energy(at + d) <= parabola + 1e-6 * d.dot(K * d));
    }
  }
}

TEST_CASE("a sheet whose threads rub makes no energy, and comes to rest", "[woven][friction]") {
  for (const char* integrator : {"implicit-euler", "bdf2"}) {
    Assembly all({0, -9.81, 0});
    Cloth& cloth = all.add(
        ClothPart{.mesh = equilateral_sheet(13, 13, 0.05), .fabric = rubbing(), .model = ClothModel::woven});
    all.pin(PinVertices{{0, 12}}, 0);
    CHECK(cloth.memory);
    all.use(integrator, "mpcg+block-ic0", {.tolerance = 1e-8});
    const double start = all.system->total_energy(all.state);
    double before = start, scale = std::abs(all.system->gravity_energy(all.state.x)) + 1;
    for (int step = 0; step < 200; ++step) {
      REQUIRE(all.advance(0.01).done);
      const double after = all.system->total_energy(all.state);
      INFO(integrator << ", step " << step);
      if (integrator[0] == 'i') CHECK(after <= before + 1e-9 * scale);
      CHECK(after <= start + 1e-9 * scale);
      before = after;
    }
  }
}

namespace {

// Fails the first `failures` solves. Its solver remembers nothing of them; block-ic0 counts for how many
// matrices its shift has stood.
class Failing final : public LinearSolver {
 public:
  explicit Failing(int failures) : left_(failures) {}
  std::string_view name() const override { return "failing"; }
  LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter, const LinearOptions& options,
                     VecX& dv) override {
    LinearReport report = inner_->solve(A, b, filter, options, dv);
    if (--left_ >= 0) report.reason = StopReason::indefinite;
    return report;
  }

 private:
  int left_;
  std::unique_ptr<LinearSolver> inner_ = make_linear_solver("mpcg");
};

// A clamped strip that falls.
struct Falling {
  Strip s = strip(StripMesh::irregular, 12, 4, 0.05);
  std::shared_ptr<BendMemory> memory = std::make_shared<BendMemory>();
  System system{masses(s.mesh, rubbing())};
  Constraints constraints;
  State state = at_rest(s.mesh);

  Falling() {
    system.add(woven(s.mesh, s.mesh, rubbing(), std::optional<Vec3>(), 0, memory));
    system.add(Gravity{});
    constraints.pin(s.clamped);
  }
};

}  // namespace

TEST_CASE("friction remembers each piece of a halved step once, and nothing of a step that failed",
          "[woven][friction]") {
  Falling one, two;
  Bdf halving(one.system, one.constraints, std::make_unique<Failing>(1), {}, 1);
  Bdf halves(two.system, two.constraints, make_linear_solver("mpcg"), {}, 1);
  for (int step = 0; step < 10; ++step) {
    const StepReport report = halving.advance(one.state, 0.02);
    REQUIRE(report.done);
    REQUIRE(report.substeps == (step == 0 ? 2 : 1));
    for (int half = 0; half < (step == 0 ? 2 : 1); ++half)
      REQUIRE(halves.advance(two.state, step == 0 ? 0.01 : 0.02).done);
    CHECK(same_bits(one.state.x, two.state.x));
    for (std::size_t t = 0; t < one.memory->rest.size(); ++t)
      CHECK(one.memory->rest[t] == two.memory->rest[t]);
  }
  // The first half is done, then every piece fails: the step returns to where it began, and so does what
  // rubs.
  class LateFailing final : public LinearSolver {
   public:
    std::string_view name() const override { return "late"; }
    LinearReport solve(const BlockMatrix& A, const VecX& b, const Filter& filter,
                       const LinearOptions& options, VecX& dv) override {
      LinearReport report = inner_->solve(A, b, filter, options, dv);
      if (++solves_ != 2) report.reason = StopReason::indefinite;
      return report;
    }
    int solves_ = 0;
    std::unique_ptr<LinearSolver> inner_ = make_linear_solver("mpcg");
  };
  const State before = one.state;
  const std::vector<Vec3> rest = one.memory->rest;
  auto solver = std::make_unique<LateFailing>();
  const LateFailing& late = *solver;
  Bdf failing(one.system, one.constraints, std::move(solver), {.max_halvings = 2}, 1);
  CHECK_FALSE(failing.advance(one.state, 0.02).done);
  CHECK(late.solves_ > 2);
  CHECK(same_bits(before.x, one.state.x));
  CHECK(rest == one.memory->rest);
}

TEST_CASE("friction goes on where forces are made anew with its memory", "[woven][friction]") {
  Falling one;
  Bdf stepper(one.system, one.constraints, make_linear_solver("mpcg+block-ic0"), {}, 1);
  for (int step = 0; step < 10; ++step) REQUIRE(stepper.advance(one.state, 0.02).done);
  System anew(masses(one.s.mesh, rubbing()));
  anew.add(woven(one.s.mesh, one.s.mesh, rubbing(), std::optional<Vec3>(), 0, one.memory));
  anew.add(Gravity{});
  System forgetful(masses(one.s.mesh, rubbing()));
  forgetful.add(woven(one.s.mesh, one.s.mesh, rubbing()));
  forgetful.add(Gravity{});
  const VecX still = VecX::Zero(one.state.x.size()), f = one.system.force(one.state.x, still);
  CHECK((anew.force(one.state.x, still) - f).norm() < 1e-12 * f.norm());
  CHECK((forgetful.force(one.state.x, still) - f).norm() > 1e-3 * f.norm());
}

TEST_CASE("friction against bending gives the same bits on any number of threads and allocates nothing",
          "[woven][friction]") {
  const ThreadsRestored restored;
  VecX first;
  for (int t : {1, 2, 7}) {
    set_threads(t);
    Assembly all({0, -9.81, 0});
    all.add(ClothPart{.mesh = grid(64, 64, 1, 1), .fabric = rubbing(), .model = ClothModel::woven});
    all.pin(PinVertices{{0, 63}}, 0);
    all.use("implicit-euler", "mpcg");
    REQUIRE(all.advance(0.01).done);
    const long before = allocations();
    for (int n = 0; n < 6; ++n) REQUIRE(all.advance(0.01).done);
    if (counts_allocations()) CHECK(allocations() == before);
    if (first.size() == 0) first = all.state.x;
    CHECK(same_bits(first, all.state.x));
  }
}

TEST_CASE("numbers that make no friction are refused by name", "[woven][friction]") {
  const TriangleMesh mesh = grid(3, 3, 1, 1);
  const auto refused = [&](const auto& change, const char* what) {
    Fabric fabric = rubbing();
    change(fabric);
    CHECK_THROWS_WITH(woven(mesh, mesh, fabric, Vec3::UnitX()), Catch::Contains(what));
  };
  refused([](Fabric& f) { f.weave.bend_friction = -1; }, "bend_friction = -1 N");
  refused([](Fabric& f) { f.weave.bend_friction = NAN; }, "bend_friction");
  refused([](Fabric& f) { f.weave.bend_friction_weft = 0; }, "bend_friction_weft = 0 N");
  refused([](Fabric& f) { f.weave.bend_friction = 0, f.weave.bend_friction_weft = 1e-4; },
          "bend_friction = 0 N");
  refused([](Fabric& f) { f.weave.bend_friction_onset = 0; }, "bend_friction_onset = 0 1/m");
  refused([](Fabric& f) { f.bend = 0; }, "bend = 0 N.m");
  Fabric fabric = rubbing();
  fabric.weave.bend_friction_weft = 2e-4;
  CHECK_THROWS_WITH(woven(mesh, mesh, fabric), Catch::Contains("warp"));
}
