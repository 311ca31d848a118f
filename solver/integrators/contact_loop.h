// The contact loop, the same for all integrators: it solves within the contacts, sees what the solution does
// to them, and solves again until they agree with it.
//                                                                  [Baraff & Witkin 1998, section 5]
//   A contact that would pull is let go, one that is pushed along the surface harder than it sticks slides,
//   and a particle that would pass through a body is caught. Then bodies that react move as the impulses make
//   them.
#pragma once

#include "constraints/contact_step.h"
#include "mesh/base/stopwatch.h"
#include "solver/integrators/integrator.h"

namespace drape::internal {

// What a solve within the contacts gave; the loop reads it, the solver owns it.
struct ContactTrial {
  const VecX& v;  // m/s, at the end of the step
  const VecX& x;  // the motion that v makes [m]
  const VecX& r;  // impulses with which the constraints held the particles [N s]
  double noise;   // an impulse below this may be round-off of the solve [N s]
};

// An Attempt offers
//   bool solve()                     solves within the contacts as they are; false: it failed, and so does
//                                    the loop
//   ContactTrial trial()             returns what the solve gave
//   void release()                   moves on what is not held any more, before the contacts are judged
//   bool refine()                    makes the next solve more accurate; false: it was accurate already
//   void changed(ContactChange)      the contacts have changed: makes anew what depends on them
//   void bodies_moved()              the same for bodies that react
// At most `most` solves are answered by other contacts, for each motion that is tried for a body that reacts.
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
