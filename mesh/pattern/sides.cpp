#include "mesh/pattern/sides.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <set>

#include "mesh/base/errors.h"
#include "mesh/pattern/sharp_corners.h"

namespace drape::internal {
namespace {

std::size_t z(int i) { return static_cast<std::size_t>(i); }

class SideCutter {
 public:
  SideCutter(const Pattern& pattern, double edge, double tolerance, double min_angle)
      : pattern_(pattern), edge_(edge), tolerance_(tolerance), min_angle_(min_angle) {}

  Sides cut() {
    const std::size_t panels = pattern_.panels.size();
    sides_.points.resize(panels), sides_.corner_legs.resize(panels), sides_.leg_of.resize(panels);
    for (std::size_t p = 0; p < panels; ++p) add_panel(static_cast<int>(p));
    sew();
    find_sharp_corners(pattern_, min_angle_, sides_);
    place_knots();
    for (std::size_t c = 0; c < knots_.size(); ++c) cut_class(static_cast<int>(c));
    return std::move(sides_);
  }

 private:
  struct Attached {  // a corner on a run where a line ends; it is no end of the run's segments
    double fraction;
    int vertex;
  };

  void add_panel(int panel) {
    const Panel& p = pattern_.panels[z(panel)];
    add_chain(panel, wound(p.outline, true), true);
    for (const Chain& hole : p.holes) add_chain(panel, wound(hole, false), true);
    for (const Chain& line : p.lines) add_chain(panel, line, false);
  }

  int corner(int panel, const Vec2& x) {
    std::vector<Vec2>& points = sides_.points[z(panel)];
    points.push_back(x);
    sides_.corner_legs[z(panel)].emplace_back();
    sides_.leg_of[z(panel)].push_back(Sides::kCorner);
    return static_cast<int>(points.size()) - 1;
  }

  // The vertex at the end of a line: an existing corner, a point of an outline, or a new corner.
  int line_end(int panel, const Vec2& x) {
    std::vector<Vec2>& points = sides_.points[z(panel)];
    for (std::size_t i = 0; i < points.size(); ++i)
      if ((points[i] - x).norm() <= tolerance_ / 2) return static_cast<int>(i);
    for (std::size_t r = 0; r < sides_.runs.size(); ++r) {
      const ChainRun& run = sides_.runs[r];
      if (run.panel != panel) continue;
      const double f = nearest_fraction(run.curve, x);
      if ((run.curve.at(f) - x).norm() > tolerance_ / 2) continue;
      const int v = corner(panel, run.curve.at(f));
      attached_[static_cast<int>(r)].push_back({f, v});
      return v;
    }
    return corner(panel, x);
  }

  static double nearest_fraction(const ArcLength& curve, const Vec2& x) {
    const int samples = 64 * static_cast<int>(curve.segments().size());
    const auto distance = [&](double f) { return (curve.at(f) - x).squaredNorm(); };
    int best = 0;
    for (int i = 1; i <= samples; ++i)
      if (distance(double(i) / samples) < distance(double(best) / samples)) best = i;
    double low = std::max(0.0, (best - 1.0) / samples), high = std::min(1.0, (best + 1.0) / samples);
    for (int i = 0; i < 60; ++i) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (distance(a) < distance(b) ? high : low) = distance(a) < distance(b) ? b : a;
    }
    return (low + high) / 2;
  }

