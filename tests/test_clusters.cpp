// Laws of clusters: the rotation is proper and the best there is, goals keep momentum and angular momentum, a pushed cluster
// moves as a rigid body, and every particle is in a set.
#include <Eigen/SVD>
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "mesh/base/errors.h"
#include "mesh/base/rotation.h"
#include "mesh/base/threads.h"
#include "mesh/triangles/generate.h"
#include "solver/forces/cluster.h"
#include "solver/forces/cluster_body.h"
#include "solver/forces/cluster_sets.h"

using namespace drape;

namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vec3 vector(double size = 1) { return {between(-size, size), between(-size, size), between(-size, size)}; }
  Quaternion rotation() {
    return Quaternion(Eigen::Vector4d(normal(), normal(), normal(), normal()).normalized());
  }

 private:
  double normal() { return std::normal_distribution<double>()(engine_); }
  std::mt19937 engine_;
};

enum class Kind { full, flat, collinear, inverted, nearly_rigid, one_place };
constexpr Kind kinds[] = {Kind::full,     Kind::flat,         Kind::collinear,
                          Kind::inverted, Kind::nearly_rigid, Kind::one_place};

// Points at rest, b, and now, a, about their centres of mass m.
struct PointSet {
  std::vector<double> m;
  std::vector<Vec3> b, a;
  Mat3 A() const {
    Mat3 sum = Mat3::Zero();
    for (std::size_t i = 0; i < m.size(); ++i) sum += m[i] * a[i] * b[i].transpose();
    return sum;
  }
};

void centre(const std::vector<double>& m, std::vector<Vec3>& points) {
  double mass = 0;
  Vec3 moment = Vec3::Zero();
  for (std::size_t i = 0; i < m.size(); ++i) mass += m[i], moment += m[i] * points[i];
  for (Vec3& p : points) p -= moment / mass;
}

PointSet point_set(Kind kind, Random& random) {
  PointSet set;
  const int count = 3 + static_cast<int>(random.between(0, 9.99));
  const Vec3 line = random.vector(), moved_line = random.vector();
  const Mat3 turn = random.rotation().toRotationMatrix();
  for (int i = 0; i < count; ++i) {
    set.m.push_back(random.between(0.1, 3));
    Vec3 b = random.vector(), a = random.vector();
    const double s = random.between(-1, 1);
    if (kind == Kind::flat) b[2] = 0, a[1] = 0;
    if (kind == Kind::collinear) b = s * line, a = random.between(0.5, 2) * s * moved_line;
    if (kind == Kind::inverted) a = turn * Vec3(b[0], b[1], -b[2]) + 0.1 * a;
    if (kind == Kind::nearly_rigid) a = turn * b + 0.01 * a;
    if (kind == Kind::one_place) a.setZero();
    set.b.push_back(b);
    set.a.push_back(a);
  }
  centre(set.m, set.b);
  centre(set.m, set.a);
  return set;
}

double largest_singular_value(const Mat3& A) { return Eigen::JacobiSVD<Mat3>(A).singularValues()[0]; }

// max tr(R^T A) over proper rotations, by another method: the singular values, the last with the sign of the determinant.
double best(const Mat3& A) {
  const Eigen::JacobiSVD<Mat3> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3 s = svd.singularValues();
  return s[0] + s[1] + (svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -s[2] : s[2]);
}

