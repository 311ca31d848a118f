#include "solver/forces/plate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "mesh/triangles/topology.h"
#include "solver/forces/plate_slopes.h"
#include "solver/forces/triangle_frame.h"

namespace drape {

using internal::Functional;
using internal::PlateSlopes;

namespace {

using Vec2 = Eigen::Vector2d;

Eigen::Matrix3d matrix(const PlateStiffness& stiffness) {
  Eigen::Matrix3d D;  // over (x_uu, x_vv, 2 x_uv)
  D << stiffness.warp, stiffness.cross, 0, stiffness.cross, stiffness.weft, 0, 0, 0, stiffness.twist;
  return D;
}

// A triangle of the plate: its energy is d . Z d / 2, where d is how far the inward slope of its linear
// function is from that of each edge with a hinge.
struct BendingTriangle {
  std::vector<int> vertices;  // ascending
  Eigen::MatrixXd rows;       // d over the vertices [1/m]
  Eigen::MatrixXd stiffness;  // Z [N m]
  Eigen::MatrixXd curvature;  // (x_uu, x_vv, 2 x_uv) over d [1/m]
  double area;                // m^2
};

class MorleyPlate {
 public:
  MorleyPlate(const TriangleMesh& mesh, const std::vector<RestCorners>& corners,
              const PlateStiffness& stiffness)
      : mesh_(mesh), slopes_(mesh, corners), D_(matrix(stiffness)) {
    slope_of_.reserve(slopes_.hinges().size());
    for (const Hinge& hinge : slopes_.hinges()) slope_of_.push_back(slopes_.slope(hinge));
  }

  // Calls f(t, bending) for every triangle that bends.
  template <class F>
  void each(const F& f) const {
    for (int t : counted_triangles(mesh_))
      if (slopes_.bends(t) && !slopes_.hinges_of(t).empty()) f(t, bending(t));
  }

 private:
  // A constant curvature H has the moments m = P D H, where row k of P is l n n of edge k, and H = P^T d / A:
  // so Z = P D P^T / A. The slope of an edge without a hinge is the one of least energy.
  BendingTriangle bending(int t) const {
    Eigen::Matrix3d P;  // over (M_uu, M_vv, M_uv)
    std::array<int, 3> hinge_of = {-1, -1, -1};
    double area = 0;
    std::vector<Eigen::Index> held, open;
    for (std::size_t k = 0; k < 3; ++k) {
      const Triangle& all = slopes_.triangle(t);
      const int a = all[k], b = all[(k + 1) % 3], c = all[(k + 2) % 3];
      for (int h : slopes_.hinges_of(t)) {
        const Hinge& hinge = slopes_.hinges()[static_cast<std::size_t>(h)];
        if (std::minmax(a, b) == std::pair<const int&, const int&>(hinge.a, hinge.b)) hinge_of[k] = h;
      }
      (hinge_of[k] < 0 ? open : held).push_back(static_cast<Eigen::Index>(k));
      const Vec2 e = slopes_.at_rest(t, b) - slopes_.at_rest(t, a);
      const double l = e.norm();
      const Vec2 n(-e.y() / l, e.x() / l);
      area = 0.5 * l * slopes_.height(t, a, b, c);
      P.row(static_cast<Eigen::Index>(k)) << l * n.x() * n.x(), l * n.y() * n.y(), 2 * l * n.x() * n.y();
    }
    const Eigen::Matrix3d Z = P * D_ * P.transpose() / area;
    BendingTriangle bending{{}, {}, Z(held, held), P(held, Eigen::all).transpose() / area, area};
    if (!open.empty()) {
      const Eigen::MatrixXd across = Z(held, open);
      const Eigen::MatrixXd inverse = Eigen::MatrixXd(Z(open, open)).inverse();
      bending.stiffness -= across * inverse * across.transpose();
      bending.curvature -= P(open, Eigen::all).transpose() / area * inverse * across.transpose();
    }
    take_rows(t, hinge_of, bending);
    return bending;
  }

  void take_rows(int t, const std::array<int, 3>& hinge_of, BendingTriangle& bending) const {
    std::vector<Functional> all;
    for (std::size_t k = 0; k < 3; ++k) {
      if (hinge_of[k] < 0) continue;
      const auto h = static_cast<std::size_t>(hinge_of[k]);
      const Hinge& hinge = slopes_.hinges()[h];
      const double sign = t == hinge.tc ? -1 : 1;
      Functional d = slope_of_[h];
      for (double& weight : d.weights) weight *= sign;
      slopes_.add_inward(t, hinge, 1, d);
      all.push_back(std::move(d));
    }
    Functional vertices;
    for (const Functional& d : all)
      for (int v : d.vertices) vertices.add(v, 0);
    std::sort(vertices.vertices.begin(), vertices.vertices.end());
    const auto n = static_cast<Eigen::Index>(vertices.vertices.size());
    bending.rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(all.size()), n);
    for (std::size_t k = 0; k < all.size(); ++k)
      for (std::size_t v = 0; v < all[k].vertices.size(); ++v) {
        const auto place =
            std::lower_bound(vertices.vertices.begin(), vertices.vertices.end(), all[k].vertices[v]);
        bending.rows(static_cast<Eigen::Index>(k), place - vertices.vertices.begin()) = all[k].weights[v];
      }
    bending.vertices = std::move(vertices.vertices);
  }