  // Adds the runs of a chain: a run goes from one change of name to the next, and a segment without a name is
  // a run.
  void add_chain(int panel, const Chain& chain, bool loop) {
    const std::size_t n = chain.segments.size();
    std::vector<int> corners(n + 1);
    for (std::size_t i = 0; i < n; ++i)
      corners[i] =
          !loop && i == 0 ? line_end(panel, chain.segments[0].start) : corner(panel, chain.segments[i].start);
    corners[n] = loop ? corners[0] : line_end(panel, chain.segments[n - 1].end);
    const auto same = [&](std::size_t i, std::size_t j) {
      return !chain.names[i].empty() && chain.names[i] == chain.names[j];
    };
    std::size_t first = 0;  // where a run begins; 0 when the whole loop is one run
    for (std::size_t i = 0; loop && i < n; ++i)
      if (!same(i, (i + n - 1) % n)) {
        first = i;
        break;
      }
    for (std::size_t k = 0; k < n;) {
      std::vector<Segment> segments;
      std::vector<int> ends = {corners[(first + k) % n]};
      const std::size_t begin = (first + k) % n;
      do {
        const std::size_t i = (first + k) % n;
        segments.push_back(chain.segments[i]);
        ends.push_back(corners[i + 1]);
        ++k;
      } while (k < n && same(begin, (first + k) % n));
      add_run(panel, chain, begin, std::move(segments), std::move(ends), loop);
    }
  }

  void add_run(int panel, const Chain& chain, std::size_t begin, std::vector<Segment> segments,
               std::vector<int> corners, bool boundary) {
    const std::string& panel_name = pattern_.panels[z(panel)].name;
    const std::string name = chain.names[begin].empty() ? "" : panel_name + "." + chain.names[begin];
    if (!name.empty() && !names_.insert(name).second)
      throw InputError(chain.where + ": the name '" + chain.names[begin] +
                       "' is given to two parts that do not follow each other; give each its own name");
    const bool closed = corners.front() == corners.back();
    ChainRun run{panel,
                 name,
                 boundary,
                 closed,
                 ArcLength(std::move(segments)),
                 std::move(corners),
                 static_cast<int>(sides_.legs.size()),
                 0,
                 false,
                 chain.where};
    for (std::size_t i = 0; i + 1 < run.corners.size(); ++i) {
      for (const int v : {run.corners[i], run.corners[i + 1]})
        sides_.corner_legs[z(panel)][z(v)].push_back(static_cast<int>(sides_.legs.size()));
      sides_.legs.push_back({static_cast<int>(sides_.runs.size())});
    }
    sides_.runs.push_back(std::move(run));
  }

  int run_named(const std::string& name, const Seam& seam) const {
    std::string known;
    for (std::size_t r = 0; r < sides_.runs.size(); ++r) {
      if (sides_.runs[r].name == name) return static_cast<int>(r);
      if (!sides_.runs[r].name.empty()) known += (known.empty() ? "" : ", ") + sides_.runs[r].name;
    }
    throw InputError(seam.where + ": there is no curve '" + name + "' to sew; " +
                     (known.empty() ? "no side has a name" : "known are: " + known));
  }

  // Makes classes of the runs that are sewn on one another, and notes for each run the direction in which it
  // goes.
  void sew() {
    std::vector<int> owner(sides_.runs.size());
    std::iota(owner.begin(), owner.end(), 0);
    std::vector<char> turned(sides_.runs.size(), 0);
    for (const Seam& seam : pattern_.seams) {
      const int a = run_named(seam.a, seam), b = run_named(seam.b, seam);
      if (owner[z(a)] == owner[z(b)])
        throw InputError(seam.where + ": the seam of '" + seam.a + "' and '" + seam.b +
                         (a == b ? "' sews a curve to itself" : "' sews what is sewn together already"));
      const char flip = static_cast<char>((turned[z(a)] != 0) ^ (turned[z(b)] != 0) ^ !seam.same_way);
      const int from = owner[z(b)], to = owner[z(a)];
      for (std::size_t r = 0; r < owner.size(); ++r)
        if (owner[r] == from) owner[r] = to, turned[r] = static_cast<char>(turned[r] ^ flip);
    }
    std::map<int, int> numbers;
    for (std::size_t r = 0; r < owner.size(); ++r) {
      sides_.runs[r].turned = turned[r] != 0;
      sides_.runs[r].seam_class =
          numbers.try_emplace(owner[r], static_cast<int>(numbers.size())).first->second;
    }
    knots_.resize(numbers.size()), members_.resize(numbers.size());
    for (std::size_t r = 0; r < sides_.runs.size(); ++r)
      members_[z(sides_.runs[r].seam_class)].push_back(static_cast<int>(r));
  }

