// The elements of a StencilForce in a substep of the integrator "pbd": solver/forces/substep.h has the equations, for a law of
// one vector. Of two vectors, or of all the points of an element, p and lambda have 6 or 3 n numbers and W is a matrix.
//   A VectorLaw may give its new impulse itself, in closed form; free is what p would be without the impulse so far:
//     static Vec3 alone(const Common&, const Rest&, const Vec3& p, const Vec3& free, double W, double h,
//                       const auto& velocity);
//   A law of two particles along their distance gives both as solver/forces/pair_force.h does: alone_along, and where it is a
//   link of a length, too_long.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <type_traits>
#include <utility>

#include "solver/forces/colours.h"
#include "solver/forces/force.h"
#include "solver/forces/stencil_laws.h"

namespace drape {

template <class Law>
class StencilProjection {
 public:
  static constexpr int n = Law::particles;
  using Common = typename Law::Common;
  using Rest = typename Law::Rest;

  // Takes over the elements. Those that stand are coloured; others are taken in the order in which they were found.
  template <class Elements>
  void take(const Elements& elements, int particles, bool stand) {
    if (stand) {
      colours_.make(static_cast<int>(elements.size()), particles, [&](int e, const auto& f) {
        for (int p : elements[static_cast<std::size_t>(e)].particles) f(p);
      });
      links_.clear();
      for (int e : colours_.order()) add(elements[static_cast<std::size_t>(e)]);
    } else {
      links_.clear();
      for (const auto& element : elements) add(element);
    }
    stand_ = stand;
    impulses_.resize(links_.size());
  }

  // Takes over what is other in elements that stand, with the same particles.
  template <class Elements>
  void take_rest(const Elements& elements) {
    for (std::size_t k = 0; k < links_.size(); ++k)
      links_[k].rest = elements[static_cast<std::size_t>(colours_.order()[k])].rest;
  }

  void run(const Common& common, Substep& substep) {
    const auto relax = [&](int k) {
      const auto number = static_cast<std::size_t>(k);
      Impulse lambda = substep.first ? Impulse(Impulse::Zero()) : impulses_[number];
      this->relax(common, links_[number], substep, lambda);
      if (!substep.last) impulses_[number] = lambda;
    };
    if (stand_)
      colours_.run(relax);
    else
      for (int k = 0; k < static_cast<int>(links_.size()); ++k) relax(k);
  }

 private:
  struct Link {
    std::array<int, static_cast<std::size_t>(n)> particles;
    Rest rest;
  };
  static constexpr int size = VectorLaw<Law> ? 3 : SlopeLaw<Law> ? 6 : 3 * n;
  using Impulse = Eigen::Matrix<double, size, 1>;
  using Block = Eigen::Matrix<double, size, size>;

  template <class Element>
  void add(const Element& element) {
    links_.push_back({element.particles, element.rest});
  }

  static void relax(const Common& common, const Link& link, Substep& substep, Impulse& lambda) {
    if constexpr (requires { &Law::alone_along; })
      relax_pair(common, link, substep, lambda);
    else if constexpr (VectorLaw<Law>)
      relax_vector(common, link, substep, lambda);
    else if constexpr (SlopeLaw<Law>)
      relax_slopes(common, link, substep, lambda);
    else
      relax_points(common, link, substep, lambda);
  }

