#include "constraints/shadow_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace drape::internal {
namespace {

constexpr double steepest = 1;  // tangent of the tilt of a triangle
constexpr double rounding = 1e-9;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

std::array<Vec3, 2> plane_across(const Vec3& n) {
  const Vec3 u = n.unitOrthogonal();
  return {u, n.cross(u)};
}

ShadowHull::ShadowHull(const std::vector<Face>& faces, const std::vector<Vec3>& places)
    : faces_(faces), places_(places), met_(faces.size(), 0), seen_(places.size(), 0) {}

int ShadowHull::beyond(int face, int side) const {
  const int other = faces_[face].across[side];
  if (other < 0) return -1;
  const Triangle &v = faces_[face].v, &w = faces_[other].v;
  for (std::size_t k = 0; k < 3; ++k)
    if (w[k] == v[(side + 1) % 3] && w[(k + 1) % 3] == v[side]) return other;
  return -1;
}

Vec3 ShadowHull::normal_of(int face) const {
  const Triangle& v = faces_[face].v;
  return (places_[v[1]] - places_[v[0]]).cross(places_[v[2]] - places_[v[0]]);
}

// Walks from the faces over all edges that go through the hull. A surface that has no border inside the hull
// and faces one way, with triangles on both sides of each edge, lies over each point of the hull equally
// often: once, where it does so somewhere.
bool ShadowHull::covers(const std::vector<int>& faces, const Vec3& normal) {
  if (!(normal.squaredNorm() > 0.5)) return false;  // as where there is a rope alone
  ++search_;
  found_.clear();
  height_ = std::numeric_limits<double>::infinity();
  slope_ = 0;
  plane_ = plane_across(normal);
  make_hull(faces);
  for (int f : faces) add(f);
  for (std::size_t k = 0; k < found_.size(); ++k) {
    const int f = found_[k];
    const Vec3 own = normal_of(f);
    const double along = own.dot(normal), slope = (own - along * normal).norm() / along;
    if (!(along > 0 && slope <= steepest)) return false;
    slope_ = std::max(slope_, slope);
    const std::array<Vec2, 3> corners = shadow_of(f);
    const double area = cross(corners[1] - corners[0], corners[2] - corners[0]);
    for (int side = 0; side < 3; ++side) {
      const Vec2 &a = corners[side], &b = corners[(side + 1) % 3];
      height_ = std::min(height_, area / (b - a).norm());
      const int other = beyond(f, side);
      if ((other >= 0 && met_[other] == search_) || !enters_hull(a, b)) continue;
      if (other < 0) return false;
      add(other);
    }
  }
  return !is_beneath_another(faces.front());
}

void ShadowHull::add(int face) {
  if (met_[face] == search_) return;
  met_[face] = search_;
  found_.push_back(face);
}

std::array<Eigen::Vector2d, 3> ShadowHull::shadow_of(int face) const {
  const Triangle& v = faces_[face].v;
  return {shadow(v[0]), shadow(v[1]), shadow(v[2])};
}

// [Andrew 1979]
void ShadowHull::make_hull(const std::vector<int>& faces) {
  points_.clear();
  for (int f : faces)
    for (int v : faces_[f].v)
      if (std::exchange(seen_[v], search_) != search_) points_.push_back(shadow(v));
  std::sort(points_.begin(), points_.end(),
            [](const Vec2& a, const Vec2& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
  hull_.clear();
  const auto chain = [&](auto begin, auto end) {
    const std::size_t from = hull_.size();
    for (auto p = begin; p != end; ++p) {
      while (hull_.size() > from + 1 &&
             !(cross(hull_.back() - hull_[hull_.size() - 2], *p - hull_.back()) > 0))
        hull_.pop_back();
      hull_.push_back(*p);
    }
    hull_.pop_back();
  };
  chain(points_.begin(), points_.end());
  chain(points_.rbegin(), points_.rend());
  size_ = (points_.back() - points_.front()).norm();
}

// Whether the straight way from a to b has points inside the hull, beyond rounding.
bool ShadowHull::enters_hull(const Vec2& a, const Vec2& b) const {
  double enter = 0, leave = 1;
  for (std::size_t k = 0; k < hull_.size(); ++k) {
    const Vec2& from = hull_[k];
    const Vec2 side = hull_[(k + 1) % hull_.size()] - from;
    const double least = rounding * size_ * side.norm();
    const double at_a = cross(side, a - from) - least, at_b = cross(side, b - from) - least;
    if (at_a <= 0 && at_b <= 0) return false;
    if (at_a < 0) enter = std::max(enter, at_a / (at_a - at_b));
    if (at_b < 0) leave = std::min(leave, at_a / (at_a - at_b));
  }
  return enter < leave;
}

// Whether the middle of the face lies over or under another face that was found.
bool ShadowHull::is_beneath_another(int face) const {
  const std::array<Vec2, 3> own = shadow_of(face);
  const Vec2 middle = (own[0] + own[1] + own[2]) / 3;
  return std::any_of(found_.begin(), found_.end(), [&](int f) {
    if (f == face) return false;
    const std::array<Vec2, 3> corners = shadow_of(f);
    for (std::size_t k = 0; k < 3; ++k)
      if (cross(corners[(k + 1) % 3] - corners[k], middle - corners[k]) < 0) return false;
    return true;
  });
}

}  // namespace drape::internal
