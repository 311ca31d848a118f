// What the readers say of their keys, noted while they read: `drape keys` and docs/scene.md are made of it,
// so that there is no second list of keys.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/base/words.h"

namespace drape {

// Stands beside the key where it is read.
struct About {
  About(const char* text_, const char* otherwise_ = nullptr) : text(text_), otherwise(otherwise_) {}

  const char* text;       // what the key means
  const char* otherwise;  // what holds without it, in words; null: the value before it is read
};

struct KeyNote {
  std::string key;
  std::string kind;       // "a time > 0", "true or false"
  std::string unit;       // SI; empty: none
  std::string otherwise;  // what holds without it; empty of a key that is required
  std::string text;
};

// The keys of one table, in the order in which they are read. A table of which there are several kinds has
// one section for each, and one for what all have.
struct KeySection {
  std::string table;  // "cloth", "rotate"; empty: the file itself
  std::string kind;   // "shape = \"sphere\""
  std::vector<KeyNote> keys;
};

class KeyNotes {
 public:
  // Once for each key of a section: what is read again is the same key.
  void add(const std::string& table, const std::string& kind, KeyNote note);

  const std::vector<KeySection>& sections() const& { return sections_; }
  std::vector<KeySection> sections() && { return std::move(sections_); }

 private:
  std::vector<KeySection> sections_;
};

}  // namespace drape
