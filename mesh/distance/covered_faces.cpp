#include "mesh/distance/covered_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/base/parallel.h"
#include "mesh/distance/passing_edges.h"
#include "mesh/triangles/normals.h"

namespace drape::internal {
namespace {

const Vec3 in_the_middle = Vec3::Constant(1.0 / 3);
const std::array samples = {Vec3(0.9, 0.05, 0.05), Vec3(0.05, 0.9, 0.05), Vec3(0.05, 0.05, 0.9),
                            in_the_middle};  // points of a triangle
constexpr double bent_little = 0.7;          // cosine of the angle between normals of a cluster
constexpr double off_the_edge = 1e-6;        // where the neighbour of a triangle has no solid angle
// From so many of its radii on a group counts as one; w is then right within a few percent.
constexpr double far = 2;

// The solid angle of a triangle seen from the origin, positive when its normal points away from there.
//                                                             [Van Oosterom & Strackee 1983, eq. 8]
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

// Divides every group into clusters: from a face on over those beside it whose normals differ little from its
// own.
void CoveredFaces::make_clusters(const std::vector<Face>& faces, const std::vector<Vec3>& x,
                                 const MovingBoxes& boxes) {
  const auto normal = [&](int f) {
    return Vec3(twice_area_normal(x[faces[f].v[0]], x[faces[f].v[1]], x[faces[f].v[2]]).normalized());
  };
  std::vector<int> group_of(faces.size(), -1);
  group_start_.assign(1, 0);
  for (int g = 0; g < static_cast<int>(boxes.patches().size()); ++g) {
    const MovingBoxes::Patch& patch = boxes.patches()[g];
    for (int k = 0; k < patch.count; ++k) group_of[boxes.face(patch.first + k)] = g;
    for (int k = 0; k < patch.count; ++k) {
      const int seed = boxes.face(patch.first + k);
      if (group_of[seed] != g) continue;  // taken already
      const Vec3 axis = normal(seed);
      const std::size_t first = cluster_faces_.size();
      const auto take = [&](int f) {
        if (f < 0 || group_of[f] != g || !(normal(f).dot(axis) > bent_little || f == seed)) return;
        group_of[f] = -1;
        cluster_faces_.push_back(f);
      };
      take(seed);
      for (std::size_t at = first; at < cluster_faces_.size(); ++at)
        for (const int beside : Triangle(faces[cluster_faces_[at]].across)) take(beside);
      clusters_.push_back({static_cast<int>(first), static_cast<int>(cluster_faces_.size() - first)});
    }
    group_start_.push_back(static_cast<int>(clusters_.size()));
  }
  make_neighbours(faces);
  cover_.assign(faces.size(), Cover::none);
  find_parts(faces);
  in_pieces_ = part_start_.size() > 2;
}

void CoveredFaces::make_neighbours(const std::vector<Face>& faces) {
  std::vector<std::pair<int, int>> at, pairs;  // vertex and cluster; two clusters
  for (int c = 0; c < static_cast<int>(clusters_.size()); ++c)
    for (int k = 0; k < clusters_[c].count; ++k)
      for (const int v : faces[cluster_faces_[clusters_[c].first + k]].v) at.emplace_back(v, c);
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  for (std::size_t i = 0, j = 0; i < at.size(); i = j) {
    for (; j < at.size() && at[j].first == at[i].first; ++j)
      for (std::size_t k = i; k <= j; ++k) {
        pairs.emplace_back(at[j].second, at[k].second);
        pairs.emplace_back(at[k].second, at[j].second);
      }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  neighbour_start_.assign(clusters_.size() + 1, 0);
  for (const auto& [cluster, other] : pairs) {
    ++neighbour_start_[cluster + 1];
    neighbours_.push_back(other);
  }
  for (std::size_t c = 0; c < clusters_.size(); ++c) neighbour_start_[c + 1] += neighbour_start_[c];
}

void CoveredFaces::fit_cluster(Cluster& cluster, const std::vector<Face>& faces, const std::vector<Vec3>& x) {
  constexpr int most = 32;  // faces of a group
  constexpr float outwards = 1e-6f;
  std::array<Vec3, most> normals;
  cluster.box.setEmpty();
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < cluster.count; ++k) {
    const Triangle& t = faces[cluster_faces_[cluster.first + k]].v;
    Eigen::AlignedBox3f& box = face_boxes_[cluster.first + k];
    box.setEmpty();
    for (const int v : t) box.extend(x[v].cast<float>());
    const Eigen::Vector3f more = outwards * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs());
    box.min() -= more;
    box.max() += more;
    cluster.box.extend(box);
    normals[k] = twice_area_normal(x[t[0]], x[t[1]], x[t[2]]);
    sum += normals[k];
  }
  cluster.axis = sum.normalized();
  double least = 1;  // cosine
  for (int k = 0; k < cluster.count; ++k)
    if (const double length = normals[k].norm(); length > 0)
      least = std::min(least, cluster.axis.dot(normals[k]) / length);
  cluster.spread = least > 0 ? 1 - 2 * least * least : 2;
}

// A connected surface whose normals all lie in one half-space does not pass through itself, but for what its
// border does.                                                   [Volino & Magnenat-Thalmann 1994, section 3]
bool CoveredFaces::cannot_meet(int cluster, int other) const {
  const Cluster &a = clusters_[cluster], &b = clusters_[other];
  if (!a.box.intersects(b.box)) return true;
  const auto begin = neighbours_.begin() + neighbour_start_[cluster];
  if (!std::binary_search(begin, neighbours_.begin() + neighbour_start_[cluster + 1], other)) return false;
  return a.axis.dot(b.axis) > std::max(a.spread, b.spread);
}

// Calls meet(face, other) for the pairs of faces of two groups that may meet, or of those within one.
template <class Meet>
void CoveredFaces::look_between(int group, int other, const Meet& meet) const {
  for (int c = group_start_[group]; c < group_start_[group + 1]; ++c)
    for (int d = group == other ? c : group_start_[other]; d < group_start_[other + 1]; ++d) {
      if (cannot_meet(c, d)) continue;
      const Cluster &one = clusters_[c], &two = clusters_[d];
      for (int k = one.first; k < one.first + one.count; ++k) {
        if (!face_boxes_[k].intersects(two.box)) continue;
        for (int l = c == d ? k + 1 : two.first; l < two.first + two.count; ++l)
          if (face_boxes_[k].intersects(face_boxes_[l])) meet(cluster_faces_[k], cluster_faces_[l]);
      }
    }
}

void CoveredFaces::look(const std::vector<Face>& faces, const std::vector<Vec3>& x,
                        const MovingBoxes& boxes) {
  any_ = false;
  find_meetings(faces, x, boxes);
  if (lines_.empty() && !in_pieces_) return;
  find_parts(faces);
  group(faces, x, boxes);
  for (std::size_t p = 0; p + 1 < part_start_.size(); ++p) {
    const int first = part_start_[p], last = part_start_[p + 1] - 1;
    const auto covered = [&](int place) { return covers(part_[place], in_the_middle, faces, x, boxes); };
    if (!covered(first) || !covered((first + last) / 2) || !covered(last)) continue;
    any_ = true;
    for (int k = first; k <= last; ++k) cover_[part_[k]] = Cover::all;
  }
  spread_from_lines(faces, x, boxes);
  // What meets others may be covered, too, by a third part of the body. About a line w is on an average half
  // of what is behind both faces more than in front of them.
  std::erase_if(lines_, [&](const MeetingLine& line) {
    const Vec3 middle = line.at(0.5, [&](int v) -> const Vec3& { return x[v]; });
    return winding(middle, line.faces, faces, x, boxes) - 1 > 0.5;
  });
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    if (cover_[f] != Cover::part) continue;
    any_ = true;
    const auto covered = [&](const Vec3& weights) { return covers(f, weights, faces, x, boxes); };
    if (std::all_of(samples.begin(), samples.end(), covered)) cover_[f] = Cover::all;
  }
}

