// The extension module drape._drape: what app/python/drape/__init__.py offers as `drape`.
#include "app/python/bindings.h"
#include "mesh/base/errors.h"

PYBIND11_MODULE(_drape, m) {
  namespace py = pybind11;
  using namespace drape::app::python;
  m.doc() = "An implicit cloth solver. Quantities are in SI units, arrays have a row for each particle.";
  m.attr("__version__") = DRAPE_VERSION;
  // A user's mistake, in the words of the command line.
  // pybind11 asks for a function that takes the exception by value.
  py::register_exception_translator(
      [](std::exception_ptr thrown) {  // NOLINT(performance-unnecessary-value-param)
        try {
          if (thrown) std::rethrow_exception(thrown);
        } catch (const drape::InputError& error) {
          PyErr_SetString(PyExc_ValueError, error.what());
        }
      });
  add_meshes(m);
  add_states(m);
  add_fabrics(m);
  add_systems(m);
  add_shapes(m);
  add_obstacles(m);
  add_constraints(m);
  add_solvers(m);
  add_integrators(m);
  add_simulations(m);
}
