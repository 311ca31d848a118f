// What the readers of scene and other files say about their keys, collected while they read. `drape keys` and
// docs/scene.md are made from these notes, so there is no second list of keys.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/base/words.h"

namespace drape::app {

// The explanation of a key, given where the key is read.
struct About {
  About(const char* text_, const char* otherwise_ = nullptr) : text(text_), otherwise(otherwise_) {}

  const char* text;  // what the key means
  // What holds when the key is absent, in words; null when it is the value that the variable has before.
  const char* otherwise;
};

struct KeyNote {
  std::string key;
  std::string kind;       // "a time > 0", "true or false"
  std::string unit;       // SI unit; empty when the key has none
  std::string otherwise;  // what holds when the key is absent; empty for a required key
  std::string text;
};

// The keys of one table, in the order in which they are read. A table that comes in several kinds has one
// section for each kind, and one for the keys that all kinds have.
struct KeySection {
  std::string table;  // "cloth", "rotate"; empty for the top level of the file
  std::string kind;   // "shape = \"sphere\""; empty for the keys of all kinds
  std::vector<KeyNote> keys;
};

class KeyNotes {
 public:
  // Adds a key to its section. A key that the section already has is not added again.
  void add(const std::string& table, const std::string& kind, KeyNote note);

  const std::vector<KeySection>& sections() const& { return sections_; }
  std::vector<KeySection> sections() && { return std::move(sections_); }

 private:
  std::vector<KeySection> sections_;
};

}  // namespace drape::app