void check_proper(const Mat3& R) {
  CHECK((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-14);
  CHECK(R.determinant() > 0.5);
}

// Particles at rest and moved by anything, with overlapping sets of `per_set` particles.
struct Body {
  VecX rest, x, v;
  std::vector<double> masses;
  ParticleSets sets;
  Clusters clusters;
  std::vector<ClusterPose> poses;

  Body(int particles, int per_set, int step, unsigned seed, double disturbance = 1) {
    Random random(seed);
    rest.resize(3 * particles), x.resize(3 * particles), v.resize(3 * particles);
    const Quaternion turn = random.rotation();
    for (int i = 0; i < particles; ++i) {
      rest.segment<3>(3 * i) = random.vector();
      x.segment<3>(3 * i) =
          turn * Vec3(rest.segment<3>(3 * i)) + disturbance * random.vector() + Vec3(5, -3, 2);
      v.segment<3>(3 * i) = random.vector();
      masses.push_back(random.between(0.1, 2));
    }
    for (int first = 0; first + per_set <= particles; first += step) {
      sets.emplace_back();
      for (int k = 0; k < per_set; ++k) sets.back().push_back(first + k);
    }
    clusters = Clusters(sets, masses, rest, "body");
    poses.resize(sets.size());
    clusters.match(x, poses);
  }

  Vec3 momentum(const VecX& u) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < masses.size(); ++i) sum += masses[i] * u.segment<3>(3 * i);
    return sum;
  }
  Vec3 angular(const VecX& at, const VecX& u) const {  // about the origin
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < masses.size(); ++i)
      sum += masses[i] * Vec3(at.segment<3>(3 * i)).cross(Vec3(u.segment<3>(3 * i)));
    return sum;
  }
  double energy_at(const VecX& y, double k) const {
    double sum = 0;
    for (int c = 0; c < clusters.count(); ++c)
      sum += energy(clusters[c], matched(clusters[c], y, poses[c].rotation), y, k);
    return sum;
  }
  VecX gradient_at(const VecX& y, double k) const {
    VecX g = VecX::Zero(y.size());
    for (int c = 0; c < clusters.count(); ++c) {
      const ClusterPose pose = matched(clusters[c], y, poses[c].rotation);
      for (const ClusterMember& m : clusters[c])
        g.segment<3>(3 * m.particle) += k * m.share * (y.segment<3>(3 * m.particle) - pose.goal(m));
    }
    return g;
  }
};

}  // namespace

TEST_CASE("the rotation is proper, stationary and the best there is", "[clusters]") {
  Random random(1);
  double worst = 0, off = 0;
  for (int k = 0; k < 102000; ++k) {
    const Kind kind = kinds[k % 6];
    const Mat3 A = point_set(kind, random).A();
    const Mat3 R = nearest_rotation(A, random.rotation()).toRotationMatrix();
    const double scale = std::max(largest_singular_value(A), 1e-300);
    const Mat3 S = R.transpose() * A / scale;
    worst = std::max(worst, best(A) / scale - S.trace());
    off = std::max(off, (S - S.transpose()).cwiseAbs().maxCoeff());
    if (k < 6000) check_proper(R);
    REQUIRE(std::abs(R.determinant() - 1) < 1e-14);
  }
  CHECK(worst < 1e-13);
  CHECK(off < 1e-10);
}

TEST_CASE("a good first guess changes nothing", "[clusters]") {
  Random random(2);
  for (int k = 0; k < 20000; ++k) {
    const Mat3 A = point_set(k % 2 ? Kind::full : Kind::nearly_rigid, random).A();
    const Quaternion q = nearest_rotation(A, random.rotation());
    const Quaternion near =
        (q * Quaternion(Eigen::AngleAxisd(random.between(0, 0.3), random.vector().normalized())))
            .normalized();
    const Eigen::JacobiSVD<Mat3> svd(A);
    const Vec3 s = svd.singularValues();
    if (s[1] - s[2] < 0.01 * s[0]) continue;  // the rotation is hardly determined
    CHECK(q.angularDistance(nearest_rotation(A, near)) < 1e-12);
  }
}

