// Takes the place of hull.cpp in a build without Bullet.
#include "constraints/hull.h"

namespace drape {

bool Hull::available() { return false; }

Hull::Hull(const std::vector<Vec3>&) {}
Hull::Hull(const TriangleMesh&) {}

void add_touches(const PlacedHull&, const PlacedHull&, double, std::vector<Touch>&) {}

}  // namespace drape
