// Triangles of the cloth against bodies. Vertices alone would let the corner of a table through the middle of a
// triangle, or its rim through an edge; a stiff spring on the three corners of the triangle keeps it off.
//   p = sum w_k x_k    the point of the triangle that is nearest to the body, or deepest in it
//   g = g_0 + n . (sum w_k (x_k - x_k0) - h v_b)     the gap of p to the surface, offset by half the margin:
//                                                    a triangle touches nothing where its vertices rest
//   E = k/2 g^2 for g < 0,   f_k = -k g w_k n,   K_kl = k w_k w_l n n^T
//   friction: the damper mu N / |u| on the part u of sum w_k v_k - v_b along the surface, N = -k g and |u|
//   those of the step before (where it touches anew: of the solve before); below slow [m/s] it creeps instead
//   of sticking.
// A constraint would lock two or three particles to each other, which a filter of 3x3 blocks cannot say; the
// spring's blocks stand where the edges of the triangle have theirs. k is the cloth's own membrane stiffness:
// so it changes neither the condition of the matrix nor the step that explicit methods bear, and a load that
// stretches the cloth by a hundredth sinks in by as little.
// Which springs act is an active set: foreseen at x + h v, corrected by react() until it agrees with the
// solve. x [m], v [m/s], k [N/m], h [s].
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "constraints/moving_body.h"

namespace drape {

struct ClothFace {
  std::array<int, 3> particles;
  double stiffness;  // N/m
};

struct FaceContact {
  int body, face;
  std::array<int, 3> particles;
  Vec3 weights;
  double stiffness;    // N/m
  Vec3 normal;         // unit, out of the body
  Vec3 place;          // m, of p at the start
  double gap;          // m, g above at x = 0, with the body as it moves: g = gap + n . sum w_k x_k
  Vec3 body_velocity;  // m/s
  double friction;     // mu
  bool active = false;
  int changes = 0;                                               // of that, within this step
  double push = 0;                                               // N, of the last solve
  double slip = 0;                                               // m/s, |u| of the last solve
  double damper = 0;                                             // N s/m, of the friction in this step
  double most_damper = std::numeric_limits<double>::infinity();  // N s/m

  template <class Vector>
  Vec3 at(const Vector& x) const {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < 3; ++k) sum += weights[k] * x.template segment<3>(3 * particles[k]);
    return sum;
  }
  // Of a place p [m] and of a velocity [m/s] of the point of the triangle.
  double gap_of(const Vec3& p) const { return gap + normal.dot(p); }
  Vec3 slip_of(const Vec3& velocity) const {
    const Vec3 u = velocity - body_velocity;
    return u - normal.dot(u) * normal;
  }
  double gap_at(const VecX& x) const { return gap_of(at(x)); }
  Vec3 slip_at(const VecX& v) const { return slip_of(at(v)); }
  Vec3 impulse = Vec3::Zero();  // N s, on the cloth in this step

  Vec3 force_at(const VecX& x, const VecX& v) const {  // N, on the cloth
    return -stiffness * std::min(gap_at(x), 0.0) * normal - damper * slip_at(v);
  }
  double rubbing() const;  // N s/m, the damper that push and slip make
};

class FaceContacts {
 public:
  void add(const std::vector<ClothFace>& faces);
  // Particle i is number particle_of[i] from now on; a triangle of which two corners have become one is gone.
  void renumber(const std::vector<int>& particle_of);
  const std::vector<ClothFace>& all() const { return faces_; }

  // x -> x_new is the motion that is foreseen. recovery: how far what starts inside is brought out in this
  // step at most [m].
  void begin_step(const std::vector<MovingBody>& bodies, const VecX& x, const VecX& x_new, double recovery);
  // For steps that take the force as it is at their start: stops what slides within a few steps of h [s], and
  // never throws it back, however many faces share a particle.
  void limit_dampers(const std::vector<double>& masses, double h);
  void follow(const std::vector<MovingBody>& bodies);  // bodies whose motion in this step has changed
  // After a solve: which act; true when that has changed.
  bool react(const VecX& x_new, const VecX& v_new);
  void end_step(const std::vector<MovingBody>& bodies, const VecX& x, const VecX& x_new);

  // What the step does to the bodies: the force that acted for so long [s], where a step has stages; else
  // that at its end.
  void count_impulse(double duration, const VecX& x, const VecX& v);
  void take_impulse(double h, const VecX& x_new, const VecX& v_new);

  void look_again() { std::fill(room_.begin(), room_.end(), 0.0); }  // at all: they have been moved

  const std::vector<FaceContact>& touching() const { return touching_; }

 private:
  void measure_travel(const MovingBody& body, const VecX& x, const VecX& x_new);
  double travel(const ClothFace& face) const;
  void look(int face, const MovingBody& body, const VecX& x, const VecX& x_new, double recovery,
            std::vector<FaceContact>& found);
  const FaceContact* before(int body, int face) const;

  std::vector<ClothFace> faces_;
  std::vector<double> room_;    // body, face: within this distance the body was not when last looked [m]
  std::vector<Vec3> likely_;    // body, face: the weights of its lowest point when last looked
  std::vector<double> travel_;  // of a particle, as the body at hand sees it [m]
  bool counted_ = false;
  std::vector<FaceContact> touching_, last_;     // of this step, of the last completed one; by body, by face
  std::vector<std::vector<FaceContact>> found_;  // by chunk of faces
};

}  // namespace drape
