#include "constraints/contact.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "mesh/base/errors.h"
#include "mesh/base/words.h"

namespace drape {

void check(const Obstacle& obstacle) {
  check(obstacle.shape);
  const std::string where(name(obstacle.shape));
  const Friction& mu = obstacle.friction;
  if (!(mu.statics >= 0) || !(mu.kinetic >= 0) || !std::isfinite(mu.statics) || !std::isfinite(mu.kinetic))
    throw InputError(where + ": friction = " + shortest(mu.statics) + " (static), " + shortest(mu.kinetic) +
                     " (kinetic): a coefficient of friction is a number from 0 up");
  if (mu.kinetic > mu.statics)
    throw InputError(where + ": friction = " + shortest(mu.kinetic) + " (kinetic) is greater than " +
                     shortest(mu.statics) + " (static); give a kinetic one of " + shortest(mu.statics) +
                     " at most");
  if (!(obstacle.margin >= 0) || !std::isfinite(obstacle.margin))
    throw InputError(where + ": margin = " + std::to_string(obstacle.margin) +
                     " m: a margin is not negative");
  if (!(obstacle.restitution >= 0 && obstacle.restitution <= 1))
    throw InputError(where + ": restitution = " + std::to_string(obstacle.restitution) +
                     ": a restitution is a number from 0 (stays) to 1 (springs back as fast as it came)");
  if (!obstacle.rigid) return;
  if (!can_react(obstacle.shape))
    throw InputError(where +
                     ": cannot react; give a mass to a body such as a sphere, a box or a closed mesh");
  if (obstacle.motion.moves())
    throw InputError(where +
                     ": has a mass and a motion; a body that moves by what acts on it has no other motion");
  try {
    check(*obstacle.rigid);
  } catch (const InputError& error) {
    throw InputError(where + ": " + error.what());
  }
}

Mat3 Contact::locked_directions() const {
  Mat3 Q = Mat3::Zero();
  for (int k = 0; k < planes; ++k) {
    Vec3 n = plane[k].normal;
    for (int j = 0; j < k; ++j) n -= Q.col(j).dot(n) * Q.col(j);
    Q.col(k) = n.normalized();
  }
  return Q;
}

void let_go(Contact& contact, int plane) {
  const auto begin = contact.plane.begin();
  std::rotate(begin + plane, begin + plane + 1, begin + contact.planes);
  --contact.planes;
}

bool add_plane(Contact& contact, const ContactPlane& plane) {
  // `rest` is the part of the normal that the planes already held do not span. Where it is too small, the new
  // plane adds no constraint.
  Vec3 rest = plane.normal;
  const Mat3 Q = contact.locked_directions();
  for (int k = 0; k < contact.planes; ++k) rest -= Q.col(k).dot(rest) * Q.col(k);
  if (contact.planes == 3 || rest.norm() < 0.1) return false;
  // Those that were let go move back by one place; where three are known, the last of them is forgotten.
  contact.known = std::min(contact.known + 1, 3);
  for (auto k = static_cast<std::size_t>(contact.known) - 1; k > static_cast<std::size_t>(contact.planes);
       --k)
    contact.plane[k] = contact.plane[k - 1];
  contact.plane[contact.planes++] = plane;
  for (auto k = static_cast<std::size_t>(contact.planes) - 1;
       k > 0 && contact.plane[k].gap < contact.plane[k - 1].gap; --k)
    std::swap(contact.plane[k], contact.plane[k - 1]);
  return true;
}

void add_deepest(Contact& contact, const ContactPlane& plane) {
  if (add_plane(contact, plane)) return;
  if (contact.planes == 1 && plane.gap < contact.plane[0].gap) contact.plane[0] = plane;
}

// N^T N, with the planes' normals as the columns of N, and ones on the unused part of the diagonal.
static Mat3 gram(const Contact& contact) {
  Mat3 G = Mat3::Identity();
  for (int i = 0; i < contact.planes; ++i)
    for (int j = 0; j < contact.planes; ++j) G(i, j) = contact.plane[i].normal.dot(contact.plane[j].normal);
  return G;
}

Vec3 along_planes(const Contact& contact, const std::array<double, 3>& components) {
  Vec3 t = Vec3::Zero(), sum = Vec3::Zero();
  for (int k = 0; k < contact.planes; ++k) t[k] = components[k];
  if (contact.planes == 1) return t[0] * contact.plane[0].normal;
  const Vec3 weights = gram(contact).inverse() * t;
  for (int k = 0; k < contact.planes; ++k) sum += weights[k] * contact.plane[k].normal;
  return sum;
}

std::array<double, 3> multipliers(const Contact& contact, const Vec3& r) {
  Vec3 t = Vec3::Zero();
  for (int k = 0; k < contact.planes; ++k) t[k] = contact.plane[k].normal.dot(r);
  if (contact.planes > 1) t = gram(contact).inverse() * t;
  return {t[0], t[1], t[2]};
}

bool add_or_exchange(Contact& contact, const Vec3& r, const ContactPlane& plane) {
  if (add_plane(contact, plane)) return true;
  const std::array<double, 3> lambda = multipliers(contact, r), share = multipliers(contact, plane.normal);
  int first = -1;
  for (int k = 0; k < contact.planes; ++k)
    if (share[k] > 0 && (first < 0 || lambda[k] * share[first] < lambda[first] * share[k])) first = k;
  if (first < 0) return false;
  Contact exchanged = contact;
  let_go(exchanged, first);
  if (!add_plane(exchanged, plane)) return false;
  contact = exchanged;
  return true;
}

bool hold_again(Contact& contact, const Vec3& r, int plane) {
  Contact holding = contact;
  const auto begin = holding.plane.begin();
  std::rotate(begin + plane, begin + plane + 1, begin + holding.known--);
  if (!add_or_exchange(holding, r, contact.plane[plane])) return false;
  contact = holding;
  return true;
}

}  // namespace drape
