// Where a cloth tears: which edges of its mesh are cut at the end of a step (mesh/triangles/tear.h).
//   s_ij = l / L - 1                 strain of the edge from vertex i to j; above a limit the cloth tears at one of its ends
//   p_ij = max(0, s_ij) (x_j - x_i) / l                          pull of j at i
//   R_A = sum of p_ij over j in A + half of p_ij over the edges that are cut,  R_B the same of B
//   sigma = min(n . R_A, -n . R_B),  n = (R_A - R_B) / |R_A - R_B|     pull that parts A from B
// A vertex is parted by two edges of its, or at a border by one, which divide the triangles round it into A
// and B. Of all such pairs of edges those are cut for which sigma is largest: so the cloth tears across its
// stretch, as straight as the mesh allows. One end of an edge is parted: that at a border rather than that
// inside, else that of the larger sigma. Where sigma is below half the limit, nothing holds on the other
// side, as at the end of a loose strip, and nothing is cut.
//   - Tears that are there grow before others begin: at their tips, which are the ends of cut edges that have not parted themselves, by
//     one vertex in a step, where an edge is strained too far, the most strained first. No two cuts of a step
//     have a vertex in common, but those that part one vertex.
//   - A tear begins at the most strained edge where this is possible, one in a step, and only where nothing was cut for
//     `draw_back`: a tear relieves the cloth round it, which would shatter otherwise. A branch from the side
//     of a tear waits as long.
//   - A vertex that has parted draws back for as long, and its edges are not looked at meanwhile.
//   - A vertex that is held does not begin to part: its copies would be held, too, and nothing would be relieved. Where
//     a tear from elsewhere ends at one that is held at a border, this one parts, and both are held.
// Only strains are looked at, so that the rule is the same whatever makes the forces.  x [m], times [s].
// Internal to the library's solver.
#pragma once

#include <vector>

#include "mesh/triangles/tear.h"
#include "solver/assembly/tearing.h"

namespace drape::internal {

inline constexpr double draw_back = 0.02;  // s

struct StrainedEdge {
  int a, b;  // vertices, a < b
  double strain;
};

struct TearingCloth {
  const TriangleMesh&
      mesh;  // its triangles between particles, which are the vertices here, as it is torn so far
  const std::vector<Vec3>& x;       // m, of the particles
  std::vector<StrainedEdge> edges;  // in any order; of several at one place the most strained counts
  std::vector<char> held;           // by vertex
  std::vector<CutEdge> never_cut;   // edges that stay whole, the lower vertex first; sorted
};

// Whether a vertex may part at the time t [s], where an edge of its is strained too far and nothing holds it:
// a tear ends there and may grow, or another may begin by now. No edge is cut of which neither end may, or of
// which one draws back.
bool may_part(int vertex, const Tearing& tearing, double t);
// Whether a vertex draws back at the time t [s], because it has parted.
bool draws_back(int vertex, const Tearing& tearing, double t);

// The edges that are cut at the time t [s].  O(n log n) for n triangles.
std::vector<CutEdge> edges_to_cut(TearingCloth cloth, const Tearing& tearing, double t);

// Notes what was cut at the time t. copies: those that the cut made, as TornTriangles::copy_of; they are the
// last of `vertices`.
void note_cuts(const std::vector<CutEdge>& cuts, const std::vector<int>& copies, double t,
               std::size_t vertices, Tearing& tearing);

}  // namespace drape::internal
