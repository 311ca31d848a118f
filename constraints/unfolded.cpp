#include "constraints/unfolded.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "constraints/shadow_hull.h"
#include "mesh/base/parallel.h"

namespace drape::internal {
namespace {

constexpr double rounding = 1e-6;      // of e
constexpr double clearly_apart = 0.3;  // an e that is not looked at more closely
constexpr int looks_spared = 8;        // where something was folded
constexpr double small_drift = 0.05;   // less is added to e, where nothing was folded, and G stays

const double half = std::sqrt(0.5);

// The rotation of the plane that is nearest to what takes its two directions to a and b.
std::array<Vec3, 2> orthonormal(const Vec3& a, const Vec3& b) {
  const Vec3 first = a.normalized(), second = b.normalized();
  const Vec3 both = (first + second).normalized(), between = (first - second).normalized();
  return {half * (both + between), half * (both - between)};
}

// Infinity where either is no number.
double larger(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::infinity();
  return std::max(a, b);
}

// change <- places - known, known <- places. Returns whether anything changes.
bool take(const std::vector<Vec3>& places, std::vector<Vec3>& known, std::vector<Vec3>& change) {
  if (places == known) return false;
  change.resize(known.size());
  for_chunks(static_cast<int>(known.size()), [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      change[i] = places[i] - known[i];
      known[i] = places[i];
    }
  });
  return true;
}

double norm(double a, double b) { return std::sqrt(a * a + b * b); }

// Of a 2 x 2 matrix with these squares of its columns and their product.
double largest_square(double p, double q, double product) {
  return 0.5 * (p + q) + std::sqrt(0.25 * (p - q) * (p - q) + product * product);
}

}  // namespace

// Finds the regions: about the triangles of each vertex, and of every two patches that have a vertex in
// common, or of one. Each is found by itself, on any thread.
class Unfolded::Builder {
 public:
  Builder(Unfolded& unfolded, const std::vector<Face>& faces, const MovingBoxes& boxes,
          const std::vector<Vec3>& places)
      : unfolded_(unfolded),
        faces_(faces),
        places_(places),
        patch_of_(faces.size()),
        of_patch_(boxes.patches().size()),
        around_(places.size()) {
    for (std::size_t p = 0; p < of_patch_.size(); ++p) {
      const MovingBoxes::Patch& patch = boxes.patches()[p];
      for (int k = patch.first; k < patch.first + patch.count; ++k) {
        patch_of_[boxes.face(k)] = static_cast<int>(p);
        of_patch_[p].push_back(boxes.face(k));
      }
    }
    for (int f = 0; f < static_cast<int>(faces.size()); ++f)
      for (int v : faces[f].v)
        if (around_[v].empty() || around_[v].back() != f) around_[v].push_back(f);
  }

  void build() {
    find_pairs();
    const int vertices = static_cast<int>(around_.size());
    const int count = vertices + static_cast<int>(unfolded_.pairs_.size());
    candidates_.resize(count);
    // Each part has a ShadowHull, with marks for all faces and vertices. So there are few parts.
    constexpr int parts = 32;
    const auto first_of = [&](int part) { return static_cast<int>(std::int64_t{count} * part / parts); };
    parallel_for(parts, count < serial_below(Work::heavy), [&](int part) {
      ShadowHull hull(faces_, places_);
      for (int k = first_of(part); k < first_of(part + 1); ++k)
        if (k < vertices)
          look(around_[k], hull, candidates_[k]);
        else
          look(faces_of(unfolded_.pairs_[k - vertices]), hull, candidates_[k]);
    });
    number_sets();
    for (int k = 0; k < count; ++k)
      (k < vertices ? unfolded_.of_vertex_ : unfolded_.of_pair_).push_back(add_region(candidates_[k]));
  }

 private:
  struct Candidate {
    std::vector<int> by;   // the patches that it is about
    std::vector<int> all;  // those over the hull of their shadow; none: it is no region
    Vec3 normal;
    double slope, height;
    int set;
  };

