// The text that a run prints at its end: how it went, what was written, and what to look at.
#pragma once

#include <string>

#include "app/recording/output.h"

namespace drape::app {

std::string summary(const RunRecord& record, const Output& output);

}  // namespace drape::app
