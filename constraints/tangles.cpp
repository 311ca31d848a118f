#include "constraints/tangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace drape::internal {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// The least |E . N| that counts: an edge that is nearly parallel to a triangle would go far for a small gain.
constexpr double steepest = 0.2;
constexpr double stretches = 0.1;  // of an edge in a step, at most
constexpr int spreadings = 6;      // over so many triangles
constexpr double spread_share = 0.3;
constexpr int few = 8;          // pairs that may cross beyond a quarter
constexpr double patience = 2;  // s, without fewer pairs that cross

class Roots {
 public:
  explicit Roots(std::size_t n) : root_(n) { std::iota(root_.begin(), root_.end(), 0); }
  int of(int i) {
    while (root_[i] != i) i = root_[i] = root_[root_[i]];
    return i;
  }
  void join(int i, int j) { root_[of(i)] = of(j); }

 private:
  std::vector<int> root_;
};

Vec3 normal_of(const std::vector<Vec3>& x, const Triangle& t) {
  return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
}

bool can_move(const StepMotion& step, int particle) {
  return !step.is_held(particle) && step.mass(particle) > 0;
}

// Those of a triangle, or the two ends of a segment.
std::span<const int> corners_of(const Triangle& t) { return {t.data(), t[1] == t[2] ? 2u : 3u}; }

// Where an edge passes through a triangle: the point of the edge less that of the triangle is sum w_k x_k.
struct Crossing {
  std::array<int, 5> particles;
  std::array<double, 5> weights;
  Vec3 ahead;    // the normal of the triangle, on the side of the edge's second end
  Vec3 shorter;  // G of one triangle at the edge

  Crossing(const Passage& passage, const std::vector<Vec3>& x, const std::vector<Triangle>& triangles) {
    const Triangle& t = triangles[passage.through];
    const Vec3 normal = normal_of(x, t), N = normal.normalized();
    const double from = N.dot(x[passage.a] - x[t[0]]), to = N.dot(x[passage.b] - x[t[0]]);
    const double s = from == to ? 0.5 : std::clamp(from / (from - to), 0.0, 1.0);
    const Vec3 p = x[passage.a] + s * (x[passage.b] - x[passage.a]);
    particles = {passage.a, passage.b, t[0], t[1], t[2]};
    weights = {1 - s, s, 0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k)
      weights[k + 2] =
          -normal.dot((x[t[(k + 1) % 3]] - p).cross(x[t[(k + 2) % 3]] - p)) / normal.squaredNorm();

    const Vec3 E = (x[passage.b] - x[passage.a]).normalized();
    const Triangle& own = triangles[passage.of];
    const double slope = std::copysign(std::max(std::abs(E.dot(N)), steepest), E.dot(N));
    ahead = std::copysign(1.0, slope) * N;
    shorter.setZero();
    const auto beside =
        std::find_if(own.begin(), own.end(), [&](int v) { return v != passage.a && v != passage.b; });
    if (beside == own.end()) return;  // a segment
    const int third = *beside;
    Vec3 R = normal_of(x, own).cross(N).normalized();
    if (R.dot((x[third] - p) - E.dot(x[third] - p) * E) < 0) R = -R;
    shorter = R - R.dot(E) / slope * N;
  }
  bool is_number() const {
    return shorter.allFinite() && ahead.allFinite() &&
           std::all_of(weights.begin(), weights.end(), [](double w) { return std::isfinite(w); });
  }
};

}  // namespace

