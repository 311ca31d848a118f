#include "constraints/hull.h"

#define BT_USE_DOUBLE_PRECISION  // as Debian's libBulletCollision-float64 is built
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btPolyhedralContactClipping.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "constraints/convex_faces.h"
#include "constraints/touch.h"

namespace drape {

using namespace internal;

namespace {

// Faces within this angle of the direction between the bodies lie on each other: cos 8 degrees.
constexpr double facing = 0.99;
constexpr double exactness = 1e-7;  // share of the size of the hulls to which the nearest points are known

btVector3 to_bullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

btMatrix3x3 to_bullet(const Mat3& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

}  // namespace

// The hull stands about its own middle, so that no digits are lost where the body was drawn far from the
// origin. Its faces are ours: Bullet's own are of corners that it rounds to a ten-thousandth of the size, and
// does not find to lie in planes.
struct Hull::Shape {
  btConvexHullShape hull;
  btConvexPolyhedron polyhedron;  // without faces where the hull was made of points alone
  Vec3 middle = Vec3::Zero();
  double size = 0;  // m

  explicit Shape(const std::vector<Vec3>& points);
};

Hull::Shape::Shape(const std::vector<Vec3>& points) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : points) box.extend(p);
  middle = box.center();
  size = box.diagonal().norm();
  for (const Vec3& p : points) hull.addPoint(to_bullet(Vec3(p - middle)), false);
  hull.recalcLocalAabb();
  hull.setMargin(0);
}

namespace {

btTransform transform(const PlacedHull& placed) {
  return btTransform(to_bullet(placed.pose.rotation),
                     to_bullet(placed.pose.to_world(placed.hull.shape().middle)));
}

// The face that looks along d [world] best.
struct Facing {
  double cosine = -1;
  Vec3 normal = Vec3::Zero();
  bool lies_on_the_other() const { return cosine > facing; }
};

Facing facing_along(const PlacedHull& placed, const Vec3& d) {
  Facing best;
  const btAlignedObjectArray<btFace>& faces = placed.hull.shape().polyhedron.m_faces;
  for (int k = 0; k < faces.size(); ++k) {
    const Vec3 n =
        placed.pose.direction_to_world(Vec3(faces[k].m_plane[0], faces[k].m_plane[1], faces[k].m_plane[2]));
    if (n.dot(d) > best.cosine) best = {n.dot(d), n};
  }
  return best;
}

// Takes the corners that clipping leaves. They lie on the clipped face; the other surface is at `gap` along
// -normal.
struct Corners : btDiscreteCollisionDetectorInterface::Result {
  Corners(const Vec3& normal_, double sign_, std::vector<Touch>& found_)
      : normal(normal_), sign(sign_), found(found_) {}
  void setShapeIdentifiersA(int, int) override {}
  void setShapeIdentifiersB(int, int) override {}
  void addContactPoint(const btVector3&, const btVector3& point, btScalar gap) override {
    found.push_back({from_bullet(point) - gap / 2 * normal, sign * normal, gap});
  }
  Vec3 normal;  // of the face that clips
  double sign;
  std::vector<Touch>& found;
};

// Clips the face of `other` that looks at `base` by the sides of the face of `base` that has this normal.
// Bullet wants the direction from `other` to `base`.
void add_polygon(const PlacedHull& base, const PlacedHull& other, const Vec3& normal, double sign,
                 double reach, std::vector<Touch>& found) {
  const Hull::Shape &b = base.hull.shape(), &o = other.hull.shape();
  if (o.polyhedron.m_faces.size() == 0) return;
  thread_local btVertexArray face, cut;  // scratch: a face in the world, and what clipping leaves of it
  Corners corners(normal, sign, found);
  btPolyhedralContactClipping::clipHullAgainstHull(
      to_bullet(Vec3(-normal)), b.polyhedron, o.polyhedron, transform(base), transform(other),
      -std::numeric_limits<double>::max(), reach, face, cut, corners);
}

std::optional<Touch> nearest(const PlacedHull& a, const PlacedHull& b) {
  const Hull::Shape &sa = a.hull.shape(), &sb = b.hull.shape();
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver overlap;
  btGjkPairDetector detector(&sa.hull, &sb.hull, &simplex, &overlap);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA = transform(a);
  input.m_transformB = transform(b);
  btPointCollector point;
  detector.getClosestPoints(input, point, nullptr);
  if (!point.m_hasResult) return std::nullopt;
  const Vec3 n = from_bullet(point.m_normalOnBInWorld),
             on_b = from_bullet(point.m_pointInWorld) + b.radius * n;
  const double gap = point.m_distance - a.radius - b.radius;
  return Touch{on_b + gap / 2 * n, n, gap};
}

}  // namespace

bool Hull::available() { return true; }

Hull::Hull(const std::vector<Vec3>& points) : shape_(std::make_shared<Shape>(points)) {}

Hull::Hull(const TriangleMesh& convex) {
  const auto shape = std::make_shared<Shape>(convex.positions);
  btConvexPolyhedron& polyhedron = shape->polyhedron;
  for (const Vec3& p : convex.positions) polyhedron.m_vertices.push_back(to_bullet(Vec3(p - shape->middle)));
  for (const ConvexFace& f : convex_faces(convex)) {
    btFace face;
    for (const int v : f.corners) face.m_indices.push_back(v);
    for (int k = 0; k < 3; ++k) face.m_plane[k] = f.normal[k];
    face.m_plane[3] = f.normal.dot(shape->middle) - f.offset;
    polyhedron.m_faces.push_back(face);
  }
  shape_ = shape;
}

void add_touches(const PlacedHull& a, const PlacedHull& b, double reach, std::vector<Touch>& found) {
  const std::optional<Touch> touch = nearest(a, b);
  if (!touch || touch->gap > reach) return;
  const std::size_t before = found.size();
  if (a.radius == 0 && b.radius == 0) {
    const Facing of_a = facing_along(a, -touch->normal), of_b = facing_along(b, touch->normal);
    if (of_b.lies_on_the_other() && of_b.cosine >= of_a.cosine)
      add_polygon(b, a, of_b.normal, 1, reach, found);
    else if (of_a.lies_on_the_other())
      add_polygon(a, b, of_a.normal, -1, reach, found);
  }
  const double size = std::max(a.hull.shape().size, b.hull.shape().size);
  for (std::size_t k = before; k < found.size(); ++k)
    if (found[k].gap <= touch->gap + exactness * size) return;
  found.push_back(*touch);
}

}  // namespace drape
