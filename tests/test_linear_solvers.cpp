// Laws that every linear solver obeys: the constraints hold, the answer is the dense one,
// the report is the truth.
#include <dlfcn.h>

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <thread>

#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

struct Problem {
  std::shared_ptr<const BlockPattern> pattern;
  BlockMatrix A;
  VecX b;
  Filter filter;

  Problem(int n, unsigned seed, bool constrained)
      : pattern(make_pattern(n, seed)), A(pattern), b(random_vector(3 * n, 1, seed)) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    A.set_to_mass(std::vector<double>(static_cast<std::size_t>(n), 0.3));
    for (int r = 0; r < n; ++r) {
      for (int s = pattern->row_start()[r]; s < pattern->row_start()[r + 1]; ++s) {
        const int c = pattern->column()[s];
        if (c <= r) continue;
        Mat3 G, H;  // |G x_r - H x_c|^2: semidefinite, with off-diagonal blocks that are not symmetric
        for (int k = 0; k < 9; ++k) G(k) = 3 * uniform(engine), H(k) = 3 * uniform(engine);
        A.at(pattern->diagonal(r)) += G.transpose() * G;
        A.at(pattern->diagonal(c)) += H.transpose() * H;
        A.at(s) -= G.transpose() * H;
      }
    }
    if (!constrained) return;
    for (int i = 0; i < n; i += 3) {
      const Vec3 p = Vec3(uniform(engine), uniform(engine), uniform(engine)).normalized();
      const Vec3 z(uniform(engine), uniform(engine), uniform(engine));
      if (i % 2 == 0)
        filter.constrain(i, Mat3::Zero(), z);
      else
        filter.constrain(i, Mat3::Identity() - p * p.transpose(), p * p.dot(z));
    }
  }

  static std::shared_ptr<const BlockPattern> make_pattern(int n, unsigned seed) {
    std::mt19937 engine(seed);
    std::vector<ParticlePair> pairs;
    for (int i = 0; i + 1 < n; ++i) {
      pairs.push_back({i, i + 1});
      pairs.push_back({i, static_cast<int>(engine() % static_cast<unsigned>(n))});
      if (pairs.back().i == pairs.back().j) pairs.pop_back();
    }
    return std::make_shared<const BlockPattern>(n, pairs);
  }

  Eigen::MatrixXd dense() const {
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(b.size(), b.size());
    for (int r = 0; r < A.rows(); ++r)
      for (int s = pattern->row_start()[r]; s < pattern->row_start()[r + 1]; ++s) {
        const int c = pattern->column()[s];
        D.block<3, 3>(3 * r, 3 * c) = A.at(s);
        D.block<3, 3>(3 * c, 3 * r) = A.at(s).transpose();
      }
    return D;
  }

  VecX dense_solution() const {
    Eigen::MatrixXd S = Eigen::MatrixXd::Identity(b.size(), b.size());
    VecX z = VecX::Zero(b.size());
    for (const FilterEntry& e : filter.entries()) {
      S.block<3, 3>(3 * e.particle, 3 * e.particle) = e.S;
      z.segment<3>(3 * e.particle) = e.z;
    }
    const Eigen::MatrixXd D = dense(), I = Eigen::MatrixXd::Identity(b.size(), b.size());
    return (S * D * S + I - S).ldlt().solve(S * (b - D * z)) + z;
  }
};

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& info : linear_solvers()) all.emplace_back(info.name);
  return all;
}

// How many threads OpenBLAS has in this process; what a test sets is put back.
struct BlasThreads {
  int (*get)() = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
  void (*set)(int) = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  int before = there() ? get() : 1;
  bool there() const { return get && set; }
  ~BlasThreads() {
    if (there()) set(before);
  }
};

bool is_direct(std::string_view name) { return name == "cholmod" || name == "eigen-ldlt"; }

}  // namespace

