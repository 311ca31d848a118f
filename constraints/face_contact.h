// Triangles of the cloth against bodies. With contact at vertices alone, the corner of a table would come
// through the middle of a triangle, or its rim through an edge. A stiff spring on the three corners of a
// triangle keeps the body off.
//   p = sum w_k x_k    the point of the triangle that is nearest to the body, or deepest in it. A second contact
//                      stays at the point of the step before as long as that touches and is not near the
//                      first.
//   n                  the body's normal there. By methods that look ahead p and n of a body that reacts are those where
//                      the step is foreseen to end, at x + h v: so what pushes a ball goes through its
//                      centre, however it moves and turns within the step. At a corner or a rim of such a
//                      body p is that of the start, and n turns with the triangle.
//   g = g_0 + n . (sum w_k (x_k - x_k0) - h v_b)     the gap of p to the surface, offset by half the margin:
//                                                    a triangle touches nothing where its vertices rest
//   E = k/2 g^2 for g < 0,   f_k = -k g w_k n,   K_kl = k w_k w_l n n^T
//   friction: the damper mu N / |u| acts on u, the part of sum w_k v_k - v_b along the surface; below
//             `slow` [m/s] the triangle creeps instead of sticking. N = -k g and |u| are those of the step
//             before (where the triangle touches anew, of the solve before). Where that comes to more than 1.05 mu N of the
//             solve, as where the triangle has just been let go, the damper is made less. It is not made more
//             within a step.
// A constraint would lock two or three particles to each other, which a filter of 3x3 blocks cannot express.
// The blocks of the spring stand where those of the triangle's edges stand. k is the cloth's own membrane
// stiffness, and a triangle has two springs at most: so they change neither the condition of the matrix nor
// the longest step that explicit methods bear by much, and a load that stretches the cloth by a hundredth
// makes it sink in by as little.
// Which springs act is an active set: it is predicted at x + h v, and react() corrects it until it agrees
// with the solve. x [m], v [m/s], k [N/m], h [s].
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "constraints/moving_body.h"
#include "constraints/parting.h"
#include "constraints/step_motion.h"

namespace drape {

struct ClothFace {
  std::array<int, 3> particles;
  double stiffness;  // N/m
};

struct FaceContact {
  int body, face;
  std::array<int, 3> particles;
  Vec3 weights;
  double stiffness;  // N/m
  Vec3 normal;       // unit, points out of the body
  Vec3 place;        // p at the start of the step [m]
  double gap;        // the g above at x = 0, with the body as it moves [m]: g = gap + n . sum w_k x_k
  double sunk =
      0;  // how much nearer to the body it still may be, because it began there [m]; g counts from there
  Vec3 body_velocity;  // m/s
  double friction;     // mu
  bool active = false;
  int changes = 0;    // of `active` within this step
  double push = 0;    // normal force of the last solve, and then of the end of the step [N]
  double slip = 0;    // |u| then [m/s]
  double damper = 0;  // of the friction in this step [N s/m]
  int begun = 0;      // how often it began to rub within this step
  double most_damper = std::numeric_limits<double>::infinity();  // upper bound of `damper` [N s/m]

  template <class Vector>
  Vec3 at(const Vector& x) const {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 3; ++k) sum += weights[k] * x.template segment<3>(3 * particles[k]);
    return sum;
  }
  // These take the place p [m], or the velocity [m/s], of the point of the triangle.
  double gap_of(const Vec3& p) const { return gap + normal.dot(p); }
  Vec3 slip_of(const Vec3& velocity) const {
    const Vec3 u = velocity - body_velocity;
    return u - normal.dot(u) * normal;
  }
  double gap_at(const VecX& x) const { return gap_of(at(x)); }
  Vec3 slip_at(const VecX& v) const { return slip_of(at(v)); }
  Vec3 impulse = Vec3::Zero();  // on the cloth in this step [N s]

  Vec3 force_at(const VecX& x, const VecX& v) const {  // force on the cloth [N]
    return -stiffness * std::min(gap_at(x), 0.0) * normal - damper * slip_at(v);
  }
  double rubbing() const;  // the damper that `push` and `slip` make [N s/m]
  // By how much the friction of a solve that came to x, v is off from its law [N].
  double wrong_friction(const VecX& x, const VecX& v) const;
  // The velocity that an impulse of 1 N s gives the point, with these inertias of its particles: 0 where none
  // moves [1/kg].
  double mobility(const StepMotion& step) const;
};