  void find_pairs() {
    std::vector<std::pair<int, int>>& pairs = unfolded_.pairs_;
    std::vector<int> here;
    for (const std::vector<int>& faces : around_) {
      patches_of(faces, here);
      for (std::size_t k = 0; k < here.size(); ++k)
        for (std::size_t l = k; l < here.size(); ++l) pairs.emplace_back(here[k], here[l]);
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  }

  std::vector<int> faces_of(const std::pair<int, int>& patches) const {
    std::vector<int> faces = of_patch_[patches.first];
    const std::vector<int>& other = of_patch_[patches.second];
    if (patches.second != patches.first) faces.insert(faces.end(), other.begin(), other.end());
    return faces;
  }

  void look(const std::vector<int>& faces, ShadowHull& hull, Candidate& found) const {
    if (faces.empty()) return;
    patches_of(faces, found.by);
    found.normal.setZero();
    for (int p : found.by) found.normal += unfolded_.normals_[p];
    found.normal.normalize();
    if (!hull.covers(faces, found.normal)) return;
    patches_of(hull.found(), found.all);
    found.slope = hull.slope();
    found.height = hull.height();
  }

  // Regions of the same patches, about the same ones of them, are looked at together.
  void number_sets() {
    std::vector<Candidate*> regions;
    for (Candidate& c : candidates_)
      if (!c.all.empty()) regions.push_back(&c);
    const auto patches = [](const Candidate* c) { return std::tie(c->by, c->all); };
    std::sort(regions.begin(), regions.end(),
              [&](const Candidate* a, const Candidate* b) { return patches(a) < patches(b); });
    for (std::size_t k = 0; k < regions.size(); ++k) {
      Candidate& c = *regions[k];
      if (k == 0 || patches(regions[k - 1]) != patches(&c)) {
        std::vector<int>& all = unfolded_.set_patches_;
        const int from = static_cast<int>(all.size());
        all.insert(all.end(), c.all.begin(), c.all.end());
        unfolded_.sets_.push_back({.from = from, .to = static_cast<int>(all.size()), .normal = c.normal});
      }
      c.set = static_cast<int>(unfolded_.sets_.size()) - 1;
      PatchSet& set = unfolded_.sets_.back();
      set.slope = std::max(set.slope, c.slope);
      set.height = std::min(set.height, c.height);
    }
  }

  int add_region(const Candidate& c) {
    if (c.all.empty()) return -1;
    unfolded_.regions_.push_back({c.set, c.height});
    return static_cast<int>(unfolded_.regions_.size()) - 1;
  }

  void patches_of(const std::vector<int>& faces, std::vector<int>& patches) const {
    patches.clear();
    for (int f : faces) patches.push_back(patch_of_[f]);
    std::sort(patches.begin(), patches.end());
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
  }

  Unfolded& unfolded_;
  const std::vector<Face>& faces_;
  const std::vector<Vec3>& places_;
  std::vector<int> patch_of_;
  std::vector<std::vector<int>> of_patch_, around_;  // faces: of each patch, and around each vertex
  std::vector<Candidate> candidates_;
};

Unfolded::Unfolded(const std::vector<Face>& faces, const MovingBoxes& boxes, const std::vector<Vec3>& places)
    : shapes_from_(1, 0), ends_(boxes.patches().size()), change_(ends_.size()), places_{places, places} {
  for (const MovingBoxes::Patch& patch : boxes.patches()) {
    Vec3 normal = Vec3::Zero();
    for (int k = patch.first; k < patch.first + patch.count; ++k) {
      const Triangle& v = faces[boxes.face(k)].v;
      normal += (places[v[1]] - places[v[0]]).cross(places[v[2]] - places[v[0]]);
      add_shape(v, places);
    }
    shapes_from_.push_back(static_cast<int>(shapes_.size()));
    normals_.push_back(normal.normalized());
    planes_.push_back(plane_across(normals_.back()));
  }
  Builder(*this, faces, boxes, places).build();
  apart_.assign(regions_.size(), 0);
}

void Unfolded::add_shape(const Triangle& v, const std::vector<Vec3>& places) {
  const Vec3 a = places[v[1]] - places[v[0]], b = places[v[2]] - places[v[0]];
  if (!has_area(places[v[0]], places[v[1]], places[v[2]])) return;  // no region has it
  const Vec3 t = a.normalized(), across = b - t.dot(b) * t;
  shapes_.push_back({v, {t, across.normalized()}, 1 / a.norm(), t.dot(b) / a.norm(), 1 / across.norm()});
}

int Unfolded::region_of(int first, int second) const {
  const std::pair pair(first, second);
  const auto at = std::lower_bound(pairs_.begin(), pairs_.end(), pair);
  return at == pairs_.end() || *at != pair ? -1 : of_pair_[at - pairs_.begin()];
}

std::span<const int> Unfolded::patches_of(const PatchSet& set) const {
  return std::span(set_patches_).subspan(set.from, set.to - set.from);
}

void Unfolded::look(const std::vector<Vec3>& start, const std::vector<Vec3>& end, double gap) {
  const auto is_apart = [gap](const PatchSet& set, double height) { return (1 - set.off) * height > gap; };
  const auto each_patch = [this](const auto& use) {
    for_chunks<Work::heavy>(static_cast<int>(ends_.size()), [&](int from, int to) {
      for (int p = from; p < to; ++p) use(p, ends_[p]);
    });
  };
  const auto each_set = [this](const auto& use) {
    for_chunks<Work::heavy>(static_cast<int>(sets_.size()), [&](int from, int to) {
      for (int k = from; k < to; ++k) use(sets_[k]);
    });
  };
  const std::array<bool, 2> changes = {take(start, places_[0], motion_[0]),
                                       take(end, places_[1], motion_[1])};
  each_patch([&](int p, Ends& ends) {
    change_[p] = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      if (!changes[k]) continue;
      const double change = change_of(p, motion_[k]);
      ends.turn[k].drift += change;
      change_[p] = larger(change_[p], change);
    }
  });
  each_set([&](PatchSet& set) {
    double change = 0;
    for (int p : patches_of(set)) change = larger(change, change_[p]);
    set.off += longest_of(set) * change;
    set.wanted = !is_apart(set, set.height) && --set.rests < 0;
  });
  for (const PatchSet& set : sets_)
    if (set.wanted)
      for (int p : patches_of(set))
        ends_[p].most_drift = std::min(ends_[p].most_drift, set.folded ? 0 : small_drift);
  each_patch([&](int p, Ends& ends) {
    const double most_drift = std::exchange(ends.most_drift, infinity);
    for (std::size_t k = 0; k < 2; ++k)
      if (most_drift < infinity && !(ends.turn[k].drift < most_drift)) ends.turn[k] = turn_of(p, places_[k]);
  });
  each_set([&](PatchSet& set) {
    if (!set.wanted) return;
    set.off = off_of(set) + rounding;
    set.folded = !is_apart(set, set.height);
    set.rests = set.folded ? looks_spared : 0;
  });
  for (std::size_t k = 0; k < regions_.size(); ++k)
    apart_[k] = is_apart(sets_[regions_[k].set], regions_[k].height);
}

