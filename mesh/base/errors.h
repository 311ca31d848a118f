// The exception that the library throws when what it is given is wrong. Inside a computation nothing is
// thrown: trouble there is reported as data.
#pragma once

#include <stdexcept>

namespace drape {

// A mistake of the user in a file or an option. The message is one line that says where it is, what was
// found and what to do.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace drape
