// What a cloth that tears remembers from step to step. solver/assembly/tear_rule.h says where it tears, and
// solver/assembly/tear.cpp makes the torn cloth.
#pragma once

#include <limits>
#include <vector>

namespace drape {

struct Tearing {
  double limit = 0;  // strain l / L - 1 of an edge above which the cloth tears there [-]
  // Vertex n + k of the mesh is a copy of vertex copy_of[k]; n: vertices at the start. Where a seam was
  // merged, particles may part at which each vertex stays whole.
  std::vector<int> copy_of;
  int cuts = 0;  // edges that were cut so far
  // By particle of the cloth, from its first one; those beyond the end were never cut.
  std::vector<char> at_cut;         // whether it is an end of an edge that was cut
  std::vector<double> rests_until;  // s: until then it draws back, because it has parted; 0: it never did
  double last = -std::numeric_limits<double>::infinity();  // s, when something was cut last
};

}  // namespace drape
