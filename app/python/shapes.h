// Shapes in the form that Python sees.
#pragma once

#include "app/python/arrays.h"
#include "constraints/shape.h"

namespace drape::app::python {

struct MeshSurface {
  MeshBody surface;
};
struct LevelSetSurface {
  LevelSetBody grid;
};

Shape shape_of(const py::handle& object);  // raises TypeError when the object is not a shape

}  // namespace drape::app::python
