// Dry friction of the threads where a fabric is bent: a moment beside the elastic one of the plate
// (plate_force.h).
//   M = B kappa + m,   |m| <= H = 2HB / 2                       [Kawabata 1980, the loop of KES-FB2 is 2HB wide]
// In every triangle a spring acts on the curvatures kappa = (n . x_uu, n . x_vv, 2 n . x_uv), and slides
// where it is strained beyond what friction holds. With e_k = H_k kappa_k - rest_k [N/m], per area,
//   psi = |e|^2 / (2 e_0)  where |e| <= e_0: it sticks;   psi = |e| - e_0 / 2  beyond: it slides         [J/m^2]
//   m_k = H_k e_k / max(e_0, |e|),   so that (m_uu / H_warp)^2 + (m_vv / H_weft)^2 + (m_uv / H_twist)^2 <= 1
// H_twist^2 = H_warp H_weft / 2: a fabric of one H has it in every direction in which it is bent. Threads
// begin to slide one after the other, so friction holds in full only after a change of curvature, the onset:
// e_0 = onset sqrt(H_warp H_weft). A gentler bend is resisted as by a rigidity of B + H / onset. Where H
// differs along warp and weft, this is the mean of the two: it is onset sqrt(H_weft / H_warp) along the warp,
// and the inverse share along the weft. Where the spring rests, rest_k, stays during a step and follows the
// slide at its end. psi is convex in the curvature, and psi of the spring that has followed is never more: so
// friction takes energy and makes none. n turns with the triangle, and so does the moment.
//
// An implicit step takes the force at x + y, where an undisturbed step ends, and as stiffness the parabola
// that touches psi there and lies above it; Stiffness::tangent is the second derivative of psi. Both are
// positive semidefinite. How n turns is in the force and left out of the matrix.
#pragma once

#include <memory>
#include <vector>

#include "solver/forces/chunk_schedule.h"
#include "solver/forces/force.h"
#include "solver/forces/plate.h"

namespace drape {

// Where the springs rest, by triangle of the mesh. A cloth keeps it when its forces are made anew.
struct BendMemory {
  std::vector<Vec3> rest;  // rest_k above [N/m]
  std::vector<Vec3> kept;  // the same as of the last keep()
  bool begun = false;  // the first step sets rest: the springs are at rest in the shape that it begins with
};

struct PlateFrictionLaw {
  double warp, weft;  // H [N]
  double onset;       // 1/m

  Vec3 moments() const;  // H_warp, H_weft and H_twist [N]
  double e_0() const;    // J/m^2
};

class PlateFriction final : public Force {
 public:
  // Vertex 0 of the plate is the particle `first_particle`.
  PlateFriction(const std::vector<PlateCurvature>& plate, const PlateFrictionLaw& law,
                std::shared_ptr<BendMemory> memory, int first_particle = 0);

  std::string_view name() const override { return "bend friction"; }
  void list_pairs(std::vector<ParticlePair>& pairs) const override;
  void bind(const BlockLayout& layout) override;
  bool begin_step(const StepStart& start) override;
  void end_step(const VecX& x) override;
  void keep() override { memory_->kept = memory_->rest; }
  void go_back() override { memory_->rest = memory_->kept; }
  double energy(const VecX& x) const override;
  void add_force(const VecX& x, const VecX& v, VecX& f) const override;
  void add_linearised(const VecX& x, const VecX& v, const VecX& y, double c, Stiffness stiffness,
                      BlockMatrix& A, VecX& b) const override;

 private:
  struct Share {
    int particle;
    Vec3 weights;  // H_k times those of the curvature [N/m^2]
  };
  struct Triangle {
    std::size_t number;  // in the memory
    std::array<int, 3> corners;
    Eigen::Matrix<double, 3, 2> slopes;
    double area;             // m^2
    std::size_t share, end;  // of its shares
    std::size_t slot;        // of its pairs: (0, 0), (0, 1), ...
  };
  struct Bent;  // how a triangle is bent at a state

  template <class At>
  Bent bent(const Triangle& t, const At& at) const;
  void push(const Triangle& t, const Bent& b, double factor, VecX& f) const;
  void add_blocks(const Triangle& t, const Bent& b, double factor, bool tangent, BlockMatrix& A) const;
  template <class F>
  void run(const F& f) const;

  double e_0_;  // J/m^2
  std::shared_ptr<BendMemory> memory_;
  std::vector<Triangle> triangles_;
  std::vector<Share> shares_;
  std::vector<int> slots_;
  ChunkSchedule schedule_;
};

}  // namespace drape
