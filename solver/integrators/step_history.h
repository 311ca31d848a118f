// What an implicit step knows of the steps before it, and the coefficients that follow from it.
//   order 1   gamma = 1                     x_bar = x_n                         [Baraff & Witkin 1998, eq. 6]
//   order 2   gamma = (1 + w) / (1 + 2 w)   x_bar = x_n + w^2 / (1 + 2 w) (x_n - x_{n-1})   [Choi & Ko 2002]
//             w = h_n / h_{n-1}; gamma = 2/3 and the factor 1/3 when steps do not change
//                                                                        [Hairer, Norsett & Wanner, III.5]
//   c = gamma h; v_bar is made like x_bar; contact adds its correction to x_bar.
//                                                      [Baraff & Witkin 1998, section 6 and eq. 18]
// Order 2 looks back over smooth motion only. Where there is no last step to look back to (at the first step,
// after a state was changed from outside, where a failed step is taken in halves, or where h has more than
// doubled) the step is of order 1. A particle that touches a body, or did in the last step, starts anew from
// its present motion u alone:
//   gamma m (v - v_n) = c f,   x = x_n + (h - c) u + c v      (u = v_n, or the target where it is locked)
// x [m], v [m/s], h [s].
#pragma once

#include <vector>

#include "constraints/contact_step.h"
#include "solver/integrators/pieces.h"
#include "solver/system/system.h"

namespace drape {

// A place and a velocity of every particle.
struct Point {
  VecX x, v;  // m, m/s
};

// The coefficients of one step; those that differ between particles are stored for each.
struct StepCoefficients {
  double h = 0, c = 0;        // s
  double ahead = 0;           // w above; 0: the step is of order 1
  double back = 0;            // in x_bar = x_n + back (x_n - x_{n-1})
  std::vector<double> scale;  // factor of a row: 1, or gamma where its particle starts anew
  std::vector<double> fall;   // how long gravity acts in a row before it is scaled [s]: c, or h there
  std::vector<double> mass;   // of the particles, scaled [kg]
  VecX x_bar, v_bar;
  bool order_2() const { return back > 0; }
};

class StepHistory {
 public:
  // order: the highest order, 1 or 2.
  explicit StepHistory(int order) : order_(order) {}

  int order() const { return order_; }
  void forget(const System& system);  // forgets the last step, for a system of other particles

  // Makes the coefficients of a step whose contacts have just been looked for.
  void begin(const State& state, const Piece& piece, const ContactStep& contacts);
  const StepCoefficients& coefficients() const { return k_; }
  // The last state, or with order 2 the point ahead of it at which the step is linearised first.
  void first_point(const State& state, Point& point) const;
  // Whether the velocity of this particle in first_point() is ahead of the last state.
  bool extrapolates(int particle) const { return k_.order_2() && !restarts(particle); }
  // Makes x_bar, v_bar and the masses with the contacts as they are at the time of the call.
  void update(const System& system, const State& state, const ContactStep& contacts);
  // Lets particles that have been caught meanwhile start anew, too.
  void restart_touching(const ContactStep& contacts);
  // Remembers a step that is done: it went from `state` to `end`.
  void remember(const State& state, const Point& end, const ContactStep& contacts);

 private:
  void mark_touching(const ContactStep& contacts);
  bool restarts(int particle) const { return touched_[particle] != 0; }

  int order_;
  StepCoefficients k_;
  // The two ends of the last step that was done.
  Point begin_, end_;
  double last_h_ = 0;          // length of that step [s]; 0: there is none
  std::vector<char> touched_;  // per particle: it met a body in the last step or in this one
  Filter filter_;              // scratch
};

}  // namespace drape
