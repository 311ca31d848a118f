// Shapes as Python has them.
#pragma once

#include "app/python/arrays.h"
#include "constraints/shape.h"

namespace drape::python {

struct MeshSurface {
  MeshBody surface;
};
struct LevelSetSurface {
  LevelSetBody grid;
};

Shape shape_of(const py::handle& object);  // TypeError when it is none

}  // namespace drape::python
