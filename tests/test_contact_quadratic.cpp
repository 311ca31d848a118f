// Contact without friction on a linear system is a quadratic problem: of all motions that stay outside of the
// planes, the step takes the one of least potential. Here a dense solver finds it in another way, by its
// multipliers.
#include "solver/forces/plate_force.h"
#include "tests/integrators.h"

using namespace drape;
using namespace drape::test;

namespace {

using Matrix = Eigen::MatrixXd;

// The least |A y - b|, y >= 0, by an active set.     [Lawson & Hanson, Solving least squares problems, algorithm 23.10]
VecX nonnegative_least_squares(const Matrix& A, const VecX& b) {
  std::vector<int> active;
  VecX y = VecX::Zero(A.cols());
  const auto solve = [&] {
    Matrix part(A.rows(), static_cast<Eigen::Index>(active.size()));
    for (std::size_t k = 0; k < active.size(); ++k) part.col(static_cast<Eigen::Index>(k)) = A.col(active[k]);
    return VecX(part.colPivHouseholderQr().solve(b));
  };
  for (;;) {
    VecX slope = A.transpose() * (b - A * y);
    for (int k : active) slope[k] = 0;
    int best;
    if (slope.maxCoeff(&best) <= 1e-12 * A.norm() * b.norm()) return y;
    active.push_back(best);
    for (;;) {
      const VecX z = solve();
      double share = 1;  // of the way to z that keeps every y >= 0
      for (std::size_t k = 0; k < active.size(); ++k) {
        const double at = y[active[k]], to = z[static_cast<Eigen::Index>(k)];
        if (to <= 0) share = std::min(share, at / (at - to));
      }
      for (std::size_t k = 0; k < active.size(); ++k) {
        const double at = y[active[k]], to = z[static_cast<Eigen::Index>(k)];
        y[active[k]] = share < 1 && to <= 0 && at / (at - to) <= share ? 0 : at + share * (to - at);
      }
      std::erase_if(active, [&](int k) { return y[k] == 0; });
      if (share == 1) break;
    }
  }
}

// Particles that are joined by random springs of no length, above planes.
struct LinearProblem {
  std::vector<Plane> planes;
  std::vector<double> masses;
  PlateEnergy springs;
  State start;
  static constexpr double margin = 1e-3, h = 0.01;

