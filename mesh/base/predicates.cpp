// The only file that knows Boost.Multiprecision. See predicates.h.
#include "mesh/base/predicates.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>

namespace drape::internal {
namespace {

namespace mp = boost::multiprecision;
// A whole number as long as needed. Up to 1024 bits, which every pattern keeps to, it takes no memory from
// the heap.
using Whole = mp::number<mp::cpp_int_backend<1024, 0, mp::signed_magnitude, mp::unchecked>, mp::et_off>;

constexpr double kHalfUlp = 0x1p-53;
constexpr double kOrientBound = (3 + 16 * kHalfUlp) * kHalfUlp;
// Of the determinant as it is summed here, its three products in sequence; d is subtracted from the others.
constexpr double kOrient3dBound = (7 + 56 * kHalfUlp) * kHalfUlp;
constexpr double kCircleBound = (10 + 96 * kHalfUlp) * kHalfUlp;

int sign(double x) { return (x > 0) - (x < 0); }

// The coordinates as whole multiples of the greatest power of two that divides them all.
template <class... Points>
auto whole(const Points&... points) {
  constexpr std::size_t n = (static_cast<std::size_t>(Points::SizeAtCompileTime) + ...);
  std::array<double, n> x;
  std::size_t filled = 0;
  const auto append = [&](const auto& point) {
    for (const double coordinate : point) x[filled++] = coordinate;
  };
  (append(points), ...);
  std::array<std::int64_t, n> digits;
  std::array<int, n> exponents;
  int least = 1 << 20;
  for (std::size_t i = 0; i < n; ++i) {
    digits[i] = static_cast<std::int64_t>(std::ldexp(std::frexp(x[i], &exponents[i]), 53));
    if (digits[i] != 0) least = std::min(least, exponents[i]);
  }
  std::array<Whole, n> scaled;
  for (std::size_t i = 0; i < n; ++i) {
    scaled[i] = digits[i];
    if (digits[i] != 0) scaled[i] <<= exponents[i] - least;
  }
  return scaled;
}

int exact_orient2d(const Vec2& a, const Vec2& b, const Vec2& c) {
  const auto x = whole(a, b, c);
  const Whole d = (x[2] - x[0]) * (x[5] - x[1]) - (x[3] - x[1]) * (x[4] - x[0]);
  return d.sign();
}

int exact_orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  auto x = whole(a, b, c, d);
  for (std::size_t i = 0; i < 9; ++i) x[i] -= x[9 + i % 3];
  const Whole det = x[0] * (x[4] * x[8] - x[5] * x[7]) + x[3] * (x[7] * x[2] - x[8] * x[1]) +
                    x[6] * (x[1] * x[5] - x[2] * x[4]);
  return -det.sign();
}

int exact_incircle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto x = whole(a, b, c, d);
  const Whole ax = x[0] - x[6], ay = x[1] - x[7], bx = x[2] - x[6], by = x[3] - x[7], cx = x[4] - x[6],
              cy = x[5] - x[7];
  const Whole det = (ax * ax + ay * ay) * (bx * cy - cx * by) + (bx * bx + by * by) * (cx * ay - ax * cy) +
                    (cx * cx + cy * cy) * (ax * by - bx * ay);
  return det.sign();
}

}  // namespace

int orient2d(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (b.x() - a.x()) * (c.y() - a.y()), right = (b.y() - a.y()) * (c.x() - a.x());
  const double det = left - right;
  if (std::abs(det) > kOrientBound * (std::abs(left) + std::abs(right))) return sign(det);
  return exact_orient2d(a, b, c);
}

int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 p = a - d, q = b - d, r = c - d;
  const double qxry = q.x() * r.y(), rxqy = r.x() * q.y(), rxpy = r.x() * p.y(), pxry = p.x() * r.y(),
               pxqy = p.x() * q.y(), qxpy = q.x() * p.y();
  const double det = p.z() * (qxry - rxqy) + q.z() * (rxpy - pxry) + r.z() * (pxqy - qxpy);
  const double size = (std::abs(qxry) + std::abs(rxqy)) * std::abs(p.z()) +
                      (std::abs(rxpy) + std::abs(pxry)) * std::abs(q.z()) +
                      (std::abs(pxqy) + std::abs(qxpy)) * std::abs(r.z());
  if (std::abs(det) > kOrient3dBound * size) return -sign(det);
  for (int k = 0; k < 3; ++k)  // cloth often starts flat, across an axis
    if (a[k] == d[k] && b[k] == d[k] && c[k] == d[k]) return 0;
  return exact_orient3d(a, b, c, d);
}

int incircle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double ax = a.x() - d.x(), ay = a.y() - d.y(), bx = b.x() - d.x(), by = b.y() - d.y(),
               cx = c.x() - d.x(), cy = c.y() - d.y();
  const double bxcy = bx * cy, cxby = cx * by, cxay = cx * ay, axcy = ax * cy, axby = ax * by, bxay = bx * ay;
  const double a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  const double det = a2 * (bxcy - cxby) + b2 * (cxay - axcy) + c2 * (axby - bxay);
  const double size = (std::abs(bxcy) + std::abs(cxby)) * a2 + (std::abs(cxay) + std::abs(axcy)) * b2 +
                      (std::abs(axby) + std::abs(bxay)) * c2;
  if (std::abs(det) > kCircleBound * size) return sign(det);
  return exact_incircle(a, b, c, d);
}

}  // namespace drape::internal
