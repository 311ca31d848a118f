#include <Python.h>
#include <cxxabi.h>
#include <unistd.h>

#include "app/python/released.h"

namespace drape::app::python {

Released::Released() : thread_(PyEval_SaveThread()) {}

Released::~Released() {
  try {
    PyEval_RestoreThread(static_cast<PyThreadState*>(thread_));
  } catch (const abi::__forced_unwind&) {
    for (;;) pause();
  }
}

}  // namespace drape::app::python
