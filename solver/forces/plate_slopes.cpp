#include "solver/forces/plate_slopes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace drape::internal {
namespace {

using Vec2 = Eigen::Vector2d;

// The smallest weights of these points that give the slope along y at the origin of every quadratic function;
// empty when there are none.
VecX exact_slope(const std::vector<Vec2>& at, const std::vector<std::size_t>& chosen) {
  Eigen::MatrixXd values(6, static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const Vec2& p = at[chosen[k]];
    values.col(static_cast<Eigen::Index>(k)) << 1, p.x(), p.y(), 0.5 * p.x() * p.x(), p.x() * p.y(),
        0.5 * p.y() * p.y();
  }
  const Eigen::Matrix<double, 6, 1> wanted = Eigen::Matrix<double, 6, 1>::Unit(2);
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(values);
  const VecX weights = solver.solve(wanted);
  return (values * weights - wanted).norm() < 1e-9 ? weights : VecX();
}

}  // namespace

void Functional::add(int vertex, double weight) {
  const auto place = std::find(vertices.begin(), vertices.end(), vertex);
  if (place != vertices.end()) {
    weights[static_cast<std::size_t>(place - vertices.begin())] += weight;
    return;
  }
  vertices.push_back(vertex);
  weights.push_back(weight);
}

PlateSlopes::PlateSlopes(const TriangleMesh& mesh, const std::vector<RestCorners>& corners)
    : mesh_(mesh), corners_(corners), hinges_(drape::hinges(mesh)), around_(mesh.triangles.size()) {
  find_neighbours();
}

std::size_t PlateSlopes::corner(int t, int vertex) const {
  const Triangle& all = triangle(t);
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), vertex) - all.begin());
}

double PlateSlopes::height(int t, int a, int b, int c) const { return apex(t, a, b, c).height; }

bool PlateSlopes::bends(int t) const {
  const RestCorners& p = corners_[static_cast<std::size_t>(t)];
  const Vec2 a = p[1] - p[0], b = p[2] - p[0];
  const double longest = std::max({a.norm(), b.norm(), (b - a).norm()});
  return std::abs(a.x() * b.y() - a.y() * b.x()) > 1e-4 * longest * longest;
}

PlateSlopes::Apex PlateSlopes::apex(int t, int a, int b, int c) const {
  const Vec2 along = at_rest(t, b) - at_rest(t, a);
  const double l = along.norm();
  const Vec2 to_c = at_rest(t, c) - 0.5 * (at_rest(t, a) + at_rest(t, b)), e = along / l;
  return {l, e.dot(to_c), std::abs(e.x() * to_c.y() - e.y() * to_c.x())};
}

void PlateSlopes::find_neighbours() {
  std::stable_sort(hinges_.begin(), hinges_.end(),
                   [](const Hinge& p, const Hinge& q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); });
  const std::vector<Hinge> all = std::move(hinges_);
  hinges_ = {};
  const auto same_edge = [&](std::size_t h, std::size_t other) {
    return other < all.size() && all[h].a == all[other].a && all[h].b == all[other].b;
  };
  for (std::size_t h = 0; h < all.size(); ++h)
    if (!same_edge(h, h + 1) && !same_edge(h, h - 1) && bends(all[h].tc) && bends(all[h].td)) {
      for (int t : {all[h].tc, all[h].td})
        around_[static_cast<std::size_t>(t)].push_back(static_cast<int>(hinges_.size()));
      hinges_.push_back(all[h]);
    }
}

// Lays the triangle across the hinge beside `known`, whose corners lie in the plane.
PlateSlopes::Placed PlateSlopes::unfolded(const Hinge& hinge, const Placed& known) const {
  const bool from_c = known.triangle == hinge.tc;
  const int t = from_c ? hinge.td : hinge.tc, c = from_c ? hinge.d : hinge.c;
  const Apex over = apex(t, hinge.a, hinge.b, c);
  const Vec2 &p = known.at[corner(known.triangle, hinge.a)], &q = known.at[corner(known.triangle, hinge.b)];
  const Vec2 middle = 0.5 * (p + q), e = (q - p).normalized(), n(-e.y(), e.x());
  const double side =
      n.dot(known.at[corner(known.triangle, from_c ? hinge.c : hinge.d)] - middle) > 0 ? -1 : 1;
  Placed beside{t, {}};
  beside.at[corner(t, hinge.a)] = p;
  beside.at[corner(t, hinge.b)] = q;
  beside.at[corner(t, c)] = middle + over.foot * e + side * over.height * n;
  return beside;
}

