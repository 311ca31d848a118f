// Passes numbers between NumPy and Eigen.
//   in   copied, from anything that NumPy can make an array of; ValueError names the shape that was expected
//   out  view(): (n, 3) or (n,) without a copy; the array keeps its owner alive
//        Vec3, Mat3: a read-only copy, so that writing into it is an error and is not silently lost
// Every file that passes a Vec3 or Mat3 must include this header.
#pragma once

#include <pybind11/numpy.h>

#include <initializer_list>
#include <vector>

#include "app/python/bindings.h"
#include "mesh/base/vectors.h"

namespace drape::app::python {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using IntArray = py::array_t<int, py::array::c_style | py::array::forcecast>;

// Takes an array of numbers. In `shape`, -1 stands for any length. `name` stands in messages: "x: expected an
// array of shape (n, 3), but got (4, 2)".
Array numbers(const py::handle& from, const char* name, std::initializer_list<py::ssize_t> shape);
IntArray integers(const py::handle& from, const char* name, std::initializer_list<py::ssize_t> shape);

VecX stacked_rows(const py::handle& from, const char* name);            // (n, 3) -> 3n numbers
std::vector<Vec3> points(const py::handle& from, const char* name);     // (n, 3)
std::vector<double> list_of(const py::handle& from, const char* name);  // (n,)

// Arrays that show memory of `owner`, a Python object, which keeps the memory as long as it lives.
enum class Access { read, write };
Array view(const double* data, std::vector<py::ssize_t> shape, const py::handle& owner, Access access);
Array view_rows(const VecX& x, const py::handle& owner, Access access);  // (n, 3)

Array copied_rows(const VecX& x);                 // (n, 3)
Array copied_rows(const std::vector<Vec3>& all);  // (n, 3)
Array copied(const std::vector<double>& all);     // (n,)
IntArray copied(const std::vector<int>& all);     // (n,)

Vec3 vec3(const py::handle& from);
Mat3 mat3(const py::handle& from);
py::object read_only(const Vec3& v);
py::object read_only(const Mat3& m);
py::object read_only(const std::vector<double>& all);  // (n,)

}  // namespace drape::app::python

namespace pybind11::detail {

template <>
struct type_caster<drape::Vec3> {
  PYBIND11_TYPE_CASTER(drape::Vec3, const_name("numpy.ndarray"));
  bool load(handle from, bool /*convert*/) {
    value = drape::app::python::vec3(from);
    return true;
  }
  static handle cast(const drape::Vec3& v, return_value_policy /*policy*/, handle /*parent*/) {
    return drape::app::python::read_only(v).release();
  }
};

template <>
struct type_caster<drape::Mat3> {
  PYBIND11_TYPE_CASTER(drape::Mat3, const_name("numpy.ndarray"));
  bool load(handle from, bool /*convert*/) {
    value = drape::app::python::mat3(from);
    return true;
  }
  static handle cast(const drape::Mat3& m, return_value_policy /*policy*/, handle /*parent*/) {
    return drape::app::python::read_only(m).release();
  }
};

}  // namespace pybind11::detail
