// The contact loop, the same for all integrators: solve within the contacts, see what the solution does to
// them, and solve again until they agree with it.                          [Baraff & Witkin 1998, section 5]
//   A contact that would pull lets go, one that is pushed harder than it sticks slides, what would pass through
//   a body is caught. Then bodies that react move as the impulses make them.
#pragma once

#include "constraints/contact_step.h"
#include "mesh/base/stopwatch.h"
#include "solver/integrators/integrator.h"

namespace drape::internal {

// What a solve within the contacts gave: read by the loop, owned by the solver.
struct ContactTrial {
  const VecX& v;  // m/s, at the end of the step
  const VecX& x;  // m, the motion that v makes
  const VecX& r;  // N s, what the constraints held the particles with
  double noise;   // N s, an impulse that may be round-off of the solve
};

// An attempt offers
//   bool solve()                     within the contacts as they are; false: it failed, and so does the loop
//   ContactTrial trial()             what it gave
//   void release()                   moves on what is not held any more, before it is judged
//   bool refine()                    solves more closely the next time; false: it did already
//   void changed(ContactChange)      contacts are others: makes anew what depends on them
//   void bodies_moved()              the same for bodies that react
// At most `most` solves are answered by other contacts, for every motion that is tried for a body that reacts.
template <class Attempt>
bool settle_contacts(ContactStep& contacts, int most, Attempt& attempt, StepReport& report) {
  for (int round = 0;; ++round) {
    if (!attempt.solve()) return false;
    if (!contacts.holds_anything()) return true;
    const Stopwatch watch(report.collide_ms);
    const ContactTrial trial = attempt.trial();
    contacts.receive(trial.v, trial.r);
    if (!contacts.bodies()) return true;
    attempt.release();
    const ContactChange change =
        round < most ? contacts.judge(trial.v, trial.r, trial.x, trial.noise) : ContactChange{};
    if (change.any()) {
      attempt.changed(change);
    } else if (!attempt.refine()) {
      if (!contacts.move_bodies(trial.noise)) return true;
      round = 0;
      attempt.bodies_moved();
    }
  }
}

}  // namespace drape::internal
