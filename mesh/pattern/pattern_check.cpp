#include "mesh/pattern/pattern_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "mesh/base/errors.h"
#include "mesh/base/predicates.h"

namespace drape::internal {
namespace {

std::size_t z(int i) { return static_cast<std::size_t>(i); }

void check_chain(const Chain& chain, bool loop) {
  if (chain.segments.empty()) throw InputError(chain.where + ": nothing is drawn");
  double length = 0;
  for (const Segment& s : chain.segments) {
    for (int eighth = 0; eighth <= 8; ++eighth) {
      const double t = eighth / 8.0;
      if (!point(s, t).allFinite() || point(s, t).cwiseAbs().maxCoeff() > 1e6)
        throw InputError(chain.where + ": a coordinate is not a finite number of at most 1000 km");
      if (t > 0) length += (point(s, t) - point(s, t - 0.125)).norm();
    }
    if (is_point(s)) throw InputError(chain.where + ": a side has no length, at " + place_of(s.start));
  }
  if (length <= 0) throw InputError(chain.where + ": has no length");
  if (loop && std::abs(enclosed_area(chain)) <= 1e-9 * length * length)
    throw InputError(chain.where + ": the outline has no area, or crosses itself so that nothing is left");
}

struct PieceBox {
  Eigen::AlignedBox2d box;
  int number;
};

// Calls f(i, j) for every two boxes that meet.
template <class F>
void for_each_meeting(std::vector<PieceBox> boxes, const F& f) {
  const auto left = [](const PieceBox& piece) { return piece.box.min().x(); };
  std::sort(boxes.begin(), boxes.end(), [&](const PieceBox& a, const PieceBox& b) {
    return left(a) != left(b) ? left(a) < left(b) : a.number < b.number;
  });
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size() && left(boxes[j]) <= boxes[i].box.max().x(); ++j)
      if (boxes[i].box.intersects(boxes[j].box)) f(boxes[i].number, boxes[j].number);
}

bool between(const Vec2& a, const Vec2& b, const Vec2& x) { return (a - x).dot(b - x) <= 0; }

// Whether two straight pieces have a point in common other than an end that both share.
bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const int abc = orient2d(a, b, c), abd = orient2d(a, b, d), cda = orient2d(c, d, a),
            cdb = orient2d(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
         (cdb == 0 && between(c, d, b));
}

class PieceChecker {
 public:
  PieceChecker(const Pattern& pattern, const Sides& sides, double tolerance)
      : pattern_(pattern), sides_(sides), tolerance_(tolerance) {}

  void check() const {
    std::vector<PieceBox> boxes;
    for (std::size_t i = 0; i < sides_.pieces.size(); ++i) {
      const Vec2 &a = start(static_cast<int>(i)), &b = end(static_cast<int>(i));
      boxes.push_back({Eigen::AlignedBox2d(a).extend(b), static_cast<int>(i)});
    }
    for_each_meeting(std::move(boxes), [&](int i, int j) {
      if (panel(i) == panel(j)) {
        check_same_panel(std::min(i, j), std::max(i, j));
      } else {
        check_other_panel(std::min(i, j), std::max(i, j));
      }
    });
    for (std::size_t p = 0; p < pattern_.panels.size(); ++p)
      for (std::size_t q = 0; q < pattern_.panels.size(); ++q)
        if (p != q) check_inside(static_cast<int>(p), static_cast<int>(q));
  }

 private:
  const Subsegment& piece(int i) const { return sides_.pieces[z(i)]; }
  const ChainRun& run(int i) const { return sides_.runs[z(piece(i).run)]; }
  int panel(int i) const { return run(i).panel; }
  const Vec2& start(int i) const { return sides_.points[z(panel(i))][z(piece(i).a)]; }
  const Vec2& end(int i) const { return sides_.points[z(panel(i))][z(piece(i).b)]; }

  void check_same_panel(int i, int j) const {
    const Subsegment &p = piece(i), &q = piece(j);
    const auto shared = [&] { return std::set<int>{p.a, p.b, q.a, q.b}.size() < 4; };
    if (!shared()) {
      if (meet(start(i), end(i), start(j), end(j))) crosses(i, j, (start(j) + end(j)) / 2);
      return;
    }
    const int common = p.a == q.a || p.a == q.b ? p.a : p.b;
    const Vec2 &x = sides_.points[z(panel(i))][z(common)], &u = p.a == common ? end(i) : start(i),
               &w = q.a == common ? end(j) : start(j);
    if ((orient2d(x, u, w) == 0 && (u - x).dot(w - x) > 0) || u == w) crosses(i, j, x);
  }

