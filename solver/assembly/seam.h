// Seams of a cloth: they close as time goes on, and their two rows of particles become one.
//   An open seam pulls the two vertices of each of its pairs together (solver/forces/seam_spring.h). Once its
//   time is over and no pair is farther apart than `near_enough` of the length of the edges there, the two
//   particles of each pair become one: mass and momentum are added, and the forces of the cloth are made
//   anew, across the seam as well. The Assembly merges the particles (solver/assembly/assembly.h). A pair of
//   a seam to be merged that begins nearer than `closed_already` of these edges becomes one in the first
//   step.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/lattice/embedding.h"
#include "mesh/triangles/triangle_mesh.h"
#include "solver/forces/fabric.h"
#include "solver/forces/force.h"
#include "solver/system/state.h"

namespace drape {

// What is to be sewn, and when.
struct SeamPlan {
  std::string name;                        // used in messages: "front.left / back.right"
  std::vector<std::pair<int, int>> pairs;  // vertices of the mesh, along the seam; a pair may be one vertex
  double close = 1;                        // time at which the seam is closed [s]
  std::optional<double> stiffness =
      {};             // of a stitch [N/m]; unset: k_s of the cloth, or a thousand times that without `merge`
  bool merge = true;  // false: the stitches are kept, and no particles become one
};

// All seams that the mesh declares (mesh/pattern/panels.h), to be closed at the time `close` [s].
std::vector<SeamPlan> declared_seam_plans(const TriangleMesh& mesh, double close);

// A seam that is closing.
struct OpenSeam {
  std::string name;
  std::vector<std::pair<int, int>> pairs;  // of different vertices
  std::vector<double> apart;               // distance of each pair at the start [m]
  double edge = 0;  // mean length at rest of the curves' edges, or of those at a single pair [m]
  double length_one = 0, length_two = 0;  // lengths of the two curves at rest [m]
  double close = 1;                       // s
  double stiffness = 0;                   // N/m
  bool merge = true;

  double gap(const Embedding& embedding, const VecX& x) const;  // of the pair that is farthest apart [m]
  bool begins_closed(
      std::size_t pair) const;  // so that the pair becomes one in the first step, if it is merged at all
  bool begins_closed() const;   // the same of all pairs
  // Takes out the pairs that may become one: all of them when its time is over and they have met, else those
  // that began closed.
  std::vector<std::pair<int, int>> take_closed(const Embedding& embedding, const State& state);
};

inline constexpr double near_enough = 0.1, closed_already = 0.01;

// Opens the seams of a mesh that stands where it starts; `rest` is as in solver/forces/noh_jung.h. Throws
// InputError when a pair names a vertex that is not there, or when a time or a stiffness makes no sense.
std::vector<OpenSeam> open_seams(const std::vector<SeamPlan>& plans, const Fabric& fabric,
                                 const TriangleMesh& mesh, const TriangleMesh& rest);

// The force that closes a seam, at the time t [s]; null when each of its pairs is one particle already.
std::unique_ptr<Force> stitches(const OpenSeam& seam, const Embedding& embedding, double t);
// Moves a force that stitches() made on to the time t [s].
void close_until(Force& force, const OpenSeam& seam, double t);

// number[i] is what particle i has become already. Returns what it becomes when these pairs of vertices
// become one, too, numbered anew in the same order.
std::vector<int> merged(const std::vector<int>& number, const std::vector<std::pair<int, int>>& pairs,
                        const Embedding& embedding);

}  // namespace drape
