// A rope: a chain of particles that resists being stretched and being bent. It rests straight, and at the distances of
// its points.
//   stretch  E = EA / (2 L) (l - L)^2              of two neighbours, and damped along them by C_s / L
//   bend     E = B / (2 d) |p|^2,  p = (x_0 - x_1) / a + (x_2 - x_1) / b,  d = (a + b) / 2      of three neighbours
// L, a, b [m]: lengths of segments at rest; l [m]: length now; EA [N]: stretch; B [N m^2]: bend; C_s [N s]: what damps it.
// p / d is the curvature, to second order in the length of the segments as long as they hardly stretch. E is quadratic in the
// positions: its Hessian is constant and positive semidefinite. The laws: solver/forces/rope_laws.h.
//                                                              [Bergou et al. 2006]
// A turn by the angle t between two segments has |p| = 2 sin(t/2) and so the moment (B / d) sin(t): at most B / d, and none where
// the rope is folded over in one particle, which stores 2 B / d. Where the tension changes along the rope, p has a part along it, too, which makes tensions wrong by a
// share of B / (EA L^2): nothing, but for a rope that is as soft as its segments are thick.
//   Bending is damped by C_b [N m^2 s]: with q = u - t, of the directions t and u of the two segments, so that q / d is the
// curvature, half of the power that goes is
//   W = C_b / (2 d) ((q . q')^2 + q_0^2 |q'|^2) / (|q|^2 + q_0^2),      q' = dq/dt
// What is hardly bent, |q| < q_0, is damped in all directions; what is bent further only as far as |q| changes. A bend that goes
// round keeps |q|: it is not damped, because nothing tells it from a rope that turns as a whole and must keep
// its spin (twist would). Where a segment is pressed to less than half of its length, C_b counts for less. q_0 / d is 1e-3 1/m. Without it the direction of q would be that of round-off where a rope is straight.
//   A segment resists compression as it resists tension. A rope that is pushed does not become shorter, it bows out, and
// its particles do that by themselves. With springs that go slack, nothing would keep the particles of a rope apart that
// nothing pulls. Twist is not modelled: a particle has no direction of its own.
//   Each particle has half of the mass of the segments beside it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mesh/base/vectors.h"
#include "solver/forces/force.h"

namespace drape {

struct RopeMaterial {
  double mass_per_length = 0.05;  // kg/m
  double stretch = 1e4;           // N, EA: the force that would stretch it to twice its length
  double bend = 1e-3;             // N m^2, B
  double damping = 0;             // N s, C_s
  double bend_damping = 0;        // N m^2 s, C_b
  double radius = 5e-3;           // m: it rests that far off a body, beside the body's margin
};

// Throws InputError, which names the field, when a value makes no sense.
void check(const RopeMaterial& material);

// The masses of the particles [kg] of a rope through these points [m].
std::vector<double> rope_masses(const std::vector<Vec3>& points, const RopeMaterial& material);

// The forces of a rope that rests with the lengths between these points [m]. particles: the number of each in the
// system. Throws InputError when there are fewer than two points, or when two that follow each other are at one place.
std::vector<std::unique_ptr<Force>> rope_forces(const std::vector<Vec3>& points,
                                                std::span<const int> particles, const RopeMaterial& material);

}  // namespace drape
