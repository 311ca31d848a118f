// An order of a graph's vertices in which neighbours stand near each other.
#pragma once

#include <vector>

namespace drape::internal {

// The neighbours of every vertex: sorted, each once, without the vertex itself.
struct Graph {
  std::vector<int> start, neighbour;
  int degree(int i) const { return start[i + 1] - start[i]; }
};

class LocalityOrder {
 public:
  // Reverse Cuthill-McKee order [Cuthill & McKee 1969]. Each connected piece starts from one of its ends: the
  // last vertex of two searches. Memory of the last call is used again.
  void find(const Graph& g, std::vector<int>& order);

 private:
  std::vector<int> trial_;
  std::vector<char> seen_, scratch_;
};

}  // namespace drape::internal
