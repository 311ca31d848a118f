// Forces of stencils: what 2, 3 or 4 particles do to each other. Gather, scatter, slots, threads, damping and
// the product K y stand here, once, for every law.
//
// A law is a struct of pure functions. It knows no mesh, no time step and no matrix:
//   static constexpr const char* name;   static constexpr int particles;   // 2, 3 or 4
//   struct Rest {...};      // one element's data, such as its rest length
//   struct Common {...};    // the same for all elements, such as a damping coefficient (may be any type)
// and, with X [m] the positions, one column a particle, either
//   static double energy(const Common&, const Rest&, const Points<n>& X);                        // E [J]
//   static Points<n> gradient(const Common&, const Rest&, const Points<n>& X);                   // dE/dX [N]
//   static Blocks<n> hessian(const Common&, const Rest&, const Points<n>& X, Stiffness);         // [N/m]
//   static Blocks<n> damping(const Common&, const Rest&, const Points<n>& X);  // D [N s/m]; may be left out
//   static bool damped(const Common&);  // whether D is anything but zero; goes with damping
// where the Hessian is symmetric and positive semidefinite: the exact one, projected, for Stiffness::tangent;
// one that is nowhere smaller where the law asks for a chord or a majorant (solver/forces/force.h). Or, when
// the law depends on one vector alone, p = sum w_k x_k (a distance, the gap of a contact; a VectorLaw),
//   static std::array<double, n> weights(const Rest&);                                             // w_k
//   static double energy(const Common&, const Rest&, const Vec3& p);
//   static double dissipation(const Common&, const Rest&, const Vec3& p, const auto& velocity);    // W
//   static Vec3 pull(const Common&, const Rest&, const Vec3& p, const auto& velocity);
//   static VectorResponse linearised(const Common&, const Rest&, const Vec3& p, const auto& velocity,
//                                    const auto& shift, double c, Stiffness);
// Or it depends on two vectors, the slopes f_u = sum w_ku x_k and f_v = sum w_kv x_k (a SlopeLaw), and gives
//   static const Eigen::Matrix<double, n, 2>& slope_weights(const Rest&);                          // w_ku, w_kv
// and energy, gradient, hessian, damping and damped as above, over f = (f_u, f_v) in place of X: the gradient
// as Slopes and the second derivatives as SlopeBlocks.
// A law may also say
//   static bool goes_slack(const Rest&);                          // whether it resists nothing until it is taut
// velocity() is sum w_k v_k and shift() is sum w_k y_k; they are functions because they are computed only
// when asked for. The pull is dE/dp + D v, and f_k = -w_k pull. The response is that of an implicit step (see
// Force::add_linearised).
//
// Stencils either stand as long as the force exists, or are found anew in every step by a function that is
// given to the force. All threads add the forces and blocks of stencils that stand. One thread adds those of
// found stencils, in the order in which they were found.
#pragma once

#include <array>
#include <functional>
#include <utility>

#include "solver/forces/chunk_schedule.h"
#include "solver/forces/force.h"
#include "solver/forces/stencil_laws.h"
#include "solver/forces/stencil_projection.h"

namespace drape {

template <class Law>
class StencilForce : public Force {
 public:
  static constexpr int n = Law::particles;
  static constexpr int blocks = n * (n + 1) / 2;
  using Common = typename Law::Common;

  struct Element {
    std::array<int, static_cast<std::size_t>(n)> particles;
    typename Law::Rest rest = {};
    // Where the blocks (0,0), (0,1) .. (n-1,n-1) are in the matrix: slot, or ~slot for a block that is
    // transposed there.
    std::array<int, static_cast<std::size_t>(blocks)> slots = {};
  };
  // Fills in the stencils of a step, and returns whether they differ from those that it was given.
  using Finder = std::function<bool(const StepStart&, std::vector<Element>&)>;

  explicit StencilForce(std::vector<Element> elements, Common common = {})
      : elements_(std::move(elements)), common_(common) {}
  explicit StencilForce(Finder find, Common common = {}) : common_(common), find_(std::move(find)) {}

  const std::vector<Element>& elements() const { return elements_; }
  // Calls change(rest) for every element, between steps, such as for a rest length that changes with time.
  template <class F>
  void change_rest(const F& change) {
    for (Element& e : elements_) change(e.rest);
    rest_changed_ = true;
  }

