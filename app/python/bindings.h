// The parts of the Python module, one subject in each file; module.cpp calls them all.
#pragma once

#include <pybind11/pybind11.h>

namespace drape::app::python {

namespace py = pybind11;

void add_meshes(py::module_& m);       // meshes.cpp
void add_states(py::module_& m);       // states.cpp
void add_fabrics(py::module_& m);      // fabrics.cpp
void add_systems(py::module_& m);      // systems.cpp
void add_shapes(py::module_& m);       // shapes.cpp
void add_obstacles(py::module_& m);    // obstacles.cpp
void add_constraints(py::module_& m);  // constraints.cpp
void add_solvers(py::module_& m);      // solvers.cpp
void add_integrators(py::module_& m);  // integrators.cpp
void add_simulations(py::module_& m);  // simulations.cpp

}  // namespace drape::app::python
