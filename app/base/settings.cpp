#include "app/base/settings.h"

#include <algorithm>
#include <charconv>

#include "app/base/words.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

Names split(const std::string& path) {
  Names parts;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    parts.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

// What an entry of a list may be called.
std::string entry_name(const Node& entry) {
  if (const auto name = entry.members.find("name"); name != entry.members.end()) return name->second.text;
  if (const auto mesh = entry.members.find("mesh"); mesh != entry.members.end())
    return std::filesystem::path(mesh->second.text).stem().string();
  if (const auto shape = entry.members.find("shape"); shape != entry.members.end()) return shape->second.text;
  return {};
}

// [cloth] is [[cloth]] with one entry.
void make_list(Node& node) {
  if (node.kind != Node::Kind::table) return;
  Node list = Node::of_table(node.where);
  list.kind = Node::Kind::array;
  list.items.push_back(std::move(node));
  node = std::move(list);
}

Node& entry(Node& list, const std::string& part, const std::string& where) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  const bool is_index = error == std::errc() && end == part.data() + part.size();
  if (is_index && index < list.items.size()) return list.items[index];

  Names known;
  for (Node& item : list.items) {
    known.push_back(entry_name(item));
    if (!is_index && known.back() == part) return item;
  }
  if (std::all_of(known.begin(), known.end(), [](const std::string& name) { return name.empty(); }))
    throw InputError(where + ": there is no '" + part + "' in the list; it has " +
                     counted(static_cast<long>(known.size()), "value") + ", counted from 0");
  throw InputError(where + ": there is no '" + part + "' in the list; it has, from 0: " + listed(known));
}

}  // namespace

Setting parse_setting(const std::string& text, const std::string& option) {
  const std::size_t equals = text.find('=');
  if (equals == text.npos || equals == 0)
    throw InputError((option.empty() ? "'" + text + "' is one word too many, or a setting without a value"
                                     : option + " " + text) +
                     ": expected PATH=VALUE such as cloth.0.bend=\"5 uN.m\"");
  const auto trimmed = [](const std::string& words) {
    const std::size_t begin = words.find_first_not_of(" \t");
    return begin == words.npos ? std::string()
                               : words.substr(begin, words.find_last_not_of(" \t") + 1 - begin);
  };
  const std::string path = trimmed(text.substr(0, equals));
  return {path, trimmed(text.substr(equals + 1)), "--set " + path};
}

void apply(const std::string& path, Node value, Node& root) {
  const std::string where = value.where;
  const Names parts = split(path);
  Node* node = &root;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const bool last = i + 1 == parts.size();
    if (parts[i].empty()) throw InputError(where + ": the path has an empty part");
    if (node->kind == Node::Kind::array) {
      node = &entry(*node, parts[i], where);
    } else if (node->kind == Node::Kind::table) {
      const bool is_list = i == 0 && !last &&
                           (parts[0] == "cloth" || parts[0] == "soft" || parts[0] == "rope" ||
                            parts[0] == "obstacle" || parts[0] == "pair");
      if (is_list && !node->members.contains(parts[0]))
        throw InputError(where + ": there is no [[" + parts[0] + "]]");
      node = &node->members.try_emplace(parts[i], Node::of_table(where)).first->second;
      if (is_list) make_list(*node);
    } else {
      throw InputError(where + ": '" + parts[i - 1] + "' has no parts");
    }
  }
  // An option of its own and a setting, or two names of one entry. What a body is by --onto and the like may
  // be refined.
  const std::string& given = node->where;
  if (given.starts_with("--") && !where.starts_with(given) && parts.front() != "obstacle")
    throw InputError(where + ": " + given + " gives the same value; give one of them");
  *node = std::move(value);
}

void apply(const Setting& setting, Node& root) {
  apply(setting.path, parse_toml_value(setting.value, setting.where), root);
}

}  // namespace drape::app
