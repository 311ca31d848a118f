#include "mesh/pattern/sharp_corners.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace drape::internal {
namespace {

constexpr double kSharp = std::numbers::pi / 3;  // rad
constexpr double kSameDistance = 0.1;  // largest relative difference of distances that count as equal
constexpr int kBox = Delaunay::kBoxCorners;

std::size_t z(int i) { return static_cast<std::size_t>(i); }

bool is_on_leg(const Sides& sides, int panel, int vertex, int leg) {
  const std::vector<int>& leg_of = sides.leg_of[z(panel)];
  if (z(vertex) >= leg_of.size()) return false;
  if (leg_of[z(vertex)] != Sides::kCorner) return leg_of[z(vertex)] == leg;
  const std::vector<int>& legs = sides.corner_legs[z(panel)][z(vertex)];
  return std::find(legs.begin(), legs.end(), leg) != legs.end();
}

class CornerFinder {
 public:
  CornerFinder(const Pattern& pattern, double min_angle, Sides& sides)
      : pattern_(pattern), min_angle_(min_angle), sides_(sides) {}

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
      const ChainRun& run = sides_.runs[z(sides_.legs[z(leg)].run)];
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

  const Pattern& pattern_;
  const double min_angle_;
  Sides& sides_;
};

}  // namespace

double leg_fraction(const ChainRun& run, int leg, bool at_end) {
  const int i = leg - run.first_leg + (at_end ? 1 : 0);
  return i == 0 ? 0 : run.curve.end_of(z(i - 1));
}

void find_sharp_corners(const Pattern& pattern, double min_angle, Sides& sides) {
  CornerFinder finder(pattern, min_angle, sides);
  for (std::size_t panel = 0; panel < sides.points.size(); ++panel)
    for (std::size_t v = 0; v < sides.corner_legs[panel].size(); ++v)
      finder.look_at_corner(static_cast<int>(panel), static_cast<int>(v));
}

// The lengths [m] of the first pieces at sharp corners: the same for all legs of a corner, and the same at
// equal fractions of curves that are sewn.
std::vector<double> collars(const Sides& sides, double edge) {
  std::vector<double> length(sides.clusters.size(), 0.6 * edge);
  for (std::size_t c = 0; c < length.size(); ++c)
    for (const auto& [leg, at_end] : sides.clusters[c]) {
      const ChainRun& run = sides.runs[z(sides.legs[z(leg)].run)];
      const double f0 = leg_fraction(run, leg, false), f1 = leg_fraction(run, leg, true);
      length[c] = std::min(length[c], (f1 - f0) * run.curve.length() / 3);
    }
  for (int round = 0; round < 50; ++round) {
    std::map<std::tuple<int, long, bool>, double> ratio;  // by class, place and way: the shortest
    const auto for_each = [&](const auto& f) {
      for (std::size_t c = 0; c < length.size(); ++c)
        for (const auto& [leg, at_end] : sides.clusters[c]) {
          const ChainRun& run = sides.runs[z(sides.legs[z(leg)].run)];
          const long place =
              std::lround(class_fraction(run, leg_fraction(run, leg, at_end)) / (10 * kSameFraction));
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

int corner_of(const Sides& sides, int leg, bool at_end) {
  const ChainRun& run = sides.runs[z(sides.legs[z(leg)].run)];
  return run.corners[z(leg - run.first_leg + (at_end ? 1 : 0))];
}

bool span_sharp_corner(const Sides& sides, const Delaunay& mesh, int panel, int u, int w) {
  const auto try_leg = [&](int leg) {
    for (const bool at_end : {false, true}) {
      const int cluster = sides.legs[z(leg)].sharp[at_end];
      if (cluster < 0) continue;
      const Vec2& apex = mesh.points()[z(corner_of(sides, leg, at_end) + kBox)];
      const double du = (mesh.points()[z(u + kBox)] - apex).norm(),
                   dw = (mesh.points()[z(w + kBox)] - apex).norm();
      if (std::abs(du - dw) > kSameDistance * std::max(du, dw)) continue;
      for (const auto& [other, other_end] : sides.clusters[z(cluster)])
        if ((other != leg || other_end != at_end) && is_on_leg(sides, panel, w, other)) return true;
    }
    return false;
  };
  const std::vector<int>& leg_of = sides.leg_of[z(panel)];
  for (const int v : {u, w})
    if (z(v) >= leg_of.size() || leg_of[z(v)] == Sides::kFree) return false;
  if (leg_of[z(u)] >= 0) return try_leg(leg_of[z(u)]);
  for (const int leg : sides.corner_legs[z(panel)][z(u)])
    if (try_leg(leg)) return true;
  return false;
}

}  // namespace drape::internal
