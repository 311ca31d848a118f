// Refuses material numbers that make no sense before anything is computed.
#pragma once

#include <cmath>
#include <sstream>

#include "mesh/base/errors.h"

namespace drape {

// Throws InputError "field = value unit: what" unless `good` is true and the value is a finite number.
inline void require(bool good, const char* field, double value, const char* unit, const char* what) {
  if (good && std::isfinite(value)) return;
  std::ostringstream message;
  message << field << " = " << value << (*unit ? " " : "") << unit << ": " << what;
  throw InputError(message.str());
}

}  // namespace drape