// Where a body touches a triangle, as the end of a step is foreseen.
struct FacePoint {
  Vec3 weights, place, normal;  // place: at the start of the step [m]; normal: at the end
  double gap;                   // that the point would have if the body carried it along [m]
};

class FaceContacts {
 public:
  void add(const std::vector<ClothFace>& faces);
  // Particle i gets the number particle_of[i]; a triangle of which two corners become one particle is
  // removed.
  void renumber(const std::vector<int>& particle_of);
  void part(const Parting& parting);
  const std::vector<ClothFace>& all() const { return faces_; }

  // x -> x_new is the predicted motion, which there is with Foresight::ahead only; else x_new is x. recovery:
  // how far a triangle that starts inside a body is brought out in this step at most [m]. What is too near to
  // a body when a run begins is not pushed away from it: it comes out by so much in a step, with its
  // vertices.
  // A triangle with a corner that is clamped in `contacts` goes with that corner, and touches nothing.
  void begin_step(const std::vector<MovingBody>& bodies, const std::vector<Contact>& contacts, const VecX& x,
                  const VecX& x_new, Foresight foresight, double recovery);
  // For methods that take the force as it is at the start of the step: limits the dampers so that they stop
  // sliding within a few steps of h [s] and never throw it back, however many faces share a particle.
  void limit_dampers(const std::vector<double>& masses, double h);
  void follow(const std::vector<MovingBody>& bodies);  // takes over a changed motion of the bodies
  // The norm of the impulses of springs that pull, of those that are missing, and of what friction takes
  // otherwise than its law, after a solve [N s].
  double imbalance(const StepMotion& step, const VecX& x_new, const VecX& v_new) const;
  // Finds after a solve which contacts act, and how they rub; tells which of that has changed.
  struct Change {
    bool acts = false, rubs = false;
  };
  Change react(const StepMotion& step, const VecX& x_new, const VecX& v_new);
  void end_step(const std::vector<MovingBody>& bodies, const VecX& x, const VecX& x_new, const VecX& v_new);

  // The impulse of the step on the bodies. Where a step has stages, count_impulse adds the force at x, v
  // times its duration [s]; otherwise take_impulse takes the force at the end of the step.
  void count_impulse(double duration, const VecX& x, const VecX& v);
  void take_impulse(double h, const VecX& x_new, const VecX& v_new);

  // Makes the next step look at every pair of face and body, after the particles were moved from outside.
  void look_again() {
    std::fill(room_.begin(), room_.end(), 0.0);
    begins_ = true;
  }

  const std::vector<FaceContact>& touching() const { return touching_; }

 private:
  void measure_travel(const MovingBody& body, const VecX& x, const VecX& x_new);
  double travel(const ClothFace& face) const;
  void look(int face, const MovingBody& body, const VecX& x, const VecX& x_new, double recovery,
            std::vector<FaceContact>& found);
  // old: the contact of the step before that it goes on from; null where it is a new one.
  FaceContact make(int face, const MovingBody& body, const FacePoint& point, double recovery,
                   const FaceContact* old) const;
  // Of the contacts of a face in the last completed step, those whose points are nearest to these weights and
  // farthest from them. Null where it had none.
  struct Before {
    const FaceContact *nearest = nullptr, *farthest = nullptr;
  };
  Before before(int body, int face, const Vec3& weights) const;

  std::vector<ClothFace> faces_;
  // By body and face: the distance within which the body was not when last looked [m], less what has been
  // travelled since.
  std::vector<double> room_;
  // By body and face: the weights of the lowest point when last looked.
  std::vector<Vec3> likely_;
  // By particle: how far it moves as seen by the body that is being looked at [m].
  std::vector<double> travel_;
  std::vector<char> clamped_;               // by particle
  Foresight foresight_ = Foresight::ahead;  // of the step under way
  bool counted_ = false;
  bool begins_ = true;  // whether this is the first step since particles were moved from outside
  // Contacts of this step, and of the last completed one; sorted by body, then by face.
  std::vector<FaceContact> touching_, last_;
  std::vector<std::vector<FaceContact>> found_;  // by chunk of faces
};

}  // namespace drape
