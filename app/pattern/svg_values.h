// The small languages inside an SVG drawing: path data, transforms, numbers. The only door to svgpp.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mesh/pattern/curve.h"

namespace drape {

// One subpath of a 'd' attribute, in its own coordinates. A segment of no length is left out.
struct SvgPath {
  std::vector<Segment> segments;
  bool closed = false;  // by 'z'
};

// Throws InputError, without the place.
std::vector<SvgPath> parse_svg_path(const std::string& d);
Eigen::Matrix<double, 2, 3> parse_svg_transform(const std::string& text);

}  // namespace drape
