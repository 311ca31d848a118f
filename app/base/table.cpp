#include "app/base/table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/base/errors.h"

namespace drape::app {
namespace {

std::string kind_name(Node::Kind kind) {
  switch (kind) {
    case Node::Kind::boolean:
      return "true or false";
    case Node::Kind::integer:
      return "a whole number";
    case Node::Kind::number:
      return "a number";
    case Node::Kind::text:
      return "a text in quotes";
    case Node::Kind::array:
      return "a list in [ ]";
    case Node::Kind::table:
      return "a table";
  }
  return {};
}

bool is_number(const Node& node) {
  return node.kind == Node::Kind::number || node.kind == Node::Kind::integer;
}

bool holds_tables(const Node& node) {
  if (node.kind == Node::Kind::array) return !node.items.empty() && holds_tables(node.items.front());
  return node.kind == Node::Kind::table;
}

void want(const Node& node, Node::Kind kind) {
  if (node.kind != kind) throw InputError("expected " + kind_name(kind));
}

int whole_number(const Node& node, int least) {
  want(node, Node::Kind::integer);
  if (node.integer < least) throw InputError("expected a whole number from " + std::to_string(least) + " up");
  if (node.integer > std::numeric_limits<int>::max()) throw InputError("the number is too large");
  return static_cast<int>(node.integer);
}

bool holds(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string in_quotes(const std::string& text) { return '"' + text + '"'; }

std::string noun(const Dimension& dimension, Range range) {
  const char* const bound = range == Range::positive ? " > 0" : range == Range::not_negative ? " ≥ 0" : "";
  return std::string(dimension.noun) + bound;
}

}  // namespace

double quantity(const Node& node, const Dimension& dimension, Range range) {
  double value = node.number;
  if (node.kind == Node::Kind::text) {
    value = parse_quantity(node.text, dimension);
  } else if (!is_number(node)) {
    throw InputError(expected(dimension));
  } else if (dimension.needs_unit) {
    throw InputError("has no unit; " + expected(dimension));
  }
  if (!(std::abs(value) < std::numeric_limits<double>::max()))  // to which the reader of TOML cuts 1e400
    throw InputError("is not a finite number; " + expected(dimension));
  if (is_number(node) && std::abs(value) > dimension.most_alone) {
    const std::string unit(dimension.unit);
    throw InputError("has no unit, and " + unit + " may not be meant; " + expected(dimension) + ", or \"" +
                     written(node) + " " + unit + "\"");
  }
  const std::string noun(dimension.noun);
  if (range == Range::positive && !(value > 0)) throw InputError("expected " + noun + " greater than zero");
  if (range == Range::not_negative && value < 0)
    throw InputError("expected " + noun + " that is not negative");
  return value;
}

Vec3 vector(const Node& node, const Dimension& dimension) {
  if (node.kind != Node::Kind::array || node.items.size() != 3)
    throw InputError("expected a list of three, each " + std::string(dimension.noun));
  Vec3 value;
  for (int i = 0; i < 3; ++i) value[i] = quantity(node.items[i], dimension, Range::any);
  return value;
}

void Table::fail(const std::string& key, const std::string& what) const {
  const Node* const found = find(key);
  if (!found) throw InputError(node_->where + ": " + title_ + ": " + what);
  const Node& node = *found;
  const bool short_value = node.kind != Node::Kind::table;
  throw InputError(node.where + ": " + key + (short_value ? " = " + written(node) : "") + ": " + what);
}

const Node* Table::find(const std::string& key) const {
  const auto found = node_->members.find(key);
  return found == node_->members.end() ? nullptr : &found->second;
}

const Node* Table::ask(const std::string& key) {
  if (!holds(asked_, key)) asked_.push_back(key);
  return find(key);
}

void Table::note(const std::string& key, const std::string& kind, std::string_view unit,
                 const std::string& value, const About& about) {
  if (!notes_) return;
  KeyNote note{key, kind, unit == dimension::number.unit ? "" : std::string(unit), value, about.text};
  if (about.otherwise) note.otherwise = about.otherwise;
  if (holds(required_, key)) note.otherwise.clear();
  notes_->add(name_, kind_, std::move(note));
}

// Runs f on the value, when there is one, and says where what it throws happened.
template <class F>
void Table::with(const std::string& key, const F& f) {
  const Node* const node = ask(key);
  if (!node) return;
  try {
    f(*node);
  } catch (const InputError& error) {
    fail(key, error.what());
  }
}

void Table::read(const std::string& key, double& value, const Dimension& dimension, Range range,
                 const About& about) {
  note(key, noun(dimension, range), dimension.unit, shortest(value), about);
  with(key, [&](const Node& node) { value = quantity(node, dimension, range); });
}

void Table::read(const std::string& key, std::optional<double>& value, const Dimension& dimension,
                 Range range, const About& about) {
  note(key, noun(dimension, range), dimension.unit, value ? shortest(*value) : "none", about);
  with(key, [&](const Node& node) { value = quantity(node, dimension, range); });
}

void Table::read(const std::string& key, Vec3& value, const Dimension& dimension, const About& about) {
  const std::string text =
      "[" + shortest(value.x()) + ", " + shortest(value.y()) + ", " + shortest(value.z()) + "]";
  note(key, "three, each " + std::string(dimension.noun), dimension.unit, text, about);
  with(key, [&](const Node& node) { value = vector(node, dimension); });
}

void Table::read(const std::string& key, int& value, int least, const About& about) {
  note(key, "a whole number ≥ " + std::to_string(least), "", std::to_string(value), about);
  with(key, [&](const Node& node) { value = whole_number(node, least); });
}

void Table::read(const std::string& key, bool& value, const About& about) {
  note(key, "true or false", "", value ? "true" : "false", about);
  with(key, [&](const Node& node) {
    want(node, Node::Kind::boolean);
    value = node.boolean;
  });
}

void Table::read(const std::string& key, std::string& value, const About& about) {
  note(key, "a text", "", value.empty() ? "none" : in_quotes(value), about);
  with(key, [&](const Node& node) {
    want(node, Node::Kind::text);
    value = node.text;
  });
}

void Table::read(const std::string& key, std::vector<int>& values, const About& about) {
  note(key, "a list of whole numbers", "", "none", about);
  with(key, [&](const Node& node) {
    want(node, Node::Kind::array);
    for (const Node& item : node.items) values.push_back(whole_number(item, 0));
  });
}

void Table::read(const std::string& key, Names& values, const About& about) {
  note(key, "a list of texts", "", "none", about);
  with(key, [&](const Node& node) {
    want(node, Node::Kind::array);
    for (const Node& item : node.items) {
      want(item, Node::Kind::text);
      values.push_back(item.text);
    }
  });
}

void Table::read(const std::string& key, std::string& value, const Names& known, const About& about) {
  Names quoted;
  for (const std::string& name : known) quoted.push_back(in_quotes(name));
  note(key, listed(quoted), "", value.empty() ? "none" : in_quotes(value), about);
  read(key, value, about);
  if (has(key) && !holds(known, value))
    fail(key, "there is no such " + key + "; " + suggestion(value, known));
}

void Table::read_part(const std::string& key, std::string& value, const Names& parts, const About& about) {
  note(key, "a name of `drape list`", "", value.empty() ? "none" : in_quotes(value), about);
  read(key, value, parts, about);
}

std::vector<Table> Table::tables(const std::string& key, const About& about) {
  note(key, "a table, or several", "", "none", about);
  return asked_tables(key);
}

std::optional<Table> Table::one(const std::string& key, const About& about) {
  note(key, "a table", "", "none", about);
  std::vector<Table> found = asked_tables(key);
  if (found.size() > 1) fail(key, "there may be only one");
  if (found.empty()) return {};
  return std::move(found.front());
}

std::vector<Table> Table::asked_tables(const std::string& key) {
  std::vector<Table> found;
  const Node* const node = ask(key);
  if (!node) return found;
  if (node->kind == Node::Kind::table) {
    found.push_back(inner(key));
    return found;
  }
  if (node->kind != Node::Kind::array) fail(key, "expected tables, as [[" + key + "]]");
  for (std::size_t i = 0; i < node->items.size(); ++i) {
    if (node->items[i].kind != Node::Kind::table) fail(key, "expected tables, as [[" + key + "]]");
    found.emplace_back(node->items[i], "[[" + key + "]] number " + std::to_string(i), notes_, key);
  }
  return found;
}

const Node* Table::take(const std::string& key, const char* kind, const About& about) {
  note(key, kind, "", "none", about);
  return ask(key);
}

Table Table::inner(const std::string& key) const { return {*find(key), "[" + key + "]", notes_, key}; }

void Table::require(const std::string& key) {
  if (!ask(key)) fail(key, "'" + key + "' is missing");
  required_.push_back(key);
}

void Table::finish() const {
  for (const auto& [key, member] : node_->members)
    if (!holds(asked_, key))
      throw InputError(member.where + ": unknown " + (holds_tables(member) ? "table '" : "key '") + key +
                       "' in " + title_ + "; " + suggestion(key, asked_));
}

}  // namespace drape::app
