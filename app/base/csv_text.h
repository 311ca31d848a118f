// Lines of CSV from the members of a JSON object, whose keys are the header. [RFC 4180]
#pragma once

#include <string>

#include "app/base/json.h"

namespace drape {

std::string csv_header(const Json::Members& members);
std::string csv_line(const Json::Members& members);  // true is 1, null is empty; quoted where it must be

}  // namespace drape
