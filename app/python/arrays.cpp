#include "app/python/arrays.h"

#include <algorithm>
#include <string>

namespace drape::app::python {
namespace {

std::string shape_text(const py::ssize_t* begin, py::ssize_t count) {
  std::string text;
  for (py::ssize_t k = 0; k < count; ++k)
    text += (k > 0 ? ", " : "") + (begin[k] < 0 ? "n" : std::to_string(begin[k]));
  return "(" + text + (count == 1 ? ",)" : ")");
}

// With its kind and shape checked.
py::array checked(const py::handle& from, const char* name, std::initializer_list<py::ssize_t> shape,
                  const char* kinds, const char* wanted) {
  const std::string start = std::string(name) + ": expected ";
  const py::array array = from.is_none() ? py::array() : py::array::ensure(from);  // null: no array at all
  if (from.is_none() || !array)
    throw py::value_error(start + "an array of " + wanted + ", but got a " +
                          std::string(py::str(py::type::of(from).attr("__name__"))));
  if (std::string(kinds).find(array.dtype().kind()) == std::string::npos && array.size() > 0)
    throw py::value_error(start + wanted + ", but got an array of " + std::string(py::str(array.dtype())));
  bool fits = array.ndim() == static_cast<py::ssize_t>(shape.size());
  for (std::size_t k = 0; fits && k < shape.size(); ++k)
    fits = shape.begin()[k] < 0 || shape.begin()[k] == array.shape(static_cast<py::ssize_t>(k));
  if (!fits)
    throw py::value_error(start + "an array of shape " +
                          shape_text(shape.begin(), static_cast<py::ssize_t>(shape.size())) + ", but got " +
                          shape_text(array.shape(), array.ndim()));
  return array;
}

py::object locked(const py::array& array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

}  // namespace

Array numbers(const py::handle& from, const char* name, std::initializer_list<py::ssize_t> shape) {
  return Array::ensure(checked(from, name, shape, "fiu", "numbers"));
}

IntArray integers(const py::handle& from, const char* name, std::initializer_list<py::ssize_t> shape) {
  const py::array array = checked(from, name, shape, "iu", "integers");
  // By way of the widest type, so that what does not fit is noticed.
  const auto wide = py::array_t<long long, py::array::c_style | py::array::forcecast>::ensure(array);
  const auto out_of_range = [](long long i) { return i != static_cast<int>(i); };
  if (std::any_of(wide.data(), wide.data() + wide.size(), out_of_range))
    throw py::value_error(std::string(name) + ": an integer is out of range");
  return IntArray::ensure(wide);
}

VecX stacked_rows(const py::handle& from, const char* name) {
  const Array array = numbers(from, name, {-1, 3});
  return Eigen::Map<const VecX>(array.data(), array.size());
}

std::vector<Vec3> points(const py::handle& from, const char* name) {
  const Array array = numbers(from, name, {-1, 3});
  std::vector<Vec3> all(static_cast<std::size_t>(array.shape(0)));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = Eigen::Map<const Vec3>(array.data() + 3 * i);
  return all;
}

std::vector<double> list_of(const py::handle& from, const char* name) {
  const Array array = numbers(from, name, {-1});
  return {array.data(), array.data() + array.size()};
}

Array view(const double* data, std::vector<py::ssize_t> shape, const py::handle& owner, Access access) {
  Array array(std::move(shape), data, owner);  // with an owner nothing is copied
  if (access == Access::read) locked(array);
  return array;
}

Array view_rows(const VecX& x, const py::handle& owner, Access access) {
  return view(x.data(), {x.size() / 3, 3}, owner, access);
}

Array copied_rows(const VecX& x) {
  return Array({static_cast<py::ssize_t>(x.size() / 3), py::ssize_t{3}}, x.data());
}

Array copied_rows(const std::vector<Vec3>& all) {
  Array array({static_cast<py::ssize_t>(all.size()), py::ssize_t{3}});
  for (std::size_t i = 0; i < all.size(); ++i) Eigen::Map<Vec3>(array.mutable_data() + 3 * i) = all[i];
  return array;
}

Array copied(const std::vector<double>& all) {
  return Array(static_cast<py::ssize_t>(all.size()), all.data());
}

IntArray copied(const std::vector<int>& all) {
  return IntArray(static_cast<py::ssize_t>(all.size()), all.data());
}

Vec3 vec3(const py::handle& from) { return Eigen::Map<const Vec3>(numbers(from, "a vector", {3}).data()); }

Mat3 mat3(const py::handle& from) {
  const Array array = numbers(from, "a matrix", {3, 3});
  return Eigen::Map<const Mat3>(array.data()).transpose();  // NumPy goes row by row, Eigen column by column
}

py::object read_only(const Vec3& v) { return locked(Array(py::ssize_t{3}, v.data())); }

py::object read_only(const std::vector<double>& all) { return locked(copied(all)); }

py::object read_only(const Mat3& m) {
  const Mat3 by_rows = m.transpose();
  return locked(Array({py::ssize_t{3}, py::ssize_t{3}}, by_rows.data()));
}

}  // namespace drape::app::python
