// What is taken from a .msh file, as it stands there: nodes by their numbers.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "mesh/base/vectors.h"
#include "mesh/tetrahedra/msh_words.h"

namespace drape::internal {

struct MshParts {
  struct Node {
    long long number;
    Vec3 x;  // m
  };
  struct Element {  // a tetrahedron, and where it stands in the file
    long long number;
    std::array<long long, 4> nodes;
    std::size_t place;
  };
  std::vector<Node> nodes;
  std::vector<Element> tetrahedra;
  std::map<std::string, std::set<long long>> groups;  // nodes of the physical groups that have a name
  std::map<std::string, long> passed_over;            // other elements, by the name of their kind
};

// Throws InputError, as parse_msh does (mesh/tetrahedra/msh.h).
MshParts read_parts(MshWords& words);

}  // namespace drape::internal
