// Numbers of a material that make no sense are refused at the door. Internal (not installed).
#pragma once

#include <cmath>
#include <sstream>

#include "mesh/base/errors.h"

namespace drape {

// Throws InputError "field = value unit: what" unless the value is good, and a finite number.
inline void require(bool good, const char* field, double value, const char* unit, const char* what) {
  if (good && std::isfinite(value)) return;
  std::ostringstream message;
  message << field << " = " << value << " " << unit << ": " << what;
  throw InputError(message.str());
}

}  // namespace drape
