// Bodies as surfaces that answer signed distance and normal.
#include "app/python/shapes.h"

#include "app/python/released.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cctype>
#include <cmath>

#include "app/base/words.h"
#include "app/scene/shape_table.h"
#include "mesh/base/errors.h"

namespace drape::app::python {
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

std::string text(double value) { return rounded(value, 6); }
std::string text(const Vec3& v) {
  return "(" + rounded(v[0], 6) + ", " + rounded(v[1], 6) + ", " + rounded(v[2], 6) + ")";
}

// "centre=(0, 0, 0) m"; a rotation is left out.
template <class Kind, class Value>
void add_text(Names& parts, const Field<Kind, Value>& field, const Kind& shape) {
  if constexpr (!std::is_same_v<Value, Mat3>)
    parts.push_back(std::string(field.name) + "=" + text(shape.*field.member) +
                    (field.measure == Measure::direction ? "" : " m"));
}

// "(3,) [m], its middle"
template <class Kind, class Value>
std::string documented(const Field<Kind, Value>& field) {
  std::string text;
  if constexpr (std::is_same_v<Value, Vec3>) text = "(3,)";
  if constexpr (std::is_same_v<Value, Mat3>) text = "(3, 3)";
  const bool metres = field.measure != Measure::direction && field.measure != Measure::turn;
  if (metres) text += text.empty() ? "m" : " [m]";
  return text + ", " + field.about;
}

std::string sentence(std::string words) {
  words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
  return words + ".";
}

template <class Kind, class... Values>
void add_class(py::module_& m, const Field<Kind, Values>&... field) {
  using About = Described<Kind>;
  const Kind standard;
  std::string members;
  ((members += std::string(field.name) + ": " + documented(field) + "\n"), ...);
  py::class_<Kind> shape(m, About::python, sentence(About::what).c_str());
  shape.def(py::init([field...](const Values&... values) {
              Kind made;
              ((made.*field.member = values), ...);
              return sound(made);
            }),
            (py::arg(field.name) = standard.*field.member)..., members.c_str());
  (shape.def_readonly(field.name, field.member, documented(field).c_str()), ...);
  shape.def("__repr__", [field...](const Kind& self) {
    Names parts;
    (add_text(parts, field, self), ...);
    return About::python + ("(" + listed(parts)) + ")";
  });
}

void add_mesh_bodies(py::module_& m) {
  py::class_<MeshSurface>(m, "MeshBody",
                          "A triangle mesh as a body: closed, with an inside, or a thick surface.\n"
                          "[Baerentzen & Aanaes 2005]")
      .def(py::init([](const TriangleMesh& mesh) {
             const Released released;
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
             if (!(voxel >= 0) || std::isinf(voxel))
               throw InputError("voxel = " + rounded(voxel, 4) +
                                ": expected a length [m], or 0 to have it chosen");
             const Released released;
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
  std::optional<Shape> shape;
  Names classes;
  for_each_built_in([&]<class Kind>(const Kind&) {
    if (py::isinstance<Kind>(object)) shape = object.cast<Kind>();
    classes.emplace_back(Described<Kind>::python);
  });
  if (shape) return *shape;
  if (py::isinstance<MeshSurface>(object)) return object.cast<const MeshSurface&>().surface;
  if (py::isinstance<LevelSetSurface>(object)) return object.cast<const LevelSetSurface&>().grid;
  throw py::type_error("shape: expected a " + listed(classes) + ", MeshBody or LevelSetBody, but got a " +
                       std::string(py::str(py::type::of(object).attr("__name__"))));
}

void add_shapes(py::module_& m) {
  for_each_built_in([&]<class Kind>(const Kind&) {
    std::apply([&](const auto&... field) { add_class<Kind>(m, field...); }, Described<Kind>::fields);
  });
  add_mesh_bodies(m);
  m.def("closest", &closest_points, "shape"_a, "points"_a,
        "Of points (n, 3) [m]: signed distances (n,) [m], negative inside, and outward normals (n, 3).");
}

}  // namespace drape::app::python
