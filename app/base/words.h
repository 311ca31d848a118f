// The words for messages; the library has them, too.
#pragma once

#include "mesh/base/words.h"
