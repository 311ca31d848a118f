// Triangulation of polygons: quads by their diagonals, the rest by ear clipping. See polygon.h.
#include "mesh/triangles/polygon.h"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "mesh/triangles/normals.h"

namespace drape::internal {

namespace {

// Diagonals that differ by less than this are equally long: files hold some six digits, so that the diagonals
// of a regular grid come out 1e-5 to 1e-4 apart.
constexpr double kSameLength = 1e-3;
constexpr double kFlat = 1e-10;  // area / squared size below which an ear counts as collinear

// How closely the rest of the polygon may come to an ear that is cut off.
enum Strictness { kUntouched = 0, kTouched = 1, kCollinear = 2 };

double cross(double ax, double ay, double bx, double by) { return ax * by - ay * bx; }

// Drops corners equal to the one before, and spikes (a b a), which have no area. Returns true if there were
// any.
bool drop_repeated(std::vector<int>& corners) {
  const std::size_t before = corners.size();
  std::vector<int> kept;
  for (const int corner : corners) {
    if (!kept.empty() && kept.back() == corner) continue;
    if (kept.size() >= 2 && kept[kept.size() - 2] == corner) {
      kept.pop_back();
      continue;
    }
    kept.push_back(corner);
  }
  // Drops repeated corners and spikes also where the last corner meets the first.
  std::size_t first = 0;
  while (kept.size() - first >= 2) {
    if (kept[first] == kept.back()) {
      kept.pop_back();
    } else if (kept[first + 1] == kept.back()) {
      ++first;
    } else if (kept.size() - first >= 3 && kept[kept.size() - 2] == kept[first]) {
      kept.pop_back();
    } else {
      break;
    }
  }
  corners.assign(kept.begin() + static_cast<std::ptrdiff_t>(first), kept.end());
  return corners.size() != before;
}

}  // namespace

PolygonCutter::Outcome PolygonCutter::cut(const std::vector<int>& corners, std::vector<Triangle>& triangles) {
  corners_ = corners;
  Outcome outcome;
  outcome.repeated_corner = drop_repeated(corners_);
  if (corners_.size() == 3) {
    triangles.push_back({corners_[0], corners_[1], corners_[2]});
  } else if (corners_.size() == 4) {
    cut_quad(triangles);
  } else if (corners_.size() > 4) {
    outcome.folded = !clip_ears(triangles);
  }
  return outcome;
}

void PolygonCutter::cut_quad(std::vector<Triangle>& triangles) {
  const int a = corners_[0], b = corners_[1], c = corners_[2], d = corners_[3];
  const Vec3 &xa = positions_[a], &xb = positions_[b], &xc = positions_[c], &xd = positions_[d];
  const Vec3 normal = newell_normal(positions_, corners_.data(), 4);
  const auto up = [&](const Vec3& p, const Vec3& q, const Vec3& r) {
    return twice_area_normal(p, q, r).dot(normal);
  };
  const bool ac_inside = up(xa, xb, xc) > 0 && up(xa, xc, xd) > 0;
  const bool bd_inside = up(xa, xb, xd) > 0 && up(xb, xc, xd) > 0;
  if (diagonals_at_.size() < positions_.size()) diagonals_at_.resize(positions_.size(), 0);

  bool along_ac = ac_inside;
  if (ac_inside == bd_inside) {
    const double ac = (xc - xa).norm(), bd = (xd - xb).norm();
    const bool tie = std::abs(ac - bd) <= kSameLength * std::max(ac, bd);
    along_ac = tie ? diagonals_at_[a] + diagonals_at_[c] >= diagonals_at_[b] + diagonals_at_[d] : ac < bd;
  }
  if (along_ac) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
    ++diagonals_at_[a], ++diagonals_at_[c];
  } else {
    triangles.push_back({a, b, d});
    triangles.push_back({b, c, d});
    ++diagonals_at_[b], ++diagonals_at_[d];
  }
}

// Computes coordinates in the plane of the Newell normal, in which the polygon runs counter-clockwise.
void PolygonCutter::flatten() {
  const int count = static_cast<int>(corners_.size());
  const Vec3 normal = newell_normal(positions_, corners_.data(), count).stableNormalized();
  Vec3 across = normal.unitOrthogonal();
  if (!across.allFinite() || across.isZero()) across = Vec3::UnitX();
  const Vec3 along = normal.cross(across);
  u_.resize(count), w_.resize(count), before_.resize(count), after_.resize(count);
  for (int i = 0; i < count; ++i) {
    const Vec3 p = positions_[corners_[i]] - positions_[corners_[0]];
    u_[i] = p.dot(across), w_[i] = p.dot(along);
    before_[i] = (i + count - 1) % count, after_[i] = (i + 1) % count;
  }
}

// The quality of the shape of the ear at corner i, or -1 if there is no ear.
double PolygonCutter::ear_quality(int i, int strictness) const {
  const int a = before_[i], c = after_[i];
  if (corners_[a] == corners_[c]) return -1;
  const auto twice_area = [&](int p, int q, int r) {
    return cross(u_[q] - u_[p], w_[q] - w_[p], u_[r] - u_[p], w_[r] - w_[p]);
  };
  const auto squared = [&](int p, int q) {
    return (u_[q] - u_[p]) * (u_[q] - u_[p]) + (w_[q] - w_[p]) * (w_[q] - w_[p]);
  };
  const double area = twice_area(a, i, c), size = squared(a, i) + squared(i, c) + squared(c, a);
  if (area <= kFlat * size) return strictness == kCollinear && area >= -kFlat * size ? 0 : -1;

  const double margin = strictness == kUntouched ? -kFlat * size : kFlat * size;
  const auto same_place = [&](int p, int q) { return u_[p] == u_[q] && w_[p] == w_[q]; };
  for (int p = after_[c]; p != a; p = after_[p]) {
    if (same_place(p, a) || same_place(p, i) || same_place(p, c)) continue;
    if (twice_area(a, i, p) > margin && twice_area(i, c, p) > margin && twice_area(c, a, p) > margin)
      return -1;
  }
  return area / size;
}

// Cuts off ears. Returns false if a part of the polygon had to be cut as a fan.
bool PolygonCutter::clip_ears(std::vector<Triangle>& triangles) {
  flatten();
  int left = static_cast<int>(corners_.size()), start = 0;
  std::vector<double> quality(left);
  for (int i = 0; i < left; ++i) quality[i] = ear_quality(i, kUntouched);

  const auto best_ear = [&] {
    int best = -1;
    for (int i = start, n = 0; n < left; i = after_[i], ++n) {
      if (quality[i] >= 0 && (best < 0 || quality[i] > quality[best])) best = i;
    }
    return best;
  };
  while (left > 3) {
    int ear = best_ear();
    for (int strictness = kUntouched; ear < 0 && strictness <= kCollinear; ++strictness) {
      for (int i = start, n = 0; n < left; i = after_[i], ++n) quality[i] = ear_quality(i, strictness);
      ear = best_ear();
    }
    if (ear < 0) break;
    const int a = before_[ear], c = after_[ear];
    triangles.push_back({corners_[a], corners_[ear], corners_[c]});
    after_[a] = c, before_[c] = a;
    start = a;
    --left;
    quality[a] = ear_quality(a, kUntouched), quality[c] = ear_quality(c, kUntouched);
  }
  for (int i = after_[start]; after_[i] != start; i = after_[i]) {
    const Triangle t{corners_[start], corners_[i], corners_[after_[i]]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  return left == 3;
}

}  // namespace drape::internal