  std::string_view name() const override { return Law::name; }
  void list_pairs(std::vector<ParticlePair>& all) const override {
    if (!find_) list(all);
  }
  void list_changing_pairs(std::vector<ParticlePair>& all) const override {
    if (find_) list(all);
  }
  bool changes() const override { return static_cast<bool>(find_); }
  bool begin_step(const StepStart& start) override { return find_ && find_(start, elements_); }

  bool goes_slack() const override {
    if constexpr (requires(const typename Law::Rest& rest) { Law::goes_slack(rest); })
      return std::any_of(elements_.begin(), elements_.end(),
                         [](const Element& e) { return Law::goes_slack(e.rest); });
    else
      return false;
  }

  bool projects() const override { return true; }
  void begin_substep(int particles) override {
    if (find_ || to_take_)
      projection_.take(elements_, particles, !find_);
    else if (rest_changed_)
      projection_.take_rest(elements_);
    to_take_ = rest_changed_ = false;
  }
  void project(Substep& substep) override { projection_.run(common_, substep); }

  void bind(const BlockLayout& layout) override {
    const auto row = [&](int i) { return layout.base.row_of()[i]; };
    const auto rows = [&](const Element& e) {
      auto sorted = e.particles;
      for (int& i : sorted) i = row(i);
      std::sort(sorted.begin(), sorted.end());
      return sorted;
    };
    if (!find_) {
      std::stable_sort(elements_.begin(), elements_.end(),
                       [&](const Element& a, const Element& b) { return rows(a) < rows(b); });
      schedule_.bind(layout.base, static_cast<int>(elements_.size()),
                     [&](int e) { return rows(elements_[e])[0]; });
      to_take_ = true;
    }
    for_chunks<Work::heavy>(static_cast<int>(elements_.size()), [&](int begin, int end) {
      for (int one = begin; one < end; ++one) {
        Element& e = elements_[one];
        auto slot = e.slots.begin();
        for (std::size_t k = 0; k < e.particles.size(); ++k)
          for (std::size_t l = k; l < e.particles.size(); ++l) {
            const int i = row(e.particles[k]), j = row(e.particles[l]);
            *slot++ = i <= j ? layout.slot(i, j) : ~layout.slot(j, i);
          }
      }
    });
  }

  double energy(const VecX& x) const override {
    return sum([&](const Element& e) {
      if constexpr (VectorLaw<Law>)
        return Law::energy(common_, e.rest, at(e, x));
      else if constexpr (SlopeLaw<Law>)
        return Law::energy(common_, e.rest, slopes(e, x));
      else
        return Law::energy(common_, e.rest, points(e, x));
    });
  }

  double dissipation(const VecX& x, const VecX& v) const override {
    if constexpr (VectorLaw<Law>)
      return sum([&](const Element& e) {
        return Law::dissipation(common_, e.rest, at(e, x), [&] { return at(e, v); });
      });
    else if constexpr (SlopeLaw<Law>)
      return !Law::damped(common_) ? 0 : sum([&](const Element& e) {
        const Slopes g = slopes(e, v);
        return 0.5 * g.cwiseProduct(times(Law::damping(common_, e.rest, slopes(e, x)), g)).sum();
      });
    else if constexpr (damps)
      return !Law::damped(common_) ? 0 : sum([&](const Element& e) {
        const Points<n> V = points(e, v);
        return 0.5 * flat(V).dot(Law::damping(common_, e.rest, points(e, x)) * flat(V));
      });
    else
      return 0;
  }

  void add_force(const VecX& x, const VecX& v, VecX& f) const override {
    run([&](const Element& e) {
      if constexpr (VectorLaw<Law>) {
        const Vec3 pull = Law::pull(common_, e.rest, at(e, x), [&] { return at(e, v); });
        if (!pull.isZero(0)) subtract(e, pull, f);
      } else if constexpr (SlopeLaw<Law>) {
        const Slopes at_x = slopes(e, x);
        Slopes pull = Law::gradient(common_, e.rest, at_x);
        if (Law::damped(common_)) pull += times(Law::damping(common_, e.rest, at_x), slopes(e, v));
        subtract(e, pull, f);
      } else {
        const Points<n> X = points(e, x);
        Points<n> pull = Law::gradient(common_, e.rest, X);
        if constexpr (damps)
          if (Law::damped(common_)) flat(pull) += Law::damping(common_, e.rest, X) * flat(points(e, v));
        subtract(e, pull, f);
      }
    });
  }