void Tangles::begin(std::vector<Triangle> triangles, int segments, std::vector<std::optional<int>> layers,
                    const std::vector<char>& pass, const VecX& x) {
  triangles_ = std::move(triangles);
  segments_ = segments;
  layers_ = std::move(layers);
  passes_.clear();
  for (const Triangle& t : triangles_)
    passes_.push_back(std::any_of(t.begin(), t.end(), [&](int v) { return pass[v] != 0; }));
  const auto n = static_cast<std::size_t>(x.size() / 3);
  first_.assign(n + 1, 0);
  for (const Triangle& t : triangles_)
    for (int v : t) ++first_[v + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  around_.resize(3 * triangles_.size());
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (std::size_t k = 0; k < triangles_.size(); ++k)
    for (int v : triangles_[k]) around_[next[v]++] = static_cast<int>(k);
  is_near_.assign(triangles_.size(), 0);
  side_.assign(triangles_.size(), 0);
  way_.setZero(x.size());
  seen_.resize(0);
  fewest_ = std::numeric_limits<int>::max();
  end_step(x);
}

void Tangles::look(const VecX& x) {
  if (seen_.size() == x.size() && seen_ == x) return;
  places_.resize(static_cast<std::size_t>(x.size() / 3));
  for (std::size_t i = 0; i < places_.size(); ++i)
    places_[i] = x.segment<3>(3 * static_cast<Eigen::Index>(i));
  found_ = crossing_contours(places_, triangles_, segments_);
  leave_out_passing();
  seen_ = x;
}

void Tangles::leave_out_passing() {
  if (std::find(passes_.begin(), passes_.end(), 1) == passes_.end()) return;
  for (CrossingContour& contour : found_) {
    std::erase_if(contour.pairs,
                  [&](const TrianglePair& p) { return passes_[p.first] != 0 && passes_[p.second] != 0; });
    std::erase_if(contour.passages,
                  [&](const Passage& p) { return passes_[p.of] != 0 && passes_[p.through] != 0; });
  }
  std::erase_if(found_, [](const CrossingContour& contour) { return contour.pairs.empty(); });
}

void Tangles::end_step(const VecX& x) {
  look(x);
  contours_ = found_;
  const int crossings = crossing_count(contours_);
  if (crossings < fewest_) stalled_ = 0;
  fewest_ = std::min(fewest_, crossings);
  mark();
}

// Gathers the triangles that the contour has and those that share a vertex with them; with two rings once
// more those that share a vertex with these.
void Tangles::gather(const CrossingContour& contour, int rings) {
  near_.clear();
  const auto add_around = [&](int triangle) {
    for (int v : triangles_[triangle])
      for (int k = first_[v]; k < first_[v + 1]; ++k)
        if (std::exchange(is_near_[around_[k]], char{1}) == 0) near_.push_back(around_[k]);
  };
  for (const TrianglePair& pair : contour.pairs)
    for (int crossing : {pair.first, pair.second}) add_around(crossing);
  for (std::size_t k = 0, first_ring = near_.size(); rings == 2 && k < first_ring; ++k) add_around(near_[k]);
  for (int k : near_) is_near_[k] = 0;
  std::sort(near_.begin(), near_.end());
}

void Tangles::mark() {
  Roots roots(places_.size());
  std::vector<char> crosses(places_.size(), 0), moves(places_.size(), 0);
  for (const CrossingContour& contour : contours_) {
    gather(contour, 2);
    for (int k : near_)
      for (int v : triangles_[k]) {
        moves[v] = 1;
        roots.join(v, triangles_[near_.front()][0]);
      }
    gather(contour, 1);
    for (int k : near_)
      for (int v : triangles_[k]) crosses[v] = 1;
  }
  tangle_.assign(places_.size(), -1);
  moved_.assign(places_.size(), -1);
  particles_ = 0;
  for (int i = 0; i < static_cast<int>(places_.size()); ++i) {
    if (moves[i] != 0) moved_[i] = roots.of(i);
    if (crosses[i] == 0) continue;
    tangle_[i] = moved_[i];
    ++particles_;
  }
}

void Tangles::find_regions(const StepMotion& step) {
  std::vector<std::array<int, 2>> cut;
  for (const CrossingContour& contour : contours_)
    for (const Passage& passage : contour.passages) cut.push_back({passage.a, passage.b});
  std::sort(cut.begin(), cut.end());
  cut.erase(std::unique(cut.begin(), cut.end()), cut.end());
  Roots roots(places_.size());
  for (const Triangle& t : triangles_)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
      const bool may_cross = tangle_[a] >= 0 && tangle_[b] >= 0;
      if (!may_cross || !std::binary_search(cut.begin(), cut.end(), std::array{a, b})) roots.join(a, b);
    }
  region_.resize(places_.size());
  region_mass_.assign(places_.size(), 0);
  for (int i = 0; i < static_cast<int>(region_.size()); ++i) {
    region_[i] = roots.of(i);
    region_mass_[region_[i]] += can_move(step, i) ? step.mass(i) : infinity;
  }
}

