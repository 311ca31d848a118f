#include "mesh/lattice/solid.h"

#include <Eigen/LU>
#include <algorithm>

#include "mesh/distance/surface_faces.h"
#include "mesh/triangles/topology.h"

namespace drape {

using namespace internal;

namespace {

std::vector<Triangle> wound(TriangleMesh surface) {
  const std::vector<Face> anew = surface_faces(surface).faces;
  const std::vector<int> weld = welded(surface.positions);
  for (Triangle& t : surface.triangles)
    for (int& v : t) v = weld[v];
  const std::vector<Edge> all = edges(surface);
  const bool one_way =
      std::all_of(all.begin(), all.end(), [](const Edge& e) { return e.triangles == 2 && e.forward == 1; });
  std::vector<Triangle> triangles;
  if (one_way)
    for (int t : counted_triangles(surface)) triangles.push_back(surface.triangles[t]);
  else
    for (const Face& face : anew) triangles.push_back(face.v);
  return triangles;
}

}  // namespace

Solid solid_of(const TriangleMesh& surface) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& x : surface.positions) middle += x / static_cast<double>(surface.vertex_count());
  double volume = 0;
  Vec3 first = Vec3::Zero();   // integral of x
  Mat3 second = Mat3::Zero();  // integral of x x^T
  for (const Triangle& t : wound(surface)) {
    Mat3 corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = surface.positions[t[k]] - middle;
    const double det = corners.determinant();
    const Vec3 sum = corners.rowwise().sum();
    volume += det / 6;
    first += det / 24 * sum;
    second += det / 120 * (corners * corners.transpose() + sum * sum.transpose());
  }
  if (volume < 0) volume = -volume, first = -first, second = -second;
  const Vec3 offset = first / volume;
  second -= volume * offset * offset.transpose();
  return {volume, middle + offset, second.trace() * Mat3::Identity() - second};
}

}  // namespace drape
