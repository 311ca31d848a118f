// What the command line changes in a scene before it is read: PATH=VALUE,
// with the same checks and messages as the file.
//   simulation.tolerance   cloth.0.bend   cloth.sheet.bend   obstacle.0.friction.static
// A list is entered by number, from 0, or by the name (or mesh, or shape) of the entry.
#pragma once

#include <string>
#include <vector>

#include "app/base/toml_file.h"

namespace drape {

struct Setting {
  std::string path;
  std::string value;  // as TOML writes it; a text needs no quotes
  std::string where;  // "--set cloth.0.bend", "--duration": stands in messages
};

Setting parse_setting(const std::string& text);  // "PATH=VALUE"; throws InputError

void apply(const Setting& setting, Node& root);  // throws InputError when the path leads nowhere
void apply(const std::string& path, Node value,
           Node& root);  // the same, from data; value.where stands in messages

}  // namespace drape
