// What a run reports of a state, beside what the step itself says.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "solver/state.h"

namespace drape {

// Largest relative stretch of an edge: max (l - L) / L over the edges that have a rest length L [m]; 0 when
// none is stretched.
class EdgeStrain {
 public:
  void add(const TriangleMesh& mesh, int first_particle);
  double largest(const VecX& x) const;

 private:
  struct RestEdge {
    int i, j;
    double length;  // m
  };
  std::vector<RestEdge> edges_;
};

double max_speed(const VecX& v);  // m/s, of a particle

// FNV-1a, 64 bits, over the bytes of x and then v, as 16 hexadecimal digits: the same when every bit is the
// same.
std::string state_hash(const State& state);

struct Distribution {
  double median = 0, p95 = 0, max = 0, mean = 0;
};
Distribution distribution(std::vector<double> values);  // zeros when there are none

}  // namespace drape
