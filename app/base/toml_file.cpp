#include "app/base/toml_file.h"

#include <sstream>
#include <toml.hpp>

#include "app/base/text_file.h"
#include "app/base/words.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

using TomlValue = toml::basic_value<toml::discard_comments, std::map, std::vector>;

Node converted(const TomlValue& value, const std::string& name) {
  Node node;
  node.where = name + ":" + std::to_string(value.location().line());
  switch (value.type()) {
    case toml::value_t::boolean:
      node.kind = Node::Kind::boolean;
      node.boolean = value.as_boolean();
      break;
    case toml::value_t::integer:
      node.kind = Node::Kind::integer;
      node.integer = value.as_integer();
      node.number = static_cast<double>(node.integer);
      break;
    case toml::value_t::floating:
      node.kind = Node::Kind::number;
      node.number = value.as_floating();
      break;
    case toml::value_t::string:
      node.kind = Node::Kind::text;
      node.text = value.as_string().str;
      break;
    case toml::value_t::array:
      node.kind = Node::Kind::array;
      for (const TomlValue& item : value.as_array()) node.items.push_back(converted(item, name));
      break;
    case toml::value_t::table:
      for (const auto& [key, member] : value.as_table()) node.members.emplace(key, converted(member, name));
      break;
    default:  // dates and times: nothing here takes one
      node.kind = Node::Kind::text;
      node.text = toml::format(value);
  }
  return node;
}

// The library reads nested values by recursion, and some thousand brackets would overflow the stack.
bool nested_too_deep(std::string_view text) {
  constexpr int deepest = 200;
  int depth = 0;
  for (const char c : text) {
    depth += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
    if (depth > deepest) return true;
  }
  return false;
}

// The first line of the library's drawing, without its own function names.
std::string reason(std::string_view what) {
  what = what.substr(0, what.find('\n'));
  if (const std::size_t mark = what.find("[error] "); mark != what.npos) what.remove_prefix(mark + 8);
  if (what.starts_with("toml::"))
    if (const std::size_t colon = what.find(": "); colon != what.npos) what.remove_prefix(colon + 2);
  return std::string(what);
}

}  // namespace

Node Node::of_text(std::string text, std::string where) {
  Node node;
  node.kind = Kind::text;
  node.text = std::move(text);
  node.where = std::move(where);
  return node;
}

Node Node::of_number(double number, std::string where) {
  Node node;
  node.kind = Kind::number;
  node.number = number;
  node.where = std::move(where);
  return node;
}

Node Node::of_list(std::vector<Node> items, std::string where) {
  Node node;
  node.kind = Kind::array;
  node.items = std::move(items);
  node.where = std::move(where);
  return node;
}

Node Node::of_table(std::string where) {
  Node node;
  node.where = std::move(where);
  return node;
}

std::string toml_text(const Node& node) {
  std::string text;
  switch (node.kind) {
    case Node::Kind::boolean:
      return node.boolean ? "true" : "false";
    case Node::Kind::integer:
      return std::to_string(node.integer);
    case Node::Kind::number:
      return shortest(node.number);
    case Node::Kind::text:
      for (const char c : one_line(node.text))
        text += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
      return "\"" + text + "\"";
    case Node::Kind::array:
      for (const Node& item : node.items) text += (text.empty() ? "" : ", ") + toml_text(item);
      return "[" + text + "]";
    case Node::Kind::table:
      for (const auto& [key, member] : node.members)
        text += (text.empty() ? " " : ", ") + key + " = " + toml_text(member);
      return "{" + text + " }";
  }
  return text;
}

std::string written(const Node& node) {
  const std::string text = toml_text(node);
  return text.size() <= 60 ? text : text.substr(0, 56) + " ...";
}

Node parse_toml(std::string_view text, const std::string& name) {
  if (nested_too_deep(text)) throw InputError(name + ": is not TOML: its brackets are nested too deep");
  try {
    std::istringstream stream{std::string(text)};
    return converted(toml::parse<toml::discard_comments, std::map, std::vector>(stream, name), name);
  } catch (const toml::exception& error) {
    throw InputError(name + ":" + std::to_string(error.location().line()) +
                     ": is not TOML: " + reason(error.what()));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(name + ": is not TOML: " + reason(error.what()));
  }
}

Node read_toml(const std::filesystem::path& path) {
  return parse_toml(read_text(path, "TOML"), path.string());
}

Node parse_toml_value(std::string_view text, const std::string& where) {
  Node node = Node::of_text(std::string(text), where);
  if (text.find('\n') == text.npos) {
    try {
      node = parse_toml("value = " + std::string(text), where).members.at("value");
    } catch (const InputError&) {  // not a TOML value: a text without quotes
      if (text.find_first_of("[{\"'") == 0)
        throw InputError(
            where + ": " + std::string(text) +
            " is not TOML: its brackets, its quotes or what stands between them; expected such as "
            "[0, -9.81, 0], { axis = [0, 1, 0], angle = \"90 deg\" } or \"5 mm\"");
    }
  }
  const auto place = [&](const auto& self, Node& n) -> void {
    n.where = where;
    for (Node& item : n.items) self(self, item);
    for (auto& [key, member] : n.members) self(self, member);
  };
  place(place, node);
  return node;
}

}  // namespace drape::app
