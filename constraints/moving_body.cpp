#include "constraints/moving_body.h"

#include <algorithm>

namespace drape {

MovingBody::MovingBody(Obstacle obstacle, int number) : obstacle_(std::move(obstacle)), number_(number) {
  check(obstacle_);
  make_unit(obstacle_.shape);
  now_ = start_ = end_ = obstacle_.motion.at(0);
  move(obstacle_.shape, 0, 0);
  if (obstacle_.rigid) reacting_.emplace(*obstacle_.rigid, now_);
  constexpr int coarser = 2;
  if (!surface() && convex(obstacle_.shape) && (reacting_ || obstacle_.motion.moves()))
    polyhedron_ = std::make_shared<const TriangleMesh>(mesh_of(obstacle_.shape, coarser));
}

const SurfaceDistance* MovingBody::surface() const {
  if (const DeformingBody* const body = deforming(obstacle_.shape)) return body->surface.get();
  const MeshBody* const mesh = std::get_if<MeshBody>(&obstacle_.shape);
  return mesh ? mesh->get() : nullptr;
}

void MovingBody::stand_at(double t) {
  if (reacting_) return;
  now_ = obstacle_.motion.at(t);
  move(obstacle_.shape, t, t);
}

void MovingBody::begin_step(double t, double h) {
  h_ = h;
  move(obstacle_.shape, t, t + h);
  start_ = reacting_ ? reacting_->pose() : obstacle_.motion.at(t);
  end_ = reacting_ ? reacting_->begin_step(h) : obstacle_.motion.at(t + h);
  turns_ = start_.rotation != end_.rotation;
}

void MovingBody::expect(const Vec3& u, const Vec3& w) {
  end_ = reacting_->expect(u, w);
  turns_ = start_.rotation != end_.rotation;
}

bool MovingBody::end_step() {
  now_ = end_;
  return !reacting_ || reacting_->end_step(end_);
}

void MovingBody::clear_impulse() {
  if (reacting_) reacting_->clear_impulse();
}

void MovingBody::push(const Vec3& impulse, const Vec3& place, double approach) {
  if (reacting_) reacting_->push(impulse, place, approach);
}

void MovingBody::pull(const Vec3& impulse, const Vec3& place, double approach) {
  if (reacting_) reacting_->pull(impulse, place, approach);
}

SurfacePoint MovingBody::at_start(const Vec3& x) const { return closest(obstacle_.shape, start_.to_body(x)); }

SurfacePoint MovingBody::near_start(const Vec3& x) const {
  const SurfacePoint s = at_start(x);
  return {s.distance, start_.direction_to_world(s.normal), s.covered};
}

SurfacePoint MovingBody::near_end(const Vec3& x) const {
  const SurfacePoint s = closest(obstacle_.shape, end_.to_body(x), 1);
  return {s.distance, end_.direction_to_world(s.normal), s.covered};
}

const TriangleMesh* MovingBody::skin() const {
  if (const SurfaceDistance* const mesh = surface()) return &mesh->mesh();
  return polyhedron_ && !polyhedron_->triangles.empty() ? polyhedron_.get() : nullptr;
}

bool MovingBody::meets_triangles() const {
  constexpr double least_margin = 1e-4;  // m
  return skin() && obstacle_.margin >= least_margin;
}

bool MovingBody::inside_skin(const Vec3& x, double deeper) const {
  if (surface()) return near_start(x).distance < -deeper;
  const Vec3 place = start_.to_body(x);
  const std::vector<Vec3>& corners = polyhedron_->positions;
  return std::all_of(polyhedron_->triangles.begin(), polyhedron_->triangles.end(), [&](const Triangle& t) {
    const Vec3& corner = corners[t[0]];
    const Vec3 normal = (corners[t[1]] - corner).cross(corners[t[2]] - corner);
    return normal.dot(place - corner) < -deeper * normal.norm();
  });
}

Vec3 MovingBody::vertex_at_start(int v) const {
  return start_.to_world(surface() ? surface()->vertex(v, 0) : polyhedron_->positions[v]);
}
Vec3 MovingBody::vertex_at_end(int v) const {
  return end_.to_world(surface() ? surface()->vertex(v, 1) : polyhedron_->positions[v]);
}

double MovingBody::distance(const Vec3& x) const {
  return closest(obstacle_.shape, now_.to_body(x), 1).distance;
}

Vec3 MovingBody::velocity(const Vec3& x) const { return (carried(x) - x) / h_; }

double MovingBody::approach(const Vec3& x0, const Vec3& x1, const ContactPlane& plane) const {
  return (x1 - carried(x0)).dot(plane.normal);
}

Vec3 MovingBody::carried(const Vec3& x) const {
  return end_.to_world(drape::carried(obstacle_.shape, start_.to_body(x)));
}

Vec3 MovingBody::turned(const Vec3& direction) const {
  return turns_ ? end_.direction_to_world(start_.direction_to_body(direction)) : direction;
}

MovingBody::Mark MovingBody::mark(const Vec3& x) const {
  const Vec3 X = now_.to_body(x);
  if (const DeformingBody* const body = deforming(obstacle_.shape)) return {X, body->surface->anchor(X, 1)};
  return {X, {}};
}

Vec3 MovingBody::carried(const Mark& mark) const {
  if (const DeformingBody* const body = deforming(obstacle_.shape))
    return end_.to_world(body->surface->place(*mark.anchor, 1));
  return end_.to_world(mark.place);
}

double MovingBody::travel(const Vec3& x0, const Vec3& x1) const {
  return (end_.to_body(x1) - start_.to_body(x0)).norm() + largest_displacement(obstacle_.shape);
}

double MovingBody::fastest_carried(const Vec3& X, double reach) const {
  const double turn = (end_.rotation - start_.rotation).norm();
  return ((end_.to_world(X) - start_.to_world(X)).norm() + turn * reach +
          largest_displacement(obstacle_.shape)) /
         h_;
}

ContactPlane MovingBody::plane_at(const Vec3& x, const Vec3& normal, double gap) const {
  return {number_, end_.direction_to_world(normal), gap, velocity(x)};
}

ContactPlane MovingBody::plane(const Vec3& x, const SurfacePoint& at_start, const Vec3& x_new,
                               double radius) const {
  const double offset = obstacle_.margin + radius;
  if (!turns_ && !deforms() && !reacting_) return plane_at(x, at_start.normal, at_start.distance - offset);
  // Where the particle will be in the body's frame: a particle that slides on a turning body does not turn
  // with it, and the tilt of the normal would drive it round, as it would turn a body that the particle
  // pushes.
  const Vec3 X = drape::carried(obstacle_.shape, start_.to_body(x)), way = end_.to_body(x_new) - X;
  const Vec3 n = deforms() ? closest(obstacle_.shape, X, 1).normal : at_start.normal;
  const Vec3 slid = way - n.dot(way) * n;
  const SurfacePoint s = closest(obstacle_.shape, X + slid, 1);
  // Where the body closes on the particle within the step, the surface at the end is no way out.
  if (s.covered) return plane_at(x, at_start.normal, at_start.distance - offset);
  return plane_at(x, s.normal, s.distance - s.normal.dot(slid) - offset);
}

std::optional<ContactPlane> MovingBody::opposite(const Vec3& x, const SurfacePoint& at_start,
                                                 double offset) const {
  constexpr double alike = 0.5;  // normals of one side of a fold: their product at least
  if (!deforms()) return std::nullopt;
  const Vec3 normal = start_.direction_to_world(at_start.normal);
  const Vec3 beyond = x + (2 * offset - at_start.distance) * normal;
  const SurfacePoint there = near_start(beyond);
  if (there.covered || there.normal.dot(normal) > alike) return std::nullopt;
  const double gap = there.distance - (beyond - x).dot(there.normal) - offset;
  return ContactPlane{number_, turned(there.normal), gap, velocity(beyond)};
}

std::optional<ContactPlane> MovingBody::meeting(const Vec3& x0, const Vec3& x1, double radius) const {
  const Vec3 X0 = start_.to_body(x0), X1 = end_.to_body(x1);
  const double offset = obstacle_.margin + radius;
  const auto hit = first_hit(obstacle_.shape, X0, X1, offset);
  if (!hit || hit->surface.covered) return std::nullopt;
  const SurfacePoint& s = hit->surface;
  const Vec3 way = X1 - drape::carried(obstacle_.shape, X0);  // relative to the surface
  const double gap = -hit->fraction * way.dot(s.normal) + s.distance - offset;
  return plane_at(x0, s.normal, std::max(gap, 0.0));
}

std::optional<Vec3> MovingBody::stop(const Vec3& x0, Vec3& x1, double start_distance, double radius) const {
  const Vec3 X0 = start_.to_body(x0), X1 = end_.to_body(x1);
  Vec3 end = X1;
  // What is known of the distance is a lower bound: for a particle without a radius it says which side that
  // is on.
  if (radius > 0) start_distance = closest(obstacle_.shape, X0, 0).distance;
  const double floor = std::min(start_distance, radius);
  if (start_distance >= 0) {
    const auto hit = first_hit(obstacle_.shape, X0, X1, std::max(floor, 0.0));
    if (!hit) return std::nullopt;
    end = drape::carried(obstacle_.shape, X0 + hit->fraction * (X1 - X0), hit->fraction);
  }
  const SurfacePoint s = closest(obstacle_.shape, end, 1);
  if (s.covered) return std::nullopt;  // the body has closed on it
  if (s.distance < floor) end += (floor - s.distance) * s.normal;
  if (end == X1) return std::nullopt;
  x1 = end_.to_world(end);
  return end_.direction_to_world(s.normal);
}

}  // namespace drape
