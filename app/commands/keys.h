// `drape keys`: every key that a scene, a fabric or a pattern file may have, with its meaning, as the readers
// explain it. For each of the three kinds of file, a small file with every kind of table is read, and what
// the readers ask for is collected.
#pragma once

#include <string>
#include <string_view>

#include "app/base/key_notes.h"

namespace drape::app {

KeyNotes scene_keys();
KeyNotes fabric_keys();
KeyNotes pattern_keys();

std::string scene_of_every_kind();  // TOML; the files that it names need not exist

struct KeysWords {
  // A table such as "cloth"; or "scene", "fabric" or "pattern" for all tables of such a file; empty for
  // everything.
  std::string table;
  bool markdown = false;  // as tables for docs/
};
int print_keys(const KeysWords& words);  // throws InputError when there is no such table

}  // namespace drape::app
