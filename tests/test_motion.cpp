// Where a moved body is: poses, steady motion, keyframes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "allocations.h"
#include "constraints/motion.h"
#include "mesh/base/errors.h"

using namespace drape;
using Catch::Contains;
using Eigen::AngleAxisd;
using Eigen::Quaterniond;

namespace {

const Vec3 none = Vec3::Zero();
constexpr double pi = std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();

class Dice {
 public:
  double number(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(engine_);
  }
  Vec3 vector(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }

 private:
  std::mt19937 engine_{7};
};

Mat3 turned(const Vec3& turn) {
  return turn.norm() > 0 ? AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() : Mat3::Identity();
}

Pose random_pose(Dice& dice) { return {turned(dice.vector(3)), dice.vector(2)}; }

double difference(const Pose& a, const Pose& b) {
  return std::max((a.rotation - b.rotation).cwiseAbs().maxCoeff(),
                  (a.translation - b.translation).cwiseAbs().maxCoeff());
}

double not_orthonormal(const Mat3& r) {
  return std::max((r.transpose() * r - Mat3::Identity()).cwiseAbs().maxCoeff(),
                  std::abs(r.determinant() - 1));
}

// Of the same axis all along: the angle that the body has turned, followed in small steps.
double angle_followed(const Motion& motion, const Vec3& axis, double from, double to, int steps = 2000) {
  double angle = 0;
  for (int k = 0; k < steps; ++k) {
    const Mat3 before = motion.at(from + (to - from) * k / steps).rotation;
    const Mat3 after = motion.at(from + (to - from) * (k + 1) / steps).rotation;
    const AngleAxisd step(Mat3(after * before.transpose()));
    angle += step.angle() * step.axis().dot(axis);
  }
  return angle;
}

std::vector<Keyframe> random_keyframes(Dice& dice, int count, double turn) {
  std::vector<Keyframe> keyframes;
  double time = -0.3;
  for (int k = 0; k < count; ++k) {
    keyframes.push_back({time, dice.vector(1), dice.vector(turn)});
    time += dice.number(0.05, 1.5);
  }
  return keyframes;
}

// Rotation vectors of the body's turn between two times near each other, over the time.
Vec3 spin(const Motion& motion, double from, double to) {
  const AngleAxisd turn(Mat3(motion.at(from).rotation.transpose() * motion.at(to).rotation));
  return turn.angle() / (to - from) * turn.axis();
}

}  // namespace

TEST_CASE("poses compose as the maps that they are", "[motion]") {
  Dice dice;
  for (int k = 0; k < 20; ++k) {
    const Pose a = random_pose(dice), b = random_pose(dice), c = random_pose(dice);
    const Vec3 x = dice.vector(2);
    CHECK(((a * b).to_world(x) - a.to_world(b.to_world(x))).norm() < 1e-14);
    CHECK(difference((a * b) * c, a * (b * c)) < 1e-14);
    CHECK(difference(a * Pose(), a) == 0);
    CHECK(difference(Pose() * a, a) == 0);
    CHECK(difference(a * inverse(a), Pose()) < 1e-14);
    CHECK(difference(inverse(a) * a, Pose()) < 1e-14);
    CHECK((a.to_body(a.to_world(x)) - x).norm() < 1e-14);
    CHECK((inverse(a).to_world(x) - a.to_body(x)).norm() < 1e-14);
    CHECK((a.direction_to_world(x) - (a.to_world(x) - a.to_world(Vec3::Zero()))).norm() < 1e-14);
    CHECK((a.direction_to_body(a.direction_to_world(x)) - x).norm() < 1e-14);
  }
}

TEST_CASE("what has no motion stands where it was drawn", "[motion]") {
  const Motion still;
  CHECK_FALSE(still.moves());
  CHECK(still.last_time() == 0);
  for (double t : {-1.0, 0.0, 0.3, 1e9}) CHECK(difference(still.at(t), Pose()) == 0);
}

