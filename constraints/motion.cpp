#include "constraints/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "mesh/base/errors.h"

namespace drape {
namespace {

using Eigen::Quaterniond;

constexpr double whole_turn = 2 * std::numbers::pi;
constexpr double same_axis = 1e-6;  // sine of the angle between two axes that count as one
constexpr double no_turn = 1e-12;   // sine of half an angle that counts as a whole number of turns

Quaterniond exp(const Vec3& turn) {
  const double angle = turn.stableNorm();
  return angle > 0 ? Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) : Quaterniond::Identity();
}

// The shortest rotation vector of a rotation, at most pi long.
Vec3 log(const Quaterniond& rotation) {
  const double sine = rotation.vec().stableNorm();
  if (!(sine > 0)) return Vec3::Zero();
  const double angle = 2 * std::atan2(sine, std::abs(rotation.w()));
  return (std::signbit(rotation.w()) ? -angle : angle) / sine * rotation.vec();
}

Vec3 turn_between(const Vec3& from, const Vec3& to) {
  const bool one_axis = from.cross(to).norm() <= same_axis * from.norm() * to.norm();
  return one_axis ? Vec3(to - from) : log(exp(-from) * exp(to));
}

Pose posed(const Quaterniond& rotation, const Vec3& centre, const Vec3& translate) {
  const Mat3 r = rotation.normalized().toRotationMatrix();
  return {r, (centre - r * centre) + translate};
}

// Fritsch & Butland's slope between two intervals of lengths h0, h1 and mean slopes d0, d1.
double slope(double h0, double h1, double d0, double d1) {
  if (!(d0 * d1 > 0)) return 0;
  const double w0 = h0 + 2 * h1, w1 = 2 * h0 + h1;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

// The slopes at every keyframe, from the changes between one and the next; at the two ends they are zero.
std::vector<Vec3> slopes(const std::vector<Keyframe>& keyframes, const std::vector<Vec3>& changes) {
  std::vector<Vec3> found(keyframes.size(), Vec3::Zero());
  for (std::size_t k = 1; k + 1 < keyframes.size(); ++k) {
    const double h0 = keyframes[k].time - keyframes[k - 1].time;
    const double h1 = keyframes[k + 1].time - keyframes[k].time;
    for (int i = 0; i < 3; ++i) found[k][i] = slope(h0, h1, changes[k - 1][i] / h0, changes[k][i] / h1);
  }
  return found;
}

std::string in_words(const Keyframe& keyframe) {
  std::ostringstream text;
  text.precision(15);
  text << keyframe.time << " s";
  return text.str();
}

void require_finite(const Vec3& value, const char* what) {
  if (!value.allFinite()) throw InputError(std::string("motion: ") + what + " must be finite");
}

void require_finite(const Keyframe& keyframe) {
  if (!std::isfinite(keyframe.time)) throw InputError("motion: the time of a keyframe must be finite");
  require_finite(keyframe.translate, "the translation of a keyframe");
  require_finite(keyframe.rotation, "the rotation of a keyframe");
}

}  // namespace

void check_order(const Keyframe& before, const Keyframe& next) {
  if (!std::isfinite(next.time - before.time))
    throw InputError("keyframes: from " + in_words(before) + " to " + in_words(next) + " it is too long");
  if (!(next.time > before.time))
    throw InputError("keyframes out of order: " + in_words(next) + " comes after " + in_words(before) +
                     "; times must increase from one to the next");
}

Vec3 unwrapped(const Quaterniond& rotation, const Vec3& before) {
  const double sine = rotation.vec().norm();
  if (!(sine > no_turn * std::abs(rotation.w()))) {  // a whole number of turns, about any axis
    const double angle = before.norm();
    return angle > 0 ? Vec3(whole_turn * std::round(angle / whole_turn) / angle * before) : Vec3::Zero();
  }
  const Vec3 axis = rotation.vec() / sine;
  const double angle = 2 * std::atan2(sine, rotation.w());
  return (angle + whole_turn * std::round((axis.dot(before) - angle) / whole_turn)) * axis;
}

Motion Motion::constant(const Vec3& velocity, const Vec3& spin, const Vec3& centre, double start,
                        double end) {
  require_finite(velocity, "the velocity");
  require_finite(spin, "the spin");
  require_finite(centre, "the centre");
  if (!std::isfinite(start) || !(end > start))
    throw InputError("motion: its start must be finite and its end must come after it");
  Motion motion;
  motion.law_ = Steady{velocity, spin, centre, start, end};
  return motion;
}

Motion Motion::keyframes(const std::vector<Keyframe>& keyframes, const Vec3& centre) {
  if (keyframes.empty()) throw InputError("motion: there must be at least one keyframe");
  require_finite(centre, "the centre");
  std::vector<Vec3> shifts, turns;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    require_finite(keyframes[k]);
    if (k == 0) continue;
    check_order(keyframes[k - 1], keyframes[k]);
    shifts.emplace_back(keyframes[k].translate - keyframes[k - 1].translate);
    turns.push_back(turn_between(keyframes[k - 1].rotation, keyframes[k].rotation));
  }
  const auto nothing = [](const Vec3& change) { return change.isZero(0); };
  Path path{{},
            centre,
            !std::all_of(shifts.begin(), shifts.end(), nothing) ||
                !std::all_of(turns.begin(), turns.end(), nothing)};