  void add_linearised(const VecX& x, const VecX& v, const VecX& y, double c, Stiffness stiffness,
                      BlockMatrix& A, VecX& b) const override {
    run([&](const Element& e) {
      if constexpr (VectorLaw<Law>) {
        const VectorResponse response = Law::linearised(
            common_, e.rest, at(e, x), [&] { return at(e, v); }, [&] { return at(e, y); }, c, stiffness);
        if (!response.acts) return;
        subtract(e, response.impulse, b);
        add_blocks(e, response.block, A);
      } else if constexpr (SlopeLaw<Law>) {
        const Slopes at_x = slopes(e, x);
        SlopeBlocks K = Law::hessian(common_, e.rest, at_x, stiffness);
        Slopes impulse = c * (Law::gradient(common_, e.rest, at_x) + times(K, slopes(e, y)));
        for (Mat3* block : {&K.uu, &K.uv, &K.vv}) *block *= c * c;
        if (Law::damped(common_)) {
          const SlopeBlocks D = Law::damping(common_, e.rest, at_x);
          impulse += c * times(D, slopes(e, v));
          K = {K.uu + c * D.uu, K.uv + c * D.uv, K.vv + c * D.vv};
        }
        subtract(e, impulse, b);
        add_blocks(e, K, A);
      } else {
        const Points<n> X = points(e, x);
        const Blocks<n> K = Law::hessian(common_, e.rest, X, stiffness);
        Points<n> impulse = Law::gradient(common_, e.rest, X);
        flat(impulse) += K * flat(points(e, y));
        Blocks<n> block = c * c * K;
        impulse *= c;
        if constexpr (damps)
          if (Law::damped(common_)) {
            const Blocks<n> cD = c * Law::damping(common_, e.rest, X);
            flat(impulse) += cD * flat(points(e, v));
            block += cD;
          }
        subtract(e, impulse, b);
        add_blocks(e, block, A);
      }
    });
  }

 protected:
  template <class F>
  double sum(const F& f) const {
    return sum_chunks<Work::heavy>(static_cast<int>(elements_.size()), [&](int begin, int end) {
      double total = 0;
      for (int e = begin; e < end; ++e) total += f(elements_[e]);
      return total;
    });
  }
  // Calls change(element) for every element; its particles must stay.
  template <class F>
  void change_elements(const F& change) {
    for (Element& e : elements_) change(e);
    rest_changed_ = true;
  }
  // The vector sum w_k x_k of an element.
  static Vec3 at(const Element& e, const VecX& all) {
    const auto w = Law::weights(e.rest);
    Vec3 p = w[0] * all.segment<3>(3 * e.particles[0]);
    for (std::size_t k = 1; k < e.particles.size(); ++k) p += w[k] * all.segment<3>(3 * e.particles[k]);
    return p;
  }
  const Common& common() const { return common_; }

 private:
  static constexpr bool damps =
      requires(const Common& common, const typename Law::Rest& rest, const Points<n>& X) {
    Law::damping(common, rest, X);
  };

  void list(std::vector<ParticlePair>& all) const {
    for (const Element& e : elements_)
      for (std::size_t k = 0; k < e.particles.size(); ++k)
        for (std::size_t l = k + 1; l < e.particles.size(); ++l)
          all.push_back({e.particles[k], e.particles[l]});
  }

  template <class F>
  void run(const F& f) const {
    schedule_.run(static_cast<int>(elements_.size()), [&](int e) { f(elements_[e]); });
  }

