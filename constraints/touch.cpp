#include "constraints/touch.h"

#include <algorithm>
#include <cmath>

namespace drape {
namespace {

constexpr int most_convex_corners = 2000;  // a finer mesh is looked at by its corners
constexpr double flatness =
    1e-6;  // share of its size by which a mesh may be hollow and still count as convex
// Of the touches that share a normal, those are kept that are farthest in so many directions.
constexpr int directions = 8;
constexpr double same_normal = 0.99;

bool bulges_everywhere(const TriangleMesh& mesh, double size) {
  for (const Triangle& t : mesh.triangles) {
    const Vec3& p = mesh.positions[t[0]];
    const Vec3 n = (mesh.positions[t[1]] - p).cross(mesh.positions[t[2]] - p);
    if (n.norm() <= 1e-14 * size * size) continue;
    for (const Vec3& x : mesh.positions)
      if (n.normalized().dot(x - p) > flatness * size) return false;
  }
  return true;
}

// Points of the surface of a level set, about as dense as 40 in its length.
std::vector<Vec3> points_on(const Shape& shape) {
  std::vector<Vec3> points;
  const Eigen::AlignedBox3d box = bounds_of(shape);
  const double spacing = box.sizes().maxCoeff() / 40;
  const Eigen::Vector3i n = (box.sizes() / spacing).array().ceil().cast<int>();
  for (int i = 0; i <= n.x(); ++i)
    for (int j = 0; j <= n.y(); ++j)
      for (int k = 0; k <= n.z(); ++k) {
        const Vec3 x = box.min() + spacing * Vec3(i, j, k);
        SurfacePoint s = closest(shape, x);
        if (std::abs(s.distance) > spacing) continue;
        Vec3 p = x - s.distance * s.normal;
        s = closest(shape, p);
        points.push_back(p - s.distance * s.normal);
      }
  return points;
}

// A vertex that belongs to no triangle is no part of the surface. Returns the numbers that those which are
// left had.
std::vector<int> leave_out_what_is_no_corner(TriangleMesh& mesh) {
  std::vector<int> kept, place(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles) kept.insert(kept.end(), t.begin(), t.end());
  std::ranges::sort(kept);
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    place[static_cast<std::size_t>(kept[k])] = static_cast<int>(k);
    mesh.positions[k] = mesh.positions[static_cast<std::size_t>(kept[k])];
  }
  mesh.positions.resize(kept.size());
  for (Triangle& t : mesh.triangles)
    for (int& v : t) v = place[static_cast<std::size_t>(v)];
  return kept;
}

}  // namespace

TouchForm::TouchForm(const Shape& shape) : kind_(Kind::any) {
  if (std::holds_alternative<Plane>(shape)) {
    kind_ = Kind::plane;
    reach_ = std::numeric_limits<double>::infinity();
    return;
  }
  TriangleMesh mesh;
  if (const Sphere* const sphere = std::get_if<Sphere>(&shape)) {
    kind_ = Kind::sphere;
    radius_ = sphere->radius;
    corners_ = {sphere->centre};
  } else if (const Capsule* const capsule = std::get_if<Capsule>(&shape)) {
    kind_ = Kind::convex;
    radius_ = capsule->radius;
    corners_ = {capsule->a, capsule->b};
  } else {
    mesh = mesh_of(shape);
    vertices_ = leave_out_what_is_no_corner(mesh);
    corners_ = mesh.positions.empty() ? points_on(shape) : mesh.positions;
    const bool solid =
        !deforming(shape) && mesh.vertex_count() <= most_convex_corners && uniform_solid(shape, 1);
    if (solid && !mesh.positions.empty() && bulges_everywhere(mesh, bounds_of(shape).diagonal().norm()))
      kind_ = Kind::convex;
  }
  const Eigen::AlignedBox3d box = bounds_of(shape);
  middle_ = box.center();
  reach_ = box.diagonal().norm() / 2;
  if (kind_ == Kind::convex && Hull::available())
    hull_ = mesh.triangles.empty() ? Hull(corners_) : Hull(mesh);
}

bool needs_hulls(const TouchForm& a, const TouchForm& b) {
  using enum TouchForm::Kind;
  return a.kind() == convex && b.kind() == convex;
}

namespace {

// One body of a pair.
struct Side {
  const MovingBody& body;
  const TouchForm& form;
  double sign;  // 1: the first body of the pair, -1: the second

