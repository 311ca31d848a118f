// Signed distance to a triangle surface. A tree proposes the triangles that may be nearest. The closest point
// of each is computed here in double precision, and the feature (vertex, edge or face) that holds it tells
// the side.
//   phi(x) = s |x - c|,  s = sign((x - c) . n_c),  n_c the angle-weighted pseudo-normal of the feature at c
//                         [Baerentzen & Aanaes 2005]
// Where a closed body overlaps itself, the nearest point c may be on a part of the surface that lies inside.
// Then x is inside, too (from outside a straight way to the nearest point meets no surface before), and the
// distance is that to the nearest point that does not lie inside: on a face, or on the line along which two
// faces meet. A surface at rest is searched with Embree's tree and keeps its normals. A moving surface is
// searched with our own boxes, and its normals are made for the s that is asked for: normals interpolated
// between those at the start and at the end of the step could tell the wrong side.
#include "mesh/distance/surface_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/base/errors.h"
#include "mesh/distance/closest_on_triangle.h"
#include "mesh/distance/covered_faces.h"
#include "mesh/distance/crossing.h"
#include "mesh/distance/moving_boxes.h"
#include "mesh/distance/surface_faces.h"
#include "mesh/distance/surface_pose.h"
#include "mesh/distance/triangle_tree.h"
#include "mesh/triangles/normals.h"

namespace drape {

using namespace internal;

namespace {

constexpr double touching = 1e-12;  // m: a point nearer than this is on the surface
constexpr double blurred = 1e-9;    // of the surface's size: nearer than this, x - c is mostly rounding
constexpr double grazing = 1e-9;    // the sine of an angle below which a way goes along the surface

struct Candidate {
  double squared = std::numeric_limits<double>::infinity();
  int face = -1;
  int feature = on_face;
  Vec3 point = Vec3::Zero();

  // Takes the face if it is nearer than those before it. Of equally near faces the one with the lowest number
  // counts.
  bool offer(int f, const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto [nearest, where] = closest_on_triangle(x, a, b, c);
    const double there = (x - nearest).squaredNorm();
    if (!(there < squared || (there == squared && f < face))) return false;
    *this = {there, f, where, nearest};
    return true;
  }
  template <class Places>
  Vec3 weights(const SurfacePose<Places>& pose) const {
    return weights_on_triangle(point, feature, pose.corner(face, 0), pose.corner(face, 1),
                               pose.corner(face, 2));
  }
};

// A frame of three axes: along a triangle's first side, across that side within the triangle, and along the
// normal.
Mat3 frame(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 side = b - a, normal = twice_area_normal(a, b, c);
  const Vec3 along = side.norm() > 0 ? Vec3(side.normalized()) : Vec3(Vec3::UnitX());
  const Vec3 out = normal.norm() > 0 ? Vec3(normal.normalized()) : Vec3(along.unitOrthogonal());
  Mat3 axes;
  axes << along, out.cross(along), out;
  return axes;
}

}  // namespace

struct SurfaceDistance::Tree {
  explicit Tree(const TriangleMesh& surface);

  TriangleMesh mesh;
  SurfaceFaces surface;
  std::vector<Vec3> vertex_normals;  // of the surface at rest
  Vec3 centre = Vec3::Zero();
  double size = 0;  // m, diagonal of the box
  std::optional<TriangleTree> standing;
  CoveredFaces covered_at_start, covered_at_end;

  // The current step; the first call of move() makes it.
  bool moving = false;
  std::vector<Vec3> start, end;
  bool changes = false;         // whether the surface is not the same at the start and at the end
  std::vector<Vec3> looked_at;  // the places of the vertices that covered_at_end is of [m]
  SurfaceMotion motion;
  std::optional<MovingBoxes> boxes;
  std::vector<int> corner_start, corners;  // 3 face + k of the corners at each vertex, ascending
  std::vector<int> carriers;               // vertices with a triangle, ascending

