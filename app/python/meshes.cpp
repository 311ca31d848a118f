// TriangleMesh, OBJ files, generated meshes.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/base/words.h"
#include "app/python/arrays.h"
#include "app/python/released.h"
#include "mesh/obj/examine.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/generate.h"
#include "mesh/triangles/topology.h"

namespace drape::app::python {
namespace {

namespace fs = std::filesystem;
using Groups = std::map<std::string, std::vector<int>>;

void check_vertex(int vertex, const TriangleMesh& mesh, const std::string& where) {
  if (vertex < 0 || vertex >= mesh.vertex_count())
    throw py::value_error(where + " names vertex " + std::to_string(vertex) + ", but there are " +
                          std::to_string(mesh.vertex_count()) + ", from 0");
}

void check_finite(const std::vector<Vec3>& positions) {
  for (const Vec3& x : positions)
    if (!x.allFinite()) throw py::value_error("positions: a coordinate is not a finite number");
}

TriangleMesh made(const py::object& positions, const py::object& triangles, const Groups& groups) {
  TriangleMesh mesh;
  mesh.positions = points(positions, "positions");
  check_finite(mesh.positions);
  const IntArray corners = integers(triangles, "triangles", {-1, 3});
  mesh.triangles.resize(static_cast<std::size_t>(corners.shape(0)));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.triangles[t][k] = corners.data()[3 * t + k];
      check_vertex(mesh.triangles[t][k], mesh, "triangles: triangle " + std::to_string(t));
    }
  for (const auto& [name, vertices] : groups) {
    const std::set<int> sorted(vertices.begin(), vertices.end());
    for (const int vertex : sorted) check_vertex(vertex, mesh, "groups: '" + name + "'");
    mesh.groups.push_back({name, {sorted.begin(), sorted.end()}});
  }
  return mesh;
}

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Triangle) == 3 * sizeof(int));

Array positions_of(const py::object& self) {
  const TriangleMesh& mesh = self.cast<const TriangleMesh&>();
  return view(mesh.positions.empty() ? nullptr : mesh.positions.front().data(), {mesh.vertex_count(), 3},
              self, Access::write);
}

py::object triangles_of(const py::object& self) {
  const TriangleMesh& mesh = self.cast<const TriangleMesh&>();
  const std::vector<py::ssize_t> shape = {mesh.triangle_count(), 3};
  IntArray array(shape, mesh.triangles.empty() ? nullptr : mesh.triangles.front().data(), self);
  array.attr("setflags")(py::arg("write") = false);  // numbers of vertices must stay so
  return array;
}

void set_positions(TriangleMesh& mesh, const py::object& positions) {
  const Array array = numbers(positions, "positions", {mesh.vertex_count(), 3});
  std::vector<Vec3> moved(mesh.positions.size());
  for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = Eigen::Map<const Vec3>(array.data() + 3 * i);
  check_finite(moved);
  std::copy(moved.begin(), moved.end(),
            mesh.positions.begin());  // arrays may look at the memory that is there
}

py::dict groups_of(const TriangleMesh& mesh) {
  py::dict groups;
  for (const VertexGroup& group : mesh.groups) groups[py::str(group.name)] = copied(group.vertices);
  return groups;
}

void write(const fs::path& path, const TriangleMesh& mesh, const py::object& positions) {
  const std::vector<Vec3> all = positions.is_none() ? mesh.positions : points(positions, "positions");
  if (all.size() != mesh.positions.size())
    throw py::value_error("positions: expected an array of shape (" + std::to_string(mesh.vertex_count()) +
                          ", 3), but got (" + std::to_string(all.size()) + ", 3)");
  const Released released;
  write_obj(path, mesh, all);
}

IntArray edges_of(const TriangleMesh& mesh) {
  const std::vector<Edge> all = edges(mesh);
  IntArray array({static_cast<py::ssize_t>(all.size()), py::ssize_t{2}});
  for (std::size_t i = 0; i < all.size(); ++i) {
    array.mutable_data()[2 * i] = all[i].a;
    array.mutable_data()[2 * i + 1] = all[i].b;
  }
  return array;
}

Names defects_of(const TriangleMesh& mesh) {
  Names lines;
  for (const Defect& defect : examine(mesh).defects) lines.push_back(format(defect));
  return lines;
}

void at_least(int least, int count, const char* name) {
  if (count < least)
    throw py::value_error(std::string(name) + ": expected " + std::to_string(least) + " or more, but got " +
                          std::to_string(count));
}

void check_length(double length, const char* name) {
  if (!(length > 0) || !std::isfinite(length))
    throw py::value_error(std::string(name) + ": a length is greater than zero, but got " +
                          rounded(length, 6) + " m");
}