  const Shape& shape() const { return body.obstacle().shape; }
  std::size_t corners() const { return form.corners().size(); }
  Vec3 corner(std::size_t k) const {
    if (deforming(shape())) return body.vertex_at_start(form.vertex(k));
    return body.start().to_world(form.corners()[k]);
  }
  Vec3 middle() const { return body.start().to_world(form.middle()); }
};

// Adds the corners of one body that are near the surface of the other.
void add_corners(const Side& one, const Side& other, double reach, std::vector<Touch>& found) {
  const Vec3 middle = other.middle();
  const double far = other.form.reach() + one.form.radius() + reach;
  for (std::size_t k = 0; k < one.corners(); ++k) {
    const Vec3 x = one.corner(k);
    if (!deforming(other.shape()) && (x - middle).squaredNorm() > far * far) continue;
    const SurfacePoint s = other.body.near_start(x);
    const double gap = s.distance - one.form.radius();
    if (s.covered || gap > reach) continue;
    found.push_back({x - (one.form.radius() + gap / 2) * s.normal, one.sign * s.normal, gap});
  }
}

bool apart(const Side& a, const Side& b, double reach) {
  if (deforming(a.shape()) || deforming(b.shape())) return false;
  const double far = a.form.reach() + b.form.reach() + reach;
  return (a.middle() - b.middle()).squaredNorm() > far * far;
}

// Moves to the front the touches of [begin, end) that are worth keeping, and returns where these end.
template <class It>
It keep_outermost(It begin, It end) {
  if (end - begin <= 2 * directions) return end;
  const auto nearer = [](const Touch& a, const Touch& b) { return a.gap < b.gap; };
  It kept = begin;
  const auto keep = [&](It touch) {
    if (touch < kept) return;
    std::rotate(kept, touch, touch + 1);
    ++kept;
  };
  keep(std::min_element(begin, end, nearer));
  const double least = begin->gap, most = std::max_element(begin, end, nearer)->gap;
  const Vec3 n = begin->normal, t = n.unitOrthogonal(), s = n.cross(t);
  // First among those that touch as good as now, then among all.
  for (const double share : {1e-3, 1.0}) {
    const double limit = least + share * (most - least);
    for (int k = 0; k < directions; ++k) {
      const double angle = 2 * M_PI * k / directions;
      const Vec3 d = std::cos(angle) * t + std::sin(angle) * s;
      It best = begin;
      for (It touch = begin; touch != end; ++touch)
        if (touch->gap <= limit && touch->place.dot(d) > best->place.dot(d)) best = touch;
      keep(best);
    }
  }
  return kept;
}

// Leaves few touches of each direction.
void thin_out(std::vector<Touch>& found) {
  if (found.size() <= 2 * directions) return;
  auto done = found.begin(), rest = found.begin();  // kept; not yet looked at
  while (rest != found.end()) {
    const Vec3 n = rest->normal;
    const auto end = std::partition(rest + 1, found.end(),
                                    [&](const Touch& touch) { return touch.normal.dot(n) > same_normal; });
    const auto kept = keep_outermost(rest, end);
    done = done == rest ? kept : std::move(rest, kept, done);
    rest = end;
  }
  found.erase(done, found.end());
}

}  // namespace

void find_touches(const MovingBody& a, const TouchForm& form_a, const MovingBody& b, const TouchForm& form_b,
                  double reach, std::vector<Touch>& found) {
  using enum TouchForm::Kind;
  found.clear();
  const Side one{a, form_a, 1}, two{b, form_b, -1};
  if (apart(one, two, reach)) return;
  if (form_b.kind() == plane || form_a.kind() == sphere) {
    add_corners(one, two, reach, found);
  } else if (form_a.kind() == plane || form_b.kind() == sphere) {
    add_corners(two, one, reach, found);
  } else if (needs_hulls(form_a, form_b)) {
    if (form_a.radius() > 0) add_corners(one, two, reach, found);
    if (form_b.radius() > 0) add_corners(two, one, reach, found);
    const std::size_t ends = found.size();
    add_touches({form_a.hull(), a.start(), form_a.radius()}, {form_b.hull(), b.start(), form_b.radius()},
                reach, found);
    // The nearest points of a capsule that lies flat are anywhere along it: its ends do better.
    if (found.size() == ends + 1)
      for (std::size_t k = 0; k < ends; ++k)
        if (found[k].gap <= found[ends].gap + 1e-7 * (form_a.reach() + form_b.reach())) {
          found.pop_back();
          break;
        }
  } else {
    add_corners(one, two, reach, found);
    add_corners(two, one, reach, found);
  }
  thin_out(found);
}

}  // namespace drape
