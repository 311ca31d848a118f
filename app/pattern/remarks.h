// Messages about the triangles that a sewing pattern was cut into.
#pragma once

#include <string>

#include "app/base/words.h"
#include "mesh/pattern/pattern.h"

namespace drape::app {

std::string in_cm(double metres);    // "12.5 cm"
std::string in_deg(double radians);  // "20.3 deg"

// Notes about corners of the drawing that are sharper than min_angle [rad], and a warning about other
// triangles with a smaller angle than that. `where` names the pattern.
Names remarks(const PatternMesh& made, double min_angle, const std::string& where);

}  // namespace drape::app
