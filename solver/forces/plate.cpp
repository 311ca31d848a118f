#include "solver/forces/plate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "mesh/triangles/topology.h"
#include "solver/forces/triangle_frame.h"

namespace drape {
namespace {

using Vec2 = Eigen::Vector2d;

// A linear function of what stands at the vertices, such as a slope: the sum of weight times value.
struct Functional {
  std::vector<int> vertices;
  std::vector<double> weights;

  void add(int vertex, double weight) {
    const auto place = std::find(vertices.begin(), vertices.end(), vertex);
    if (place != vertices.end()) {
      weights[static_cast<std::size_t>(place - vertices.begin())] += weight;
      return;
    }
    vertices.push_back(vertex);
    weights.push_back(weight);
  }
};

// How the corner across from an edge lies over it.
struct Apex {
  double l, foot,
      height;  // m: the edge, and of the corner its foot from the middle of the edge and its height
};

class MorleyPlate {
 public:
  MorleyPlate(const TriangleMesh& mesh, const std::vector<RestCorners>& corners,
              const PlateStiffness& stiffness, double rest_angle)
      : mesh_(mesh),
        corners_(corners),
        rest_angle_(rest_angle),
        hinges_(hinges(mesh)),
        around_(mesh.triangles.size()) {
    D_ << stiffness.warp, stiffness.cross, 0, stiffness.cross, stiffness.weft, 0, 0, 0, stiffness.twist;
    find_neighbours();
  }

  PlateEnergy make() {
    slopes_.reserve(hinges_.size());
    for (const Hinge& hinge : hinges_) slopes_.push_back(slope(hinge));
    for (int t : counted_triangles(mesh_))
      if (bends(t)) add_triangle(t);
    std::stable_sort(pairs_.begin(), pairs_.end(), [](const PlatePair& p, const PlatePair& q) {
      return std::tie(p.i, p.j) < std::tie(q.i, q.j);
    });
    std::size_t kept = 0;
    for (const PlatePair& p : pairs_) {
      if (kept > 0 && pairs_[kept - 1].i == p.i && pairs_[kept - 1].j == p.j)
        pairs_[kept - 1].k += p.k;
      else
        pairs_[kept++] = p;
    }
    pairs_.resize(kept);
    return {std::move(pairs_), std::move(bent_)};
  }

 private:
  // A triangle and where its corners are in the plane of an edge.
  struct Placed {
    int triangle;
    std::array<Vec2, 3> at;
  };

  const Triangle& triangle(int t) const { return mesh_.triangles[static_cast<std::size_t>(t)]; }

  std::size_t corner(int t, int vertex) const {
    const Triangle& all = triangle(t);
    return static_cast<std::size_t>(std::find(all.begin(), all.end(), vertex) - all.begin());
  }
  const Vec2& at_rest(int t, int vertex) const {
    return corners_[static_cast<std::size_t>(t)][corner(t, vertex)];
  }

  bool bends(int t) const {
    const RestCorners& p = corners_[static_cast<std::size_t>(t)];
    const Vec2 a = p[1] - p[0], b = p[2] - p[0];
    const double longest = std::max({a.norm(), b.norm(), (b - a).norm()});
    return std::abs(a.x() * b.y() - a.y() * b.x()) > 1e-4 * longest * longest;
  }

  Apex apex(int t, int a, int b, int c) const {
    const Vec2 along = at_rest(t, b) - at_rest(t, a);
    const double l = along.norm();
    const Vec2 to_c = at_rest(t, c) - 0.5 * (at_rest(t, a) + at_rest(t, b)), e = along / l;
    return {l, e.dot(to_c), std::abs(e.x() * to_c.y() - e.y() * to_c.x())};
  }