TEST_CASE("every linear solver gives the dense solution of the projected system", "[solvers]") {
  for (const std::string& name : names()) {
    for (bool constrained : {false, true}) {
      Problem p(40, 11, constrained);
      const auto solver = make_linear_solver(name);
      for (int again = 0; again < 2; ++again) {  // the second time with the analysis kept
        INFO(name << (constrained ? ", constrained" : ", free"));
        VecX dv = random_vector(p.b.size(), 1, 5);
        const LinearReport report = solver->solve(p.A, p.b, p.filter, {.tolerance = 1e-11}, dv);
        CHECK(report.reason == StopReason::converged);
        CHECK((dv - p.dense_solution()).norm() < 1e-8 * dv.norm());
        for (const FilterEntry& e : p.filter.entries()) {
          const Vec3 v = dv.segment<3>(3 * e.particle);
          CHECK(((v - e.S * v) - e.z).norm() < 1e-13);
        }
        // The residual it reports is the true one.
        VecX r = p.b - p.dense() * dv;
        p.filter.apply(r);
        CHECK(report.residual_impulse == Approx(r.norm()).margin(1e-13 * p.b.norm()));
        p.b = random_vector(p.b.size(), 2, 77);
      }
    }
  }
}

TEST_CASE("a solve leaves the threads of BLAS as they were, and its bits do not depend on them",
          "[solvers]") {
  const BlasThreads blas;
  if (!blas.there()) {
    WARN("skipped: this process has no OpenBLAS");
    return;
  }
  const Problem p(300, 7, true);  // large fronts, which BLAS would share out
  for (const std::string& name : names()) {
    if (!is_direct(name)) continue;
    INFO(name);
    const auto solved = [&] {
      VecX dv = VecX::Zero(p.b.size());
      const auto solver = make_linear_solver(name);
      for (int again = 0; again < 2; ++again) {
        CHECK(solver->solve(p.A, p.b, p.filter, {}, dv).reason == StopReason::converged);
      }
      return dv;
    };
    blas.set(1);
    const VecX alone = solved();
    CHECK(blas.get() == 1);
    blas.set(2);
    const auto solver = make_linear_solver(name);
    CHECK(blas.get() == 2);
    CHECK(same_bits(solved(), alone));
    CHECK(blas.get() == 2);
    Problem indefinite = p;  // also where the solve ends early
    indefinite.A.at(p.pattern->diagonal(7)) -= 1e4 * Mat3::Identity();
    VecX dv = VecX::Zero(p.b.size());
    solver->solve(indefinite.A, p.b, p.filter, {}, dv);
    CHECK(blas.get() == 2);
  }
}

TEST_CASE("solvers at work at the same time leave the threads of BLAS as they were", "[solvers]") {
  const BlasThreads blas;
  const std::vector<std::string> all = names();
  if (!blas.there() || std::find(all.begin(), all.end(), "cholmod") == all.end()) {
    WARN("skipped: this process has no OpenBLAS, or the build no cholmod");
    return;
  }
  const Problem p(150, 7, true);
  std::array<VecX, 3> dv;
  const auto solve_often = [&](VecX& result) {
    const auto solver = make_linear_solver("cholmod");
    for (int k = 0; k < 10; ++k) {
      result = VecX::Zero(p.b.size());
      solver->solve(p.A, p.b, p.filter, {}, result);
    }
  };
  blas.set(1);
  solve_often(dv[0]);
  blas.set(2);
  std::thread other([&] { solve_often(dv[1]); });
  solve_often(dv[2]);
  other.join();
  CHECK(blas.get() == 2);
  CHECK(same_bits(dv[1], dv[0]));
  CHECK(same_bits(dv[2], dv[0]));
}

