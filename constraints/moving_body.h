// A body as it moves through the steps. Contact is looked for in the body's own frame, where the body stands
// still: a particle that goes straight from x0 to x1 while the body goes from its pose at t to the one at
// t + h is seen there on the way from X0 = pose(t)^-1 x0 to X1 = pose(t + h)^-1 x1, which is taken as
// straight. So a fast body meets a particle as surely as a fast particle meets a body at rest.
//   carried   where the body takes the point x until the end of the step: c = pose(t + h) X0, and further
//             where the body deforms
//   velocity  v_b = (c - x) / h: the mean velocity of the body at x over the step, so that x + h v_b stays
//             with it
//   plane     the surface at the end of the step that is nearest to where the particle will have slid by
//             x + h v: its normal n, and its gap from the carried point. v.n = v_b.n - gap / h arrives
//             exactly on it. (Of a body that neither turns, deforms nor reacts: the surface at the start.)
//                                                    [Baraff & Witkin 1998, 5.2, in the frame of the body]
// x [m], v [m/s], t, h [s].
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "constraints/contact.h"
#include "constraints/reacting_body.h"

namespace drape {

class MovingBody {
 public:
  MovingBody(Obstacle obstacle, int number);  // number: names this body in the planes that it makes

  const Obstacle& obstacle() const { return obstacle_; }
  int number() const { return number_; }
  double step() const { return h_; }            // length of the step under way [s]
  const Pose& pose() const { return now_; }     // at the end of the last completed step
  const Pose& start() const { return start_; }  // when the step under way begins
  // The state of a body that reacts; null when it does not react.
  const ReactingBody* reacting() const { return reacting_ ? &*reacting_ : nullptr; }

  // A point that the body carries with it, marked where the body stands at the end of the last completed
  // step. A body that deforms carries it with the triangle beside it.
  struct Mark {
    Vec3 place;  // m, in the body's frame
    std::optional<SurfaceDistance::Anchor> anchor;
  };
  Mark mark(const Vec3& x) const;

  // The surface of a body that is a mesh; null for all others.
  const SurfaceDistance* surface() const;
  // The triangles that meet the triangles of cloth, and where their vertices are when the step begins and
  // ends [m]: those of a mesh, and a polyhedron in a convex shape that moves. Null for all others.
  const TriangleMesh* skin() const;
  // Whether cloth meets these triangles: not where the margin is so small that edges would rest on edges, and
  // be stopped for ever.
  bool meets_triangles() const;
  // Whether x is deeper inside of them than this when the step begins [m].
  bool inside_skin(const Vec3& x, double deeper) const;
  Vec3 vertex_at_start(int v) const;
  Vec3 vertex_at_end(int v) const;

  // Between steps: puts a body whose motion is prescribed where it is at the time t [s].
  void stand_at(double t);
  void begin_step(double t, double h);
  bool end_step();  // false: the reaction has not converged. A step that is abandoned does not move the body.
  // go_back() makes the body what it was at the last keep(), whatever steps have ended since.
  void keep() { kept_ = {now_, reacting_}; }
  void go_back() { now_ = kept_.first, reacting_ = kept_.second; }

  // Before a response of its own: it is corrected anew, from where it has come to.
  void begin_corrections() {
    if (reacting_) reacting_->begin_corrections();
  }
  // The impulses of the particles on the body in this step, summed from zero. Where they make the body move
  // otherwise than was assumed, `correct` is true, and the planes that it made must be updated (their
  // velocity has changed).
  void clear_impulse();
  void push(const Vec3& impulse, const Vec3& place, double approach = 0);
  void pull(const Vec3& impulse, const Vec3& place, double approach);  // see ReactingBody::pull
  bool correct(double noise) { return reacting_ && reacting_->correct(end_, noise); }

  // Impulse [N s] and moment [N m s] of other bodies on this one, which reacts (constraints/body_meeting.h).
  void meet(const Vec3& impulse, const Vec3& moment) { reacting_->meet(impulse, moment); }
  // See ReactingBody::expect.
  void expect(const Vec3& u, const Vec3& w);

  // Signed distance at the end of the last completed step [m].
  double distance(const Vec3& x) const;

  // The closest point of the surface at the start and at the end of the step under way.
  SurfacePoint near_start(const Vec3& x) const;
  SurfacePoint near_end(const Vec3& x) const;
  SurfacePoint at_start(const Vec3& x) const;  // in the body's frame
  Vec3 carried(const Vec3& x) const;
  Vec3 carried(const Mark& mark) const;
  // A direction at the start of the step, as the body turns it until the end. What deforms is taken as if it
  // did not.
  Vec3 turned(const Vec3& direction) const;
  Vec3 velocity(const Vec3& x) const;
  // The most that a point within `reach` [m] of X, in the body's frame, moves in this step, over the time
  // [m/s].
  double fastest_carried(const Vec3& X, double reach) const;
  // The most by which the distance of a particle from the body can change on its way [m].
  double travel(const Vec3& x0, const Vec3& x1) const;
  // radius [m]: of the particle (Constraints::set_radius), here and below.
  ContactPlane plane(const Vec3& x, const SurfacePoint& at_start, const Vec3& x_new, double radius = 0) const;
  // The other side of a fold in which x is, such as an armpit, as a plane moved out by the offset [m]: what is
  // nearest to the place twice the offset above at_start, the surface beside x. Nothing where that is the same
  // side, and for a body that does not deform, whose folds do not close.
  std::optional<ContactPlane> opposite(const Vec3& x, const SurfacePoint& at_start, double offset) const;
  ContactPlane plane_at(const Vec3& x, const Vec3& normal, double gap) const;  // normal: in the body's frame
  // How far the way leads away from the plane that moves with the body [m]; negative where it comes nearer.
  double approach(const Vec3& x0, const Vec3& x1, const ContactPlane& plane) const;
  // The plane in which the way first meets the surface offset by the margin and the radius.
  std::optional<ContactPlane> meeting(const Vec3& x0, const Vec3& x1, double radius = 0) const;
  // Moves x1 to where the way ends if the surface stops it, and returns the normal there; returns nothing
  // when the way is free. A particle that was farther off than its radius does not end nearer or behind
  // the body, and one that was nearer (start_distance, negative inside) does not end nearer still.
  std::optional<Vec3> stop(const Vec3& x0, Vec3& x1, double start_distance, double radius = 0) const;

 private:
  bool deforms() const { return deforming(obstacle_.shape) != nullptr; }

  Obstacle obstacle_;
  std::shared_ptr<const TriangleMesh> polyhedron_;
  int number_;
  double h_ = 0;
  bool turns_ = false;  // whether the body turns in this step
  Pose now_, start_, end_;
  std::optional<ReactingBody> reacting_;
  std::pair<Pose, std::optional<ReactingBody>> kept_;
};

}  // namespace drape
