#include "app/base/key_notes.h"

#include <algorithm>
#include <stdexcept>

namespace drape::app {

void KeyNotes::add(const std::string& table, const std::string& kind, KeyNote note) {
  const auto of_table = [&](const KeySection& each) { return each.table == table; };
  auto section = std::find_if(sections_.begin(), sections_.end(),
                              [&](const KeySection& each) { return of_table(each) && each.kind == kind; });
  if (section == sections_.end()) {  // what all have comes before what some have
    const auto place = kind.empty() ? std::find_if(sections_.begin(), sections_.end(), of_table) : section;
    section = sections_.insert(place, {table, kind, {}});
  }
  for (const KeyNote& before : section->keys)
    if (before.key == note.key) {
      if (before.text != note.text)
        throw std::logic_error("key '" + note.key + "' of '" + table + "' is explained in two ways");
      return;
    }
  section->keys.push_back(std::move(note));
}

}  // namespace drape::app