void PlateSlopes::grow(std::vector<Placed>& patch) const {
  const std::size_t known = patch.size();
  for (std::size_t k = 0; k < known; ++k)
    for (int h : around_[static_cast<std::size_t>(patch[k].triangle)]) {
      const Hinge& hinge = hinges_[static_cast<std::size_t>(h)];
      const int other = hinge.tc == patch[k].triangle ? hinge.td : hinge.tc;
      if (std::none_of(patch.begin(), patch.end(), [&](const Placed& p) { return p.triangle == other; }))
        patch.push_back(unfolded(hinge, patch[k]));
    }
}

Functional PlateSlopes::slope(const Hinge& hinge) const {
  const Apex one = apex(hinge.tc, hinge.a, hinge.b, hinge.c), two = apex(hinge.td, hinge.a, hinge.b, hinge.d);
  Placed first{hinge.tc, {}};
  first.at[corner(hinge.tc, hinge.a)] = Vec2(-0.5 * one.l, 0);
  first.at[corner(hinge.tc, hinge.b)] = Vec2(0.5 * one.l, 0);
  first.at[corner(hinge.tc, hinge.c)] = Vec2(one.foot, one.height);
  std::vector<Placed> patch = {first, unfolded(hinge, first)};
  const double unit = std::max(one.l, std::sqrt(one.l * (one.height + two.height)));
  constexpr int rings = 3;
  for (int ring = 0; ring < rings; ++ring) {
    grow(patch);
    if (std::optional<Functional> found = quadratic_slope(patch, unit)) return *found;
  }
  // Too few vertices for a quadratic function: the slope between those of the two triangles.
  Functional between;
  const double share = two.height / (one.height + two.height);
  add_inward(hinge.tc, hinge, share, between);
  add_inward(hinge.td, hinge, share - 1, between);
  return between;
}

// The slope along y at the origin that is right for every quadratic function, from the two triangles'
// vertices and as few others as will do: often none, never more than two unless they lie badly. Nothing where
// the vertices do not determine it.
std::optional<Functional> PlateSlopes::quadratic_slope(const std::vector<Placed>& patch, double unit) const {
  std::vector<int> vertices;
  std::vector<Vec2> at;
  for (const Placed& p : patch)
    for (std::size_t k = 0; k < 3; ++k) {
      const int vertex = triangle(p.triangle)[k];
      if (std::find(vertices.begin(), vertices.end(), vertex) != vertices.end()) continue;
      vertices.push_back(vertex);
      at.push_back(p.at[k] / unit);
    }
  constexpr double steep = 4;  // times 1 / unit: weights beyond this would make the plate stiff
  std::optional<Functional> best;
  double least = steep * steep;
  const auto consider = [&](const std::vector<std::size_t>& chosen) {
    const VecX weights = exact_slope(at, chosen);
    if (weights.size() == 0 || weights.squaredNorm() >= least * (1 - 1e-9)) return;
    least = weights.squaredNorm();
    best.emplace();
    for (std::size_t k = 0; k < chosen.size(); ++k)
      if (const double w = weights[static_cast<Eigen::Index>(k)]; std::abs(w) > 1e-12)
        best->add(vertices[chosen[k]], w / unit);
  };
  const std::vector<std::size_t> own = {0, 1, 2, 3};
  consider(own);
  if (best) return best;
  const auto with = [&](auto... more) {
    std::vector<std::size_t> chosen = own;
    (chosen.push_back(more), ...);
    consider(chosen);
  };
  for (std::size_t k = 4; k < at.size(); ++k) with(k);
  if (best) return best;
  for (std::size_t k = 4; k < at.size(); ++k)
    for (std::size_t l = k + 1; l < at.size(); ++l) with(k, l);
  return best;
}

void PlateSlopes::add_inward(int t, const Hinge& hinge, double factor, Functional& slope) const {
  const int c = t == hinge.tc ? hinge.c : hinge.d;
  const Apex over = apex(t, hinge.a, hinge.b, c);
  const double share = 0.5 + over.foot / over.l;
  slope.add(c, factor / over.height);
  slope.add(hinge.a, -factor * (1 - share) / over.height);
  slope.add(hinge.b, -factor * share / over.height);
}

}  // namespace drape::internal
