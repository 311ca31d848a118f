// Makes lines of CSV from the members of a JSON object. The keys make the header. [RFC 4180]
#pragma once

#include <string>

#include "app/base/json.h"

namespace drape::app {

std::string csv_header(const Json::Members& members);
// True is written as 1 and null as an empty cell. A cell is quoted where necessary.
std::string csv_line(const Json::Members& members);

}  // namespace drape::app
