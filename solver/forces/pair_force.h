// Forces between two particles along the line that joins them: gather, scatter, threads and slots, written
// once.
//
// A law is a small pure function of the distance l, given the rest data of one pair:
//   struct Law { struct Rest {...}; static constexpr const char* name;
//                static double energy(const Rest&, double l);         // E(l)                       [J]
//                static Tension tension(const Rest&, double l);       // t = dE/dl, dt/dl           [N],
//                [N/m] static double stiffest(const Rest&, double l); };    // >= dt/dl: of a parabola above
//                E(l) [N/m]
// With d = x_i - x_j, l = |d|, n = d/l:
//   f_i = -t n,  f_j = t n
//   K   = max(dt/dl, 0) n n^T + max(t/l, 0) (I - n n^T)     of block (i,i) and (j,j); -K of (i,j)
// The two eigenvalues of the exact stiffness are dt/dl and t/l (twice), so clamping them at zero is its exact
// positive semidefinite part: it drops the transverse term under compression, as Choi & Ko 2002 do.
// Coincident particles: no direction, so no force; K = dt/dl I when t = 0 there (a weld), else 0.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/base/parallel.h"
#include "solver/forces/force.h"

namespace drape {

struct Tension {
  double t;   // N, positive pulls together
  double dt;  // N/m
};

// The elements of a force, cut at the chunks of a pattern.
class ChunkSchedule {
 public:
  // first_row(e) ascending over the elements e = 0 .. count-1.
  template <class FirstRow>
  void bind(const BlockPattern& pattern, int count, const FirstRow& first_row) {
    start_.assign(static_cast<std::size_t>(pattern.chunks()) + 1, count);
    int chunk = -1;
    for (int e = 0; e < count; ++e)
      while (chunk < first_row(e) / pattern.chunk_rows()) start_[static_cast<std::size_t>(++chunk)] = e;
    start_[0] = 0;
    for (std::size_t k = start_.size() - 1; k-- > 0;) start_[k] = std::min(start_[k], start_[k + 1]);
    serial_ = pattern.rows() < serial_below;
  }

  // f(e) for every element: even chunks side by side, then odd ones; in order when not bound.
  template <class F>
  void run(int count, const F& f) const {
    if (start_.empty()) {
      for (int e = 0; e < count; ++e) f(e);
      return;
    }
    even_then_odd(static_cast<int>(start_.size()) - 1, serial_, [&](int k) {
      const auto chunk = static_cast<std::size_t>(k);
      for (int e = start_[chunk]; e < start_[chunk + 1]; ++e) f(e);
    });
  }

 private:
  std::vector<int> start_;
  bool serial_ = true;
};

struct PairSlots {
  int ii = -1, jj = -1, ij = -1;  // ij also stands for ji
};

// Adds s K to (i,i) and (j,j), -s K to (i,j); K symmetric.
inline void add_pair_block(BlockMatrix& A, const PairSlots& slots, const Mat3& sK) {
  double* ii = A.block(slots.ii);
  double* jj = A.block(slots.jj);
  double* ij = A.block(slots.ij);
  const double* k = sK.data();
  for (int e = 0; e < 9; ++e) {
    ii[e] += k[e];
    jj[e] += k[e];
    ij[e] -= k[e];
  }
}

// Elements with two ends i, j: sorted along the matrix rows and given their slots.
template <class Element>
void bind_pairs(const BlockPattern& pattern, std::vector<Element>& elements, ChunkSchedule& schedule) {
  const auto row = [&](int particle) { return pattern.row_of()[static_cast<std::size_t>(particle)]; };
  const auto rows = [&](const Element& e) { return std::minmax({row(e.i), row(e.j)}); };
  std::stable_sort(elements.begin(), elements.end(),
                   [&](const Element& a, const Element& b) { return rows(a) < rows(b); });
  for (Element& e : elements) {
    const int i = row(e.i), j = row(e.j);
    e.slots = {pattern.diagonal(i), pattern.diagonal(j), pattern.slot(std::min(i, j), std::max(i, j))};
  }
  schedule.bind(pattern, static_cast<int>(elements.size()),
                [&](int e) { return rows(elements[static_cast<std::size_t>(e)]).first; });
}

template <class Law>
class PairForce final : public Force {
 public:
  struct Element {
    int i, j;
    typename Law::Rest rest;
    PairSlots slots = {};
  };

  // k_d [N s/m]: damping along every pair, f_i = -k_d ((v_i - v_j) . n) n, in the same loop.
  explicit PairForce(std::vector<Element> elements, double k_d = 0)
      : elements_(std::move(elements)), k_d_(k_d) {}