  LinearProblem(int particles, std::vector<Plane> bodies, unsigned seed) : planes(std::move(bodies)) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < particles; ++i) {
      masses.push_back(std::pow(10, -4 + 2 * uniform(engine)));
      for (int j = 0; j < i; ++j)
        if (j == i - 1 || uniform(engine) < 0.1)
          springs.pairs.push_back({j, i, std::pow(10, 3 * uniform(engine))});
    }
    start = {0, random_vector(3 * particles, 0.05, seed + 1), random_vector(3 * particles, 3, seed + 2)};
    for (int i = 0; i < particles; ++i)
      for (int again = 0; again < 100; ++again)  // out of all planes
        for (const Plane& p : planes) {
          const double inside = margin - p.normal.dot(start.x.segment<3>(3 * i) - p.point);
          if (inside > 0) start.x.segment<3>(3 * i) += (inside + 1e-4 * (i % 3)) * p.normal;
        }
  }

  // The velocity at the end of a step of implicit Euler: the least v.Av/2 - b.v with N v >= c, where A is 3n
  // by 3n.
  VecX end_velocity() const {
    const auto n = static_cast<Eigen::Index>(masses.size());
    Matrix K = Matrix::Zero(n, n), M = Matrix::Zero(n, n);
    for (const PlatePair& p : springs.pairs) {
      K(p.i, p.i) += p.k, K(p.j, p.j) += p.k;
      K(p.i, p.j) -= p.k, K(p.j, p.i) -= p.k;
    }
    for (Eigen::Index i = 0; i < n; ++i) M(i, i) = masses[static_cast<std::size_t>(i)];
    const auto along_axes = [&](const Matrix& scalar) {
      Matrix full = Matrix::Zero(3 * n, 3 * n);
      for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j) full.block<3, 3>(3 * i, 3 * j) = scalar(i, j) * Mat3::Identity();
      return full;
    };
    const Matrix A = along_axes(M + h * h * K);
    VecX b = along_axes(M) * start.v - h * along_axes(K) * start.x;
    for (Eigen::Index i = 0; i < n; ++i) b.segment<3>(3 * i) += h * M(i, i) * Gravity{}.g;
    Matrix N = Matrix::Zero(n * static_cast<Eigen::Index>(planes.size()), 3 * n);
    VecX c(N.rows());
    Eigen::Index row = 0;
    for (Eigen::Index i = 0; i < n; ++i)
      for (const Plane& p : planes) {
        N.block<1, 3>(row, 3 * i) = p.normal.transpose();
        c[row++] = (margin - p.normal.dot(start.x.segment<3>(3 * i) - p.point)) / h;
      }
    // With A = L L^T and w = L^T v - L^-1 b it is the least |w| with G w >= d, whose dual is a least squares
    // problem:
    // y >= 0 with the least |[G d]^T y - (0, 1)|; then w = (G^T y) / (1 - d.y).      [Lawson & Hanson, chapter 23.4]
    const Eigen::LLT<Matrix> L(A);
    const VecX u = L.matrixL().solve(b);
    const Matrix G = L.matrixL().solve(N.transpose()).transpose();
    const VecX d = c - G * u;
    Matrix E(3 * n + 1, N.rows());
    E << G.transpose(), d.transpose();
    VecX f = VecX::Zero(3 * n + 1);
    f[3 * n] = 1;
    const VecX y = nonnegative_least_squares(E, f);
    const VecX w = G.transpose() * y / (1 - d.dot(y));
    return L.matrixU().solve(u + w);
  }
};

std::vector<std::pair<std::string, std::vector<Plane>>> plane_sets() {
  const Plane floor, tilted{Vec3::Zero(), Vec3(0.3, 1, 0.1).normalized()},
      left{Vec3::Zero(), Vec3(1, 1, 0).normalized()}, back{Vec3::Zero(), Vec3(0, 1, 1).normalized()},
      right{Vec3::Zero(), Vec3(-1, 0.6, 0).normalized()};
  return {{"a floor", {floor}},
          {"a tilted plane", {tilted}},
          {"a groove", {left, right}},
          {"a corner of three planes", {floor, left, back}},
          {"one floor twice", {floor, floor}},
          {"four planes through a point", {floor, left, back, right}}};
}

}  // namespace

TEST_CASE("without friction a step solves its quadratic problem, as a dense solver does", "[contact]") {
  for (const auto& [name, planes] : plane_sets())
    for (unsigned seed = 1; seed <= 30; ++seed) {
      const LinearProblem problem(20, planes, seed);
      const VecX expected = problem.end_velocity();
      for (const std::string_view integrator : {"implicit-euler", "newton-kinsol"})
        for (const LinearSolverInfo& solver : linear_solvers()) {
          INFO(name << ", seed " << seed << ", " << integrator << ", " << solver.name);
          System system(problem.masses);
          system.add(std::make_unique<PlateForce>(problem.springs, 0));
          system.add(Gravity{});
          Constraints constraints;
          for (const Plane& p : planes)
            constraints.add(Obstacle{.shape = p, .friction = 0, .margin = LinearProblem::margin});
          const auto stepper =
              make_integrator(integrator, system, constraints, make_linear_solver(solver.name),
                              {.newton_iterations = 1,
                               .newton_tolerance = 1e-12,
                               .tolerance = 1e-12,
                               .contact_tolerance = 1e-10,
                               .max_contact_solves = 60});
          State state = problem.start;
          const StepReport report = stepper->advance(state, LinearProblem::h);
          REQUIRE(report.done);
          CHECK(report.converged);
          CHECK(report.substeps == 1);
          CHECK((state.v - expected).cwiseAbs().maxCoeff() <= 1e-7 * expected.cwiseAbs().maxCoeff());
        }
    }
}
