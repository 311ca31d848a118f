// Reads the small languages inside an SVG drawing: path data and transforms. The only file that includes
// svgpp is svg_values.cpp.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mesh/pattern/curve.h"

namespace drape::app {

// One subpath of a 'd' attribute, in its own coordinates. Segments without a length are left out.
struct SvgPath {
  std::vector<Segment> segments;
  bool closed = false;  // true when 'z' closes it
};

// Both throw InputError; its message does not name the place.
std::vector<SvgPath> parse_svg_path(const std::string& d);
Eigen::Matrix<double, 2, 3> parse_svg_transform(const std::string& text);

}  // namespace drape::app
