#include "mesh/triangles/normals.h"

namespace drape {

Vec3 newell_normal(const std::vector<Vec3>& positions, const int* corners, int count) {
  Vec3 sum = Vec3::Zero();
  const Vec3& origin = positions[corners[0]];  // any point would do; a near one keeps the digits
  for (int i = 1; i + 1 < count; ++i)
    sum += twice_area_normal(origin, positions[corners[i]], positions[corners[i + 1]]);
  return sum / 2;
}

std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.positions.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 normal = twice_area_normal(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
    for (int v : t) normals[v] += normal;
  }
  for (Vec3& normal : normals)
    if (const double length = normal.norm(); length > 0) normal /= length;
  return normals;
}

}  // namespace drape