  const TriangleMesh& mesh_;
  PlateSlopes slopes_;
  std::vector<Functional> slope_of_;  // of the hinges
  Eigen::Matrix3d D_;
};

void add_pairs(const BendingTriangle& bending, std::vector<PlatePair>& pairs) {
  const Eigen::MatrixXd K = bending.rows.transpose() * bending.stiffness * bending.rows;
  for (Eigen::Index i = 0; i < K.rows(); ++i)
    for (Eigen::Index j = i + 1; j < K.rows(); ++j)
      if (K(i, j) != 0)
        pairs.push_back({bending.vertices[static_cast<std::size_t>(i)],
                         bending.vertices[static_cast<std::size_t>(j)], -K(i, j)});
}

PlatePart part_of(const BendingTriangle& bending) {
  PlatePart part;
  const Eigen::Index rows = bending.rows.rows();  // at most 3
  part.stiffness.topLeftCorner(rows, rows) = bending.stiffness;
  for (Eigen::Index v = 0; v < bending.rows.cols(); ++v) {
    Vec3 weights = Vec3::Zero();
    weights.head(rows) = bending.rows.col(v);
    part.shares.push_back({bending.vertices[static_cast<std::size_t>(v)], weights});
  }
  return part;
}

// The rest slopes are those of the mesh, rows X; a triangle among others in its plane has none.
void add_bent(const TriangleMesh& mesh, const Triangle& triangle, const RestCorners& corners,
              double rest_angle, const BendingTriangle& bending, std::vector<BentTriangle>& all) {
  const auto at = [&](int v) { return mesh.positions[static_cast<std::size_t>(v)]; };
  BentTriangle bent{.corners = triangle, .weights = slopes_of(corners).weights, .pulls = {}, .energy = 0};
  Slopes f = Slopes::Zero();
  for (int k = 0; k < 3; ++k) f += at(bent.corners[static_cast<std::size_t>(k)]) * bent.weights.row(k);
  const internal::TriangleFrame frame(f);
  const Eigen::MatrixXd& rows = bending.rows;
  Eigen::MatrixX3d from_corner(rows.cols(), 3);
  for (Eigen::Index v = 0; v < rows.cols(); ++v)
    from_corner.row(v) =
        (at(bending.vertices[static_cast<std::size_t>(v)]) - at(bent.corners[0])).transpose();
  const Eigen::MatrixX3d slopes = rest_angle * rows * from_corner;
  if (!frame.stands || !(slopes.norm() > 1e-12)) return;
  bent.energy = 0.5 * (slopes.transpose() * bending.stiffness * slopes).trace();
  const Eigen::MatrixX3d pulls = rows.transpose() * bending.stiffness * slopes * frame.axes;
  for (Eigen::Index v = 0; v < rows.cols(); ++v)
    bent.pulls.push_back({bending.vertices[static_cast<std::size_t>(v)], pulls.row(v).transpose()});
  all.push_back(std::move(bent));
}

}  // namespace

std::vector<PlatePair> summed(std::vector<PlatePair> pairs) {
  std::stable_sort(pairs.begin(), pairs.end(), [](const PlatePair& p, const PlatePair& q) {
    return std::tie(p.i, p.j) < std::tie(q.i, q.j);
  });
  std::size_t kept = 0;
  for (const PlatePair& p : pairs) {
    if (kept > 0 && pairs[kept - 1].i == p.i && pairs[kept - 1].j == p.j)
      pairs[kept - 1].k += p.k;
    else
      pairs[kept++] = p;
  }
  pairs.resize(kept);
  return pairs;
}

PlateEnergy plate_energy(const TriangleMesh& mesh, const std::vector<RestCorners>& corners,
                         const PlateStiffness& stiffness, double rest_angle) {
  PlateEnergy energy;
  MorleyPlate(mesh, corners, stiffness).each([&](int t, const BendingTriangle& bending) {
    const auto number = static_cast<std::size_t>(t);
    add_pairs(bending, energy.pairs);
    energy.parts.push_back(part_of(bending));
    if (rest_angle > 0)
      add_bent(mesh, mesh.triangles[number], corners[number], rest_angle, bending, energy.bent);
  });
  energy.pairs = summed(std::move(energy.pairs));
  measure_pairs(mesh, energy);
  return energy;
}

void measure_pairs(const TriangleMesh& mesh, PlateEnergy& energy) {
  energy.pull = energy.size = 0;
  for (const PlatePair& p : energy.pairs) {
    const double d =
        (mesh.positions[static_cast<std::size_t>(p.i)] - mesh.positions[static_cast<std::size_t>(p.j)])
            .norm();
    energy.pull += std::abs(p.k) * d;
    energy.size += std::abs(p.k) * d * d;
  }
}

std::vector<PlateCurvature> plate_curvatures(const TriangleMesh& mesh,
                                             const std::vector<RestCorners>& corners,
                                             const PlateStiffness& stiffness) {
  std::vector<PlateCurvature> all;
  MorleyPlate(mesh, corners, stiffness).each([&](int t, const BendingTriangle& bending) {
    const auto number = static_cast<std::size_t>(t);
    PlateCurvature& triangle = all.emplace_back();
    triangle.number = t;
    triangle.corners = mesh.triangles[number];
    triangle.slopes = slopes_of(corners[number]).weights;
    triangle.area = bending.area;
    const Eigen::MatrixXd weights = bending.curvature * bending.rows;
    for (Eigen::Index v = 0; v < weights.cols(); ++v)
      triangle.shares.push_back({bending.vertices[static_cast<std::size_t>(v)], weights.col(v)});
  });
  return all;
}

}  // namespace drape