  [[noreturn]] void crosses(int i, int j, const Vec2& x) const {
    const ChainRun &a = run(i), &b = run(j);
    const std::string at = " near " + place_of(x);
    if (a.where == b.where)
      throw InputError(a.where + ": crosses or touches itself" + at + "; draw it without a crossing");
    throw InputError(a.where + ": crosses or touches " + b.where + at + "; draw them apart");
  }

  void check_other_panel(int i, int j) const {
    const Vec2 &a = start(i), &b = end(i), &c = start(j), &d = end(j);
    const auto off = [&](const Vec2& p, const Vec2& q, const Vec2& x) {  // distance from the line p q
      return std::abs((q - p).x() * (x - p).y() - (q - p).y() * (x - p).x()) / (q - p).norm();
    };
    const bool deep = off(a, b, c) > tolerance_ && off(a, b, d) > tolerance_ && off(c, d, a) > tolerance_ &&
                      off(c, d, b) > tolerance_;
    const bool cross = orient2d(a, b, c) * orient2d(a, b, d) < 0 && orient2d(c, d, a) * orient2d(c, d, b) < 0;
    if (deep && cross && run(i).boundary && run(j).boundary) overlap(panel(i), panel(j), (c + d) / 2);
  }

  [[noreturn]] void overlap(int p, int q, const Vec2& x) const {
    throw InputError(pattern_.panels[z(p)].outline.where + ": panel '" + pattern_.panels[z(p)].name +
                     "' overlaps panel '" + pattern_.panels[z(q)].name + "' near " + place_of(x) +
                     "; move one of them");
  }

  // Whether a vertex, the middle of a piece or an inner point of panel p is well inside panel q.
  void check_inside(int p, int q) const {
    const Boundary& other = boundary(q);
    const auto look = [&](const Vec2& x) {
      if (other.box.contains(x) && other.holds(x) && other.distance(x) > tolerance_) overlap(p, q, x);
    };
    for (const auto& [a, b] : boundary(p).pieces) look(a), look((a + b) / 2);
    look(boundary(p).inner_point());  // where the sides of one panel lie on those of the other
  }

  struct Boundary {
    std::vector<std::pair<Vec2, Vec2>> pieces;
    Eigen::AlignedBox2d box;

    bool holds(const Vec2& x) const {
      bool inside = false;
      for (const auto& [a, b] : pieces)
        if ((a.y() > x.y()) != (b.y() > x.y()) && (orient2d(a, b, x) > 0) == (b.y() > a.y()))
          inside = !inside;
      return inside;
    }
    // A point in the middle of the widest part of the horizontal line at half the height of the panel.
    Vec2 inner_point() const {
      const double y = box.center().y();
      std::vector<double> crossings;
      for (const auto& [a, b] : pieces)
        if ((a.y() > y) != (b.y() > y))
          crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
      std::sort(crossings.begin(), crossings.end());
      std::size_t best = 0;
      for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
        if (crossings[i + 1] - crossings[i] > crossings[best + 1] - crossings[best]) best = i;
      return {(crossings[best] + crossings[best + 1]) / 2, y};
    }
    double distance(const Vec2& x) const {
      double least = 1e300;
      for (const auto& [a, b] : pieces) {
        const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
        least = std::min(least, (a + t * (b - a) - x).norm());
      }
      return least;
    }
  };

  const Boundary& boundary(int p) const {
    if (boundaries_.empty()) {
      boundaries_.resize(pattern_.panels.size());
      for (std::size_t i = 0; i < sides_.pieces.size(); ++i) {
        const int k = static_cast<int>(i);
        Boundary& of = boundaries_[z(panel(k))];
        if (!run(k).boundary) continue;
        of.pieces.emplace_back(start(k), end(k));
        of.box.extend(start(k));
      }
    }
    return boundaries_[z(p)];
  }

  const Pattern& pattern_;
  const Sides& sides_;
  const double tolerance_;
  mutable std::vector<Boundary> boundaries_;
};

}  // namespace

void check_pattern(const Pattern& pattern) {
  if (pattern.panels.empty())
    throw InputError(pattern.where + ": there is no panel: no closed outline; draw one, or close it");
  std::set<std::string> names;
  for (const Panel& panel : pattern.panels) {
    const bool blank = panel.name.find_first_of(" \t\r\n\"#") != panel.name.npos;
    if (panel.name.empty() || blank)
      throw InputError(panel.outline.where + ": a panel needs a name of one word, and this is '" +
                       panel.name + "'");
    if (!names.insert(panel.name).second)
      throw InputError(panel.outline.where + ": there is another panel '" + panel.name +
                       "'; give it its own name");
    check_chain(panel.outline, true);
    for (const Chain& hole : panel.holes) check_chain(hole, true);
    for (const Chain& line : panel.lines) check_chain(line, false);
  }
}

void check_pieces(const Pattern& pattern, const Sides& sides, double tolerance) {
  PieceChecker(pattern, sides, tolerance).check();
}

}  // namespace drape::internal