TEST_CASE("a solve that stops early says so, with the true residual", "[solvers]") {
  for (const std::string& name : names()) {
    if (is_direct(name)) continue;
    INFO(name);
    Problem p(200, 3, true);
    VecX dv = VecX::Zero(p.b.size());
    const LinearReport report =
        make_linear_solver(name)->solve(p.A, p.b, p.filter, {.tolerance = 1e-12, .max_iterations = 3}, dv);
    CHECK(report.reason == StopReason::iteration_limit);
    CHECK(report.iterations == 3);
    VecX r = p.b - p.dense() * dv;
    p.filter.apply(r);
    CHECK(report.residual_impulse == Approx(r.norm()));
    CHECK(report.residual > 1e-12);
  }
}

TEST_CASE("a solve that begins at the solution, or at a multiple of it, is over at once", "[solvers]") {
  for (const std::string& name : names()) {
    INFO(name);
    Problem p(40, 11, true);
    VecX dv = VecX::Zero(p.b.size());
    const auto solver = make_linear_solver(name);
    const int iterations = solver->solve(p.A, p.b, p.filter, {.tolerance = 1e-11}, dv).iterations;
    CHECK((iterations == 0) == is_direct(name));
    const VecX solution = dv;
    for (const double multiple : {1.0, -3.5, 1e-6, 1e6}) {
      dv = multiple * solution;
      CHECK(solver->solve(p.A, p.b, p.filter, {.tolerance = 1e-6}, dv).iterations == 0);
      CHECK((dv - solution).norm() < 1e-6 * solution.norm());
    }
  }
}

TEST_CASE("a history leads from the guess to the residual of the report", "[solvers]") {
  for (const std::string& name : names()) {
    INFO(name);
    Problem p(40, 11, false);
    VecX dv = VecX::Zero(p.b.size());
    std::vector<double> history;
    const LinearReport report =
        make_linear_solver(name)->solve(p.A, p.b, p.filter, {.tolerance = 1e-6, .history = &history}, dv);
    CHECK_FALSE((history.empty() && (name.starts_with("mpcg") || name.starts_with("ppcg"))));
    if (history.empty()) continue;  // it has none to tell
    CHECK(static_cast<int>(history.size()) == report.iterations + 1);
    CHECK(history.front() == Approx(1));
    CHECK(history.back() == Approx(report.residual).epsilon(1e-3));
  }
}

TEST_CASE("particles that nothing connects are solved in one iteration, held or sliding", "[solvers]") {
  // The inverses of the blocks, within the constraints, are the whole inverse then.
  const int n = 9;
  BlockMatrix A(std::make_shared<const BlockPattern>(n, std::vector<ParticlePair>{}));
  Filter filter;
  for (int i = 0; i < n; ++i) {
    const Vec3 u = random_vector(3, 2, static_cast<unsigned>(i)), p = Vec3(u + Vec3(1, 2, 3)).normalized();
    A.at(A.pattern().diagonal(i)) = Mat3::Identity() + u * u.transpose();
    if (i % 3 == 0) filter.constrain(i, Mat3::Zero(), u);
    if (i % 3 == 1) filter.constrain(i, Mat3::Identity() - p * p.transpose(), 0.3 * p);
  }
  const VecX b = random_vector(3 * n, 1, 3);
  for (const std::string& name : names()) {
    if (!name.ends_with("pcg")) continue;  // with block-jacobi
    INFO(name);
    VecX dv = VecX::Zero(b.size());
    const LinearReport report = make_linear_solver(name)->solve(A, b, filter, {.tolerance = 1e-12}, dv);
    CHECK(report.reason == StopReason::converged);
    CHECK(report.iterations == 1);
  }
}

TEST_CASE("an indefinite matrix is called so, though the blocks of its diagonal are definite", "[solvers]") {
  BlockMatrix A(std::make_shared<const BlockPattern>(2, std::vector<ParticlePair>{{0, 1}}));
  A.set_to_mass({1, 1});
  A.at(A.pattern().slot(0, 1)) = 2 * Mat3::Identity();
  VecX b(6);
  b << 1, 2, 3, -1, -2, -3;  // A b = -b
  for (const std::string& name : names()) {
    if (name.starts_with("eigen") || name == "sundials-pcg") continue;  // find a solution all the same
    INFO(name);
    VecX dv = VecX::Zero(6);
    CHECK(make_linear_solver(name)->solve(A, b, Filter{}, {}, dv).reason == StopReason::indefinite);
  }
}

