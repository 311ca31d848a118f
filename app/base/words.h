// The words for messages, which the library has, too.
#pragma once

#include "mesh/base/words.h"