  void measure();
  void grow();
  void make_ready();
  void begin_step();
  void look_for_covered();
  // As the surface is at the nearer end of the step.
  const CoveredFaces& covered(double s) const {
    return changes && s < 0.5 ? covered_at_start : covered_at_end;
  }
  static double time_of(const SurfacePose<Standing>&) { return 1; }
  static double time_of(const SurfacePose<Moving>& pose) { return pose.places().s; }
  // The nearest point of those faces that take(the point of the face nearest to x) accepts.
  template <class Take>
  Candidate find(const Vec3& x, const SurfacePose<Standing>& pose, const Take& take) const;
  template <class Take>
  Candidate find(const Vec3& x, const SurfacePose<Moving>& pose, const Take& take) const;
  // The nearest point of all of the surface. When that is covered, `deep` is set, and it is the nearest that
  // is not.
  template <class Places>
  Candidate find(const Vec3& x, const SurfacePose<Places>& pose, bool& deep) const;
  template <class Places>
  bool is_covered(const Candidate& c, const SurfacePose<Places>& pose) const;
  // The same, quicker, and not right where three parts of the body overlap.
  template <class Places>
  bool seems_covered(const Candidate& c, const SurfacePose<Places>& pose) const;
  template <class Places>
  void offer_lines(const Vec3& x, const std::vector<MeetingLine>& lines, const SurfacePose<Places>& pose,
                   Candidate& best) const;
  Vec3 vertex_normal(int v, const SurfacePose<Standing>&) const { return vertex_normals[v]; }
  Vec3 vertex_normal(int v, const SurfacePose<Moving>& pose) const;
  template <class Places>
  Vec3 pseudo_normal(const Candidate& c, const SurfacePose<Places>& pose) const;
  template <class Places>
  SurfacePoint answer(const Vec3& x, const Candidate& c, const SurfacePose<Places>& pose) const;
  template <class Places>
  SurfacePoint closest(const Vec3& x, const SurfacePose<Places>& pose, Candidate& found) const;
  Vec3 displacement(int face, const Vec3& weights) const;
  template <class Places>
  Anchor anchor(const Vec3& x, const Candidate& c, const SurfacePose<Places>& pose) const;

  // Calls f(pose) with the configuration of the surface at s.
  template <class F>
  auto in_pose(double s, const F& f) const {
    return moving ? f(SurfacePose<Moving>(surface, {start, end, s}))
                  : f(SurfacePose<Standing>(surface, {mesh.positions}));
  }
};

SurfaceDistance::Tree::Tree(const TriangleMesh& given) : mesh(given), surface(surface_faces(given)) {
  measure();
  grow();
  vertex_normals.assign(mesh.positions.size(), Vec3::Zero());
  const SurfacePose<Standing> pose(surface, {mesh.positions});
  for (int f = 0; f < static_cast<int>(surface.faces.size()); ++f)
    for (int k = 0; k < 3; ++k) vertex_normals[surface.faces[f].v[k]] += pose.angle_weighted(f, k);
  if (!surface.closed) return;
  start = end = mesh.positions;
  begin_step();
  covered_at_start = covered_at_end;  // with the clusters of the surface at rest
}

void SurfaceDistance::Tree::measure() {
  const Eigen::AlignedBox3d box = box_of(surface, mesh.positions);
  centre = box.center();
  size = box.diagonal().norm();
}

void SurfaceDistance::Tree::grow() {
  std::vector<Triangle> triangles;
  triangles.reserve(static_cast<std::size_t>(surface.with_area));
  for (int f = 0; f < surface.with_area; ++f) triangles.push_back(surface.faces[f].v);
  standing.emplace(mesh.positions, triangles, centre);
}

// Makes what a moving surface needs: the boxes, and the list of corners at each vertex.
void SurfaceDistance::Tree::make_ready() {
  boxes.emplace(surface.faces, mesh.positions);
  corner_start.assign(mesh.positions.size() + 1, 0);
  for (const Face& f : surface.faces)
    for (int v : f.v) ++corner_start[v + 1];
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (corner_start[v + 1] > 0) carriers.push_back(v);
    corner_start[v + 1] += corner_start[v];
  }
  corners.resize(3 * surface.faces.size());
  std::vector<int> at = corner_start;
  for (int f = 0; f < static_cast<int>(surface.faces.size()); ++f)
    for (int k = 0; k < 3; ++k) corners[at[surface.faces[f].v[k]]++] = 3 * f + k;
}

void SurfaceDistance::Tree::begin_step() {
  moving = start != mesh.positions || end != mesh.positions;
  motion = {};
  if (!boxes) make_ready();
  boxes->refit(surface.faces, start, end);
  if (surface.closed) look_for_covered();
  if (!moving) return;
  for (int v : carriers) motion.mean += end[v] - start[v];
  motion.mean /= static_cast<double>(carriers.size());
  for (int v : carriers) {
    motion.largest = std::max(motion.largest, (end[v] - start[v]).norm());
    motion.about_mean = std::max(motion.about_mean, (end[v] - start[v] - motion.mean).norm());
  }
}

// Most steps begin where the last one ended, and a body that stands is looked at once.
void SurfaceDistance::Tree::look_for_covered() {
  changes = start != end;
  if (looked_at != start) covered_at_end.look(surface.faces, start, *boxes);
  looked_at = end;
  if (!changes) return;
  std::swap(covered_at_start, covered_at_end);
  covered_at_end.look(surface.faces, end, *boxes);
}