TEST_CASE("a steady motion goes at its speed and turns at its rate", "[motion]") {
  const Vec3 velocity(0.2, -0.1, 3), axis = Vec3(1, 2, -2) / 3, centre(0.5, 1, -2);
  const Motion motion = Motion::constant(velocity, 4 * axis, centre, 0.5, 2);
  CHECK(motion.moves());
  CHECK(motion.last_time() == 2);
  for (double t : {-1.0, 0.0, 0.5, 0.75, 1.9, 2.0, 7.0}) {
    const double tau = std::clamp(t, 0.5, 2.0) - 0.5;
    const Pose pose = motion.at(t);
    CHECK((pose.rotation - AngleAxisd(4 * tau, axis).toRotationMatrix()).cwiseAbs().maxCoeff() < 1e-15);
    CHECK((pose.to_world(centre) - (centre + tau * velocity)).norm() < 1e-14);
  }
  CHECK(difference(motion.at(2), motion.at(100)) == 0);
  const Motion without_end = Motion::constant(Vec3::Zero(), Vec3(0, 2 * pi, 0), Vec3::Zero());
  CHECK(without_end.last_time() == infinity);
  CHECK((without_end.at(1000.25).rotation * Vec3::UnitZ() - Vec3::UnitX()).norm() < 1e-11);
  CHECK_FALSE(Motion::constant(Vec3::Zero(), Vec3::Zero(), Vec3::Ones()).moves());
}

TEST_CASE("rotations are orthonormal to round-off", "[motion]") {
  Dice dice;
  double worst = 0;
  for (double size : {1e-320, 1e-160, 1e-9, 1.0, 30.0, 1e6}) {
    const Motion steady = Motion::constant(Vec3::Zero(), dice.vector(size), Vec3::Zero());
    const Motion path = Motion::keyframes(random_keyframes(dice, 8, size), Vec3::Zero());
    for (double t = -1; t < 12; t += 0.037)
      for (const Motion* motion : {&steady, &path})
        worst = std::max(worst, not_orthonormal(motion->at(t).rotation));
  }
  CHECK(worst < 2e-15);
}

TEST_CASE("the path goes through its keyframes and is at rest outside them", "[motion]") {
  Dice dice;
  for (double turn : {0.5, 3.0, 40.0}) {
    const Vec3 centre = dice.vector(2);
    const std::vector<Keyframe> keyframes = random_keyframes(dice, 9, turn);
    const Motion motion = Motion::keyframes(keyframes, centre);
    CHECK(motion.moves());
    CHECK(motion.last_time() == keyframes.back().time);
    for (const Keyframe& keyframe : keyframes) {
      const Mat3 r = turned(keyframe.rotation);
      const Pose there{r, centre - r * centre + keyframe.translate};
      CHECK(difference(motion.at(keyframe.time), there) < 1e-13);
      const double before = std::nextafter(keyframe.time, -infinity);  // the end of the interval before
      CHECK(difference(motion.at(before), there) < 1e-12);
    }
    CHECK(difference(motion.at(-5), motion.at(keyframes.front().time)) == 0);
    CHECK(difference(motion.at(1e6), motion.at(keyframes.back().time)) == 0);
  }
}

TEST_CASE("velocity and spin do not jump, and are zero at the ends", "[motion]") {
  Dice dice;
  const std::vector<Keyframe> keyframes = random_keyframes(dice, 9, 1.5);
  const Motion motion = Motion::keyframes(keyframes, Vec3::Zero());
  // A jump would stay as the step shrinks; of a C1 path it shrinks with it.
  const auto jump = [&](double time, double step) {
    const auto place = [&](double t) { return motion.at(t).translation; };
    const Vec3 before = (place(time) - place(time - step)) / step;
    const Vec3 after = (place(time + step) - place(time)) / step;
    return std::max((after - before).norm(),
                    (spin(motion, time, time + step) - spin(motion, time - step, time)).norm());
  };
  for (const Keyframe& keyframe : keyframes) {
    CHECK(jump(keyframe.time, 1e-3) < 2);
    CHECK(jump(keyframe.time, 1e-5) < 2e-2);
  }
  for (double t = keyframes.front().time; t < keyframes.back().time; t += 0.0137) CHECK(jump(t, 1e-5) < 2e-2);
  CHECK(spin(motion, keyframes.front().time, keyframes.front().time + 1e-6).norm() < 1e-3);
  CHECK(spin(motion, keyframes.back().time - 1e-6, keyframes.back().time).norm() < 1e-3);
  const double within = (keyframes[3].time + keyframes[4].time) / 2;
  CHECK(spin(motion, within, within + 1e-6).norm() > 0.1);  // the test sees what turns
}

