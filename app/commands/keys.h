// `drape keys`: every key that a scene, a fabric or a pattern file may have, with what it means, as the
// readers say it. Each reads a small file that has one of every kind of table, and notes what it asks for.
#pragma once

#include <string>
#include <string_view>

#include "app/base/key_notes.h"

namespace drape {

KeyNotes scene_keys();
KeyNotes fabric_keys();
KeyNotes pattern_keys();

std::string_view scene_of_every_kind();  // TOML; the files it names need not exist

struct KeysWords {
  std::string table;      // "cloth"; or "scene", "fabric", "pattern": all of such a file; empty: everything
  bool markdown = false;  // as tables for docs/
};
int print_keys(const KeysWords& words);  // throws InputError when there is no such table

}  // namespace drape
