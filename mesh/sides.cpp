#include "mesh/sides.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "mesh/obj.h"

namespace drape {
namespace {

constexpr double kSame = 1e-7;                   // fractions of a run that count as one
constexpr double kSharp = std::numbers::pi / 3;  // rad

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
    find_sharp_corners();
    place_knots();
    for (std::size_t c = 0; c < knots_.size(); ++c) cut_class(static_cast<int>(c));
    return std::move(sides_);
  }

 private:
  struct Attached {  // a corner on a run that is not the end of one of its segments: a line ends there
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

  // The end of a line: a corner that is there already, a point of an outline, or a new corner.
  int line_end(int panel, const Vec2& x) {
    std::vector<Vec2>& points = sides_.points[z(panel)];
    for (std::size_t i = 0; i < points.size(); ++i)
      if ((points[i] - x).norm() <= tolerance_ / 2) return static_cast<int>(i);
    for (std::size_t r = 0; r < sides_.runs.size(); ++r) {
      const Run& run = sides_.runs[r];
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

  // Runs of a chain: from each change of name to the next; segments without a name are runs of their own.
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
    std::size_t first = 0;  // where a run begins; 0 when the whole loop is one
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
    for (const Run& run : sides_.runs)
      if (!name.empty() && run.name == name)
        throw InputError(chain.where + ": the name '" + chain.names[begin] +
                         "' is given to two parts that do not follow each other; give each its own name");
    const bool closed = corners.front() == corners.back();
    Run run{panel,
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

  // Classes of runs that are sewn on one another, each with the way it runs.
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
    knots_.resize(numbers.size());
  }

  // Fraction of the class for one of the run, and back.
  static double common(const Run& run, double f) { return run.turned ? 1 - f : f; }

  void find_sharp_corners() {
    for (std::size_t panel = 0; panel < sides_.points.size(); ++panel)
      for (std::size_t v = 0; v < sides_.corner_legs[panel].size(); ++v)
        look_at_corner(static_cast<int>(panel), static_cast<int>(v));
  }

  struct Spoke {  // a leg as seen from a corner
    double angle;
    int leg;
    bool at_end, inside_next;  // inside_next: the panel is on its counter-clockwise side
    bool operator<(const Spoke& o) const { return angle != o.angle ? angle < o.angle : leg < o.leg; }
  };

  void look_at_corner(int panel, int v) {
    std::vector<Spoke> spokes;
    std::vector<int> legs = sides_.corner_legs[z(panel)][z(v)];
    legs.erase(std::unique(legs.begin(), legs.end()), legs.end());
    for (const int leg : legs) {
      const Run& run = sides_.runs[z(sides_.legs[z(leg)].run)];
      const std::size_t i = z(leg - run.first_leg);
      for (const bool at_end : {false, true}) {
        if (run.corners[i + (at_end ? 1 : 0)] != v) continue;
        const Vec2 d = direction(run.curve.segments()[i], at_end) * (at_end ? -1 : 1);
        spokes.push_back({std::atan2(d.y(), d.x()), leg, at_end, !run.boundary || !at_end});
      }
    }
    std::sort(spokes.begin(), spokes.end());
    for (std::size_t i = 0; i < spokes.size() && spokes.size() > 1; ++i) {
      const Spoke &s = spokes[i], &t = spokes[(i + 1) % spokes.size()];
      double angle = t.angle - s.angle;
      if (i + 1 == spokes.size()) angle += 2 * std::numbers::pi;
      if (!s.inside_next || angle >= kSharp) continue;
      if (angle < min_angle_)
        sides_.sharp.push_back({pattern_.panels[z(panel)].name, sides_.points[z(panel)][z(v)], angle});
      int& a = sides_.legs[z(s.leg)].sharp[s.at_end];
      int& b = sides_.legs[z(t.leg)].sharp[t.at_end];
      if (a < 0 && b < 0) a = static_cast<int>(sides_.clusters.size()), sides_.clusters.emplace_back();
      const int cluster = a >= 0 ? a : b;
      add_to_cluster(cluster, s), add_to_cluster(cluster, t);
    }
  }

  void add_to_cluster(int cluster, const Spoke& s) {
    auto& members = sides_.clusters[z(cluster)];
    const std::pair<int, bool> member(s.leg, s.at_end);
    sides_.legs[z(s.leg)].sharp[s.at_end] = cluster;
    if (std::find(members.begin(), members.end(), member) == members.end()) members.push_back(member);
  }

  // Fraction of a run at an end of one of its legs.
  static double fraction_at(const Run& run, int leg, bool at_end) {
    const int i = leg - run.first_leg + (at_end ? 1 : 0);
    return i == 0 ? 0 : run.curve.end_of(z(i - 1));
  }

  // How long the first pieces at sharp corners are: the same at all legs of a corner, and at the same
  // fractions of curves that are sewn.
  std::vector<double> collars() const {
    std::vector<double> length(sides_.clusters.size(), 0.6 * edge_);
    for (std::size_t c = 0; c < length.size(); ++c)
      for (const auto& [leg, at_end] : sides_.clusters[c]) {
        const Run& run = sides_.runs[z(sides_.legs[z(leg)].run)];
        const double f0 = fraction_at(run, leg, false), f1 = fraction_at(run, leg, true);
        length[c] = std::min(length[c], (f1 - f0) * run.curve.length() / 3);
      }
    for (int round = 0; round < 50; ++round) {
      std::map<std::tuple<int, long, bool>, double> ratio;  // class, place, way: the shortest
      const auto for_each = [&](const auto& f) {
        for (std::size_t c = 0; c < length.size(); ++c)
          for (const auto& [leg, at_end] : sides_.clusters[c]) {
            const Run& run = sides_.runs[z(sides_.legs[z(leg)].run)];
            const long place = std::lround(common(run, fraction_at(run, leg, at_end)) / (10 * kSame));
            f(c, run.curve.length(), std::tuple(run.seam_class, place, at_end != run.turned));
          }
      };
      for_each([&](std::size_t c, double whole, const auto& key) {
        const auto [found, fresh] = ratio.try_emplace(key, length[c] / whole);
        found->second = std::min(found->second, length[c] / whole);
      });
      bool changed = false;
      for_each([&](std::size_t c, double whole, const auto& key) {
        const double shortest = ratio.at(key) * whole;
        if (shortest < length[c] * (1 - 1e-12)) length[c] = shortest, changed = true;
      });
      if (!changed) break;
    }
    return length;
  }

  // Where every run of a class must have a vertex, in fractions of the class.
  void place_knots() {
    for (std::size_t r = 0; r < sides_.runs.size(); ++r) {
      const Run& run = sides_.runs[r];
      std::vector<double>& knots = knots_[z(run.seam_class)];
      knots.insert(knots.end(), {0, 1});
      for (std::size_t i = 0; i + 1 < run.curve.segments().size(); ++i)
        knots.push_back(common(run, run.curve.end_of(i)));
      for (const Attached& a : attached_[static_cast<int>(r)]) knots.push_back(common(run, a.fraction));
    }
    const std::vector<double> collar = collars();
    for (std::size_t c = 0; c < collar.size(); ++c)
      for (const auto& [leg, at_end] : sides_.clusters[c]) {
        const Run& run = sides_.runs[z(sides_.legs[z(leg)].run)];
        const double part = collar[c] / run.curve.length();
        knots_[z(run.seam_class)].push_back(
            common(run, fraction_at(run, leg, at_end) + (at_end ? -part : part)));
      }
    for (std::vector<double>& knots : knots_) {
      std::sort(knots.begin(), knots.end());
      knots.erase(std::unique(knots.begin(), knots.end(), [](double a, double b) { return b - a < kSame; }),
                  knots.end());
      knots.back() = 1;
    }
  }

  // Into how many pieces a part of a curve must be cut: none longer than the edge, none farther from the
  // curve than the tolerance, none that turns by more than about a radian.
  int pieces_needed(const ArcLength& curve, double f0, double f1) const {
    int n = std::max(1, static_cast<int>(std::ceil((f1 - f0) * curve.length() / (kSpacing * edge_) - 1e-9)));
    for (; n < (1 << 24); n += 1 + n / 4) {
      bool good = true;
      for (int i = 0; good && i < n; ++i) {
        const double a = f0 + (f1 - f0) * i / n, b = f0 + (f1 - f0) * (i + 1) / n;
        const Vec2 start = curve.at(a), chord = curve.at(b) - start;
        const double length = chord.norm(), allowed = std::min(tolerance_, length / 8);
        for (int k = 1; good && k < 8; ++k) {
          const Vec2 d = curve.at(a + (b - a) * k / 8) - start;
          good = std::abs(chord.x() * d.y() - chord.y() * d.x()) <= allowed * length &&
                 d.norm() < 1.1 * length + 1e-300;
        }
      }
      if (good) break;
    }
    return n;
  }

  void cut_class(int seam_class) {
    std::vector<int> members;
    for (std::size_t r = 0; r < sides_.runs.size(); ++r)
      if (sides_.runs[r].seam_class == seam_class) members.push_back(static_cast<int>(r));
    const std::vector<double>& knots = knots_[z(seam_class)];
    std::vector<double> cuts = {0};
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
      int n = 1;
      for (const int r : members) {
        const Run& run = sides_.runs[z(r)];
        const double a = common(run, knots[k]), b = common(run, knots[k + 1]);
        n = std::max(n, pieces_needed(run.curve, std::min(a, b), std::max(a, b)));
      }
      for (int i = 1; i <= n; ++i)
        cuts.push_back(i == n ? knots[k + 1] : knots[k] + (knots[k + 1] - knots[k]) * i / n);
    }
    const std::size_t count = cuts.size() - 1, first = sides_.pieces.size();
    for (std::size_t m = 0; m < members.size(); ++m) {
      add_pieces(members[m], cuts);
      for (std::size_t i = 0; i < count; ++i)  // of the class's order, whichever way the run goes
        sides_.pieces[first + m * count + i].twin =
            static_cast<int>(first + (m + 1) % members.size() * count + i);
    }
  }

  // The vertices and pieces of a run, in the order of its class.
  void add_pieces(int r, const std::vector<double>& cuts) {
    const Run& run = sides_.runs[z(r)];
    std::vector<Attached> fixed = attached_[r];
    for (std::size_t i = 0; i < run.corners.size(); ++i)
      fixed.push_back({i == 0 ? 0 : run.curve.end_of(i - 1), run.corners[i]});
    std::vector<int> vertices;
    for (const double cut : cuts) {
      const double f = common(run, cut);
      int vertex = -1;
      for (const Attached& a : fixed)
        if (std::abs(a.fraction - f) < 2 * kSame) vertex = a.vertex;
      if (vertex < 0) {
        vertex = static_cast<int>(sides_.points[z(run.panel)].size());
        sides_.points[z(run.panel)].push_back(run.curve.at(f));
        sides_.leg_of[z(run.panel)].push_back(leg_at(run, f));
      }
      vertices.push_back(vertex);
    }
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double f = common(run, cuts[i]), g = common(run, cuts[i + 1]);
      Piece piece{r, vertices[i], vertices[i + 1], f, g, leg_at(run, (f + g) / 2), 0};
      if (run.turned) std::swap(piece.a, piece.b), std::swap(piece.f0, piece.f1);
      sides_.pieces.push_back(piece);
    }
  }

  static int leg_at(const Run& run, double f) {
    int i = 0;
    while (z(i) + 1 < run.curve.segments().size() && f > run.curve.end_of(z(i))) ++i;
    return run.first_leg + i;
  }

  static constexpr double kSpacing = 1;  // of the edge: how far apart vertices on a boundary are at most

  const Pattern& pattern_;
  const double edge_, tolerance_, min_angle_;
  Sides sides_;
  std::map<int, std::vector<Attached>> attached_;  // of each run
  std::vector<std::vector<double>> knots_;         // of each class, ascending
};

}  // namespace

double enclosed_area(const Chain& loop) {
  double twice = 0;
  const Vec2 origin = loop.segments.front().start;
  for (const Segment& s : loop.segments) {
    constexpr int parts = 64;
    for (int i = 0; i < parts; ++i) {
      const Vec2 a = point(s, double(i) / parts) - origin, b = point(s, double(i + 1) / parts) - origin;
      twice += a.x() * b.y() - a.y() * b.x();
    }
  }
  return twice / 2;
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

}  // namespace drape
