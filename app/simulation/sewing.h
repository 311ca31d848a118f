// A garment made of a flat pattern: its panels placed, and its seams closed as time goes on.
//   An open seam pulls its pairs of vertices together (solver/forces/seam_spring.h). Once the time is over and no
//   pair is farther apart than near_enough of the edges there, the two particles of each become one: mass and
//   momentum are added, and the cloth gets its connections anew, now also across the seam.
#pragma once

#include <memory>

#include "app/scene/scene.h"
#include "mesh/lattice/embedding.h"
#include "solver/forces/force.h"
#include "solver/system/state.h"

namespace drape {

// The curves of one seam, vertex by vertex.
struct OpenSeam {
  std::string name;  // "front.left / back.right"
  std::vector<std::pair<int, int>> pairs;
  std::vector<double> apart;  // m, of each pair at the start
  double edge = 0;            // m, mean length of the curves' edges at rest
  double close = 1;           // s
  double stiffness = 0;       // N/m
  bool merge = true;

  double gap(const Embedding& embedding, const VecX& x) const;  // m, the widest
  // It may be merged: its time is over, and its pairs have met.
  bool closed(const Embedding& embedding, const State& state) const;
};

inline constexpr double near_enough = 0.1;

// Throws InputError when a panel is no group of the mesh or shares a vertex with another one.
void place_panels(const ClothEntry& entry, TriangleMesh& mesh, Names& messages);

// The mesh is placed, its rest shape as in solver/forces/noh_jung.h. Throws InputError when a curve is missing or
// two have different numbers of vertices; what is gathered is said in the messages.
std::vector<OpenSeam> open_seams(const ClothEntry& entry, const TriangleMesh& mesh, const TriangleMesh& rest,
                                 Names& messages);

// The force that closes a seam, at the time t [s]; null when all its pairs are one particle already.
std::unique_ptr<Force> stitches(const OpenSeam& seam, const Embedding& embedding, double t);
// Lets a force of stitches() go on to the time t.
void close_until(Force& force, const OpenSeam& seam, double t);

// What each particle becomes when the pairs of these seams do, numbered anew in their order, after what it
// has become already.
std::vector<int> merged(const std::vector<int>& number, const std::vector<const OpenSeam*>& seams,
                        const Embedding& embedding);

}  // namespace drape
