// The shadow of a draped specimen on the ground, in parallel light from above, as a drape tester measures it:
//   drape coefficient = (shadow - plate) / (specimen - plate), of areas counted on one raster
#pragma once

#include <optional>
#include <vector>

#include "app/picture/image.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape::app {

// Which cells of a square about the origin, in the plane of x and z, are in the shadow.
class Shadow {
 public:
  // The shadow of a plate of this radius; the raster reaches out to `reach`. Lengths in m.
  Shadow(double plate_radius, double reach);
  void add(const std::vector<Triangle>& triangles, const std::vector<Vec3>& positions);

  double area() const;                  // m^2
  std::vector<double> outline() const;  // m, the largest radius in the shadow, in 720 directions
  // With a black circle round the specimen before it was draped, and, where a drape coefficient was measured,
  // a red one whose area is the shadow that was measured.
  drawing::Image picture(double specimen_radius, std::optional<double> measured_coefficient = {}) const;

 private:
  int cells_;  // along a side
  double cell_, reach_, plate_radius_;
  std::vector<char> dark_;
};

struct Waves {
  int nodes;         // how many folds the rim has: its maxima that stand out from the minima on both sides
  double amplitude;  // m, half of what lies between a maximum and a minimum, on average
};

// Of an outline all round. A maximum counts when it stands out by more than `least` [m] on both sides.
Waves waves(const std::vector<double>& outline, double least);

}  // namespace drape::app
