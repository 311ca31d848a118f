#include "app/json.h"

#include <nlohmann/json.hpp>

namespace drape {
namespace {

using Library = nlohmann::ordered_json;

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

}  // namespace

std::string json_text(const Json& json) {
  return converted(json).dump(2, ' ', false, Library::error_handler_t::replace) + "\n";
}

}  // namespace drape
