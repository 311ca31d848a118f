#include "app/key_notes.h"

#include <algorithm>
#include <stdexcept>

namespace drape {

void KeyNotes::add(const std::string& table, const std::string& kind, KeyNote note) {
  auto section = std::find_if(sections_.begin(), sections_.end(), [&](const KeySection& each) {
    return each.table == table && each.kind == kind;
  });
  if (section == sections_.end()) section = sections_.insert(section, {table, kind, {}});
  for (const KeyNote& before : section->keys)
    if (before.key == note.key) {
      if (before.text != note.text)
        throw std::logic_error("key '" + note.key + "' of '" + table + "' is explained in two ways");
      return;
    }
  section->keys.push_back(std::move(note));
}

}  // namespace drape
