// The elements of a StencilForce in a substep of the integrator "pbd": solver/forces/substep.h has the
// equations, for a law of one vector. Of two vectors, or of all the points of an element, p and lambda have 6
// or 3 n numbers and W is a matrix.
//   A VectorLaw may give its new impulse itself, in closed form; free is what p would be without the impulse
//   so far:
//     static Vec3 alone(const Common&, const Rest&, const Vec3& p, const Vec3& free, double W, double h,
//                       const auto& velocity);
//   A law of two particles along their distance gives what solver/forces/pair_projection.h asks for.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <type_traits>
#include <utility>

#include "solver/forces/colours.h"
#include "solver/forces/force.h"
#include "solver/forces/pair_projection.h"
#include "solver/forces/stencil_laws.h"

namespace drape {

template <class Law>
class StencilProjection {
 public:
  static constexpr int n = Law::particles;
  using Common = typename Law::Common;
  using Rest = typename Law::Rest;

  // Takes over the elements. Those that stand are coloured; others are taken in the order in which they were
  // found.
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
    const auto relax = [&](int begin, int end) {
      for (int k = begin; k < end; ++k) {
        const auto number = static_cast<std::size_t>(k);
        Impulse lambda = substep.first ? Impulse(Impulse::Zero()) : impulses_[number];
        this->relax(common, links_[number], substep, lambda);
        if (!substep.last) impulses_[number] = lambda;
      }
    };
    const auto relax_apart = [&](int begin, int end) {
      if constexpr (requires(Link * links, Vec3 * impulses) {
                      Law::relax_apart(links, 1, substep, impulses);
                    })
        if (substep.first && common == 0 && substep.options.links == Links::compliance)
          return Law::relax_apart(links_.data() + begin, end - begin, substep,
                                  substep.last ? nullptr : impulses_.data() + begin);
      relax(begin, end);
    };
    if (stand_)
      colours_.run(relax_apart, relax);
    else
      relax(0, static_cast<int>(links_.size()));
  }

 private:
  using Link = StencilLink<n, Rest>;
  static constexpr int size = VectorLaw<Law> ? 3 : SlopeLaw<Law> ? 6 : 3 * n;
  using Impulse = Eigen::Matrix<double, size, 1>;
  using Block = Eigen::Matrix<double, size, size>;

  template <class Element>
  void add(const Element& element) {
    links_.push_back({element.particles, element.rest});
  }

  static void relax(const Common& common, const Link& link, Substep& substep, Impulse& lambda) {
    if constexpr (requires { &Law::alone_along; })
      relax_pair<Law>(common, link, substep, lambda);
    else if constexpr (VectorLaw<Law>)
      relax_vector(common, link, substep, lambda);
    else if constexpr (SlopeLaw<Law>)
      relax_slopes(common, link, substep, lambda);
    else
      relax_points(common, link, substep, lambda);
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
      SlopeBlocks D = Law::damping(common, link.rest, p);
      const double takes = h * (W(0, 0) * D.uu.trace() + 2 * W(0, 1) * D.uv.trace() + W(1, 1) * D.vv.trace());
      const double share = substep.counted(takes);
      for (Mat3* block : {&D.uu, &D.uv, &D.vv}) *block *= share;
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
        Block hD = h * Law::damping(common, link.rest, X);
        hD *= substep.counted(root.cwiseAbs2().dot(hD.diagonal()));
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
