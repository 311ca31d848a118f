// The springs of constraints/self_contact.h, which explains the symbols, as a force. A contact fills the
// blocks of its four particles.
//   E = f^2 / 2k + (H(d) - |t_0|^2 / 2) / k,   H(d) = d^2 / 2 while |d| <= mu f', else mu f' |d| - (mu f')^2 / 2
//   f_k = w_k (f n + t),   K_kl = w_k w_l k (n n^T + share (I - n n^T))
// f' is the f of the solve before: so the friction has an energy.
#pragma once

#include <memory>

#include "constraints/constraints.h"
#include "solver/forces/force.h"

namespace drape {

// Keeps a reference to the constraints, to which the triangles were added by add_self_faces.
std::unique_ptr<Force> self_contact_force(const Constraints& constraints);

}  // namespace drape
