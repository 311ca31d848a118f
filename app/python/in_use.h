// During a step the interpreter goes on, and so may other Python threads. InUse marks the objects that the
// step reads or changes; another thread that wants to change one of them meanwhile gets a RuntimeError
// instead of a crash. (Reading arrays is allowed; what they show during a step is undefined. Data that would
// be copied, or that may move in memory, cannot be read during a step.)
//   All functions must be called with the interpreter's lock held, which guards the marks.
#pragma once

#include <vector>

namespace drape::app::python {

class InUse {
 public:
  // Throws std::runtime_error when one of them is marked already.
  explicit InUse(std::vector<const void*> objects);
  ~InUse();
  InUse(const InUse&) = delete;
  InUse& operator=(const InUse&) = delete;

 private:
  std::vector<const void*> objects_;
};

void require_free(const void* object);  // throws std::runtime_error when the object is marked

}  // namespace drape::app::python