TEST_CASE("no coordinate overshoots, and one that is an extreme rests", "[motion]") {
  Dice dice;
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<Keyframe> keyframes = random_keyframes(dice, 7, 0);
    const Motion motion = Motion::keyframes(keyframes, Vec3::Zero());
    for (std::size_t k = 0; k + 1 < keyframes.size(); ++k) {
      const Keyframe &a = keyframes[k], &b = keyframes[k + 1];
      Vec3 last = a.translate;
      double backwards = 0;
      for (int i = 1; i <= 200; ++i) {
        const Vec3 here = motion.at(a.time + (b.time - a.time) * i / 200).translation;
        backwards = std::max(
            backwards, -((here - last).array() * (b.translate - a.translate).array().sign()).minCoeff());
        last = here;
      }
      CHECK(backwards < 1e-14);
    }
  }
  const Motion there_and_back =
      Motion::keyframes({{0, Vec3::Zero()}, {1, {1, 0, 0}}, {2, {0.5, 0, 0}}}, Vec3::Zero());
  const double nearly = there_and_back.at(1 - 1e-6).translation[0];
  CHECK(1 - nearly < 1e-11);
}

TEST_CASE("between three keyframes on a line the slope is Fritsch and Butland's", "[motion]") {
  // h 1 and 2, mean slopes 3 and 1: w 5 and 4, slope 9 / (5/3 + 4/1) = 27/17
  const Motion motion = Motion::keyframes({{0, Vec3::Zero()}, {1, {3, 0, 0}}, {3, {5, 0, 0}}}, Vec3::Zero());
  const double slope = (motion.at(1 + 1e-6).translation[0] - motion.at(1 - 1e-6).translation[0]) / 2e-6;
  CHECK(slope == Approx(27.0 / 17).epsilon(1e-5));
  // Hermite at the middle.
  CHECK(motion.at(0.5).translation[0] == Approx(1.5 - 27.0 / 17 / 8).epsilon(1e-14));
  // An angle about one axis follows the same curve.
  const Vec3 axis = Vec3(1, -2, 2) / 3;
  const Motion turning =
      Motion::keyframes({{0, none, Vec3::Zero()}, {1, none, 3 * axis}, {3, none, 5 * axis}}, Vec3::Zero());
  for (double t : {0.2, 0.5, 1.0, 1.7, 2.9})
    CHECK((turning.at(t).rotation - turned(motion.at(t).translation[0] * axis)).cwiseAbs().maxCoeff() <
          1e-14);
}

TEST_CASE("an angle of 720 degrees is two turns", "[motion]") {
  const Vec3 axis = Vec3(2, 1, -2) / 3;
  for (double angle : {pi / 2, pi, 2 * pi, 4 * pi, -4 * pi}) {
    const Motion motion = Motion::keyframes({{0, none, Vec3::Zero()}, {2, none, angle * axis}}, Vec3::Zero());
    CHECK(motion.moves());
    CHECK(angle_followed(motion, axis, 0, 2) == Approx(angle));
    CHECK((motion.at(1).rotation - turned(angle / 2 * axis)).cwiseAbs().maxCoeff() < 1e-14);
  }
}

TEST_CASE("between different axes a body turns the short way", "[motion]") {
  const Vec3 a(0, pi / 2, 0), b(pi / 2, 0, 0);
  const Motion motion = Motion::keyframes({{0, none, a}, {1, none, b}}, Vec3::Zero());
  const AngleAxisd whole(Mat3(turned(a).transpose() * turned(b)));
  double angle = 0;
  for (int k = 0; k < 1000; ++k) angle += spin(motion, k * 1e-3, (k + 1) * 1e-3).norm() * 1e-3;
  CHECK(angle == Approx(whole.angle()).epsilon(1e-6));
}

TEST_CASE("quaternions are unwrapped to the vector nearest the one before", "[motion]") {
  const Vec3 axis = Vec3(1, 2, -2) / 3;
  Vec3 before = Vec3::Zero();
  for (int k = 1; k <= 80; ++k) {  // 10 degrees each, past two whole turns; q and -q are the same rotation
    Quaterniond q(AngleAxisd(k * pi / 18, axis));
    if (k % 3 == 0) q.coeffs() *= -1;
    const Vec3 now = unwrapped(q, before);
    CHECK((now - k * pi / 18 * axis).norm() < 1e-11);
    before = now;
  }
  for (int k = 79; k >= -80; --k) before = unwrapped(Quaterniond(AngleAxisd(k * pi / 18, axis)), before);
  CHECK((before + 80 * pi / 18 * axis).norm() < 1e-11);
  CHECK(unwrapped(Quaterniond::Identity(), Vec3::Zero()).norm() == 0);
}