// The search radius stays a little longer than the best distance, by more than Embree's rounding to float, so
// that no nearer triangle and no tie is passed over.
template <class Take>
Candidate SurfaceDistance::Tree::find(const Vec3& x, const SurfacePose<Standing>&, const Take& take) const {
  Candidate best;
  const std::vector<Vec3>& p = mesh.positions;
  auto offer = [&](int f, float radius) {
    const Triangle& t = surface.faces[f].v;
    Candidate better = best;
    if (!better.offer(f, x, p[t[0]], p[t[1]], p[t[2]]) || !take(better)) return radius;
    best = better;
    return static_cast<float>(std::sqrt(best.squared) * (1 + 1e-5) + 1e-6 * size);
  };
  standing->near(x, offer);
  return best;
}

// Faces that have no area at s are left to their neighbours, unless no other face is there.
template <class Take>
Candidate SurfaceDistance::Tree::find(const Vec3& x, const SurfacePose<Moving>& pose,
                                      const Take& take) const {
  Candidate best;
  for (bool flat_ones : {false, true}) {
    boxes->near(x, pose.places().s, [&](int f) {
      Candidate better = best;
      if (better.offer(f, x, pose.corner(f, 0), pose.corner(f, 1), pose.corner(f, 2)) &&
          (flat_ones || !pose.flat(f)) && take(better))
        best = better;
      return best.squared;
    });
    if (best.face >= 0) break;
  }
  return best;
}

template <class Places>
Candidate SurfaceDistance::Tree::find(const Vec3& x, const SurfacePose<Places>& pose, bool& deep) const {
  const Candidate nearest = find(x, pose, [](const Candidate&) { return true; });
  deep = nearest.face >= 0 && is_covered(nearest, pose);
  if (!deep) return nearest;
  Candidate best =
      find(x, pose, [&](const Candidate& c) { return !seems_covered(c, pose) && !is_covered(c, pose); });
  offer_lines(x, covered(time_of(pose)).lines(), pose, best);
  deep = best.face >= 0;
  return deep ? best : nearest;
}

// A point of a face that others pass through is looked at where it is at the end of the step, or at its
// start.
template <class Places>
bool SurfaceDistance::Tree::is_covered(const Candidate& c, const SurfacePose<Places>& pose) const {
  const double s = time_of(pose);
  const Cover cover = covered(s)[c.face];
  if (cover != Cover::part) return cover == Cover::all;
  return covered(s).covers(c.face, c.weights(pose), surface.faces, s < 0.5 ? start : end, *boxes);
}

// A point of a face is covered where it is behind the nearest of those that pass through the face.
template <class Places>
bool SurfaceDistance::Tree::seems_covered(const Candidate& c, const SurfacePose<Places>& pose) const {
  const CoveredFaces& now = covered(time_of(pose));
  if (now[c.face] != Cover::part) return now[c.face] == Cover::all;
  Candidate nearest;
  for (const int other : now.met_by(c.face))
    nearest.offer(other, c.point, pose.corner(other, 0), pose.corner(other, 1), pose.corner(other, 2));
  return nearest.face >= 0 && (c.point - nearest.point).dot(pseudo_normal(nearest, pose)) < 0;
}

template <class Places>
void SurfaceDistance::Tree::offer_lines(const Vec3& x, const std::vector<MeetingLine>& lines,
                                        const SurfacePose<Places>& pose, Candidate& best) const {
  for (const MeetingLine& line : lines) {
    const Vec3 from = line.at(0, pose.places()), way = line.at(1, pose.places()) - from;
    const double length = way.squaredNorm();
    const double share = length > 0 ? std::clamp(way.dot(x - from) / length, 0.0, 1.0) : 0;
    const Vec3 point = from + share * way;
    const double squared = (x - point).squaredNorm();
    if (squared < best.squared) best = {squared, line.faces[0], on_face, point};
  }
}

// The sum of the normals of the faces around a vertex, each weighted by its angle there.
Vec3 SurfaceDistance::Tree::vertex_normal(int v, const SurfacePose<Moving>& pose) const {
  Vec3 sum = Vec3::Zero();
  for (int i = corner_start[v]; i < corner_start[v + 1]; ++i)
    sum += pose.angle_weighted(corners[i] / 3, corners[i] % 3);
  return sum;
}

