#include "app/python/scenes.h"

#include <cstdint>

#include "app/base/words.h"
#include "mesh/base/errors.h"

namespace drape::app::python {
namespace {

constexpr int deepest = 200;  // as in a TOML file; a dict may also contain itself

Node of(const py::handle& value, const std::string& where, int depth);

Node of_boolean(bool boolean, const std::string& where) {
  Node node = Node::of_table(where);
  node.kind = Node::Kind::boolean;
  node.boolean = boolean;
  return node;
}

Node of_integer(const py::handle& value, const std::string& where) {
  int overflow = 0;
  const auto integer = PyLong_AsLongLongAndOverflow(value.ptr(), &overflow);
  if (overflow != 0) throw InputError(where + ": the integer is out of range");
  Node node = Node::of_number(static_cast<double>(integer), where);
  node.kind = Node::Kind::integer;
  node.integer = integer;
  return node;
}

std::string text_of(const py::handle& value, const std::string& where) {
  Py_ssize_t size = 0;
  const char* const text = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
  if (text) return {text, static_cast<std::size_t>(size)};
  PyErr_Clear();
  throw InputError(where + ": " + one_line(std::string(py::repr(value)).substr(0, 60)) +
                   " has a lone surrogate, which no file can hold");
}

bool is_mapping(const py::handle& value) {
  return py::isinstance(value, py::module_::import("collections.abc").attr("Mapping"));
}

Node of_dict(const py::dict& dict, const std::string& where, int depth) {
  Node node = Node::of_table(where);
  for (const auto& [key, value] : dict) {
    if (!py::isinstance<py::str>(key))
      throw InputError(where + ": a key is a text, but here is " + std::string(py::repr(key)));
    const std::string place = where + "[" + std::string(py::repr(key)) + "]";
    node.members.emplace(text_of(key, where), of(value, place, depth + 1));
  }
  return node;
}

Node of_sequence(const py::sequence& sequence, const std::string& where, int depth) {
  std::vector<Node> items;
  for (const py::handle item : sequence)
    items.push_back(of(item, where + "[" + std::to_string(items.size()) + "]", depth + 1));
  return Node::of_list(std::move(items), where);
}

Node of(const py::handle& value, const std::string& where, int depth) {
  if (depth > deepest) throw InputError(where.substr(0, 60) + "...: is nested too deep");
  if (py::isinstance<py::bool_>(value)) return of_boolean(value.cast<bool>(), where);
  if (py::isinstance<py::int_>(value)) return of_integer(value, where);
  if (py::isinstance<py::float_>(value)) return Node::of_number(value.cast<double>(), where);
  if (py::isinstance<py::str>(value)) return Node::of_text(text_of(value, where), where);
  if (is_mapping(value)) return of_dict(py::dict(py::reinterpret_borrow<py::object>(value)), where, depth);
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value))
    return of_sequence(value.cast<py::sequence>(), where, depth);
  if (py::hasattr(value, "__fspath__")) return Node::of_text(py::str(value.attr("__fspath__")()), where);
  if (py::hasattr(value, "tolist")) return of(value.attr("tolist")(), where, depth + 1);  // of NumPy
  throw InputError(where + ": expected a number, a text, True or False, a list or a dict, but got " +
                   one_line(std::string(py::repr(value)).substr(0, 60)));
}

}  // namespace

Node node_of(const py::handle& value, const std::string& where) { return of(value, where, 0); }

}  // namespace drape::app::python
