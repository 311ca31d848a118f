// The parts of a plate's energy (solver/forces/plate.h) in a substep of the integrator "pbd": each is an
// element of up to three vectors d = sum x_v w_v^T, taken as solver/forces/substep.h says, and exactly,
// because it is linear:
//   dlambda (1 + h (h + T) W Z) = -(lambda + h (d + T v_d) Z),   W = sum w_v w_v^T / m_v
// lambda has a column for each of the vectors [N s m], T [s] is the viscosity over the stiffness Z.
#pragma once

#include "solver/forces/colours.h"
#include "solver/forces/plate.h"
#include "solver/forces/substep.h"

namespace drape {

class PlateParts {
 public:
  // Vertex 0 is the particle `first`.
  PlateParts(const std::vector<PlatePart>& parts, double time, int first);

  void colour(int particles);  // once, before the first run
  void run(Substep& substep);

 private:
  struct Part {
    Mat3 stiffness;
    std::size_t begin, end;  // of its shares
  };
  void relax(const Part& part, Substep& substep, Mat3& lambda) const;

  double time_;  // s
  std::vector<Part> parts_;
  std::vector<PlatePart::Share> shares_;
  std::vector<Mat3> lambda_;  // of each part
  Colours colours_;
  bool coloured_ = false;
};

}  // namespace drape
