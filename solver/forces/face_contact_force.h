// The springs of constraints/face_contact.h, which explains the symbols, as a force. A contact fills the
// blocks of the edges of its triangle. d is the damper of the friction, u the slip [m/s].
//   E = sum k/2 min(g, 0)^2,   f_k = (-k g n - d u) w_k
//   K_kl = k w_k w_l n n^T,    D_kl = d w_k w_l (I - n n^T)
// A contact that acts is a linear spring within a solve, even when the solve starts at a gap g > 0.
#pragma once

#include <memory>

#include "constraints/constraints.h"
#include "solver/forces/force.h"

namespace drape {

// Keeps a reference to the constraints, whose faces are those of the cloths. Add one such force for all
// cloths, after all faces were added.
std::unique_ptr<Force> face_contact_force(const Constraints& constraints);

}  // namespace drape