  static Points<n> points(const Element& e, const VecX& all) {
    Points<n> X;
    for (int k = 0; k < n; ++k) X.col(k) = all.segment<3>(3 * e.particles[k]);
    return X;
  }
  static Eigen::Map<Eigen::Matrix<double, 3 * n, 1>> flat(Points<n>& X) {
    return Eigen::Map<Eigen::Matrix<double, 3 * n, 1>>(X.data());
  }
  static Eigen::Map<const Eigen::Matrix<double, 3 * n, 1>> flat(const Points<n>& X) {
    return Eigen::Map<const Eigen::Matrix<double, 3 * n, 1>>(X.data());
  }
  static Slopes slopes(const Element& e, const VecX& all) {
    const auto& w = Law::slope_weights(e.rest);
    Slopes f = Slopes::Zero();
    for (int k = 0; k < n; ++k) {
      const double* const p = all.data() + 3 * e.particles[static_cast<std::size_t>(k)];
      for (int i = 0; i < 3; ++i) {
        f(i, 0) += w(k, 0) * p[i];
        f(i, 1) += w(k, 1) * p[i];
      }
    }
    return f;
  }
  static Slopes times(const SlopeBlocks& K, const Slopes& g) {
    Slopes product;
    product.col(0) = K.uu * g.col(0) + K.uv * g.col(1);
    product.col(1) = K.uv.transpose() * g.col(0) + K.vv * g.col(1);
    return product;
  }

  static void subtract(const Element& e, const Vec3& pull, VecX& f) {
    const auto w = Law::weights(e.rest);
    for (std::size_t k = 0; k < e.particles.size(); ++k) f.segment<3>(3 * e.particles[k]) -= w[k] * pull;
  }
  static void subtract(const Element& e, const Slopes& pull, VecX& f) requires SlopeLaw<Law> {
    const auto& w = Law::slope_weights(e.rest);
    for (int k = 0; k < n; ++k)
      f.segment<3>(3 * e.particles[static_cast<std::size_t>(k)]) -=
          w(k, 0) * pull.col(0) + w(k, 1) * pull.col(1);
  }
  static void subtract(const Element& e, const Points<n>& pull, VecX& f) {
    for (int k = 0; k < n; ++k) f.segment<3>(3 * e.particles[k]) -= pull.col(k);
  }

  static void add_blocks(const Element& e, const Mat3& block, BlockMatrix& A) {
    const auto w = Law::weights(e.rest);
    auto slot = e.slots.begin();
    for (std::size_t k = 0; k < e.particles.size(); ++k)
      for (std::size_t l = k; l < e.particles.size(); ++l, ++slot) {
        double* a = A.block(*slot < 0 ? ~*slot : *slot);  // the block is symmetric
        const double weight = w[k] * w[l];
        for (int i = 0; i < 9; ++i) a[i] += weight * block.data()[i];
      }
  }
  static void add_blocks(const Element& e, const SlopeBlocks& K, BlockMatrix& A) {
    const auto& w = Law::slope_weights(e.rest);
    const Mat3 K_vu = K.uv.transpose();
    auto slot = e.slots.begin();
    for (int k = 0; k < n; ++k)
      for (int l = k; l < n; ++l, ++slot) {
        const bool stands = *slot >= 0;  // or it stands transposed
        double* const a = A.block(stands ? *slot : ~*slot);
        const double uu = w(k, 0) * w(l, 0), vv = w(k, 1) * w(l, 1), kl = w(k, 0) * w(l, 1),
                     lk = w(k, 1) * w(l, 0), uv = stands ? kl : lk, vu = stands ? lk : kl;
        for (int i = 0; i < 9; ++i)
          a[i] += uu * K.uu.data()[i] + vv * K.vv.data()[i] + uv * K.uv.data()[i] + vu * K_vu.data()[i];
      }
  }
  static void add_blocks(const Element& e, const Blocks<n>& block, BlockMatrix& A) {
    auto slot = e.slots.begin();
    for (int k = 0; k < n; ++k)
      for (int l = k; l < n; ++l, ++slot) {
        if (*slot >= 0)
          A.at(*slot) += block.template block<3, 3>(3 * k, 3 * l);
        else
          A.at(~*slot) += block.template block<3, 3>(3 * k, 3 * l).transpose();
      }
  }

  std::vector<Element> elements_;
  Common common_;
  Finder find_;  // empty: the stencils stand
  ChunkSchedule schedule_;
  StencilProjection<Law> projection_;
  bool to_take_ = true, rest_changed_ = false;  // since the projection took the elements
};

}  // namespace drape
