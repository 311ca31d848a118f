// A PNG file as pixels, by a reader that has nothing in common with the writer.
#pragma once

#include <string>

#include "app/picture/image.h"

namespace drape::test {

using namespace app;

using drawing::Image;

Image read_png(const std::string& bytes);  // throws when it is none

}  // namespace drape::test
