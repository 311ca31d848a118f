// The interpreter goes on while one of these lives: other Python threads run during a step.
//   At the end of the program Python ends a thread that asks for the interpreter's lock by unwinding its
//   stack, which C++ answers by std::terminate() [CPython, PyEval_RestoreThread]. Such a thread stays where
//   it is here instead, and the process ends with its main thread, as from Python 3.14 on.
#pragma once

namespace drape::app::python {

class Released {
 public:
  Released();
  ~Released();
  Released(const Released&) = delete;
  Released& operator=(const Released&) = delete;

 private:
  void* thread_;  // PyThreadState
};

}  // namespace drape::app::python
