// Turns a scene given as a dict into the plain data that the reader of scenes takes from TOML.
#pragma once

#include "app/base/toml_file.h"
#include "app/python/bindings.h"

namespace drape::app::python {

// `where` stands in messages: "scene", then "scene['cloth'][0]['bend']" and so on. Raises ValueError for what
// TOML cannot express.
Node node_of(const py::handle& value, const std::string& where);

}  // namespace drape::app::python
