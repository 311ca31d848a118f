// A nip: a particle that two bodies pinch between them, such as one of a cloth on a table that a ball lies
// on. No motion of the particle can answer both, for their planes face each other. So the bodies meet there
// (constraints/body_meeting.h), as if the particle were a part of their surfaces: they meet where they are
// nearest to each other beside it, as far apart as both of their margins say. The plane of the rougher body
// alone holds the particle (of the greater kinetic coefficient). Two bodies that do not react have no way to
// give: where they close on a particle they clamp it (constraints/contact.h).
//   Hold       the particle is let go only where r.n + N < 0, N being the impulse between the bodies: with r.n < 0 it is the other
//              body that bears it, such as the weight of the cloth
//   At rest    the cloth goes along with the rougher body, which rubs it with mu (r.n + N); the smoother body
//              slides on the cloth, and so on the rougher one, with mu N
//   Running    with integrators that foresee contact, where the cloth slides on the body that holds it, such as a tablecloth
//              that is pulled from under a dish, the bodies do not rub on each other. The other one rubs the
//              particle, too, with mu N against the slip s with which the step begins; a slip that could be
//              stopped within the step is damped, with h D = mu N / |s|.
#pragma once

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

}  // namespace drape
