#include "solver/integrators/rest_frame.h"

#include <algorithm>
#include <numeric>

namespace drape {

void RestFrame::follow(const BlockPattern& pattern) {
  piece_ = connected_pieces(pattern);
  next_.resize(piece_.empty() ? 0 : *std::max_element(piece_.begin(), piece_.end()) + std::size_t{1});
  groups_.resize(next_.size());
}

int RestFrame::root(int piece) const {
  while (next_[piece] != piece) piece = next_[piece];
  return piece;
}

// By the blocks of the overlay that act.
void RestFrame::join_touching(const BlockMatrix& A) {
  std::iota(next_.begin(), next_.end(), 0);
  const BlockOverlay& overlay = A.overlay();
  const std::vector<int>& particle_of = A.pattern().particle_of();
  for (int k = 0; k < overlay.row_count(); ++k)
    overlay.in_row(k, [&](const BlockOverlay::Entry& e) {
      if (e.transposed || A.at(e.slot).isZero(0)) return;
      const int a = root(piece_[particle_of[overlay.row(k)]]), b = root(piece_[particle_of[e.column]]);
      next_[std::max(a, b)] = std::min(a, b);
    });
  for (int& next : next_) next = next_[next];  // what it names is lower, and is done already
}

// What holds a piece: pins and particles without mass, with the velocity that is prescribed; and bodies, with
// their own. (A contact that arrives in this step prescribes how the particle comes to the body.)
void RestFrame::add_bodies(const Constraints& constraints, const ContactStep& contacts, const Filter& filter,
                           const Point& point, const StepCoefficients& k) {
  const std::vector<int>& pinned = constraints.pinned();
  for (const FilterEntry& e : filter.entries())
    if (k.mass[static_cast<std::size_t>(e.particle)] == 0 ||
        std::binary_search(pinned.begin(), pinned.end(), e.particle))
      group_of(e.particle).held.add(point.v.segment<3>(3 * e.particle) + e.z, 1);
  for (const Contact& c : contacts.touching()) {
    if (c.planes == 0) continue;
    Group& group = group_of(c.particle);
    (c.grip == Grip::stick || c.clamped ? group.held : group.slides).add(c.plane[0].body_velocity, 1);
  }
  for (const FaceContact& c : contacts.touching_faces())
    if (c.active) group_of(c.particles[0]).slides.add(c.body_velocity, 1);
  for (const SelfContact& c : contacts.touching_cloth()) {
    if (c.body < 0 || !c.active) continue;
    for (std::size_t corner = 0; corner < 4; ++corner)
      if (c.weights[corner] != 0) {
        const int i = c.particles[corner];
        group_of(i).slides.add(constraints.bodies()[c.body].velocity(k.x_bar.segment<3>(3 * i)), 1);
      }
  }
}

bool RestFrame::find(const BlockMatrix& A, const Constraints& constraints, const ContactStep& contacts,
                     const Filter& filter, const Point& point, const StepCoefficients& k, const Vec3& gravity,
                     bool adrift, VecX& u) {
  join_touching(A);
  std::fill(groups_.begin(), groups_.end(), Group());
  add_bodies(constraints, contacts, filter, point, k);
  const int n = static_cast<int>(piece_.size());
  for (int i = 0; i < n; ++i) {
    const auto particle = static_cast<std::size_t>(i);
    if (const double m = k.mass[particle]; m > 0)
      group_of(i).moves.add(k.v_bar.segment<3>(3 * i) + k.fall[particle] * gravity, m);
  }
  bool any_slides = false;
  for (Group& group : groups_) {
    const bool slides = group.held.weight == 0 && group.slides.weight > 0;
    any_slides = any_slides || slides;
    Mean& mean = group.held.weight > 0 ? group.held : slides && !adrift ? group.slides : group.moves;
    if (mean.weight > 0) mean.sum /= mean.weight;
    group.moves = mean;
  }
  for (int i = 0; i < n; ++i) u.segment<3>(3 * i) = group_of(i).moves.sum;
  return any_slides;
}

}  // namespace drape