  // Finds where every run of a class must have a vertex, in fractions of the class.
  void place_knots() {
    for (std::size_t r = 0; r < sides_.runs.size(); ++r) {
      const ChainRun& run = sides_.runs[r];
      std::vector<double>& knots = knots_[z(run.seam_class)];
      knots.insert(knots.end(), {0, 1});
      for (std::size_t i = 0; i + 1 < run.curve.segments().size(); ++i)
        knots.push_back(class_fraction(run, run.curve.end_of(i)));
      for (const Attached& a : attached_[static_cast<int>(r)])
        knots.push_back(class_fraction(run, a.fraction));
    }
    const std::vector<double> collar = collars(sides_, edge_);
    for (std::size_t c = 0; c < collar.size(); ++c)
      for (const auto& [leg, at_end] : sides_.clusters[c]) {
        const ChainRun& run = sides_.runs[z(sides_.legs[z(leg)].run)];
        const double part = collar[c] / run.curve.length();
        knots_[z(run.seam_class)].push_back(
            class_fraction(run, leg_fraction(run, leg, at_end) + (at_end ? -part : part)));
      }
    for (std::vector<double>& knots : knots_) {
      std::sort(knots.begin(), knots.end());
      knots.erase(
          std::unique(knots.begin(), knots.end(), [](double a, double b) { return b - a < kSameFraction; }),
          knots.end());
      knots.back() = 1;
    }
  }

  // Whether one straight piece is enough for a part of a curve: the curve is not farther from it than the
  // tolerance and turns by no more than about a radian.
  bool close_enough(const ArcLength& curve, double f0, double f1) const {
    const Vec2 start = curve.at(f0), chord = curve.at(f1) - start;
    const double length = chord.norm(), allowed = std::min(tolerance_, length / 8);
    for (int k = 1; k < 8; ++k) {
      const Vec2 d = curve.at(f0 + (f1 - f0) * k / 8) - start;
      if (std::abs(chord.x() * d.y() - chord.y() * d.x()) > allowed * length || d.norm() > 1.1 * length)
        return false;
    }
    return true;
  }

  // Halves a part, given in fractions of the class, until one piece is enough for each half on every run of
  // the class.
  void cut_part(const std::vector<int>& members, double a, double b, int depth,
                std::vector<double>& cuts) const {
    bool good = true;
    for (const int r : members) {
      const ChainRun& run = sides_.runs[z(r)];
      const double f = class_fraction(run, a), g = class_fraction(run, b);
      good = good && close_enough(run.curve, std::min(f, g), std::max(f, g));
    }
    if (good || depth == 0) {
      cuts.push_back(b);
      return;
    }
    cut_part(members, a, (a + b) / 2, depth - 1, cuts);
    cut_part(members, (a + b) / 2, b, depth - 1, cuts);
  }

  void cut_class(int seam_class) {
    const std::vector<int>& members = members_[z(seam_class)];
    const std::vector<double>& knots = knots_[z(seam_class)];
    double longest = 0;
    for (const int r : members) longest = std::max(longest, sides_.runs[z(r)].curve.length());
    std::vector<double> cuts = {0};
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
      const double part = knots[k + 1] - knots[k];
      const int n = std::max(1, static_cast<int>(std::ceil(part * longest / edge_ - 1e-9)));
      for (int i = 0; i < n; ++i)
        cut_part(members, knots[k] + part * i / n, i + 1 == n ? knots[k + 1] : knots[k] + part * (i + 1) / n,
                 kDeepest, cuts);
    }
    const std::size_t count = cuts.size() - 1, first = sides_.pieces.size();
    for (std::size_t m = 0; m < members.size(); ++m) {
      add_pieces(members[m], cuts);
      for (std::size_t i = 0; i < count; ++i)  // in the order of the class, whichever way the run goes
        sides_.pieces[first + m * count + i].twin =
            static_cast<int>(first + (m + 1) % members.size() * count + i);
    }
  }

