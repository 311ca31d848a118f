// While a step is taken the interpreter goes on, and so may other Python threads. What the step changes or
// reads is marked here, and whoever wants to change it meanwhile gets a RuntimeError instead of a crash.
// (Reading arrays is allowed: what they show during a step is not defined. What is copied, or may get other
// memory, is not read meanwhile.)
//   All of this is called with the interpreter's lock held, which guards the marks.
#pragma once

#include <vector>

namespace drape::python {

class InUse {
 public:
  explicit InUse(std::vector<const void*> objects);  // throws std::runtime_error when one is in use
  ~InUse();
  InUse(const InUse&) = delete;
  InUse& operator=(const InUse&) = delete;

 private:
  std::vector<const void*> objects_;
};

void require_free(const void* object);  // throws std::runtime_error

}  // namespace drape::python