  // Hinges that join two triangles with area and are the only one of their edge; the others bend freely.
  void find_neighbours() {
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
  Placed unfolded(const Hinge& hinge, const Placed& known) const {
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

  void grow(std::vector<Placed>& patch) const {
    const std::size_t known = patch.size();
    for (std::size_t k = 0; k < known; ++k)
      for (int h : around_[static_cast<std::size_t>(patch[k].triangle)]) {
        const Hinge& hinge = hinges_[static_cast<std::size_t>(h)];
        const int other = hinge.tc == patch[k].triangle ? hinge.td : hinge.tc;
        if (std::none_of(patch.begin(), patch.end(), [&](const Placed& p) { return p.triangle == other; }))
          patch.push_back(unfolded(hinge, patch[k]));
      }
  }

  // The slope at the middle of the hinge's edge, across it and into the triangle of c.
  Functional slope(const Hinge& hinge) const {
    const Apex one = apex(hinge.tc, hinge.a, hinge.b, hinge.c),
               two = apex(hinge.td, hinge.a, hinge.b, hinge.d);
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

  // The slope along y at the origin that is right for every quadratic function, from the two triangles' vertices
  // and as few others as will do: often none, never more than two unless they lie badly. Nothing where the
  // vertices do not determine it.
  std::optional<Functional> quadratic_slope(const std::vector<Placed>& patch, double unit) const {
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

  // The smallest weights of these points that give the slope along y at the origin of every quadratic function;
  // empty when there are none.
  static VecX exact_slope(const std::vector<Vec2>& at, const std::vector<std::size_t>& chosen) {
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

  // Adds `factor` times the slope of the linear function in the triangle, from the edge of the hinge inward.
  void add_inward(int t, const Hinge& hinge, double factor, Functional& slope) const {
    const int c = t == hinge.tc ? hinge.c : hinge.d;
    const Apex over = apex(t, hinge.a, hinge.b, c);
    const double share = 0.5 + over.foot / over.l;
    slope.add(c, factor / over.height);
    slope.add(hinge.a, -factor * (1 - share) / over.height);
    slope.add(hinge.b, -factor * share / over.height);
  }

  // The energy of a triangle of area A is d . Z d / 2, with d how far the inward slope of its linear function is
  // from that of each edge. A constant curvature H has the moments m = P D H, where row k of P is l n n of edge k,
  // and H = P^T d / A: so Z = P D P^T / A. The slope of an edge without a hinge is the one of least energy.
  void add_triangle(int t) {
    Eigen::Matrix3d P;  // over (M_uu, M_vv, M_uv)
    std::array<int, 3> hinge_of = {-1, -1, -1};
    double area = 0;
    std::vector<Eigen::Index> held, open;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = triangle(t)[k], b = triangle(t)[(k + 1) % 3], c = triangle(t)[(k + 2) % 3];
      for (int h : around_[static_cast<std::size_t>(t)]) {
        const Hinge& hinge = hinges_[static_cast<std::size_t>(h)];
        if (std::minmax(a, b) == std::pair<const int&, const int&>(hinge.a, hinge.b)) hinge_of[k] = h;
      }
      (hinge_of[k] < 0 ? open : held).push_back(static_cast<Eigen::Index>(k));
      const Vec2 e = at_rest(t, b) - at_rest(t, a);
      const double l = e.norm();
      const Vec2 n(-e.y() / l, e.x() / l);
      area = 0.5 * l * apex(t, a, b, c).height;
      P.row(static_cast<Eigen::Index>(k)) << l * n.x() * n.x(), l * n.y() * n.y(), 2 * l * n.x() * n.y();
    }
    if (held.empty()) return;
    const Eigen::Matrix3d Z = P * D_ * P.transpose() / area;
    Eigen::MatrixXd stiffness = Z(held, held);
    if (!open.empty()) {
      const Eigen::MatrixXd across = Z(held, open);
      stiffness -= across * Eigen::MatrixXd(Z(open, open)).inverse() * across.transpose();
    }
    add_energy(t, hinge_of, stiffness);
  }

  void add_energy(int t, const std::array<int, 3>& hinge_of, const Eigen::MatrixXd& stiffness) {
    std::vector<Functional> all;
    for (std::size_t k = 0; k < 3; ++k) {
      if (hinge_of[k] < 0) continue;
      const auto h = static_cast<std::size_t>(hinge_of[k]);
      const double sign = t == hinges_[h].tc ? -1 : 1;
      Functional d = slopes_[h];
      for (double& weight : d.weights) weight *= sign;
      add_inward(t, hinges_[h], 1, d);
      all.push_back(std::move(d));
    }
    Functional vertices;
    for (const Functional& d : all)
      for (int v : d.vertices) vertices.add(v, 0);
    std::sort(vertices.vertices.begin(), vertices.vertices.end());
    const auto n = static_cast<Eigen::Index>(vertices.vertices.size());
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(all.size()), n);
    for (std::size_t k = 0; k < all.size(); ++k)
      for (std::size_t v = 0; v < all[k].vertices.size(); ++v) {
        const auto place =
            std::lower_bound(vertices.vertices.begin(), vertices.vertices.end(), all[k].vertices[v]);
        rows(static_cast<Eigen::Index>(k), place - vertices.vertices.begin()) = all[k].weights[v];
      }
    const Eigen::MatrixXd K = rows.transpose() * stiffness * rows;
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = i + 1; j < n; ++j)
        if (K(i, j) != 0)
          pairs_.push_back({vertices.vertices[static_cast<std::size_t>(i)],
                            vertices.vertices[static_cast<std::size_t>(j)], -K(i, j)});
    if (rest_angle_ > 0) add_bent(t, vertices.vertices, rows, stiffness);
  }

  // The rest slopes are those of the mesh, rows X; a triangle among others in its plane has none.
  void add_bent(int t, const std::vector<int>& vertices, const Eigen::MatrixXd& rows,
                const Eigen::MatrixXd& stiffness) {
    const auto at = [&](int v) { return mesh_.positions[static_cast<std::size_t>(v)]; };
    BentTriangle bent{.corners = triangle(t),
                      .weights = slopes_of(corners_[static_cast<std::size_t>(t)]).weights,
                      .pulls = {},
                      .energy = 0};
    Slopes f = Slopes::Zero();
    for (int k = 0; k < 3; ++k) f += at(bent.corners[static_cast<std::size_t>(k)]) * bent.weights.row(k);
    const internal::TriangleFrame frame(f);
    Eigen::MatrixX3d from_corner(rows.cols(), 3);
    for (Eigen::Index v = 0; v < rows.cols(); ++v)
      from_corner.row(v) = (at(vertices[static_cast<std::size_t>(v)]) - at(bent.corners[0])).transpose();
    const Eigen::MatrixX3d slopes = rest_angle_ * rows * from_corner;
    if (!frame.stands || !(slopes.norm() > 1e-12)) return;
    bent.energy = 0.5 * (slopes.transpose() * stiffness * slopes).trace();
    const Eigen::MatrixX3d pulls = rows.transpose() * stiffness * slopes * frame.axes;
    for (Eigen::Index v = 0; v < rows.cols(); ++v)
      bent.pulls.push_back({vertices[static_cast<std::size_t>(v)], pulls.row(v).transpose()});
    bent_.push_back(std::move(bent));
  }

  const TriangleMesh& mesh_;
  const std::vector<RestCorners>& corners_;
  double rest_angle_;
  std::vector<Hinge> hinges_;
  std::vector<std::vector<int>> around_;  // triangle -> its hinges
  std::vector<Functional> slopes_;        // of the hinges
  std::vector<PlatePair> pairs_;
  std::vector<BentTriangle> bent_;
  Eigen::Matrix3d D_;
};

}  // namespace

PlateEnergy plate_energy(const TriangleMesh& mesh, const std::vector<RestCorners>& corners,
                         const PlateStiffness& stiffness, double rest_angle) {
  return MorleyPlate(mesh, corners, stiffness, rest_angle).make();
}

}  // namespace drape