TEST_CASE("the rotation follows a rigid motion", "[clusters]") {
  Random random(3);
  for (const Kind kind : {Kind::full, Kind::flat}) {
    for (int k = 0; k < 5000; ++k) {
      PointSet set = point_set(kind, random);
      const Quaternion q = random.rotation(), last = random.rotation();
      for (std::size_t i = 0; i < set.a.size(); ++i) set.a[i] = q * set.b[i];
      const Vec3 s = Eigen::JacobiSVD<Mat3>(set.A()).singularValues();
      if (s[1] < 1e-3 * s[0]) continue;  // close to a line
      const Mat3 found = nearest_rotation(set.A(), last).toRotationMatrix();
      CHECK((found - q.toRotationMatrix()).cwiseAbs().maxCoeff() < 1e-12);
    }
  }
}

TEST_CASE("where many rotations are as good, the nearest to the last one is taken", "[clusters]") {
  Random random(4);
  for (int k = 0; k < 2000; ++k) {
    const Quaternion last = random.rotation();
    // A line: the shortest arc from where the last rotation has it to where it is.
    const Vec3 b = random.vector().normalized(), a = random.vector().normalized();
    const Quaternion arc = Quaternion::FromTwoVectors(last * b, a);
    CHECK(nearest_rotation(7e-5 * a * b.transpose(), last).angularDistance(arc * last) < 1e-7);
    // One place.
    CHECK(nearest_rotation(Mat3::Zero(), last).coeffs() == last.coeffs());
    // A ball turned inside out: every half turn is as good.
    const Quaternion found = nearest_rotation(-Mat3::Identity(), last);
    CHECK(found.toRotationMatrix().trace() == Approx(-1).margin(1e-12));
    const Vec3 axis = last.vec().normalized();
    CHECK(found.angularDistance(last) ==
          Approx(Quaternion(0, axis[0], axis[1], axis[2]).angularDistance(last)).margin(1e-7));
  }
}

TEST_CASE("close to a line the rotation loses no more than the threshold", "[clusters]") {
  Random random(5);
  for (int k = 0; k < 30000; ++k) {
    PointSet set = point_set(Kind::collinear, random);
    const double thickness = std::pow(10, -random.between(2, 9));
    for (Vec3& a : set.a) a += thickness * random.vector();
    for (Vec3& b : set.b) b += thickness * random.vector();
    centre(set.m, set.a), centre(set.m, set.b);
    const Mat3 A = set.A(), R = nearest_rotation(A, random.rotation()).toRotationMatrix();
    REQUIRE(best(A) - (R.transpose() * A).trace() <= 1e-9 * largest_singular_value(A));
  }
}

TEST_CASE("what is not a number leaves the rotation as it was", "[clusters]") {
  const Quaternion last = Random(6).rotation();
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Mat3 A = Mat3::Identity();
    A(1, 2) = bad;
    CHECK(nearest_rotation(A, last).coeffs() == last.coeffs());
  }
  for (const double size : {1e-290, 1e-150, 1e150, 1e290})  // no product overflows or vanishes
    CHECK(nearest_rotation(size * last.toRotationMatrix(), Quaternion::Identity()).angularDistance(last) <
          1e-12);
}

TEST_CASE("the pull to the goals is the slope of the energy", "[clusters]") {
  constexpr double k = 40, step = 1e-5;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const Body body(12, 5, seed % 2 ? 5 : 2, seed,
                    seed % 3 ? 0.3 : 2);  // overlapping or not, disturbed little or much
    const VecX g = body.gradient_at(body.x, k);
    for (Eigen::Index i = 0; i < body.x.size(); ++i) {
      VecX up = body.x, down = body.x;
      up[i] += step, down[i] -= step;
      const double slope = (body.energy_at(up, k) - body.energy_at(down, k)) / (2 * step);
      CHECK(g[i] == Approx(slope).margin(2e-6 * g.norm()));
    }
  }
}