// |dF| where the places change so, at most.
double Unfolded::change_of(int patch, const std::vector<Vec3>& change) const {
  double most = 0;
  for (int k = shapes_from_[patch]; k < shapes_from_[patch + 1]; ++k) {
    const Shape& s = shapes_[k];
    const Vec3 a = change[s.v[1]] - change[s.v[0]], b = change[s.v[2]] - change[s.v[0]] - s.along * a;
    most = larger(most, a.squaredNorm() * s.inverse_length * s.inverse_length +
                            b.squaredNorm() * s.inverse_height * s.inverse_height);
  }
  return std::sqrt(most);
}

Unfolded::Turn Unfolded::turn_of(int patch, const std::vector<Vec3>& x) const {
  const int from = shapes_from_[patch], to = shapes_from_[patch + 1];
  const auto& [u, v] = planes_[patch];
  std::array<Plane, MovingBoxes::most_in_a_patch> F;  // along t_0 and t_1
  Vec3 of_u = Vec3::Zero(), of_v = Vec3::Zero();
  for (int k = from; k < to; ++k) {
    const Shape& s = shapes_[k];
    const Vec3 a = x[s.v[1]] - x[s.v[0]], b = x[s.v[2]] - x[s.v[0]];
    Plane& f = F[static_cast<std::size_t>(k - from)];
    f = {a * s.inverse_length, (b - s.along * a) * s.inverse_height};
    of_u += s.t[0].dot(u) * f[0] + s.t[1].dot(u) * f[1];
    of_v += s.t[0].dot(v) * f[0] + s.t[1].dot(v) * f[1];
  }
  const Plane now = orthonormal(of_u, of_v);
  const Vec3 n = now[0].cross(now[1]);
  Turn turn;
  turn.G = now[0] * u.transpose() + now[1] * v.transpose() + n * normals_[patch].transpose();
  turn.q = Eigen::Quaterniond(turn.G).coeffs();
  // Squares. What is drawn to a line has turned in no one way.
  double in_plane = turn.G.determinant() > 1 - rounding ? 0 : infinity, out_of_plane = 0;
  for (int k = from; k < to; ++k) {
    const Shape& s = shapes_[k];
    const Plane& f = F[static_cast<std::size_t>(k - from)];
    Vec3 a = f[0] - turn.G * s.t[0], b = f[1] - turn.G * s.t[1];
    const double over_a = n.dot(a), over_b = n.dot(b);
    a -= over_a * n;
    b -= over_b * n;
    const double here = largest_square(a.squaredNorm(), b.squaredNorm(), a.dot(b));
    in_plane = larger(in_plane, here);
    out_of_plane = std::max(out_of_plane, over_a * over_a + over_b * over_b);
  }
  turn.in_plane = std::sqrt(in_plane);
  turn.out_of_plane = std::sqrt(out_of_plane);
  return turn;
}

