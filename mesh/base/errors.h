// The exception that the library throws when its input is wrong. Nothing is thrown inside a computation:
// there, trouble is reported as data.
#pragma once

#include <stdexcept>

namespace drape {

// A mistake of the user in a file or an option. The message is one line that says where it is, what was
// found and what to do.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace drape
