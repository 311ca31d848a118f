// A nip: a particle that two bodies pinch between them, such as one of a cloth on a table that a ball lies on. No motion of the
// particle can answer both, for their planes face each other. So the bodies meet there (constraints/body_meeting.h), as if the
// particle were a part of their surfaces, and the plane of the rougher body alone holds it (of the
// greater kinetic coefficient).
//   Hold       the particle is let go only where r.n + N < 0, N being the impulse between the bodies: with r.n < 0 it is the other
//              body that bears it, such as the weight of the cloth
//   At rest    the cloth goes along with the rougher body, which rubs it with mu (r.n + N); the smoother body
//              slides on the cloth, and so on the rougher one, with mu N
//   Running    with integrators that foresee contact, where the cloth slides on the body that holds it (and faster than friction could stop the body within the step,
//              where that reacts), such as a tablecloth that is pulled from under a dish, the
//              bodies do not rub on each other. The other one rubs the particle, too, with mu N against the slip s with which
//              the step begins; a slip that could be stopped within the step is damped, with h D = mu N / |s|.
#pragma once

#include "constraints/moving_body.h"
#include "constraints/touch.h"

namespace drape {

struct Nip {
  int particle;
  int a, b;            // bodies, of which one reacts at least; a < b
  int holder;          // a or b: whose plane holds the particle
  bool runs;           // the particle slides on its holder
  Touch touch;         // its gap is that of both sides together
  double impulse = 0;  // N, in the step under way [N s]
  int other() const { return holder == a ? b : a; }
};

// How two bodies that do not react stand to a place that goes with both of them, by the mean of their ways, to where the step
// ends. Bodies that close on a place have no room for what is there, and what they do not let slip out is clamped between them.
struct Squeeze {
  SurfacePoint at_a, at_b;  // there, with normals out of the bodies
  Vec3 way;                 // m/s, the mean
  bool closes;              // the bodies come nearer to each other
  bool
      holds;  // the place cannot slip out: one normal is as near to the opposite of the other as friction of both holds
};
// x [m]: the place when the step begins.
Squeeze squeeze(const MovingBody& a, const MovingBody& b, const Vec3& x);

}  // namespace drape
