// Quantities of a state that a run reports beside the report of the step.
#pragma once

#include <vector>

#include "solver/assembly/cloth.h"
#include "solver/system/measure.h"

namespace drape::app {

// p95 is the 95th percentile. Percentiles are values that occur (nearest rank).
struct Distribution {
  double median = 0, p95 = 0, max = 0, mean = 0;
};
Distribution distribution(std::vector<double> values);  // all zero when there are no values

}  // namespace drape::app