TEST_CASE("measured quaternions that pass a whole turn beside it go on turning", "[motion]") {
  Dice dice;
  std::vector<Keyframe> keyframes;
  for (int k = 0; k <= 72; ++k) {  // two turns about y, each pose with an error of about half a degree
    const Quaterniond q =
        Quaterniond(AngleAxisd(k * pi / 18, Vec3::UnitY())) * Quaterniond(turned(dice.vector(0.01)));
    keyframes.push_back({0.1 * k, none, unwrapped(q, k == 0 ? Vec3::Zero() : keyframes.back().rotation)});
  }
  const Motion motion = Motion::keyframes(keyframes, Vec3::Zero());
  CHECK(angle_followed(motion, Vec3::UnitY(), 0, 7.2) == Approx(4 * pi).epsilon(0.02));
  for (int k = 0; k < 720; ++k) CHECK(spin(motion, 0.01 * k, 0.01 * (k + 1)).norm() < 2 * pi / 1.8);
}

TEST_CASE("one keyframe places a body that stands", "[motion]") {
  const Motion motion = Motion::keyframes({{1, {1, 2, 3}, {0, pi / 2, 0}}}, Vec3(0, 0, 1));
  CHECK_FALSE(motion.moves());
  CHECK(motion.last_time() == 0);
  for (double t : {0.0, 1.0, 2.0})
    CHECK((motion.at(t).to_world(Vec3(0, 0, 2)) - Vec3(2, 2, 4)).norm() < 1e-14);
  const Motion same = Motion::keyframes({{0, {1, 0, 0}}, {1, {1, 0, 0}}}, Vec3::Zero());
  CHECK_FALSE(same.moves());
}

TEST_CASE("asking for a pose allocates nothing", "[motion]") {
  Dice dice;
  const Motion motion = Motion::keyframes(random_keyframes(dice, 50, 2), Vec3::Zero());
  const long before = test::allocations();
  double sum = 0;
  for (double t = 0; t < 20; t += 0.01) sum += motion.at(t).translation[0];
  if (test::counts_allocations()) CHECK(test::allocations() == before);
  CHECK(std::isfinite(sum));
}

TEST_CASE("a motion that cannot be is refused", "[motion]") {
  const double nan = std::nan("");
  const Vec3 zero = Vec3::Zero(), bad(0, nan, 0);
  CHECK_THROWS_AS(Motion::keyframes({}, zero), InputError);
  CHECK_THROWS_WITH(Motion::keyframes({{1, zero}, {0.5, zero}}, zero),
                    Contains("keyframes out of order: 0.5 s comes after 1 s"));
  CHECK_THROWS_WITH(Motion::keyframes({{.time = -1e308}, {.time = 1e308}}, Vec3::Zero()),
                    Contains("it is too long"));
  CHECK_THROWS_WITH(Motion::keyframes({{1, zero}, {1, zero}}, zero), Contains("out of order"));
  CHECK_THROWS_WITH(Motion::keyframes({{nan, zero}}, zero), Contains("finite"));
  CHECK_THROWS_WITH(Motion::keyframes({{0, zero}, {infinity, zero}}, zero), Contains("finite"));
  CHECK_THROWS_WITH(Motion::keyframes({{0, bad}}, zero), Contains("translation"));
  CHECK_THROWS_WITH(Motion::keyframes({{0, zero, bad}}, zero), Contains("rotation"));
  CHECK_THROWS_WITH(Motion::keyframes({{0, zero}}, bad), Contains("centre"));
  CHECK_THROWS_WITH(Motion::constant(bad, zero, zero), Contains("velocity"));
  CHECK_THROWS_WITH(Motion::constant(zero, bad, zero), Contains("spin"));
  CHECK_THROWS_WITH(Motion::constant(zero, zero, bad), Contains("centre"));
  CHECK_THROWS_WITH(Motion::constant(zero, zero, zero, 1, 1), Contains("end"));
  CHECK_THROWS_WITH(Motion::constant(zero, zero, zero, nan), Contains("start"));
  CHECK_THROWS_WITH(Motion::constant(zero, zero, zero, 0, nan), Contains("end"));
  CHECK_NOTHROW(Motion::keyframes({{-1e300, zero}, {1e300, zero}}, zero));
}
