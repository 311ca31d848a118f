#include "solver/assembly/cloth.h"

#include <algorithm>

namespace drape {

void Cloth::renumber(const std::vector<int>& number) {
  embedding.renumber(number);
  for (RestEdge& e : edges) {
    e.i = number[e.i];
    e.j = number[e.j];
  }
  int low = number[first_particle], high = low;
  for (int i = first_particle; i < end_particle; ++i) {
    low = std::min(low, number[i]);
    high = std::max(high, number[i]);
  }
  first_particle = low;
  end_particle = high + 1;
}

double largest_strain(const std::vector<Cloth>& cloths, const VecX& x) {
  double largest = 0;
  for (const Cloth& cloth : cloths)
    for (const RestEdge& e : cloth.edges)
      largest = std::max(largest, (x.segment<3>(3 * e.j) - x.segment<3>(3 * e.i)).norm() / e.L - 1);
  return largest;
}

std::vector<int> pinned_particles(const PinRule& rule, const Cloth& cloth, const VecX& x) {
  std::vector<int> particles;
  if (cloth.soft && std::holds_alternative<PinBox>(rule)) {
    TriangleMesh points;  // the particles themselves
    points.positions =
        unstacked(x.segment(3 * cloth.first_particle, 3 * (cloth.end_particle - cloth.first_particle)));
    particles = select(rule, points);
    for (int& p : particles) p += cloth.first_particle;
    return particles;
  }
  for (int v : select(rule, cloth.mesh))
    for (const Embedding::Share& share : cloth.embedding.shares(v)) particles.push_back(share.particle);
  std::sort(particles.begin(), particles.end());
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  return particles;
}

}  // namespace drape
