// What a body does to a particle that an explicit method has just moved: it locks nothing and solves nothing,
// but changes the velocity. There are two forms, each for one particle and one plane (constraints/contact.h):
//   phi  gap to the surface offset by the margin at the start of the step [m]
//   n    unit normal there, out of the body;  v_b: velocity of the body [m/s];  h: the step [s]
//
// velocity [LS: after Bridson, Marino & Fedkiw 2003], on the velocity v after the forces have acted:
//   v - v_b = v_N n + v_T,   phi_new = phi + h v_N
//   where phi_new < 0:  v_N' = v_N - phi_new / h,   v_T' = v_T max(0, 1 - mu |v_N' - v_N| / |v_T|)
// Of two coefficients of friction the static one says whether the particle stops, the kinetic one what it
// loses.
//
// restitution [SB], where phi < eps and v.n < 0, or where the path meets the surface within the step:
//   impact    v' = -k_r v_N n + v_T: friction has no part in it
//   support   where after the impact the forces f still push towards the body, n.f < 0, it answers with the
//             contact force -(n.f) n and with the friction -k_f (-n.f) v_T/|v_T|: the particle rests.
//             (v_T/|v_T| makes k_f Coulomb's coefficient and the product a force; SB writes v_t alone.) Both
//             are taken over the step as in LS: friction cannot turn the motion round.
// The path meets the surface after the part s of the step, with the velocity v_s = v_n + s (v - v_n); what
// the forces do in the part 1 - s comes after the impact. So a bounce makes no energy where the method makes
// none.
//
// A method moves x by the mean velocity u = (x' - x) / h of the step. For symplectic Euler u is v; for
// explicit Euler and midpoint it lags behind v. LS is then applied to both u and v: v' by the formula above,
// u_N' by the formula with u for v, u_T' by the share of v_T that friction leaves. So x + h u' is exactly on
// the surface, a particle at rest has v = 0, and one that sticks does not creep; for symplectic Euler
// u' = v', which is LS as written. (Adding h (v' - v) to x instead would leave a particle of explicit Euler
// on the surface with v = -g h.)
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

#include "constraints/contact.h"

namespace drape {

enum class ContactMode { constraint, velocity, restitution };

struct ContactModeInfo {
  ContactMode mode;
  std::string_view name, summary;
};
const std::array<ContactModeInfo, 3>& contact_modes();
std::string_view name(ContactMode mode);

// The form of LS as written, with the coefficients mu; returns v itself where phi_new >= 0.
Vec3 projected(const Vec3& v, const Vec3& v_b, const Vec3& n, double phi, const Friction& mu, double h);

// The impact of SB; returns v itself where the particle leaves the body.
Vec3 reflected(const Vec3& v, const Vec3& v_b, const Vec3& n, double k_r);

// The factor, from 0 to 1, by which friction reduces a slip [m/s] when the normal velocity changes by
// normal_change [m/s].
double slip_kept(const Friction& mu, double normal_change, double slip);

// The velocities of one particle in a step [m/s].
struct StepVelocities {
  Vec3 start, end;  // v_n, v_n+1
  Vec3 mean;        // (x_n+1 - x_n) / h
};

// Apply the two forms to a whole step; false where the step is left as it was. A particle that starts inside
// is brought out at the recovery speed [m/s] at most: LS gives it the velocity for that, SB moves it without
// one.
bool project(StepVelocities& step, const ContactPlane& plane, const Friction& mu, double recovery_speed,
             double h);
// eps: the layer above the surface that counts as touching [m]. Changes step.start to the velocity with which
// the step would have ended the same way without the impact.
bool rebound(StepVelocities& step, const ContactPlane& plane, const Friction& mu, double k_r, double eps,
             double recovery_speed, double h);

// The eps of SB for a body [m]: a twentieth of its margin. A bounce is lower by eps at most.
inline double contact_layer(double margin) { return std::max(0.05 * margin, 1e-6); }

}  // namespace drape
