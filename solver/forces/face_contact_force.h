// The springs of constraints/face_contact.h as a force: its blocks stand where the edges of the cloth have
// theirs.
//   E = sum k/2 min(g, 0)^2,   f_k = (-k g n - d u) w_k,   K_kl = k w_k w_l n n^T,
//   D_kl = d w_k w_l (I - n n^T)
// What acts is linear within a solve, also where it starts on the other side of g = 0.
#pragma once

#include <memory>

#include "constraints/constraints.h"
#include "solver/forces/force.h"

namespace drape {

// Keeps a reference to the constraints, whose faces are those of this cloth. Add it once for all cloths, and
// after all faces were added.
std::unique_ptr<Force> face_contact_force(const Constraints& constraints);

}  // namespace drape