TEST_CASE("at rest and after a rigid motion the goals are where the particles are", "[clusters]") {
  Random random(7);
  for (const auto& [per_set, step] : {std::pair(4, 4), std::pair(6, 3), std::pair(12, 12)}) {
    Body body(24, per_set, step, 9);
    const Quaternion q = random.rotation();
    VecX moved(body.rest.size());
    for (int i = 0; i < 24; ++i)
      moved.segment<3>(3 * i) = q * Vec3(body.rest.segment<3>(3 * i)) + Vec3(1, 2, 3);
    for (const VecX& x : {body.rest, moved}) {
      body.clusters.match(x, body.poses);
      VecX y = x;
      body.clusters.project(body.poses, 1, y);
      CHECK((y - x).cwiseAbs().maxCoeff() < 1e-13);
      CHECK(body.energy_at(x, 1) < 1e-26);
    }
  }
}

TEST_CASE("the way to the goals keeps momentum and angular momentum", "[clusters]") {
  for (unsigned seed = 0; seed < 40; ++seed) {
    for (const int step : {2, 3, 6}) {
      Body body(30, 6, step, seed);
      VecX together = body.x, one = body.x;
      body.clusters.project(body.poses, 0.7, together);
      project(body.clusters[1], body.poses[1], 0.7, one);
      for (const VecX& y : {together, one}) {
        const VecX moved = y - body.x;
        CHECK(moved.norm() > 1e-3);
        CHECK(body.momentum(moved).norm() < 1e-12);
        CHECK(body.angular(body.x, moved).norm() < 1e-11);
      }
    }
  }
}

TEST_CASE("the whole way makes a cluster rigid, and overlapping ones go to the mean of their goals",
          "[clusters]") {
  Body apart(24, 6, 6, 11);
  VecX y = apart.x;
  apart.clusters.project(apart.poses, 1, y);
  for (const std::vector<int>& set : apart.sets)
    for (const int i : set)
      for (const int j : set)
        CHECK((y.segment<3>(3 * i) - y.segment<3>(3 * j)).norm() ==
              Approx((apart.rest.segment<3>(3 * i) - apart.rest.segment<3>(3 * j)).norm()).margin(1e-13));
  Body over(24, 6, 3, 12);
  y = over.x;
  over.clusters.project(over.poses, 1, y);
  VecX one_by_one = over.x;  // the same by the kernel of one cluster, each from where the particles were
  for (int c = 0; c < over.clusters.count(); ++c) {
    VecX z = over.x;
    project(over.clusters[c], over.poses[c], 1, z);
    one_by_one += z - over.x;
  }
  CHECK((y - one_by_one).cwiseAbs().maxCoeff() < 1e-13);
}

TEST_CASE("one projection is the step of implicit Euler of clusters that do not overlap", "[clusters]") {
  for (const double h : {0.001, 0.01, 0.1}) {
    for (const double k : {1.0, 1e3, 1e7}) {
      Body body(24, 6, 6, 13);
      VecX y = body.x;
      body.clusters.project(body.poses, goal_share(k, h), y);
      VecX residual = h * h * body.gradient_at(y, k);
      for (std::size_t i = 0; i < body.masses.size(); ++i)
        residual.segment<3>(3 * i) += body.masses[i] * (y - body.x).segment<3>(3 * i);
      CHECK(residual.norm() < 1e-13 * (1 + k * h * h));
    }
  }
  CHECK(goal_share(0, 0.01) == 0);
  CHECK(goal_share(std::numeric_limits<double>::infinity(), 0.01) == 1);
}

TEST_CASE("shares add up to the masses", "[clusters]") {
  const Body body(30, 6, 2, 14);
  std::vector<double> sum(body.masses.size(), 0);
  for (int c = 0; c < body.clusters.count(); ++c)
    for (const ClusterMember& m : body.clusters[c]) {
      sum[m.particle] += m.share;
      CHECK(m.mass == body.masses[m.particle]);
    }
  for (std::size_t i = 0; i < sum.size(); ++i) CHECK(sum[i] == Approx(body.masses[i]).epsilon(1e-14));
}