  // The same as relax_vector, written out: most elements are of this kind.
  [[gnu::always_inline]] static void relax_pair(const Common& damping, const Link& link, Substep& substep,
                                                Vec3& lambda) {
    const int i = link.particles[0], j = link.particles[1];
    const double share_i = substep.mobility[static_cast<std::size_t>(i)],
                 share_j = substep.mobility[static_cast<std::size_t>(j)], W = share_i + share_j,
                 h = substep.h;
    if (W == 0) return;
    double *const a = substep.x.data() + 3 * i, *const b = substep.x.data() + 3 * j;
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    const auto move = [&](double x, double y, double z) {
      a[0] += share_i * x, a[1] += share_i * y, a[2] += share_i * z;
      b[0] -= share_j * x, b[1] -= share_j * y, b[2] -= share_j * z;
    };
    const double l2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if constexpr (requires { Law::too_long(link.rest, l2, true); })
      if (const Links links = substep.options.links; links != Links::compliance) {
        const double s =
            l2 > 0 ? -substep.options.alpha / W * Law::too_long(link.rest, l2, links == Links::squared_length)
                   : 0;
        return move(s * d[0], s * d[1], s * d[2]);
      }
    const double k_d = Law::damper(damping, link.rest);
    double drag = 0;
    if (k_d > 0 && l2 > 0) {
      const double *const x = substep.start.data() + 3 * i, *const y = substep.start.data() + 3 * j;
      for (int c = 0; c < 3; ++c) drag += d[c] * (d[c] - (x[c] - y[c]));
      drag /= h * std::sqrt(l2);
    }
    if (substep.first) {
      const double l = std::sqrt(l2), s = l > 0 ? Law::alone_along(k_d, link.rest, l, l, drag, W, h) : 0;
      lambda = Vec3(s * d[0], s * d[1], s * d[2]);
      return move(h * s * d[0], h * s * d[1], h * s * d[2]);
    }
    const double back = h * W;
    const double free[3] = {d[0] - back * lambda[0], d[1] - back * lambda[1], d[2] - back * lambda[2]};
    const double l_free = std::sqrt(free[0] * free[0] + free[1] * free[1] + free[2] * free[2]);
    if (l_free == 0) return;
    const double l = std::max((free[0] * d[0] + free[1] * d[1] + free[2] * d[2]) / l_free, 0.0);
    const double s = Law::alone_along(k_d, link.rest, l, l_free, drag, W, h);
    const double change[3] = {s * free[0] - lambda[0], s * free[1] - lambda[1], s * free[2] - lambda[2]};
    lambda = Vec3(s * free[0], s * free[1], s * free[2]);
    move(h * change[0], h * change[1], h * change[2]);
  }

  static void relax_vector(const Common& common, const Link& link, Substep& substep, Vec3& lambda) {
    const auto w = Law::weights(link.rest);
    std::array<double, static_cast<std::size_t>(n)> share;  // w_k / m_k
    double W = 0;
    Vec3 p = Vec3::Zero();
    for (std::size_t k = 0; k < share.size(); ++k) {
      share[k] = w[k] * substep.mobility[static_cast<std::size_t>(link.particles[k])];
      W += w[k] * share[k];
      p += w[k] * substep.x.template segment<3>(3 * link.particles[k]);
    }
    if (W == 0) return;
    const auto velocity = [&] {
      Vec3 start = Vec3::Zero();
      for (std::size_t k = 0; k < share.size(); ++k)
        start += w[k] * substep.start.template segment<3>(3 * link.particles[k]);
      return Vec3((p - start) / substep.h);
    };
    const double h = substep.h;
    Vec3 change;
    if constexpr (requires { Law::alone(common, link.rest, p, p, W, h, velocity); }) {
      change = Law::alone(common, link.rest, p, p - (h * W) * lambda, W, h, velocity) - lambda;
    } else {
      const VectorResponse response = Law::linearised(
          common, link.rest, p, velocity, [] { return Vec3(Vec3::Zero()); }, h, Stiffness::tangent);
      change = -(Mat3::Identity() + W * response.block).inverse() * (lambda + response.impulse);
    }
    lambda += change;
    for (std::size_t k = 0; k < share.size(); ++k)
      substep.x.template segment<3>(3 * link.particles[k]) += h * share[k] * change;
  }

  // -(1 + B W)^-1 residual, where W = L L^T and B is positive semidefinite.
  static Impulse change_of(const Block& B, const Block& L, const Impulse& residual) {
    const Block BL = B * L;
    Block inner = Block::Identity();
    inner.noalias() += L.transpose() * BL;
    const Impulse y = inner.llt().solve(L.transpose() * residual);
    return BL * y - residual;
  }