  // Adds the vertices and pieces of a run, in the order of its class.
  void add_pieces(int r, const std::vector<double>& cuts) {
    const ChainRun& run = sides_.runs[z(r)];
    std::vector<Attached> fixed = attached_[r];
    for (std::size_t i = 0; i < run.corners.size(); ++i)
      fixed.push_back({i == 0 ? 0 : run.curve.end_of(i - 1), run.corners[i]});
    std::vector<int> vertices(cuts.size(), -1);
    for (const Attached& a : fixed) {
      int& vertex = vertices[nearest(cuts, class_fraction(run, a.fraction))];
      if (vertex >= 0 && vertex != a.vertex)
        throw InputError(run.where + ": two corners are too near to each other, at " +
                         place_of(run.curve.at(a.fraction)) + "; make one of them");
      vertex = a.vertex;
    }
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      if (vertices[i] >= 0) continue;
      const double f = class_fraction(run, cuts[i]);
      vertices[i] = static_cast<int>(sides_.points[z(run.panel)].size());
      sides_.points[z(run.panel)].push_back(run.curve.at(f));
      sides_.leg_of[z(run.panel)].push_back(leg_at(run, f));
    }
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double f = class_fraction(run, cuts[i]), g = class_fraction(run, cuts[i + 1]);
      if (vertices[i] == vertices[i + 1])  // both ends of a line were taken for one vertex
        throw InputError(run.where + ": a part at " + place_of(run.curve.at(f)) +
                         " is shorter than half the tolerance; leave it out, or ask for a smaller tolerance");
      Subsegment piece{r, vertices[i], vertices[i + 1], f, g, leg_at(run, (f + g) / 2), 0};
      if (run.turned) std::swap(piece.a, piece.b), std::swap(piece.f0, piece.f1);
      sides_.pieces.push_back(piece);
    }
  }

  static int leg_at(const ChainRun& run, double f) {
    std::size_t low = 0, high = run.curve.segments().size() - 1;  // seeks the first that ends at f or later
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      f > run.curve.end_of(middle) ? low = middle + 1 : high = middle;
    }
    return run.first_leg + static_cast<int>(low);
  }

  static std::size_t nearest(const std::vector<double>& cuts, double f) {
    const auto above = std::lower_bound(cuts.begin(), cuts.end(), f);
    if (above == cuts.begin()) return 0;
    const auto below = std::prev(above);
    return static_cast<std::size_t>((above == cuts.end() || f - *below < *above - f ? below : above) -
                                    cuts.begin());
  }

  static constexpr int kDeepest = 20;  // most halvings of a part that is no longer than the edge

  const Pattern& pattern_;
  const double edge_, tolerance_, min_angle_;
  Sides sides_;
  std::set<std::string> names_;                    // of runs
  std::map<int, std::vector<Attached>> attached_;  // for each run
  std::vector<std::vector<double>> knots_;         // for each class, ascending
  std::vector<std::vector<int>> members_;          // the runs of each class
};

}  // namespace

std::string place_of(const Vec2& x) {
  char text[80];
  std::snprintf(text, sizeof text, "x = %.4g cm, y = %.4g cm", 100 * x.x(), 100 * x.y());
  return text;
}

Chain wound(const Chain& loop, bool left) {
  if ((enclosed_area(loop) > 0) == left) return loop;
  Chain turned = loop;
  std::reverse(turned.segments.begin(), turned.segments.end());
  std::reverse(turned.names.begin(), turned.names.end());
  for (Segment& s : turned.segments) s = reversed(s);
  return turned;
}

Sides cut_sides(const Pattern& pattern, double edge, double tolerance, double min_angle) {
  return SideCutter(pattern, edge, tolerance, min_angle).cut();
}

}  // namespace drape::internal
