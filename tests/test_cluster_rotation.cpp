// Laws of the rotation that is nearest to a matrix: it is proper, and the best there is.
#include <Eigen/SVD>
#include <catch2/catch.hpp>

#include "tests/clusters.h"

using namespace drape;
using namespace drape::test;

namespace {

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

// max tr(R^T A) over proper rotations, by another method: the singular values, the last with the sign of the
// determinant.
double best(const Mat3& A) {
  const Eigen::JacobiSVD<Mat3> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3& s = svd.singularValues();
  return s[0] + s[1] + (svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -s[2] : s[2]);
}

void check_proper(const Mat3& R) {
  CHECK((R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-14);
  CHECK(R.determinant() > 0.5);
}

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
    const Vec3& s = svd.singularValues();
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