  const std::vector<Vec3> velocities = slopes(keyframes, shifts), spins = slopes(keyframes, turns);
  for (std::size_t k = 0; k < keyframes.size(); ++k)
    path.knots.push_back(
        {keyframes[k].time, keyframes[k].translate, velocities[k], exp(keyframes[k].rotation)});
  for (std::size_t k = 0; k + 1 < path.knots.size(); ++k) {
    Knot& knot = path.knots[k];
    const Knot& next = path.knots[k + 1];
    const double h = next.time - knot.time;
    knot.leaving = h / 3 * spins[k];
    knot.arriving = h / 3 * spins[k + 1];
    knot.turning = turns[k] - knot.leaving - knot.arriving;
    knot.left = log(exp(-knot.turning) * exp(-knot.leaving) * knot.rotation.conjugate() * next.rotation *
                    exp(-knot.arriving));
  }
  Motion motion;
  motion.law_ = std::move(path);
  return motion;
}

Pose Motion::Steady::at(double time) const {
  const double tau = std::clamp(time, start, end) - start;
  return posed(exp(tau * spin), centre, tau * velocity);
}

Pose Motion::Path::at(double time) const {
  const auto later = [](double t, const Knot& knot) { return t < knot.time; };
  const auto next = std::upper_bound(knots.begin(), knots.end(), time, later);
  if (next == knots.begin()) return posed(next->rotation, centre, next->translate);
  const Knot& knot = *std::prev(next);
  if (next == knots.end()) return posed(knot.rotation, centre, knot.translate);

  const double h = next->time - knot.time, s = (time - knot.time) / h, u = 1 - s;
  const double b2 = s * s * (3 - 2 * s);
  const Vec3 translate = knot.translate + b2 * (next->translate - knot.translate) +
                         h * s * u * (u * knot.velocity - s * next->velocity);
  const Quaterniond rotation = knot.rotation * exp((1 - u * u * u) * knot.leaving) * exp(b2 * knot.turning) *
                               exp(b2 * knot.left) * exp(s * s * s * knot.arriving);
  return posed(rotation, centre, translate);
}

Pose Motion::at(double time) const {
  if (const Steady* const steady = std::get_if<Steady>(&law_)) return steady->at(time);
  if (const Path* const path = std::get_if<Path>(&law_)) return path->at(time);
  return {};
}

bool Motion::moves() const {
  if (const Steady* const steady = std::get_if<Steady>(&law_))
    return !steady->velocity.isZero(0) || !steady->spin.isZero(0);
  const Path* const path = std::get_if<Path>(&law_);
  return path && path->moves;
}

double Motion::last_time() const {
  if (!moves()) return 0;
  const Steady* const steady = std::get_if<Steady>(&law_);
  return steady ? steady->end : std::get<Path>(law_).knots.back().time;
}

}  // namespace drape
