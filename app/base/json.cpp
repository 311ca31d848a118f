#include "app/base/json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "mesh/base/errors.h"

namespace drape::app {
namespace {

using Library = nlohmann::ordered_json;

constexpr int deepest = 200;  // lists in lists: what reads and frees them calls itself

Library converted(const Json& json);

struct Convert {
  Library operator()(std::monostate) const { return nullptr; }
  Library operator()(bool b) const { return b; }
  Library operator()(long i) const { return i; }
  Library operator()(double x) const { return x; }
  Library operator()(const std::string& text) const { return text; }
  Library operator()(const Json::List& items) const {
    Library list = Library::array();
    for (const Json& item : items) list.push_back(converted(item));
    return list;
  }
  Library operator()(const Json::Members& members) const {
    Library object = Library::object();
    for (const auto& [key, member] : members) object[key] = converted(member);
    return object;
  }
};

Library converted(const Json& json) { return std::visit(Convert{}, json.value); }

Json read(const Library& library) {
  if (library.is_boolean()) return library.get<bool>();
  if (library.is_number_integer()) return library.get<long>();
  if (library.is_number()) return library.get<double>();
  if (library.is_string()) return library.get<std::string>();
  if (library.is_array()) {
    Json::List list;
    for (const Library& item : library) list.push_back(read(item));
    return list;
  }
  if (!library.is_object()) return {};
  Json::Members members;
  for (const auto& [key, member] : library.items()) members.emplace_back(key, read(member));
  return members;
}

}  // namespace

const Json& Json::operator[](std::string_view member) const {
  static const Json absent;
  const auto* const members = std::get_if<Members>(&value);
  if (!members) return absent;
  const auto found =
      std::find_if(members->begin(), members->end(), [&](const auto& m) { return m.first == member; });
  return found == members->end() ? absent : found->second;
}

const Json::List& Json::items() const {
  static const List none;
  const auto* const list = std::get_if<List>(&value);
  return list ? *list : none;
}

std::string Json::text() const {
  const auto* const text = std::get_if<std::string>(&value);
  return text ? *text : std::string();
}

double Json::number(double otherwise) const {
  if (const auto* const integer = std::get_if<long>(&value)) return static_cast<double>(*integer);
  if (const auto* const real = std::get_if<double>(&value)) return *real;
  return otherwise;
}

std::string json_text(const Json& json) {
  return converted(json).dump(2, ' ', false, Library::error_handler_t::replace) + "\n";
}

std::string compact_json_text(const Json& json) {
  return converted(json).dump(-1, ' ', false, Library::error_handler_t::replace);
}

bool is_utf8(std::string_view text) {
  try {
    Library(std::string(text)).dump();
    return true;
  } catch (const Library::type_error&) {
    return false;
  }
}

Json parse_json(std::string_view text, const std::string& name) {
  const auto not_too_deep = [&](int depth, Library::parse_event_t, Library&) {
    if (depth > deepest) throw InputError(name + ": lists are nested deeper than " + std::to_string(deepest));
    return true;
  };
  try {
    return read(Library::parse(text, not_too_deep));
  } catch (const Library::parse_error& error) {
    const auto end = std::min(text.size(), error.byte);
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
    throw InputError(name + ":" + std::to_string(line) + ": is not JSON, or was cut short");
  } catch (const Library::exception&) {
    throw InputError(name + ": a number in it is out of range");
  }
}

}  // namespace drape::app
