// State: time, positions and velocities, shared with NumPy.
#include "app/base/words.h"
#include "app/python/arrays.h"
#include "app/python/in_use.h"
#include "app/simulation/measure.h"
#include "mesh/base/errors.h"
#include "solver/system/state.h"

namespace drape::app::python {
namespace {

State made(const py::object& x, const py::object& v, double time) {
  State state;
  state.time = time;
  state.x = stacked_rows(x, "x");
  state.v = v.is_none() ? VecX(VecX::Zero(state.x.size())) : stacked_rows(v, "v");
  if (state.v.size() != state.x.size())
    throw py::value_error("v: expected an array of shape (" + std::to_string(state.particles()) +
                          ", 3) as x has it, but got (" + std::to_string(state.v.size() / 3) + ", 3)");
  return state;
}

// Into the memory that is there: arrays may look at it.
void assign(VecX& to, const py::object& from, const char* name) {
  const Array array = numbers(from, name, {to.size() / 3, 3});
  to = Eigen::Map<const VecX>(array.data(), array.size());
}

// The vectors have the same memory during a step, except where particles may become fewer.
py::object rows(const py::object& self, const VecX& all) {
  require_free(&self.cast<State&>().x);
  return view_rows(all, self, Access::write);
}

py::object x_of(const py::object& self) { return rows(self, self.cast<State&>().x); }
py::object v_of(const py::object& self) { return rows(self, self.cast<State&>().v); }

State copy_of(const State& state) {
  require_free(&state);
  return state;
}

}  // namespace

void add_states(py::module_& m) {
  py::class_<State, std::shared_ptr<State>>(
      m, "State",
      "What a step changes of the cloth: time [s], positions x [m] and velocities v [m/s]. What touched in "
      "the last step and\n"
      "where bodies with a mass are is not in it, so a run does not go on from a saved state as it would "
      "have.\n\n"
      "x and v are views: writing into them changes the state. A state can be copied and pickled,\n"
      "to the last bit.")
      .def(py::init(&made), py::arg("x"), py::arg("v") = py::none(), py::arg("time") = 0.0,
           "x: (n, 3) positions [m]; v: (n, 3) velocities [m/s], by default 0; time [s]. Both are copied.")
      .def_readwrite("time", &State::time, "s")
      .def_property(
          "x", &x_of,
          [](State& state, const py::object& x) {
            require_free(&state);
            assign(state.x, x, "x");
          },
          "(n, 3) positions [m], a view that can be written")
      .def_property(
          "v", &v_of,
          [](State& state, const py::object& v) {
            require_free(&state);
            assign(state.v, v, "v");
          },
          "(n, 3) velocities [m/s], a view that can be written")
      .def_property_readonly("particles", &State::particles, "how many: n")
      .def_property_readonly(
          "hash",
          [](const State& state) {
            require_free(&state);
            return state_hash(state);
          },
          "16 hexadecimal digits, the same when every bit of x and v is: state_hash in run.json")
      .def("copy", &copy_of, "Another state with the same numbers.")
      .def("__copy__", &copy_of)
      .def("__deepcopy__", [](const State& state, const py::object&) { return copy_of(state); })
      // Not py::pickle, which ends the interpreter with the protocols 0 and 1.
      .def("__reduce__",
           [](const py::object& self) {
             const State& state = self.cast<const State&>();
             require_free(&state);
             return py::make_tuple(py::type::of(self),
                                   py::make_tuple(copied_rows(state.x), copied_rows(state.v), state.time));
           })
      .def("__repr__", [](const State& state) {
        return "State(time=" + shortest(state.time) + " s, " + counted(state.particles(), "particle") + ")";
      });

  m.def("at_rest", &at_rest, py::arg("mesh"), "The mesh as it stands, without velocity, at time 0.");
}

}  // namespace drape::app::python