TEST_CASE("indefinite and non-finite systems are reported, not looped on", "[solvers]") {
  for (const std::string& name : names()) {
    INFO(name);
    Problem p(20, 4, false);
    const auto solver = make_linear_solver(name);
    VecX dv = VecX::Zero(p.b.size());
    p.A.at(p.pattern->diagonal(7)) -= 1e4 * Mat3::Identity();
    if (name.find("eigen") == name.npos)  // LDL^T finds a solution all the same
      CHECK(solver->solve(p.A, p.b, p.filter, {}, dv).reason != StopReason::converged);
    Problem q(20, 4, false);
    q.b[5] = std::nan("");
    dv.setZero();
    CHECK(solver->solve(q.A, q.b, q.filter, {}, dv).reason != StopReason::converged);
  }
}

TEST_CASE("nothing to do is done in no iterations", "[solvers]") {
  for (const std::string& name : names()) {
    Problem p(20, 4, false);
    p.b.setZero();
    VecX dv = random_vector(p.b.size(), 1, 6);  // whatever the guess
    const LinearReport report = make_linear_solver(name)->solve(p.A, p.b, p.filter, {}, dv);
    CHECK(report.reason == StopReason::converged);
    CHECK(report.iterations == 0);
    CHECK(dv.norm() == 0);
  }
}

TEST_CASE("where all that acts is along what is locked there is nothing to do", "[solvers]") {
  // The projections leave their round-off of it, which no iteration can lessen. With z of Problem A z acts,
  // too.
  for (const std::string& name : names()) {
    for (const bool moving : {false, true}) {
      for (const unsigned seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
        INFO(name << ", seed " << seed << (moving ? ", moving" : ", still"));
        Problem p(seed < 4 ? 1 : 20, seed, false);
        VecX z = VecX::Zero(p.b.size());
        p.b.setZero();
        for (int i = 0; i < p.A.rows(); ++i) {
          const Eigen::Matrix3d Q =
              Eigen::Quaterniond(Eigen::Vector4d(random_vector(4, 1, 10 * seed + i)).normalized())
                  .toRotationMatrix();
          const Vec3 locked = 300 * (Q.col(0) - 2 * Q.col(1));
          if (moving) z.segment<3>(3 * i) = 0.2 * Q.col(0) + 0.3 * Q.col(1);
          p.filter.constrain(
              i, Mat3::Identity() - Q.col(0) * Q.col(0).transpose() - Q.col(1) * Q.col(1).transpose(),
              z.segment<3>(3 * i));
          p.b.segment<3>(3 * i) = locked;
        }
        p.b += p.dense() * z;
        VecX dv = random_vector(p.b.size(), 1, 6);
        const LinearReport report = make_linear_solver(name)->solve(p.A, p.b, p.filter, {}, dv);
        CHECK(report.reason == StopReason::converged);
        CHECK(report.iterations == 0);
        CHECK((dv - z).norm() < 1e-12);
      }
    }
  }
}

