// Pins and obstacles: what particles may do.
#include "constraints/constraints.h"

#include <pybind11/stl.h>

#include <algorithm>

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

const MovingBody& body_of(const Constraints& constraints, int body) {
  require_free(&constraints);
  const auto count = static_cast<int>(constraints.bodies().size());
  if (body < 0 || body >= count)
    throw py::value_error("body: there is no body " + std::to_string(body) + "; there are " +
                          std::to_string(count) + ", from 0");
  return constraints.bodies()[static_cast<std::size_t>(body)];
}

// The first pin of a particle would go on to hold it.
void require_free_particles(const Constraints& constraints, const std::vector<int>& particles) {
  for (const int i : particles)
    if (std::ranges::binary_search(constraints.pinned(), i))
      throw py::value_error("particles: particle " + std::to_string(i) +
                            " is pinned already; unpin() it first");
}

// A contact as Python is told of it.
struct TouchingParticle {
  int particle, body;
  bool sticks;
  Vec3 normal;
  double impulse;
};

std::vector<TouchingParticle> touching(const Constraints& constraints) {
  require_free(&constraints);
  std::vector<TouchingParticle> all;
  for (const Contact& contact : constraints.contacts())
    for (int k = 0; k < contact.planes; ++k) {
      const ContactPlane& plane = contact.plane[k];
      all.push_back(
          {contact.particle, plane.obstacle, contact.grip == Grip::stick, plane.normal, contact.impulse[k]});
    }
  return all;
}

void add_touches(py::module_& m) {
  py::class_<TouchingParticle>(m, "Contact",
                               "A particle that touches a body, after the last step: between several bodies "
                               "one for each that holds it.")
      .def_readonly("particle", &TouchingParticle::particle)
      .def_readonly("body", &TouchingParticle::body, "number of the obstacle, from 0")
      .def_readonly("sticks", &TouchingParticle::sticks, "else it slides")
      .def_readonly("normal", &TouchingParticle::normal, "(3,) unit, out of the body")
      .def_readonly(
          "impulse", &TouchingParticle::impulse,
          "N s, along the normal, without friction: of the last step, or of its last piece where it was cut "
          "(StepReport.substeps). 0 by 'pbd' and the explicit integrators, which move and stop particles "
          "instead")
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
            const std::vector<int> all = particles_of(particles);
            for (const MovingPin& pin : constraints.moving_pins())
              if (std::ranges::find(all, pin.particle) != all.end())
                require_free_particles(constraints, {pin.particle});
            constraints.pin(all);
          },
          "particles"_a, "These stay where they are: a number, or an array of them.")
      .def(
          "pin_to_body",
          [](Constraints& constraints, const py::object& particles, int body, const State& state) {
            require_free(&constraints);
            body_of(constraints, body);
            const std::vector<int> all = particles_of(particles, state);
            require_free_particles(constraints, all);
            constraints.stand_at(state.time);
            constraints.pin_to_body(all, body, state.x);
          },
          "particles"_a, "body"_a, "state"_a,
          "These are carried along by a body, from where they are in the state: a body that is moved stands "
          "where it\n"
          "is at the time of the state, one with a mass where it is after the last step.")
      .def(
          "pin_along",
          [](Constraints& constraints, const py::object& particles, const Motion& motion,
             const State& state) {
            require_free(&constraints);
            const std::vector<int> all = particles_of(particles, state);
            require_free_particles(constraints, all);
            constraints.pin_along(all, motion, state.x, state.time);
          },
          "particles"_a, "motion"_a, "state"_a,
          "These follow a motion of their own, from where they are at the time of the state.")
      .def(
          "unpin",
          [](Constraints& constraints, const py::object& particles) {
            require_free(&constraints);
            constraints.unpin(particles_of(particles));
          },
          "particles"_a,
          "These are free from the next step on, with the velocity that they have. They may be pinned again.")
      .def_property_readonly(
          "pinned", [](const Constraints& constraints) { return copied(constraints.pinned()); },
          "int32, ascending; a copy")
      .def_property_readonly(
          "bodies", [](const Constraints& constraints) { return constraints.bodies().size(); }, "how many")
      .def_property_readonly(
          "contacts", &touching,
          "what touches after the last step, by particle: between several bodies one for each that holds it. "
          "Of cloth that two bodies clamp one of them, with an impulse of 0")
      .def(
          "penetration",
          [](Constraints& constraints, const State& state) {
            require_free(&constraints);
            require_free(&state);
            if (state.v.size() != state.x.size() || !state.x.allFinite())
              throw py::value_error("state: its positions are not finite, or not as many as its velocities");
            constraints.stand_at(state.time);
            return copied(constraints.penetration(state.x));
          },
          "state"_a,
          "(n,) [m]: how deep each particle is inside a body, 0 outside. Bodies stand as pin_to_body says.")
      .def(
          "pose",
          [](const Constraints& constraints, int body) {
            const Pose& pose = body_of(constraints, body).pose();
            return std::pair(pose.rotation, pose.translation);
          },
          "body"_a,
          "Rotation (3, 3) and translation (3,) [m] of a body after the last step: where it was drawn X, it "
          "is R X + t.")
      .def(
          "velocity",
          [](const Constraints& constraints, int body) {
            const ReactingBody* const r = body_of(constraints, body).reacting();
            if (!r)
              throw py::value_error("body: body " + std::to_string(body) +
                                    " has no mass; its motion tells its velocity");
            return std::pair(r->velocity(), r->spin());
          },
          "body"_a,
          "Of a body with a mass after the last step: of its centre of mass (3,) [m/s], and its spin (3,) "
          "[rad/s].")
      .def("__repr__", [](const Constraints& constraints) {
        return "Constraints(" + counted(static_cast<long>(constraints.pinned().size()), "pinned particle") +
               ", " +
               (constraints.bodies().size() == 1 ? "1 body"
                                                 : std::to_string(constraints.bodies().size()) + " bodies") +
               ")";
      });
}

}  // namespace drape::app::python
