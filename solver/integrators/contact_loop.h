// The contact loop, the same for all integrators: it solves within the contacts, sees what the solution does
// to them, and solves again until they agree with it.
//                                                                  [Baraff & Witkin 1998, section 5]
//   A contact that would pull is let go, one that is pushed along the surface harder than it sticks slides,
//   and a particle that would pass through a body is caught. Then bodies that react move as the impulses make
//   them.
// This is a primal-dual active set with inexact solves: every round decides all contacts, and is solved only as
// accurately as the contacts are settled.                    [Hintermueller, Ito & Kunisch 2002]
#pragma once

#include <optional>

#include "constraints/contact_step.h"
#include "mesh/base/stopwatch.h"
#include "solver/integrators/integrator.h"

namespace drape::internal {

// What a solve within the contacts gave; the loop reads it, the solver owns it.
struct ContactTrial {
  const VecX& v;         // m/s, at the end of the step
  const VecX& x;         // the motion that v makes [m]
  const VecX& r;         // impulses with which the constraints held the particles [N s]
  double noise;          // an impulse on a body below this may be round-off of the solve [N s]
  double speed_noise;    // a change of a particle's velocity below this may be round-off of the solve [m/s]
  double reference;      // the impulse of the weight, or a larger one that acts [N s]
  double curvature = 0;  // d . A d of the way d from contacts.accepted_velocity() to v [J]
};

// How often a step is solved again because cloth would pass through cloth where no spring was. What passes in spite
// of them is stopped by the guard.
inline constexpr int max_meetings = 3;

// An Attempt offers
//   bool solve()                     solves within the contacts as they are; false: it failed, and so does
//                                    the loop
//   bool worth_settling()            false: the step overshoots and will be solved anew, so that the contacts need
//                                    not agree with it
//   ContactTrial trial()             returns what the solve gave
//   void release()                   moves on what is not held any more, before the contacts are looked at
//   bool refine(imbalance)           makes the next solve more accurate, if this one was less accurate than
//                                    contacts with this imbalance [-] need; false: it was accurate enough
//   void changed(ContactChange)      the contacts have changed: makes anew what depends on them
//   void bodies_moved()              the same for bodies that react
// The contacts have settled when the imbalance of impulses is at most contact_tolerance(options) of the
// reference. At most max_contact_solves solves are answered by other contacts, for each motion that is tried for
// a body that reacts.
// `imbalance` [-] is how far the contacts are from settled in the end.
template <class Attempt>
bool settle_contacts(ContactStep& contacts, const StepOptions& options, Attempt& attempt, StepReport& report,
                     double& imbalance) {
  imbalance = 0;
  int meetings = 0;
  for (int round = 0;; ++round) {
    if (!attempt.solve()) return false;
    if (!contacts.holds_anything()) return true;
    std::optional<Stopwatch> watch(std::in_place, report.collide_ms);
    const auto change_to = [&](const ContactChange& change) {
      watch.reset();  // what is made anew counts as what it is, such as assembly
      attempt.changed(change);
    };
    const ContactTrial trial = attempt.trial();
    contacts.receive(trial.v, trial.r, trial.x);
    if (!contacts.meets_anything() || !attempt.worth_settling()) return true;
    attempt.release();
    const ContactImbalance found = contacts.imbalance(trial.v, trial.r, trial.x);
    imbalance = found.relative_to(trial.reference);
    if (imbalance > contact_tolerance(options) && round < options.max_contact_solves) {
      if (const ContactChange change =
              contacts.react(trial.v, trial.r, trial.x, trial.speed_noise, trial.curvature);
          change.any()) {
        attempt.refine(imbalance);
        change_to(change);
        continue;
      }
    }
    if (attempt.refine(0)) continue;
    if (meetings < max_meetings) {
      if (const ContactChange change = contacts.meet(trial.x); change.any()) {
        ++meetings;
        change_to(change);
        continue;
      }
    }
    if (!contacts.move_bodies(trial.noise)) {
      contacts.settle(trial.v, trial.r);
      return true;
    }
    round = 0;
    watch.reset();
    attempt.bodies_moved();
  }
}

}  // namespace drape::internal