TEST_CASE("what acts freely is solved as far as round-off of what is locked lets it", "[solvers]") {
  // Such as cloth without weight that is drawn tight round a body: nearly all that acts is along the locked
  // normals.
  for (const std::string& name : names()) {
    for (const double share : {1e-14, 1e-13, 1e-12, 1e-9}) {
      for (const unsigned seed : {1u, 2u, 3u}) {
        INFO(name << ", share " << share << ", seed " << seed);
        Problem p(20, seed, false);
        const VecX free = share * random_vector(static_cast<int>(p.b.size()), 300, seed);
        for (int i = 0; i < p.A.rows(); ++i) {
          const Vec3 n = random_vector(3, 1, 10 * seed + i).normalized();
          p.filter.constrain(i, Mat3::Identity() - n * n.transpose(), Vec3::Zero());
          p.b.segment<3>(3 * i) = 300 * n + free.segment<3>(3 * i);
        }
        VecX dv = VecX::Zero(p.b.size());
        const LinearReport report =
            make_linear_solver(name)->solve(p.A, p.b, p.filter, {.tolerance = 1e-8}, dv);
        CHECK(report.reason == StopReason::converged);
        VecX left = p.b - p.dense() * dv;
        p.filter.apply(left);
        CHECK(left.norm() < 1e-8 * free.norm() + 2e-14 * p.b.norm());
      }
    }
  }
}

TEST_CASE("an unknown linear solver is refused with the names there are", "[solvers]") {
  CHECK_THROWS_WITH(make_linear_solver("magic"), Catch::Contains("mpcg") && Catch::Contains("magic"));
}

TEST_CASE("the block product is the dense product", "[solvers]") {
  Problem p(60, 9, false);
  const VecX x = random_vector(180, 1, 1);
  VecX y(180);
  p.A.multiply(x, y);
  CHECK((y - p.dense() * x).norm() < 1e-12 * y.norm());
}

TEST_CASE("the product is that of the whole symmetric matrix, the same bits on any number of threads",
          "[solvers]") {
  const TriangleMesh mesh = grid(60, 60, 1, 1);  // large enough for threads, and many chunks
  System system(lumped_mass(mesh, 1));
  system.add(noh_jung(mesh, {}));
  BlockMatrix A(system.bind());
  const BlockPattern& pattern = A.pattern();
  REQUIRE(pattern.chunks() > 8);
  const VecX numbers = random_vector(9 * pattern.blocks(), 1, 5), x = random_vector(3 * A.rows(), 1, 6);
  for (int s = 0; s < pattern.blocks(); ++s)
    A.at(s) = Eigen::Map<const Mat3>(numbers.data() + 9 * static_cast<std::ptrdiff_t>(s));
  VecX expected = VecX::Zero(x.size()), y = random_vector(static_cast<int>(x.size()), 1, 7);
  for (int r = 0; r < A.rows(); ++r)
    for (int s = pattern.diagonal(r); s < pattern.row_start()[r + 1]; ++s) {
      const int c = pattern.column()[s];
      expected.segment<3>(3 * r) += A.at(s) * x.segment<3>(3 * c);
      if (c > r) expected.segment<3>(3 * c) += A.at(s).transpose() * x.segment<3>(3 * r);
    }
  const ThreadsRestored restored;
  VecX first;
  for (int t : {1, 2, 7}) {
    set_threads(t);
    A.multiply(x, y);
    CHECK((y - expected).norm() <= 1e-13 * expected.norm());
    if (first.size() == 0) first = y;
    CHECK(y == first);
  }
}

TEST_CASE("a pattern knows every pair once, in chunks that only neighbours share", "[solvers]") {
  const Problem p(500, 21, false);
  const BlockPattern& pattern = *p.pattern;
  for (int r = 0; r < pattern.rows(); ++r) {
    CHECK(pattern.particle_of()[pattern.row_of()[r]] == r);
    CHECK(pattern.column()[pattern.diagonal(r)] == r);
    for (int s = pattern.row_start()[r]; s < pattern.row_start()[r + 1]; ++s) {
      const int c = pattern.column()[s];
      CHECK(c >= r);
      CHECK(c / pattern.chunk_rows() - r / pattern.chunk_rows() <= 1);
    }
  }
  const TriangleMesh mesh = grid(60, 60, 1, 1);
  System system(lumped_mass(mesh, 1));
  system.add(noh_jung(mesh, {}));
  CHECK(system.bind()->bandwidth() < 6 * 60);  // a sheet of n x n: a few rows of it, not n^2
}