  static void relax_slopes(const Common& common, const Link& link, Substep& substep, Impulse& lambda) {
    const Eigen::Matrix<double, n, 2>& w = Law::slope_weights(link.rest);
    const double h = substep.h;
    Slopes p = Slopes::Zero(), start = Slopes::Zero();
    Eigen::Matrix2d W = Eigen::Matrix2d::Zero();
    for (int k = 0; k < n; ++k) {
      const int particle = link.particles[static_cast<std::size_t>(k)];
      p += substep.x.template segment<3>(3 * particle) * w.row(k);
      start += substep.start.template segment<3>(3 * particle) * w.row(k);
      W += substep.mobility[static_cast<std::size_t>(particle)] * w.row(k).transpose() * w.row(k);
    }
    if (W.isZero(0)) return;
    SlopeBlocks K = Law::hessian(common, link.rest, p, Stiffness::tangent);
    Slopes impulse = h * Law::gradient(common, link.rest, p);
    for (Mat3* block : {&K.uu, &K.uv, &K.vv}) *block *= h * h;
    if (Law::damped(common)) {
      const SlopeBlocks D = Law::damping(common, link.rest, p);
      const Slopes v = (p - start) / h;
      impulse.col(0) += h * (D.uu * v.col(0) + D.uv * v.col(1));
      impulse.col(1) += h * (D.uv.transpose() * v.col(0) + D.vv * v.col(1));
      K = {K.uu + h * D.uu, K.uv + h * D.uv, K.vv + h * D.vv};
    }
    Block B, L = Block::Zero();
    B << K.uu, K.uv, K.uv.transpose(), K.vv;
    const double a = std::sqrt(W(0, 0)), b = a > 0 ? W(1, 0) / a : 0;
    L.template block<3, 3>(0, 0).diagonal().setConstant(a);
    L.template block<3, 3>(3, 0).diagonal().setConstant(b);
    L.template block<3, 3>(3, 3).diagonal().setConstant(std::sqrt(std::max(W(1, 1) - b * b, 0.0)));
    const Impulse change = change_of(B, L, lambda + Eigen::Map<const Impulse>(impulse.data()));
    lambda += change;
    for (int k = 0; k < n; ++k) {
      const int particle = link.particles[static_cast<std::size_t>(k)];
      substep.x.template segment<3>(3 * particle) +=
          (h * substep.mobility[static_cast<std::size_t>(particle)]) *
          (w(k, 0) * change.template head<3>() + w(k, 1) * change.template tail<3>());
    }
  }

  static void relax_points(const Common& common, const Link& link, Substep& substep, Impulse& lambda) {
    const double h = substep.h;
    Points<n> X, start;
    Impulse root;  // of 1/m
    for (int k = 0; k < n; ++k) {
      const int particle = link.particles[static_cast<std::size_t>(k)];
      X.col(k) = substep.x.template segment<3>(3 * particle);
      start.col(k) = substep.start.template segment<3>(3 * particle);
      root.template segment<3>(3 * k).setConstant(
          std::sqrt(substep.mobility[static_cast<std::size_t>(particle)]));
    }
    const Points<n> pull = h * Law::gradient(common, link.rest, X);
    Impulse residual = lambda + Eigen::Map<const Impulse>(pull.data());
    Block B = h * h * Law::hessian(common, link.rest, X, Stiffness::tangent);
    if constexpr (requires { Law::damping(common, link.rest, X); })
      if (Law::damped(common)) {
        const Block hD = h * Law::damping(common, link.rest, X);
        const Points<n> v = (X - start) / h;
        residual += hD * Eigen::Map<const Impulse>(v.data());
        B += hD;
      }
    const Impulse change = change_of(B, root.asDiagonal(), residual);
    lambda += change;
    for (int k = 0; k < n; ++k) {
      const int particle = link.particles[static_cast<std::size_t>(k)];
      substep.x.template segment<3>(3 * particle) +=
          (h * substep.mobility[static_cast<std::size_t>(particle)]) * change.template segment<3>(3 * k);
    }
  }

  Colours colours_;
  std::vector<Link> links_;  // colour by colour where they stand
  std::vector<Impulse> impulses_;
  bool stand_ = false;
};

}  // namespace drape
