// What the library throws at its door. Inside a computation nothing is thrown: trouble is reported as data.
#pragma once

#include <stdexcept>

namespace drape {

// A mistake of the user in a file or an option. The message is one line: where, what was found, what to do.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace drape