  const std::vector<Element>& elements() const { return elements_; }
  // Between steps: change(rest) for every element, such as a rest length that goes with time.
  template <class F>
  void change_rest(const F& change) {
    for (Element& e : elements_) change(e.rest);
  }
  std::string_view name() const override { return Law::name; }

  void list_pairs(std::vector<ParticlePair>& pairs) const override {
    for (const Element& e : elements_) pairs.push_back({e.i, e.j});
  }

  void bind(const BlockPattern& pattern) override { bind_pairs(pattern, elements_, schedule_); }

  double energy(const VecX& x) const override {
    return sum_chunks(static_cast<int>(elements_.size()), [&](int begin, int end) {
      double sum = 0;
      for (int k = begin; k < end; ++k) {
        const Element& e = elements_[static_cast<std::size_t>(k)];
        sum += Law::energy(e.rest, (x.segment<3>(3 * e.i) - x.segment<3>(3 * e.j)).norm());
      }
      return sum;
    });
  }

  double dissipation(const VecX& x, const VecX& v) const override {
    if (k_d_ == 0) return 0;
    return sum_chunks(static_cast<int>(elements_.size()), [&](int begin, int end) {
      double sum = 0;
      for (int k = begin; k < end; ++k) {
        const Element& e = elements_[static_cast<std::size_t>(k)];
        const Vec3 d = x.segment<3>(3 * e.i) - x.segment<3>(3 * e.j);
        const double l2 = d.squaredNorm(), along = d.dot(v.segment<3>(3 * e.i) - v.segment<3>(3 * e.j));
        if (l2 > 0) sum += 0.5 * k_d_ * along * along / l2;
      }
      return sum;
    });
  }

  void add_force(const VecX& x, const VecX& v, VecX& f) const override {
    schedule_.run(static_cast<int>(elements_.size()), [&](int k) {
      const Element& e = elements_[static_cast<std::size_t>(k)];
      const Vec3 d = x.segment<3>(3 * e.i) - x.segment<3>(3 * e.j);
      const double l = d.norm();
      if (l == 0) return;
      double t = Law::tension(e.rest, l).t;
      if (k_d_ > 0) t += k_d_ / l * d.dot(v.segment<3>(3 * e.i) - v.segment<3>(3 * e.j));
      if (t == 0) return;
      const Vec3 pull = t / l * d;
      f.segment<3>(3 * e.i) -= pull;
      f.segment<3>(3 * e.j) += pull;
    });
  }

  void add_linearised(const VecX& x, const VecX& v, const VecX& y, double c, Stiffness stiffness,
                      BlockMatrix& A, VecX& b) const override {
    schedule_.run(static_cast<int>(elements_.size()), [&](int k) {
      const Element& e = elements_[static_cast<std::size_t>(k)];
      const Vec3 d = x.segment<3>(3 * e.i) - x.segment<3>(3 * e.j);
      const double l = d.norm();
      Tension law = Law::tension(e.rest, l);
      if (stiffness == Stiffness::chord) law.dt = std::max(law.dt, Law::chord(e.rest, l));
      if (stiffness == Stiffness::majorant) law.dt = std::max(law.dt, Law::stiffest(e.rest, l));
      const double k_d = l == 0 ? 0 : k_d_;
      if ((law.t == 0 && law.dt == 0 && k_d == 0) || (l == 0 && law.t != 0)) return;
      const double pull = l == 0 ? 0 : law.t / l;
      const double across = l == 0 ? law.dt : std::max(pull, 0.0);
      const double along = std::max(law.dt, 0.0);
      const Vec3 n = l == 0 ? Vec3::Zero() : Vec3(d / l);
      const Vec3 dy = y.segment<3>(3 * e.i) - y.segment<3>(3 * e.j);
      Vec3 impulse = c * (pull * d + (along - across) * n.dot(dy) * n + across * dy);
      if (k_d > 0) impulse += c * k_d * n.dot(v.segment<3>(3 * e.i) - v.segment<3>(3 * e.j)) * n;
      b.segment<3>(3 * e.i) -= impulse;
      b.segment<3>(3 * e.j) += impulse;
      // symmetric to the last bit
      Mat3 K = (c * c * (along - across) + c * k_d) * (n * n.transpose()).eval();
      K.diagonal().array() += c * c * across;
      add_pair_block(A, e.slots, K);
    });
  }

 private:
  std::vector<Element> elements_;
  double k_d_;
  ChunkSchedule schedule_;
};

}  // namespace drape
