// The velocity at which a piece of cloth would go if nothing in it moved: what an implicit step is judged
// against (solver/integrators/merit.h). A piece is what forces join in this step, those of contact among
// them. It is at rest
//   with what holds it:  the mean of the velocities that pins prescribe and of those of bodies where it sticks to them
//   else with the bodies that it slides on:  the mean of their velocities where it touches them
//   else with its own centre of mass:  u = sum m (v_bar + fall g) / sum m,  as it would move in this step without forces
// (All pieces that only slide may be asked to go with their centres of mass, too.) So a step has as much
// energy to spend as its motion within such a frame has. The common motion of cloth that flies, falls or is
// led along may not become energy of vibration, and the step is the same in any frame that moves steadily.
// v [m/s], m [kg].
#pragma once

#include <vector>

#include "constraints/contact_step.h"
#include "solver/integrators/step_history.h"
#include "solver/matrix/block_matrix.h"

namespace drape {

class RestFrame {
 public:
  void follow(const BlockPattern& pattern);  // finds the pieces

  // Sets u, 3 numbers a particle [m/s], for the system A of a step with these coefficients. The filter is
  // that of the velocity of the point. adrift: pieces that only slide go with their centre of mass. Returns
  // whether there are such.
  bool find(const BlockMatrix& A, const Constraints& constraints, const ContactStep& contacts,
            const Filter& filter, const Point& point, const StepCoefficients& k, const Vec3& gravity,
            bool adrift, VecX& u);

 private:
  struct Mean {
    Vec3 sum = Vec3::Zero();
    double weight = 0;
    void add(const Vec3& value, double by) {
      sum += by * value;
      weight += by;
    }
  };
  struct Group {
    Mean held, slides, moves;
  };
  int root(int piece) const;
  void join_touching(const BlockMatrix& A);
  void add_bodies(const Constraints& constraints, const ContactStep& contacts, const Filter& filter,
                  const Point& point, const StepCoefficients& k);
  Group& group_of(int particle) { return groups_[root(piece_[particle])]; }

  std::vector<int> piece_;     // by particle
  std::vector<int> next_;      // by piece: another one of its group, or itself where it stands for the group
  std::vector<Group> groups_;  // by the piece that stands for it
};

}  // namespace drape