// -1: the edge divides no region off that could move.
int Tangles::lighter_end(const Passage& passage) const {
  const int a = region_[passage.a], b = region_[passage.b];
  if (a == b || (region_mass_[a] == infinity && region_mass_[b] == infinity)) return -1;
  return std::pair(region_mass_[a], a) < std::pair(region_mass_[b], b) ? passage.a : passage.b;
}

// Triangles that cross lie on two sides of their contour. Where it crosses itself, there are no sides.
void Tangles::sort_sides(const CrossingContour& contour) {
  for (int k : near_) side_[k] = 0;
  std::vector<std::array<int, 2>> across;
  for (const TrianglePair& pair : contour.pairs) {
    across.push_back({pair.first, pair.second});
    across.push_back({pair.second, pair.first});
  }
  std::sort(across.begin(), across.end());
  std::vector<int> queue = {contour.pairs.front().first};
  side_[queue.front()] = 1;
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const int here = queue[k];
    auto next = std::lower_bound(across.begin(), across.end(), std::array{here, 0});
    for (; next != across.end() && (*next)[0] == here; ++next) {
      int& there = side_[(*next)[1]];
      if (there == side_[here]) {
        for (int triangle : near_) side_[triangle] = 0;
        return;
      }
      if (there == 0) queue.push_back((*next)[1]);
      there = -side_[here];
    }
  }
}

// The side that has the lightest region; 2: the contour divides none off.
int Tangles::lightest_side(const CrossingContour& contour) const {
  int side = 2;
  double lightest = infinity;
  for (const Passage& passage : contour.passages) {
    const int end = lighter_end(passage);
    if (end < 0 || region_mass_[region_[end]] >= lightest) continue;
    lightest = region_mass_[region_[end]];
    side = side_[passage.of];
  }
  return side;
}

// How the edge moves against the triangle, where the order of the two is known.
std::optional<Vec3> Tangles::way_by_layers(const Passage& passage) const {
  const std::optional<int>&of = layers_[passage.of], &through = layers_[passage.through];
  if (!of || !through || *of == *through) return {};
  const bool outer = *of > *through;
  const Vec3 out = normal_of(places_, triangles_[outer ? passage.through : passage.of]).normalized();
  return outer ? out : Vec3(-out);
}

// Adds to way_ what brings the sides of the contour apart; only its direction counts.
void Tangles::add_ways(const CrossingContour& contour, const StepMotion& step) {
  const int side = lightest_side(contour);
  Vec3 whole = Vec3::Zero();
  for (const Passage& passage : contour.passages) {
    const Crossing crossing(passage, places_, triangles_);
    if (crossing.is_number()) whole += side_[passage.of] * crossing.shorter;
  }
  for (const Passage& passage : contour.passages) {
    const Crossing crossing(passage, places_, triangles_);
    if (!crossing.is_number()) continue;
    Vec3 way = crossing.shorter + side_[passage.of] * whole;
    if (const auto ordered = way_by_layers(passage); ordered && ordered->allFinite()) {
      way = *ordered;
    } else if (side != 2) {
      const int end = lighter_end(passage);
      if (end < 0 || side_[passage.of] != side) continue;
      way = end == passage.a ? crossing.ahead : Vec3(-crossing.ahead);
    }
    const auto inverse = [&](int i) { return can_move(step, i) ? 1 / step.mass(i) : 0; };
    double both = 0;
    for (std::size_t k = 0; k < 5; ++k)
      both += crossing.weights[k] * crossing.weights[k] * inverse(crossing.particles[k]);
    if (!(both > 0)) continue;
    for (std::size_t k = 0; k < 5; ++k)
      way_.segment<3>(3 * crossing.particles[k]) +=
          crossing.weights[k] * inverse(crossing.particles[k]) / both * way;
  }
}

// Takes each triangle some way towards its mean by mass, which keeps the momentum.
void Tangles::spread(const StepMotion& step) {
  for (int round = 0; round < spreadings; ++round)
    for (int k : near_) {
      double mass = 0;
      Vec3 mean = Vec3::Zero();
      for (int v : corners_of(triangles_[k])) {
        if (!can_move(step, v)) continue;
        mass += step.mass(v);
        mean += step.mass(v) * way_.segment<3>(3 * v);
      }
      if (mass == 0) continue;
      for (int v : corners_of(triangles_[k]))
        if (can_move(step, v))
          way_.segment<3>(3 * v) += spread_share * (mean / mass - way_.segment<3>(3 * v));
    }
}

