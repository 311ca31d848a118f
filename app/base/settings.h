// A setting changes a scene from the command line before the scene is read: PATH=VALUE. It gets the same
// checks and messages as the file.
//   simulation.tolerance   cloth.0.bend   cloth.sheet.bend   obstacle.0.friction.static
// An entry of a list is named by its number, from 0, or by its name, its mesh or its shape.
#pragma once

#include <string>
#include <vector>

#include "app/base/toml_file.h"

namespace drape::app {

struct Setting {
  std::string path;
  std::string value;  // in TOML; a text needs no quotes
  std::string where;  // for messages: "--set cloth.0.bend", "--duration"
};

// "PATH=VALUE", as it came after this option, or after none. Throws InputError.
Setting parse_setting(const std::string& text, const std::string& option = "--set");

// Throws InputError when the path leads nowhere, and when another option or setting gave the same value.
void apply(const Setting& setting, Node& root);
// The same, with the value as data; value.where stands in messages.
void apply(const std::string& path, Node value, Node& root);

}  // namespace drape::app