// Where a surface is folded through itself, as in an armpit, the line along which it meets itself ends at a
// vertex of the fold, and what is covered hangs together with what is not. So faces beside the line are
// looked at one by one, and from those that are covered on those beside them.
void CoveredFaces::spread_from_lines(const std::vector<Face>& faces, const std::vector<Vec3>& x,
                                     const MovingBoxes& boxes) {
  seen_.assign(faces.size(), 0);
  part_.clear();
  const auto reach = [&](int face) {
    if (face < 0 || seen_[face] != 0 || cover_[face] != Cover::none) return;
    seen_[face] = 1;
    if (!covers(face, in_the_middle, faces, x, boxes)) return;
    part_.push_back(face);
  };
  const auto reach_from = [&](int face) {
    for (const int other : Triangle(faces[face].across)) reach(other);
  };
  for (int f = 0; f < static_cast<int>(faces.size()); ++f)
    if (cover_[f] == Cover::part) reach_from(f);
  for (std::size_t next = 0; next < part_.size(); ++next) {
    any_ = true;
    cover_[part_[next]] = Cover::all;
    reach_from(part_[next]);
  }
}

void CoveredFaces::find_meetings(const std::vector<Face>& faces, const std::vector<Vec3>& x,
                                 const MovingBoxes& boxes) {
  if (clusters_.empty()) make_clusters(faces, x, boxes);
  cover_.assign(faces.size(), Cover::none);
  lines_.clear();
  meetings_.clear();
  face_boxes_.resize(cluster_faces_.size());
  const auto clusters = static_cast<int>(clusters_.size());
  parallel_for(chunk_count(clusters), false, [&](int chunk) {
    for (int c = chunk * chunk_size; c < std::min(clusters, (chunk + 1) * chunk_size); ++c)
      fit_cluster(clusters_[c], faces, x);
  });
  const auto meet = [&](int s, int t) {
    const Triangle &first = faces[s].v, &second = faces[t].v;
    if (share_a_vertex(first, second) || !boxes_touch(x, first, second)) return;
    MeetingLine line{{}, {s, t}};
    std::size_t ends = 0;
    const auto add = [&](const Triangle& through) {
      return [&](int a, int b) {
        if (ends < 2) line.ends[ends++] = {a, b, share_of_way(x, a, b, through)};
      };
    };
    if (!passing_edges(x, first, second, add(second))) passing_edges(x, second, first, add(first));
    if (ends == 0) return;
    if (ends == 1) line.ends[1] = line.ends[0];
    lines_.push_back(line);
    meetings_.push_back({s, t});
    meetings_.push_back({t, s});
    cover_[s] = cover_[t] = Cover::part;
  };
  boxes.near_patches(
      [&](int group, int other) {
        look_between(group, other, meet);
        return true;
      },
      0);
  std::sort(meetings_.begin(), meetings_.end());
  met_start_.assign(faces.size() + 1, 0);
  met_by_.clear();
  for (const auto& [face, other] : meetings_) {
    ++met_start_[face + 1];
    met_by_.push_back(other);
  }
  for (std::size_t f = 0; f < faces.size(); ++f) met_start_[f + 1] += met_start_[f];
}

