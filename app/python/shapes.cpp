// Bodies as surfaces that answer signed distance and normal.
#include "app/python/shapes.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "app/base/words.h"

namespace drape::python {
namespace {

using namespace py::literals;

template <class Kind>
Kind sound(Kind shape) {
  check(Shape(shape));
  return shape;
}

// (n,) signed distances and (n, 3) normals.
py::tuple closest_points(const py::object& shape_object, const py::object& places) {
  const Shape shape = shape_of(shape_object);
  const std::vector<Vec3> at = points(places, "points");
  std::vector<double> distances(at.size());
  std::vector<Vec3> normals(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    const SurfacePoint point = closest(shape, at[i]);
    distances[i] = point.distance;
    normals[i] = point.normal;
  }
  return py::make_tuple(copied(distances), copied_rows(normals));
}

std::string text(const Vec3& v) {
  return "(" + rounded(v[0], 6) + ", " + rounded(v[1], 6) + ", " + rounded(v[2], 6) + ")";
}

void add_mesh_bodies(py::module_& m) {
  py::class_<MeshSurface>(m, "MeshBody",
                          "A triangle mesh as a body: closed, with an inside, or a thick surface.\n"
                          "[Baerentzen & Aanaes 2005]")
      .def(py::init([](const TriangleMesh& mesh) {
             py::gil_scoped_release release;
             return MeshSurface{std::make_shared<const SurfaceDistance>(mesh)};
           }),
           "mesh"_a, "The mesh is copied. ValueError when no triangle has an area.")
      .def_property_readonly("closed", [](const MeshSurface& body) { return body.surface->closed(); })
      .def("__repr__", [](const MeshSurface& body) {
        return "MeshBody(" + counted(body.surface->mesh().triangle_count(), "triangle") +
               (body.surface->closed() ? ", closed)" : ", open)");
      });
  py::class_<LevelSetSurface>(m, "LevelSetBody", "A closed mesh as a grid of distances: quicker to ask.")
      .def(py::init([](const TriangleMesh& mesh, double voxel) {
             py::gil_scoped_release release;
             return LevelSetSurface{
                 std::make_shared<const LevelSet>(LevelSet::from_mesh(mesh, {.voxel = voxel}))};
           }),
           "mesh"_a, "voxel"_a = 0.0, "voxel [m], 0: chosen. ValueError when the mesh is not closed.")
      .def_property_readonly(
          "voxel", [](const LevelSetSurface& body) { return body.grid->voxel(); }, "m")
      .def("__repr__", [](const LevelSetSurface& body) {
        return "LevelSetBody(voxel=" + rounded(body.grid->voxel(), 4) + " m)";
      });
}

}  // namespace

Shape shape_of(const py::handle& object) {
  if (py::isinstance<Plane>(object)) return object.cast<Plane>();
  if (py::isinstance<Sphere>(object)) return object.cast<Sphere>();
  if (py::isinstance<Bowl>(object)) return object.cast<Bowl>();
  if (py::isinstance<Box>(object)) return object.cast<Box>();
  if (py::isinstance<Capsule>(object)) return object.cast<Capsule>();
  if (py::isinstance<MeshSurface>(object)) return object.cast<const MeshSurface&>().surface;
  if (py::isinstance<LevelSetSurface>(object)) return object.cast<const LevelSetSurface&>().grid;
  throw py::type_error(
      "shape: expected a Plane, Sphere, Bowl, Box, Capsule, MeshBody or LevelSetBody, but got a " +
      std::string(py::str(py::type::of(object).attr("__name__"))));
}

void add_shapes(py::module_& m) {
  const Vec3 origin = Vec3::Zero(), up = Vec3::UnitY();
  py::class_<Plane>(m, "Plane", "The half space that the normal points away from.")
      .def(py::init([](const Vec3& point, const Vec3& normal) {
             return sound(Plane{point, normal});
           }),
           "point"_a = origin, "normal"_a = up, "A point of it [m]; the normal has any length but zero.")
      .def_readonly("point", &Plane::point, "(3,) [m]")
      .def_readonly("normal", &Plane::normal, "(3,)")
      .def("__repr__", [](const Plane& s) {
        return "Plane(point=" + text(s.point) + " m, normal=" + text(s.normal) + ")";
      });
  py::class_<Sphere>(m, "Sphere", "A ball.")
      .def(py::init([](const Vec3& centre, double radius) {
             return sound(Sphere{centre, radius});
           }),
           "centre"_a = origin, "radius"_a = 1.0, "m")
      .def_readonly("centre", &Sphere::centre, "(3,) [m]")
      .def_readonly("radius", &Sphere::radius, "m")
      .def("__repr__", [](const Sphere& s) {
        return "Sphere(centre=" + text(s.centre) + " m, radius=" + rounded(s.radius, 6) + " m)";
      });
  py::class_<Bowl>(m, "Bowl", "A hemispherical shell with a rounded rim that opens along its axis.")
      .def(py::init([](const Vec3& centre, double radius, double thickness, const Vec3& axis) {
             return sound(Bowl{centre, radius, thickness, axis});
           }),
           "centre"_a = origin, "radius"_a = 1.0, "thickness"_a = 0.02, "axis"_a = up,
           "m; radius: the inner one")
      .def_readonly("centre", &Bowl::centre, "(3,) [m]")
      .def_readonly("radius", &Bowl::radius, "m, inner")
      .def_readonly("thickness", &Bowl::thickness, "m")
      .def_readonly("axis", &Bowl::axis, "(3,)")
      .def("__repr__", [](const Bowl& s) {
        return "Bowl(centre=" + text(s.centre) + " m, radius=" + rounded(s.radius, 6) + " m)";
      });
  py::class_<Box>(m, "Box", "A box with sharp edges, turned.")
      .def(py::init([](const Vec3& centre, const Vec3& size, const Mat3& rotation) {
             return sound(Box{centre, size, rotation});
           }),
           "centre"_a = origin, "size"_a = Vec3(Vec3::Ones()), "rotation"_a = Mat3(Mat3::Identity()),
           "centre (3,) and whole edge lengths (3,) [m]; rotation (3, 3), orthonormal")
      .def_readonly("centre", &Box::centre, "(3,) [m]")
      .def_readonly("size", &Box::size, "(3,) [m], whole edge lengths")
      .def_readonly("rotation", &Box::rotation, "(3, 3)")
      .def("__repr__",
           [](const Box& s) { return "Box(centre=" + text(s.centre) + " m, size=" + text(s.size) + " m)"; });
  py::class_<Capsule>(m, "Capsule", "All that is within a radius of the line from a to b.")
      .def(py::init([](const Vec3& a, const Vec3& b, double radius) {
             return sound(Capsule{a, b, radius});
           }),
           "a"_a, "b"_a, "radius"_a, "m")
      .def_readonly("a", &Capsule::a, "(3,) [m]")
      .def_readonly("b", &Capsule::b, "(3,) [m]")
      .def_readonly("radius", &Capsule::radius, "m")
      .def("__repr__", [](const Capsule& s) {
        return "Capsule(a=" + text(s.a) + " m, b=" + text(s.b) + " m, radius=" + rounded(s.radius, 6) + " m)";
      });
  add_mesh_bodies(m);
  m.def("closest", &closest_points, "shape"_a, "points"_a,
        "Of points (n, 3) [m]: signed distances (n,) [m], negative inside, and outward normals (n, 3).");
}

}  // namespace drape::python
