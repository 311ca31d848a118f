// System: masses and forces.
#include "solver/system/system.h"

#include <pybind11/stl.h>

#include "app/base/words.h"
#include "app/python/arrays.h"
#include "app/python/forces.h"
#include "app/python/in_use.h"

namespace drape::app::python {
namespace {

void check_state(const System& system, const State& state) {
  if (state.particles() != system.particles())
    throw py::value_error("state: " + std::to_string(state.particles()) + " particles, but the system has " +
                          std::to_string(system.particles()));
}

// A force that names a particle that is not there would write beside the system's arrays.
void check_reach(const System& system, const Forces& forces) {
  std::vector<ParticlePair> pairs;
  for (const auto& force : forces.all) force->list_pairs(pairs);
  for (const ParticlePair& pair : pairs)
    for (const int i : {pair.i, pair.j})
      if (i < 0 || i >= system.particles())
        throw py::value_error("forces: they name particle " + std::to_string(i) + ", but the system has " +
                              std::to_string(system.particles()) + ", from 0");
}

void add(System& system, Forces& forces) {
  require_free(&system);
  if (forces.given) throw py::value_error("forces: they belong to a system already; make them again");
  check_reach(system, forces);
  forces.given = true;
  system.add(std::move(forces.all));
  forces.all.clear();
}

double energy(const System& system, const State& state) { return system.total_energy(state); }

// With the state looked over first.
template <class F>
auto with_state(F f) {
  return [f](const System& system, const State& state) {
    require_free(&system);
    require_free(&state);
    check_state(system, state);
    return f(system, state);
  };
}

}  // namespace

void add_systems(py::module_& m) {
  py::class_<Gravity>(m, "Gravity", "An acceleration that acts on all particles.")
      .def_readonly("g", &Gravity::g, "(3,) [m/s^2]");
  m.def("gravity", &gravity, py::arg("g"),
        "The acceleration (3,) [m/s^2], for System.add, where it takes the place of the one before.");

  py::class_<System, std::shared_ptr<System>>(m, "System", "Masses and forces: all that pushes.")
      .def(py::init([](const py::object& masses) { return System(list_of(masses, "masses")); }),
           py::arg("masses"), "masses: (n,) [kg], copied. A particle of mass 0 stays where it is.")
      .def("add", &add, py::arg("forces"),
           "Forces go over to the system: the same ones cannot be added twice.")
      .def(
          "add",
          [](System& system, const Gravity& gravity) {
            require_free(&system);
            system.add(gravity);
          },
          py::arg("gravity"), "Gravity takes the place of the one before.")
      .def_property_readonly("particles", &System::particles, "how many: n")
      .def_property_readonly(
          "masses",
          [](const py::object& self) {
            const auto& masses = self.cast<const System&>().masses();
            return view(masses.data(), {static_cast<py::ssize_t>(masses.size())}, self, Access::read);
          },
          "(n,) [kg], a read-only view")
      .def_property_readonly("gravity", &System::gravity_acceleration, "(3,) [m/s^2]")
      .def_property_readonly(
          "forces",
          [](const System& system) {
            Names names;
            for (const auto& force : system.forces()) names.emplace_back(force->name());
            return names;
          },
          "their names")
      .def("elastic_energy",
           with_state([](const System& s, const State& at) { return s.elastic_energy(at.x); }),
           py::arg("state"), "J")
      .def("contact_energy",
           with_state([](const System& s, const State& at) { return s.contact_energy(at.x); }),
           py::arg("state"), "J, of the contacts of faces in the step under way or just done")
      .def("kinetic_energy",
           with_state([](const System& s, const State& at) { return s.kinetic_energy(at.v); }),
           py::arg("state"), "J")
      .def("gravity_energy",
           with_state([](const System& s, const State& at) { return s.gravity_energy(at.x); }),
           py::arg("state"), "J, zero at the origin")
      .def("energy", with_state(&energy), py::arg("state"), "J, the sum of these")
      .def("force",
           with_state([](const System& s, const State& at) { return copied_rows(s.force(at.x, at.v)); }),
           py::arg("state"), "(n, 3) [N], gravity included")
      .def("__repr__", [](const System& system) {
        Names names;
        for (const auto& force : system.forces()) names.emplace_back(force->name());
        return "System(" + counted(system.particles(), "particle") + "; " + listed(names) + ")";
      });
}

}  // namespace drape::app::python
