// Bodies as cloth meets them with its triangles: surfaces whose vertices are particles that are held and go
// where the bodies take them. With them the corners and edges of a body meet the triangles and edges of the
// cloth, so that a needle does not come through between the vertices. They are the meshes among the bodies,
// and polyhedra in convex shapes that move (MovingBody::skin): a body with a mass would else fall through a
// sheet whose triangles are as large as itself, since springs alone keep its faces off.
//   Cloth that starts in a body, or through its surface, has to come out first: its particles near there are
//   pinched, and may pass. So may cloth that nothing could keep off, as where two bodies press it through
//   each other. They are pinched until they are outside again.
// Internal to the library's constraints.
#pragma once

#include <utility>
#include <vector>

#include "constraints/moving_body.h"
#include "constraints/self_contact.h"
#include "constraints/step_motion.h"

namespace drape::internal {

class Surfaces {
 public:
  // Begins the step of the particles of the cloth. True when there are other surfaces, or other particles,
  // than in the last step.
  bool begin_step(const std::vector<MovingBody>& bodies, const StepMotion& cloth);
  // Takes the ends of the ways anew, after bodies that react have changed their motion.
  void follow(const std::vector<MovingBody>& bodies);

  int cloth() const {
    return cloth_;
  }  // particles of the cloth; those of the surfaces have the numbers from there on
  bool any() const { return !faces_.empty(); }
  const std::vector<SelfFace>& faces() const { return faces_; }
  int body_of(int particle) const { return body_[particle - cloth_]; }
  double thickest() const { return thickest_; }  // of the faces [m]
  // Whether the particle is of a body that never moves.
  bool is_still(int particle) const { return particle >= cloth_ && still_[particle - cloth_] != 0; }
  const StepMotion& step() const { return step_; }  // of all particles
  // The places of all particles at the end of a step that takes the cloth to x_new [m]. Good until the next
  // call.
  const VecX& with(const VecX& x_new);

  // Which particles of these triangles of the cloth are pinched when a run begins, or was changed from
  // outside.
  void look(const std::vector<MovingBody>& bodies, const std::vector<SelfFace>& cloth);
  // The same while some are; it is looked at anew every few steps.
  void look_again(const std::vector<MovingBody>& bodies, const std::vector<SelfFace>& cloth);
  void pinch(int particle);  // from now on
  bool is_pinched(int particle) const { return pinched_[particle] != 0; }
  int pinched() const { return count_; }

 private:
  void set(const std::vector<MovingBody>& bodies);
  void place(const std::vector<MovingBody>& bodies, bool start);

  int cloth_ = -1, bodies_ = 0;
  struct Surface {
    int body, first;  // its first particle
    bool still;
  };
  std::vector<Surface> surfaces_;
  std::vector<SelfFace> faces_;
  std::vector<int> body_;    // by particle of the surfaces
  std::vector<char> still_;  // likewise
  bool placed_ = false;      // what is still
  double thickest_ = 0;
  StepMotion step_;
  VecX x_new_, ends_;          // m; ends_: of the surfaces
  std::vector<char> pinched_;  // by particle of the cloth
  int count_ = 0, since_ = 0;  // since_: steps since it was looked at
};

}  // namespace drape::internal
