// A scene given as a dict, as the plain data that the reader of scenes takes from TOML.
#pragma once

#include "app/base/toml_file.h"
#include "app/python/bindings.h"

namespace drape::python {

// where: "scene", then "scene['cloth'][0]['bend']" and so on. ValueError for what TOML has no word for.
Node node_of(const py::handle& value, const std::string& where);

}  // namespace drape::python