template <class Places>
Vec3 SurfaceDistance::Tree::pseudo_normal(const Candidate& c, const SurfacePose<Places>& pose) const {
  const Vec3 face_normal = pose.plain_normal(c.face);
  Vec3 n = face_normal;
  if (c.feature < on_edge) n = vertex_normal(surface.faces[c.face].v[c.feature], pose);
  if (c.feature >= on_edge && c.feature < on_face) n += pose.normal_beyond(c.face, c.feature - on_edge);
  const double length = n.norm();
  return length > 1e-9 ? Vec3(n / length) : face_normal;  // a sheet folded flat on itself has no other
}

template <class Places>
SurfacePoint SurfaceDistance::Tree::answer(const Vec3& x, const Candidate& c,
                                           const SurfacePose<Places>& pose) const {
  if (c.face < 0) return {std::numeric_limits<double>::quiet_NaN(), Vec3::UnitY()};  // x is not finite
  const Vec3 offset = x - c.point;
  const double d = offset.norm();
  const Vec3 n = pseudo_normal(c, pose);
  const double side = offset.dot(n) < 0 ? -1 : 1;
  const bool clear = d >= touching && d >= blurred * size;
  // On a face, the normal of the face has more digits than offset / d.
  const bool by_offset = clear && c.feature != on_face;
  const Vec3 away = by_offset ? Vec3(offset / d) : Vec3(side * n);
  if (surface.closed) return {side * d, side * away};
  return {d, d < touching ? n : away};
}

template <class Places>
SurfacePoint SurfaceDistance::Tree::closest(const Vec3& x, const SurfacePose<Places>& pose,
                                            Candidate& found) const {
  bool deep = false;
  found = find(x, pose, deep);
  const double d = std::sqrt(found.squared);
  if (!deep || found.face < 0) return answer(x, found, pose);
  return {-d, d < touching ? pseudo_normal(found, pose) : Vec3((found.point - x) / d), true};
}

Vec3 SurfaceDistance::Tree::displacement(int face, const Vec3& weights) const {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const int v = surface.faces[face].v[k];
    if (weights[k] != 0) sum += weights[k] * (end[v] - start[v]);
  }
  return sum;
}

SurfaceDistance::SurfaceDistance(const TriangleMesh& mesh) : tree_(std::make_unique<Tree>(mesh)) {}
SurfaceDistance::~SurfaceDistance() = default;

void SurfaceDistance::move(const std::vector<Vec3>& start, const std::vector<Vec3>& end) {
  for (const std::vector<Vec3>* places : {&start, &end})
    if (places->size() != tree_->mesh.positions.size())
      throw InputError("a body of " + std::to_string(tree_->mesh.vertex_count()) +
                       " vertices cannot be moved to " + std::to_string(places->size()) + " places");
  tree_->start = start;
  tree_->end = end;
  tree_->begin_step();
}

void SurfaceDistance::move(const MeshFrames& frames, double t0, double t1) {
  if (frames.vertex_count() != tree_->mesh.vertex_count())
    throw InputError("a body of " + std::to_string(tree_->mesh.vertex_count()) +
                     " vertices cannot be moved by frames of " + std::to_string(frames.vertex_count()));
  frames.positions_at(t0, tree_->start);
  frames.positions_at(t1, tree_->end);
  tree_->begin_step();
}

const SurfaceMotion& SurfaceDistance::motion() const { return tree_->motion; }

SurfacePoint SurfaceDistance::closest(const Vec3& x, double s) const {
  Candidate found;
  return tree_->in_pose(s, [&](const auto& pose) { return tree_->closest(x, pose, found); });
}

SurfacePoint SurfaceDistance::closest(const Vec3& x, double s, Vec3& displacement) const {
  return tree_->in_pose(s, [&](const auto& pose) {
    Candidate c;
    const SurfacePoint surface = tree_->closest(x, pose, c);
    const bool moves = tree_->moving && c.face >= 0;
    displacement = moves ? tree_->displacement(c.face, c.weights(pose)) : Vec3(Vec3::Zero());
    return surface;
  });
}

