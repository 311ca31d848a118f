// What a body does to a particle that an explicit method has just moved: no lock and no solve, but another
// velocity. Two forms, of one particle and one plane (constraints/contact.h):
//   phi  gap to the surface offset by the margin at the start of the step [m]
//   n    unit normal there, out of the body;  v_b velocity of the body [m/s];  h the step [s]
//
// velocity [LS: after Bridson, Marino & Fedkiw 2003], on the velocity v after the forces have acted:
//   v - v_b = v_N n + v_T,   phi_new = phi + h v_N
//   where phi_new < 0:  v_N' = v_N - phi_new / h,   v_T' = v_T max(0, 1 - mu |v_N' - v_N| / |v_T|)
// Of two coefficients the static one says whether it stops, the kinetic one what it loses.
//
// restitution [SB], where phi < eps and v.n < 0, or where the path meets the surface within the step:
//   impact    v' = -k_r v_N n + v_T: friction has no part in it
//   support   contact force -(n.f) n and friction -k_f (-n.f) v_T/|v_T|, of what the forces push back towards
//             the body after the impact, n.f < 0: it rests. (v_T/|v_T|: so k_f is Coulomb's coefficient, and
//             a force. SB writes v_t alone.) Taken over the step as in LS: friction cannot turn the motion
//             round.
// The path meets the surface after the part s of the step, with the velocity v_s = v_n + s (v - v_n); what
// the forces do in the part 1 - s comes after the impact. So a bounce makes no energy where the method makes
// none.
//
// A method moves x by the mean velocity u = (x' - x) / h of the step, which is v for symplectic Euler only;
// explicit Euler and midpoint are still behind. LS then goes for both, u and v: v' by the formula as it
// stands, u_N' by the formula with u for v, u_T' by the share of v_T that friction leaves. So x + h u' is
// exactly on the surface, what rests has v = 0, what sticks does not creep; for symplectic Euler u' = v',
// which is LS as written. (h (v' - v) added to x instead leaves explicit Euler on the surface with v = -g h.)
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

// LS as written, mu for both coefficients; v itself where phi_new >= 0.
Vec3 projected(const Vec3& v, const Vec3& v_b, const Vec3& n, double phi, const Friction& mu, double h);

// SB's impact; v itself where it leaves.
Vec3 reflected(const Vec3& v, const Vec3& v_b, const Vec3& n, double k_r);

// What is left of a slip [m/s] when the normal velocity changes by so much: a factor from 0 to 1.
double slip_kept(const Friction& mu, double normal_change, double slip);

// A step of one particle [m/s].
struct StepVelocities {
  Vec3 start, end;  // v_n, v_n+1
  Vec3 mean;        // (x_n+1 - x_n) / h
};

// The forms on a whole step; false where it is left as it was. What starts inside is brought out at the
// recovery speed [m/s] at most: by LS with the velocity it takes for that, by SB without any.
bool project(StepVelocities& step, const ContactPlane& plane, const Friction& mu, double recovery_speed,
             double h);
// eps: the layer [m]. step.start becomes what it would have been to end so without the impact.
bool rebound(StepVelocities& step, const ContactPlane& plane, const Friction& mu, double k_r, double eps,
             double recovery_speed, double h);

// SB's eps of a body [m]: a twentieth of its margin, which a bounce is lower by at most.
inline double contact_layer(double margin) { return std::max(0.05 * margin, 1e-6); }

}  // namespace drape