// e for the mean of how the patches have turned at the start.
double Unfolded::off_of(const PatchSet& set) const {
  const double least = off_by_angles(set);
  if (least <= clearly_apart) return least;
  const auto [u, v] = plane_across(set.normal);
  Vec3 of_u = Vec3::Zero(), of_v = Vec3::Zero();
  for (int p : patches_of(set)) {
    of_u += ends_[p].turn[0].G * u;
    of_v += ends_[p].turn[0].G * v;
  }
  const Plane R = orthonormal(of_u, of_v);
  const double longest = longest_of(set);
  double off = 0;
  for (int p : patches_of(set))
    for (const Turn& turn : ends_[p].turn) {
      const Vec3 a = turn.G * u, b = turn.G * v, c = turn.G * set.normal, n = turn.G * normals_[p];
      const double aa = R[0].dot(a), bb = R[1].dot(b), shear = 0.5 * (R[0].dot(b) + R[1].dot(a));
      const double turned = 0.5 * (aa + bb) - std::sqrt(0.25 * (aa - bb) * (aa - bb) + shear * shear);
      const double tilted = norm(R[0].dot(c), R[1].dot(c)), bent = norm(R[0].dot(n), R[1].dot(n));
      const double here =
          1 - turned + set.slope * tilted + longest * (turn.in_plane + bent * turn.out_of_plane + turn.drift);
      off = larger(off, here);
    }
  return std::min(least, off);
}

// |t| in a region of the set, at most.
double Unfolded::longest_of(const PatchSet& set) { return std::sqrt(1 + set.slope * set.slope); }

// An upper bound of e that costs little: by the largest angle between a patch and their mean.
double Unfolded::off_by_angles(const PatchSet& set) const {
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  for (int p : patches_of(set)) {
    const Eigen::Vector4d& q = ends_[p].turn[0].q;
    mean += q.dot(mean) < 0 ? -q : q;
  }
  mean.normalize();
  double cosine = 1, in_plane = 0, out_of_plane = 0, drift = 0;  // cosine: of half the angle
  for (int p : patches_of(set))
    for (const Turn& turn : ends_[p].turn) {
      cosine = std::min(cosine, std::abs(turn.q.dot(mean)));
      in_plane = std::max(in_plane, turn.in_plane);
      out_of_plane = std::max(out_of_plane, turn.out_of_plane);
      drift = std::max(drift, turn.drift);
    }
  return longest_of(set) * (norm(in_plane, out_of_plane) + drift + 2 * std::sqrt(1 - cosine * cosine));
}

}  // namespace drape::internal
