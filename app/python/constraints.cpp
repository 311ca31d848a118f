// Pins and obstacles: what particles may do.
#include "constraints/constraints.h"

#include <pybind11/stl.h>

#include "app/base/words.h"
#include "app/python/arrays.h"
#include "app/python/in_use.h"
#include "solver/system/state.h"

namespace drape::app::python {
namespace {

using namespace py::literals;

// A number, or an array of them.
std::vector<int> particles_of(const py::object& given) {
  const bool one =
      py::isinstance<py::array>(given) ? py::array(given).ndim() == 0 : PyIndex_Check(given.ptr()) != 0;
  const IntArray array =
      one ? integers(py::make_tuple(given), "particles", {1}) : integers(given, "particles", {-1});
  const std::vector<int> all(array.data(), array.data() + array.size());
  for (const int i : all)
    if (i < 0)
      throw py::value_error("particles: there is no particle " + std::to_string(i) + "; they count from 0");
  return all;
}

std::vector<int> particles_of(const py::object& given, const State& state) {
  const std::vector<int> all = particles_of(given);
  for (const int i : all)
    if (i >= state.particles())
      throw py::value_error("particles: there is no particle " + std::to_string(i) + "; the state has " +
                            std::to_string(state.particles()) + ", from 0");
  return all;
}

// A contact as Python is told of it.
struct TouchingParticle {
  int particle, body;
  bool sticks;
  Vec3 normal;
  double gap, impulse;
};

std::vector<TouchingParticle> touching(const Constraints& constraints) {
  require_free(&constraints);
  std::vector<TouchingParticle> all;
  for (const Contact& contact : constraints.contacts())
    if (contact.active())
      all.push_back({contact.particle, contact.plane[0].obstacle, contact.grip == Grip::stick,
                     contact.plane[0].normal, contact.plane[0].gap, contact.normal_impulse});
  return all;
}

void add_touches(py::module_& m) {
  py::class_<TouchingParticle>(m, "Contact", "A particle that touches a body, after the last step.")
      .def_readonly("particle", &TouchingParticle::particle)
      .def_readonly("body", &TouchingParticle::body, "number of the obstacle, from 0")
      .def_readonly("sticks", &TouchingParticle::sticks, "else it slides")
      .def_readonly("normal", &TouchingParticle::normal, "(3,) unit, out of the body")
      .def_readonly("impulse", &TouchingParticle::impulse, "N s, along the normal, of the last step")
      .def("__repr__", [](const TouchingParticle& touch) {
        return "Contact(particle " + std::to_string(touch.particle) +
               (touch.sticks ? " sticks to" : " slides on") + " body " + std::to_string(touch.body) + ")";
      });
}

}  // namespace

void add_constraints(py::module_& m) {
  add_touches(m);
  py::class_<Constraints, std::shared_ptr<Constraints>>(m, "Constraints",
                                                        "Pins and obstacles: what particles may do.")
      .def(py::init([](double recovery_speed) {
             if (!(recovery_speed > 0)) throw py::value_error("recovery_speed: a speed is greater than zero");
             return Constraints(ContactOptions{recovery_speed});
           }),
           "recovery_speed"_a = 0.25,
           "recovery_speed [m/s]: at which a particle that starts inside a body is brought out")
      .def(
          "add",
          [](Constraints& constraints, const Obstacle& obstacle) {
            require_free(&constraints);
            constraints.add(obstacle);
          },
          "obstacle"_a, "The obstacle is copied; the first one is body 0.")
      .def(
          "pin",
          [](Constraints& constraints, const py::object& particles) {
            require_free(&constraints);
            constraints.pin(particles_of(particles));
          },
          "particles"_a, "These stay where they are: a number, or an array of them.")
      .def(
          "pin_to_body",
          [](Constraints& constraints, const py::object& particles, int body, const State& state) {
            require_free(&constraints);
            const auto count = static_cast<int>(constraints.bodies().size());
            if (body < 0 || body >= count)
              throw py::value_error("body: there is no body " + std::to_string(body) + "; there are " +
                                    std::to_string(count) + ", from 0");
            constraints.pin_to_body(particles_of(particles, state), body, state.x);
          },
          "particles"_a, "body"_a, "state"_a,
          "These are carried along by a body, from where they and the body are after the last step.")
      .def(
          "pin_along",
          [](Constraints& constraints, const py::object& particles, const Motion& motion,
             const State& state) {
            require_free(&constraints);
            constraints.pin_along(particles_of(particles, state), motion, state.x, state.time);
          },
          "particles"_a, "motion"_a, "state"_a,
          "These follow a motion of their own, from where they are at the time of the state.")
      .def_property_readonly(
          "pinned", [](const Constraints& constraints) { return copied(constraints.pinned()); },
          "int32, ascending; a copy")
      .def_property_readonly(
          "bodies", [](const Constraints& constraints) { return constraints.bodies().size(); }, "how many")
      .def_property_readonly("contacts", &touching, "what touches after the last step, by particle")
      .def(
          "penetration",
          [](const Constraints& constraints, const State& state) {
            require_free(&constraints);
            require_free(&state);
            if (state.v.size() != state.x.size() || !state.x.allFinite())
              throw py::value_error("state: its positions are not finite, or not as many as its velocities");
            return copied(constraints.penetration(state.x));
          },
          "state"_a, "(n,) [m]: how deep each particle is inside a body, 0 outside.")
      .def("__repr__", [](const Constraints& constraints) {
        return "Constraints(" + counted(static_cast<long>(constraints.pinned().size()), "pinned particle") +
               ", " +
               (constraints.bodies().size() == 1 ? "1 body"
                                                 : std::to_string(constraints.bodies().size()) + " bodies") +
               ")";
      });
}

}  // namespace drape::app::python