// By how much these displacements exceed what is allowed at the triangle, as a factor.
double Tangles::excess_of(const Triangle& t, const VecX& ways, double most) const {
  double excess = 1;
  for (std::size_t j = 0; j < 3; ++j) {
    const int v = t[j], w = t[(j + 1) % 3];
    const Vec3 way = ways.segment<3>(3 * v), other = ways.segment<3>(3 * w);
    excess = std::max(excess, way.norm() / most);
    if (way != other)
      excess = std::max(excess, (way - other).norm() / (stretches * (places_[v] - places_[w]).norm()));
  }
  return excess;
}

void Tangles::add_relief(double most) {
  double excess = 1;
  for (int k : near_) excess = std::max(excess, excess_of(triangles_[k], way_, most));
  for (int k : near_)
    for (int v : triangles_[k]) {
      if (std::isfinite(excess)) relief_.segment<3>(3 * v) += way_.segment<3>(3 * v) / excess;
      way_.segment<3>(3 * v).setZero();
    }
}

// Where contours lie close their displacements add up, and at the rim of a tangle the cloth beyond does not
// move: one factor for each tangle, which keeps its momentum.
void Tangles::limit_relief(double most) {
  excess_.assign(places_.size(), 1);
  for (const Triangle& t : triangles_) {
    if (moved_[t[0]] < 0 && moved_[t[1]] < 0 && moved_[t[2]] < 0) continue;
    const double excess = excess_of(t, relief_, most);
    for (int v : t)
      if (moved_[v] >= 0) excess_[moved_[v]] = std::max(excess_[moved_[v]], excess);
  }
  for (int i = 0; i < static_cast<int>(moved_.size()); ++i)
    if (moved_[i] >= 0) relief_.segment<3>(3 * i) /= excess_[moved_[i]];
}

const VecX& Tangles::relief(const StepMotion& step, double most) {
  look(step.x);
  relief_.setZero(step.x.size());
  if (stalled_ > patience) return relief_;
  const int rings = stalled_ < 0.5 * patience ? 2 : 1;
  stalled_ += step.h;
  find_regions(step);
  for (const CrossingContour& contour : contours_) {
    gather(contour, rings);
    sort_sides(contour);
    add_ways(contour, step);
    spread(step);
    add_relief(most);
  }
  limit_relief(most);
  return relief_;
}

const std::vector<int>& Tangles::growing(const VecX& x) {
  look(x);
  growing_.clear();
  if (crossing_count(found_) <= fewest_ + fewest_ / 4 + few) return growing_;
  const auto pairs_of = [](const std::vector<CrossingContour>& contours) {
    std::vector<TrianglePair> pairs;
    for (const CrossingContour& contour : contours)
      pairs.insert(pairs.end(), contour.pairs.begin(), contour.pairs.end());
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  };
  const std::vector<TrianglePair> before = pairs_of(contours_), after = pairs_of(found_);
  gain_.assign(places_.size(), 0);
  std::vector<int> of_pair;
  const auto count = [&](const TrianglePair& pair, int gain) {
    of_pair.clear();
    for (int triangle : {pair.first, pair.second})
      for (int v : triangles_[triangle])
        if (tangle_[v] >= 0) of_pair.push_back(tangle_[v]);
    std::sort(of_pair.begin(), of_pair.end());
    of_pair.erase(std::unique(of_pair.begin(), of_pair.end()), of_pair.end());
    for (int tangle : of_pair) gain_[tangle] += gain;
  };
  for (const TrianglePair& pair : after)
    if (!std::binary_search(before.begin(), before.end(), pair)) count(pair, 1);
  for (const TrianglePair& pair : before)
    if (!std::binary_search(after.begin(), after.end(), pair)) count(pair, -1);
  for (int i = 0; i < static_cast<int>(gain_.size()); ++i)
    if (gain_[i] > 0) growing_.push_back(i);
  return growing_;
}

}  // namespace drape::internal