std::optional<double> SurfaceDistance::first_crossing(const Vec3& x0, const Vec3& x1, double from) const {
  const Tree& tree = *tree_;
  const StraightWay x{x0, x1};
  const double tolerance = blurred * tree.size;
  double first = std::numeric_limits<double>::infinity();
  const auto ask = [&](int f) {
    const Triangle& t = tree.surface.faces[f].v;
    std::array<StraightWay, 3> ways;
    for (int k = 0; k < 3; ++k)
      ways[k] = tree.moving ? StraightWay{tree.start[t[k]], tree.end[t[k]]}
                            : StraightWay{tree.mesh.positions[t[k]], tree.mesh.positions[t[k]]};
    std::array<double, 3> found;
    const int count = crossings(x, ways, tolerance, found);
    for (int i = 0; i < count; ++i) {
      if (found[i] < from || found[i] >= first) continue;
      if (tree.covered(found[i])[f] != Cover::none && tree.in_pose(found[i], [&](const auto& pose) {
            const Vec3 point = x.at(found[i]);
            return tree.is_covered({0, f, on_face, point}, pose);
          }))
        continue;
      const double steep = steepness(x, ways, found[i]);
      if (tree.surface.closed ? steep < -grazing : std::abs(steep) > grazing) first = found[i];
    }
    return first;
  };
  if (tree.boxes)
    tree.boxes->along(x0, x1, from, ask);
  else  // the surface has never moved, and is not closed
    for (int f = 0; f < static_cast<int>(tree.surface.faces.size()); ++f) ask(f);
  return first <= 1 ? std::optional(first) : std::nullopt;
}

bool SurfaceDistance::stays_clear(const Vec3& x0, const Vec3& x1, double margin) const {
  const Tree& tree = *tree_;
  if (!tree.moving || !x0.allFinite() || !x1.allFinite()) return false;
  bool clear = true;
  tree.boxes->along(
      x0, x1, 0,
      [&](int f) {
        const Triangle& t = tree.surface.faces[f].v;
        double most = 0;
        for (int v : t) most = std::max(most, (x1 - x0 - (tree.end[v] - tree.start[v])).squaredNorm());
        const Vec3 nearest =
            closest_on_triangle(x0, tree.start[t[0]], tree.start[t[1]], tree.start[t[2]]).first;
        if ((x0 - nearest).norm() - std::sqrt(most) <= margin) clear = false;
        return clear ? 1.0 : -1.0;
      },
      margin);
  return clear;
}

template <class Places>
SurfaceDistance::Anchor SurfaceDistance::Tree::anchor(const Vec3& x, const Candidate& c,
                                                      const SurfacePose<Places>& pose) const {
  if (c.face < 0) throw InputError("an anchor must be at a finite place");
  const Mat3 axes = frame(pose.corner(c.face, 0), pose.corner(c.face, 1), pose.corner(c.face, 2));
  return {surface.faces[c.face].v, c.weights(pose), axes.transpose() * (x - c.point)};
}

SurfaceDistance::Anchor SurfaceDistance::anchor(const Vec3& x, double s) const {
  return tree_->in_pose(s, [&](const auto& pose) {
    return tree_->anchor(x, tree_->find(x, pose, [](const Candidate&) { return true; }), pose);
  });
}

Vec3 SurfaceDistance::carried(const Vec3& x, double s) const {
  return tree_->in_pose(s, [&](const auto& pose) {
    const Candidate one = tree_->find(x, pose, [](const Candidate&) { return true; });
    const Vec3 end = place(tree_->anchor(x, one, pose), 1);
    if (!tree_->is_covered(one, pose)) return end;
    const Vec3 normal = pose.plain_normal(one.face);
    const Candidate other = tree_->find(x, pose, [&](const Candidate& c) {
      return pose.plain_normal(c.face).dot(normal) < 0 && tree_->seems_covered(c, pose);
    });
    if (other.face < 0) return end;
    return Vec3(0.5 * (end + place(tree_->anchor(x, other, pose), 1)));
  });
}

Vec3 SurfaceDistance::place(const Anchor& anchor, double s) const {
  const auto at = [&](int v) {
    return tree_->moving ? StraightWay{tree_->start[v], tree_->end[v]}.at(s) : tree_->mesh.positions[v];
  };
  const Vec3 a = at(anchor.triangle[0]), b = at(anchor.triangle[1]), c = at(anchor.triangle[2]);
  return anchor.weights[0] * a + anchor.weights[1] * b + anchor.weights[2] * c +
         frame(a, b, c) * anchor.offset;
}

std::vector<Vec3> SurfaceDistance::vertices(double s) const {
  std::vector<Vec3> places = tree_->mesh.positions;
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = vertex(static_cast<int>(i), s);
  return places;
}

Vec3 SurfaceDistance::vertex(int v, double s) const {
  return tree_->moving ? Vec3((1 - s) * tree_->start[v] + s * tree_->end[v]) : tree_->mesh.positions[v];
}

bool SurfaceDistance::closed() const { return tree_->surface.closed; }
bool SurfaceDistance::inside_out() const { return tree_->surface.inside_out; }
const TriangleMesh& SurfaceDistance::mesh() const { return tree_->mesh; }

}  // namespace drape