TEST_CASE("a push changes momentum by J, angular momentum by r x J, and the motion as that of a rigid body",
          "[clusters]") {
  Random random(8);
  for (unsigned seed = 0; seed < 200; ++seed) {
    Body body(12, 8, 4, seed);        // two that share four particles
    const bool flat = seed % 2 == 1;  // a flat set has an inertia of full rank
    if (flat)
      for (int i = 0; i < 12; ++i) body.x[3 * i + 1] = 0;
    const ClusterBody b = body_of(body.clusters[0], body.x);
    const Vec3 r = random.vector(), J = random.vector();
    VecX v = body.v;
    push(body.clusters[0], b, r, J, body.x, v);
    CHECK((body.momentum(v - body.v) - J).norm() < 1e-12);
    CHECK((body.angular(body.x, v - body.v) - (b.centre + r).cross(J)).norm() < 1e-11);
    const ClusterMotion before = motion_of(body.clusters[0], b, body.x, body.v),
                        after = motion_of(body.clusters[0], b, body.x, v);
    CHECK((after.at(r) - before.at(r) - give_at(b, r) * J).norm() < 1e-11);
  }
}

TEST_CASE("the impulse between two clusters makes the relative velocity that is asked for", "[clusters]") {
  Random random(9);
  for (unsigned seed = 0; seed < 100; ++seed) {
    Body body(16, 8, 8, seed);
    const auto one = body.clusters[0], two = body.clusters[1];
    const ClusterBody a = body_of(one, body.x), b = body_of(two, body.x);
    const Vec3 point = random.vector(), asked = random.vector(), ra = point - a.centre, rb = point - b.centre;
    const auto relative = [&](const VecX& v) {
      return Vec3(motion_of(one, a, body.x, v).at(ra) - motion_of(two, b, body.x, v).at(rb));
    };
    const Vec3 J = (give_at(a, ra) + give_at(b, rb)).inverse() * (asked - relative(body.v));
    VecX v = body.v;
    push(one, a, ra, J, body.x, v);
    push(two, b, rb, -J, body.x, v);
    CHECK((relative(v) - asked).norm() < 1e-10);
    CHECK(body.momentum(v - body.v).norm() < 1e-12);
    CHECK(body.angular(body.x, v - body.v).norm() < 1e-11);
  }
}

TEST_CASE("a line of particles takes up all but the turn about it, and one place no turn", "[clusters]") {
  Random random(10);
  for (unsigned seed = 0; seed < 100; ++seed) {
    Body body(6, 6, 6, seed);
    const Vec3 axis = random.vector().normalized(), start = random.vector();
    for (int i = 0; i < 6; ++i) body.x.segment<3>(3 * i) = start + random.between(-1, 1) * axis;
    const Vec3 r = random.vector(), J = random.vector();
    for (const bool one_place : {false, true}) {
      if (one_place)
        for (int i = 0; i < 6; ++i) body.x.segment<3>(3 * i) = start;
      const ClusterBody b = body_of(body.clusters[0], body.x);
      VecX v = VecX::Zero(body.v.size());
      push(body.clusters[0], b, r, J, body.x, v);
      CHECK((body.momentum(v) - J).norm() < 1e-12);
      Vec3 turn = r.cross(J) - axis.dot(r.cross(J)) * axis;
      if (one_place) turn.setZero();
      const Vec3 about_centre = body.angular(body.x, v) - b.centre.cross(J);
      CHECK((about_centre - turn).norm() < 1e-6);
      CHECK(v.cwiseAbs().maxCoeff() < 100);
    }
  }
}

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

TEST_CASE("clusters have the same bits on any number of threads", "[clusters]") {
  Body body(6000, 8, 3, 15);
  VecX first;
  const int before = threads();
  for (const int t : {1, 2, 7}) {
    set_threads(t);
    VecX y = body.x;
    std::vector<ClusterPose> poses(body.sets.size());
    for (int round = 0; round < 3; ++round) {
      body.clusters.match(y, poses);
      body.clusters.project(poses, 0.5, y);
    }
    if (t == 1) first = y;
    CHECK(y == first);
  }
  set_threads(before);
}
