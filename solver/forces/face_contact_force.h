// The springs of constraints/face_contact.h as a force. The blocks of a contact are those of the edges of its
// triangle.
//   E = sum k/2 min(g, 0)^2,   f_k = (-k g n - d u) w_k
//   K_kl = k w_k w_l n n^T,    D_kl = d w_k w_l (I - n n^T)
// A contact that acts is a linear spring within a solve, also when the solve starts at a gap g > 0.
#pragma once

#include <memory>

#include "constraints/constraints.h"
#include "solver/forces/force.h"

namespace drape {

// Keeps a reference to the constraints, whose faces are those of this cloth. Add it once for all cloths, and
// after all faces were added.
std::unique_ptr<Force> face_contact_force(const Constraints& constraints);

}  // namespace drape
