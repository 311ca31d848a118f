#include "mesh/triangles/normals.h"

namespace drape {

Vec3 newell_normal(const std::vector<Vec3>& positions, const int* corners, int count) {
  Vec3 sum = Vec3::Zero();
  const Vec3& origin = positions[corners[0]];  // any point would do; a near one keeps the digits
  for (int i = 1; i + 1 < count; ++i)
    sum += twice_area_normal(origin, positions[corners[i]], positions[corners[i + 1]]);
  return sum / 2;
}

}  // namespace drape