std::span<const int> CoveredFaces::met_by(int face) const {
  return std::span(met_by_).subspan(met_start_[face], met_start_[face + 1] - met_start_[face]);
}

// The faces that meet none fall into parts, between which there are only such that do.
void CoveredFaces::find_parts(const std::vector<Face>& faces) {
  part_start_.assign(1, 0);
  part_.clear();
  seen_.assign(faces.size(), 0);
  const auto reach = [&](int face) {
    if (face < 0 || seen_[face] != 0 || cover_[face] == Cover::part) return;
    seen_[face] = 1;
    part_.push_back(face);
  };
  for (int seed = 0; seed < static_cast<int>(faces.size()); ++seed) {
    std::size_t next = part_.size();
    reach(seed);
    if (next == part_.size()) continue;
    for (; next < part_.size(); ++next) {
      const Triangle across = faces[part_[next]].across;
      for (const int other : across) reach(other);
    }
    part_start_.push_back(static_cast<int>(part_.size()));
  }
}

void CoveredFaces::group(const std::vector<Face>& faces, const std::vector<Vec3>& x,
                         const MovingBoxes& boxes) {
  groups_.assign(boxes.patches().size(), {});
  for (std::size_t p = 0; p < groups_.size(); ++p) {
    const MovingBoxes::Patch& patch = boxes.patches()[p];
    Group& group = groups_[p];
    for (int k = 0; k < patch.count; ++k) {
      const Triangle& t = faces[boxes.face(patch.first + k)].v;
      group.middle += (x[t[0]] + x[t[1]] + x[t[2]]) / (3 * patch.count);
      group.area += 0.5 * twice_area_normal(x[t[0]], x[t[1]], x[t[2]]);
    }
    for (int k = 0; k < patch.count; ++k)
      for (const int v : faces[boxes.face(patch.first + k)].v)
        group.radius = std::max(group.radius, (x[v] - group.middle).norm());
  }
}

// Seen from a point of a face, half of what is behind the face adds to w in front of it.
bool CoveredFaces::covers(int face, const Vec3& weights, const std::vector<Face>& faces,
                          const std::vector<Vec3>& x, const MovingBoxes& boxes) const {
  const Triangle& own = faces[face].v;
  const Vec3 in = (1 - off_the_edge) * weights + off_the_edge * in_the_middle;
  const Vec3 from = in[0] * x[own[0]] + in[1] * x[own[1]] + in[2] * x[own[2]];
  if (!has_area(x[own[0]], x[own[1]], x[own[2]])) return true;  // its neighbours decide
  return winding(from, {face, face}, faces, x, boxes) - 0.5 > 0.5;
}

double CoveredFaces::winding(const Vec3& from, const std::array<int, 2>& without,
                             const std::vector<Face>& faces, const std::vector<Vec3>& x,
                             const MovingBoxes& boxes) const {
  double sum = 0;
  for (std::size_t p = 0; p < groups_.size(); ++p) {
    const Group& group = groups_[p];
    const Vec3 way = group.middle - from;
    const double distance = way.norm();
    if (distance > far * group.radius) {
      sum += group.area.dot(way) / (distance * distance * distance);
      continue;
    }
    const MovingBoxes::Patch& patch = boxes.patches()[p];
    for (int k = 0; k < patch.count; ++k) {
      const int face = boxes.face(patch.first + k);
      const Triangle& t = faces[face].v;
      if (face != without[0] && face != without[1])
        sum += solid_angle(x[t[0]] - from, x[t[1]] - from, x[t[2]] - from);
    }
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace drape::internal
