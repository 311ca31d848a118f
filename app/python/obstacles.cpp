// Obstacle: a shape that may move and that rubs; its motion; its mass when it reacts.
#include "constraints/obstacle.h"

#include <pybind11/stl.h>

#include "app/base/words.h"
#include "app/python/shapes.h"

namespace drape::app::python {
namespace {

using namespace py::literals;

Friction friction_of(const py::object& given) {
  const bool one = py::isinstance<py::float_>(given) || py::isinstance<py::int_>(given) ||
                   (py::hasattr(given, "ndim") && py::array(given).ndim() == 0);
  if (one) return Friction(*numbers(py::make_tuple(given), "friction", {1}).data());
  const Array pair = numbers(given, "friction", {2});
  return Friction(pair.data()[0], pair.data()[1]);
}

void add_motions(py::module_& m) {
  py::class_<Keyframe>(m, "Keyframe", "Where a body is at a time.")
      .def(py::init([](double time, const Vec3& translate, const Vec3& rotation) {
             return Keyframe{time, translate, rotation};
           }),
           "time"_a, "translate"_a = Vec3(Vec3::Zero()), "rotation"_a = Vec3(Vec3::Zero()),
           "time [s]; translate (3,) [m]; rotation (3,) [rad], axis times angle: about one axis it counts "
           "turns")
      .def_readonly("time", &Keyframe::time, "s")
      .def_readonly("translate", &Keyframe::translate, "(3,) [m]")
      .def_readonly("rotation", &Keyframe::rotation, "(3,) [rad]");
  py::class_<Motion>(m, "Motion",
                     "The prescribed motion of a rigid body; by default it stands where it was drawn.")
      .def(py::init<>())
      .def_static(
          "constant", &Motion::constant, "velocity"_a = Vec3(Vec3::Zero()), "spin"_a = Vec3(Vec3::Zero()),
          "centre"_a = Vec3(Vec3::Zero()), "start"_a = 0.0, "end"_a = std::numeric_limits<double>::infinity(),
          "velocity (3,) [m/s] and spin (3,) [rad/s] about the centre (3,) [m], from start to end [s]")
      .def_static(
          "keyframes", &Motion::keyframes, "keyframes"_a, "centre"_a = Vec3(Vec3::Zero()),
          "A smooth way through all of them that overshoots none; rotations are about the centre (3,) [m].\n"
          "[Fritsch & Butland 1984; Kim, Kim & Shin 1995]")
      .def(
          "at",
          [](const Motion& motion, double time) {
            const Pose pose = motion.at(time);
            return std::pair(pose.rotation, pose.translation);
          },
          "time"_a, "Where it is at a time [s]: rotation (3, 3) and translation (3,) [m].")
      .def_property_readonly("moves", &Motion::moves)
      .def_property_readonly("last_time", &Motion::last_time, "s; it stands from then on");
}

}  // namespace

void add_obstacles(py::module_& m) {
  add_motions(m);
  const RigidBody usual;
  py::class_<RigidBody>(m, "RigidBody", "The mass of a body that falls and that the cloth pushes.")
      .def(py::init([](double mass, const Mat3& inertia, const Vec3& centre, const Vec3& velocity,
                       const Vec3& spin, const Vec3& gravity) {
             const RigidBody body{mass, inertia, centre, velocity, spin, gravity};
             check(body);
             return body;
           }),
           py::kw_only(), "mass"_a, "inertia"_a, "centre"_a = usual.centre, "velocity"_a = usual.velocity,
           "spin"_a = usual.spin, "gravity"_a = usual.gravity,
           "mass [kg]; inertia (3, 3) [kg m^2] about the centre of mass (3,) [m]; velocity (3,) [m/s] and\n"
           "spin (3,) [rad/s] at the start; gravity (3,) [m/s^2]")
      .def_readonly("mass", &RigidBody::mass, "kg")
      .def_readonly("inertia", &RigidBody::inertia, "(3, 3) [kg m^2]")
      .def_readonly("centre", &RigidBody::centre, "(3,) [m]")
      .def_readonly("velocity", &RigidBody::velocity, "(3,) [m/s]")
      .def_readonly("spin", &RigidBody::spin, "(3,) [rad/s]")
      .def_readonly("gravity", &RigidBody::gravity, "(3,) [m/s^2]");
  py::class_<Obstacle>(m, "Obstacle", "A body in the cloth's way: a shape that may move and that rubs.")
      .def(py::init([](const py::object& shape, const py::object& friction, double margin,
                       const Motion& motion, double restitution, const std::optional<RigidBody>& rigid) {
             const Obstacle obstacle{shape_of(shape), friction_of(friction), margin,
                                     motion,          restitution,           rigid};
             check(obstacle);
             return obstacle;
           }),
           "shape"_a, "friction"_a = 0.3, "margin"_a = 2e-3, "motion"_a = Motion(), "restitution"_a = 0.0,
           "rigid"_a = py::none(),
           "friction: Coulomb's coefficient, or a pair (static, kinetic); margin [m]: the cloth comes to "
           "rest this\n"
           "far outside; motion: where it is when; restitution: 0 to 1, of cloth with the contact mode "
           "'restitution' "
           "only, of bodies always;\n"
           "rigid: its mass, when it reacts")
      .def_property_readonly(
          "friction", [](const Obstacle& o) { return std::pair(o.friction.statics, o.friction.kinetic); },
          "(static, kinetic)")
      .def_readonly("margin", &Obstacle::margin, "m")
      .def_readonly("restitution", &Obstacle::restitution)
      .def("__repr__", [](const Obstacle& o) {
        return "Obstacle(" + std::string(name(o.shape)) + ", friction=(" + rounded(o.friction.statics, 6) +
               ", " + rounded(o.friction.kinetic, 6) + "), margin=" + rounded(o.margin, 6) + " m)";
      });
}

}  // namespace drape::app::python
