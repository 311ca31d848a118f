// Bodies that meet: those that react, with each other and with bodies that do not (which stand or are led).
//   v' = v + M^-1 sum J_k' lambda_k      v: velocities and spins that gravity and the cloth alone would make
// At every touch k, with n from body b to body a, the relative velocity u = v_a + w_a x r_a - v_b - w_b x r_b
// and the impulse lambda on a (minus it on b),
//   0 <= lambda.n  perpendicular to  u.n - a_k >= 0                         [Signorini]
//   |lambda_T| <= mu lambda.n, and opposite to u_T where that is reached    [Coulomb]
// The target a_k is -(gap - rest)/h, so that the surfaces arrive exactly at `rest_gap`; for an impact at the
// speed s > 0 within the step it is e s, so that they part at once. mu and e of a pair are the geometric
// means of the two bodies'; mu is the static coefficient where the surfaces do not slide when the step
// begins, otherwise the kinetic one. All impulses are found together by sweeps over the touches (projected
// Gauss-Seidel), from those of the last step, until no sweep changes a velocity by more than `exactness` of
// the largest, or `most_sweeps` are done.
//                                                         [Moreau 1988; Jourdan, Alart & Jean 1998; Catto 2005]
// Where bodies pinch a particle (constraints/nip.h), they meet at it as if it were a part of their surfaces:
// there mu is that of the body that does not hold it, or 0 where it runs through, e is 0, and the gap is what
// is left beside the margins. Bodies that are nearer than rest_gap are moved apart besides, by at most
// recovery_speed h in a step, which gives them no velocity; cloth that lies on them goes along.
// The order is that of the bodies, and no thread takes part, so the bits are always the same. Impulses are
// kept from step to step; memory grows only while more touches are found than ever before. (Bullet's search
// allocates where hulls overlap.)
// gap [m], h [s], u, v [m/s], w [rad/s], lambda [N s], mu, e [-].
#pragma once

#include <vector>

#include "constraints/carriers.h"
#include "constraints/nip.h"

namespace drape {

struct BodyMeetingReport {
  int touches = 0;     // points at which bodies press on each other, also through cloth
  double deepest = 0;  // how far bodies were inside each other when the step began [m]
  // The last sweep changed a velocity by at most a thousandth of the speed at which surfaces met, or 0.1
  // um/s.
  bool settled = true;
};

class BodyMeeting {
 public:
  using Bodies = std::vector<MovingBody>;

  // Between surfaces at rest [m]: at 0 the direction from one to the other is lost.
  static constexpr double rest_gap = 2e-6;
  static constexpr double exactness = 1e-11;
  static constexpr int most_sweeps = 3000;  // after these the impulses are taken as they are

  // Throws InputError when the body would meet one of the others in a way that needs Bullet, which this build
  // is without. To be called for every body.
  void add(const Bodies& bodies);

  // Finds the touches, and takes what they do into the expected motion of the bodies. Tells the nips their
  // impulses.
  void begin_step(Bodies& bodies, std::vector<Nip>& nips, double h, double recovery_speed);
  // Finds the impulses anew when the cloth acts on the bodies otherwise than it did before.
  void solve(Bodies& bodies, std::vector<Nip>& nips);
  BodyMeetingReport end_step(const Bodies& bodies,
                             const std::vector<Nip>& nips);  // keeps the impulses for the next step

  // Lists where bodies touch in the step under way, with the impulses that were found last.
  void show(std::vector<BodyTouch>& touches) const;

  // Pairs of bodies that were inside each other by more than `margin` [m] when the last step began.
  struct Overlap {
    int a, b;
    double depth;  // m
  };
  std::vector<Overlap> overlaps(const Bodies& bodies, double margin);

 private:
  struct Mover {  // a body in the equations
    bool reacts = false, meets = false;
    double inverse_mass = 0;  // 1/kg
    Mat3 inverse_inertia = Mat3::Zero();
    Vec3 centre = Vec3::Zero();
    Vec3 free_v = Vec3::Zero(), free_w = Vec3::Zero();
    Vec3 v = Vec3::Zero(), w = Vec3::Zero();
    Vec3 impulse = Vec3::Zero(), moment = Vec3::Zero();
  };
  struct Meeting {  // a touch in the equations
    int a, b;
    int nip;  // its place among the nips; -1: the surfaces themselves
    Vec3 normal, t1, t2;
    Vec3 arm_a, arm_b;  // from the centres of mass [m]
    Vec3 carried;       // what a body that does not react adds to the relative velocity [m/s]
    Vec3 mark;          // the place in the frame of body a, by which it is known again [m]
    double gap;         // m
    double mu;
    bool slides;     // when the step begins
    double rebound;  // e s of an impact, otherwise 0 [m/s]
    double target;   // a_k [m/s]
    double k_n,
        k_t;      // velocity for an impulse of 1 N s along the normal, and at most for one along the surface
    Vec3 lambda;  // along n, t1, t2
    Vec3 impulse() const;
  };
  static int particle_of(const Meeting& m, const std::vector<Nip>& nips) {
    return m.nip < 0 ? -1 : nips[static_cast<std::size_t>(m.nip)].particle;
  }
  struct Kept {  // of the last step
    int a, b;
    int particle;        // of a nip; -1: the surfaces themselves
    Vec3 mark, impulse;  // in the frame of body a
    bool taken = false;
  };

  void find(const Bodies& bodies, double h);
  Meeting& add_touch(const Bodies& bodies, int a, int b, const Touch& touch);
  void add_nip(const Bodies& bodies, const std::vector<Nip>& nips, int number);
  void recall(const Bodies& bodies, const std::vector<Nip>& nips, double share);
  bool take_free(const Bodies& bodies);
  void apply(const Meeting& meeting, const Vec3& impulse);
  Vec3 slip(const Meeting& meeting) const;
  void sweep_until_settled();
  double sweep();
  void push_apart(double h, double recovery_speed);
  void give(Bodies& bodies, std::vector<Nip>& nips);

  std::vector<TouchForm> forms_;
  std::vector<Mover> movers_;
  std::vector<Meeting> meetings_;
  std::vector<Kept> kept_;
  std::vector<Touch> touches_;                // scratch
  std::vector<double> pushes_;                // scratch: by touch, what moves the bodies apart
  std::vector<std::pair<Vec3, Vec3>> apart_;  // by body: what moves it apart from others [m/s], [rad/s]
  double h_ = 0, last_h_ = 0;
  bool settled_ = true;
};

}  // namespace drape