void add_generated(py::module_& m) {
  using namespace py::literals;
  m.def(
      "grid",
      [](int nx, int nz, double width, double depth) {
        at_least(2, nx, "nx"), at_least(2, nz, "nz");
        check_length(width, "width"), check_length(depth, "depth");
        return grid(nx, nz, width, depth);
      },
      "nx"_a, "nz"_a, "width"_a, "depth"_a,
      "nx x nz vertices over width x depth [m] in the plane y = 0, centred on the origin, x fastest, normals "
      "up;\n"
      "the diagonals of the cells alternate.");
  m.def(
      "equilateral_sheet",
      [](int nx, int nz, double edge) {
        at_least(2, nx, "nx"), at_least(2, nz, "nz"), check_length(edge, "edge");
        return equilateral_sheet(nx, nz, edge);
      },
      "nx"_a, "nz"_a, "edge"_a, "Rows of equilateral triangles in the plane y = 0; edge length [m].");
  m.def(
      "disc",
      [](int rings, double radius) {
        at_least(1, rings, "rings"), check_length(radius, "radius");
        return disc(rings, radius);
      },
      "rings"_a, "radius"_a, "Rings of vertices around a centre in the plane y = 0; radius [m].");
  m.def(
      "sphere",
      [](int subdivisions, double radius) {
        at_least(0, subdivisions, "subdivisions"), check_length(radius, "radius");
        if (subdivisions > 9)
          throw py::value_error("subdivisions: expected 9 or fewer: each makes four triangles of one");
        return sphere(subdivisions, radius);
      },
      "subdivisions"_a, "radius"_a,
      "An icosahedron, subdivided and projected to the radius [m]; closed, normals out.");
  m.def(
      "tube",
      [](int around, int along, double radius, double height) {
        at_least(3, around, "around"), at_least(2, along, "along");
        check_length(radius, "radius"), check_length(height, "height");
        return tube(around, along, radius, height);
      },
      "around"_a, "along"_a, "radius"_a, "height"_a,
      "An open cylinder along y, centred; radius and height [m].");
}

}  // namespace

void add_meshes(py::module_& m) {
  py::class_<TriangleMesh, std::shared_ptr<TriangleMesh>>(
      m, "TriangleMesh", "Vertices and triangles of a cloth or a body, and the OBJ file they came from.")
      .def(py::init(&made), py::arg("positions"), py::arg("triangles"), py::arg("groups") = Groups(),
           "positions: (n, 3) [m]; triangles: (m, 3) vertex numbers from 0; groups: name -> vertex numbers.\n"
           "All are copied. ValueError when a triangle or a group names a vertex that is not there.")
      .def_property("positions", &positions_of, &set_positions, "(n, 3) [m], a view that can be written")
      .def_property_readonly("triangles", &triangles_of,
                             "(m, 3) int32, vertex numbers from 0; a read-only view")
      .def_property_readonly("groups", &groups_of,
                             "name -> vertex numbers, ascending: 'g' and 'o' of the OBJ file")
      .def_property_readonly("vertex_count", &TriangleMesh::vertex_count)
      .def_property_readonly("triangle_count", &TriangleMesh::triangle_count)
      .def(
          "copy", [](const TriangleMesh& mesh) { return TriangleMesh(mesh); },
          "Another mesh with the same numbers, and the same OBJ file behind it.")
      .def("__copy__", [](const TriangleMesh& mesh) { return TriangleMesh(mesh); })
      .def("__deepcopy__", [](const TriangleMesh& mesh, const py::object&) { return TriangleMesh(mesh); })
      .def("__repr__", [](const TriangleMesh& mesh) {
        return "TriangleMesh(" + counted(mesh.vertex_count(), "vertex") + ", " +
               counted(mesh.triangle_count(), "triangle") + ")";
      });

  m.def(
      "read_obj", [](const fs::path& path) { return read_obj(path); }, py::arg("path"),
      py::call_guard<Released>(),
      "Reads an OBJ file: polygons, uv, groups and materials are kept for write_obj.\n"
      "ValueError when it is none, or has a number that is not finite or a face beyond its vertices.");
  m.def(
      "parse_obj", [](const std::string& text, const std::string& name) { return parse_obj(text, name); },
      py::arg("text"), py::arg("name") = "<text>",
      "The same from a text; `name` stands in error messages in the place of the file.");
  m.def("write_obj", &write, py::arg("path"), py::arg("mesh"), py::arg("positions") = py::none(),
        "Writes the mesh with these positions, (n, 3) [m], or its own: vertices in the input's order, its "
        "polygons,\n"
        "uv, groups and materials of the file that it was read from, normals anew. A mesh made of arrays is\n"
        "written without its groups, which OBJ files have by faces. The file appears when it is complete.");
  m.def("edges", &edges_of, py::arg("mesh"), "(e, 2) int32: the vertices of every edge, sorted, each once.");
  m.def(
      "vertex_areas", [](const TriangleMesh& mesh) { return copied(vertex_areas(mesh)); }, py::arg("mesh"),
      "(n,) [m^2]: a third of every triangle around a vertex.");
  m.def("examine", &defects_of, py::arg("mesh"),
        "What is wrong with the mesh, a line each, as `drape check` says it.");
  add_generated(m);
}

}  // namespace drape::app::python
