#include "app/table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/obj.h"

namespace drape {
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

}  // namespace

double quantity(const Node& node, const Dimension& dimension, Range range) {
  double value = node.number;
  if (node.kind == Node::Kind::text) {
    value = parse_quantity(node.text, dimension);
  } else if (!is_number(node)) {
    throw InputError(expected(dimension));
  }
  if (!std::isfinite(value)) throw InputError("is not a finite number; " + expected(dimension));
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
  for (int i = 0; i < 3; ++i)
    value[i] = quantity(node.items[static_cast<std::size_t>(i)], dimension, Range::any);
  return value;
}

void Table::fail(const std::string& key, const std::string& what) const {
  const auto found = node_->members.find(key);
  if (found == node_->members.end()) throw InputError(node_->where + ": " + title_ + ": " + what);
  const Node& node = found->second;
  const bool short_value = node.kind != Node::Kind::table;
  throw InputError(node.where + ": " + key + (short_value ? " = " + written(node) : "") + ": " + what);
}

const Node* Table::take(const std::string& key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.push_back(key);
  const auto found = node_->members.find(key);
  return found == node_->members.end() ? nullptr : &found->second;
}

// Runs f on the value, when there is one, and says where what it throws happened.
template <class F>
void Table::with(const std::string& key, const F& f) {
  const Node* const node = take(key);
  if (!node) return;
  try {
    f(*node);
  } catch (const InputError& error) {
    fail(key, error.what());
  }
}

void Table::read(const std::string& key, double& value, const Dimension& dimension, Range range) {
  with(key, [&](const Node& node) { value = quantity(node, dimension, range); });
}

void Table::read(const std::string& key, std::optional<double>& value, const Dimension& dimension,
                 Range range) {
  with(key, [&](const Node& node) { value = quantity(node, dimension, range); });
}

void Table::read(const std::string& key, Vec3& value, const Dimension& dimension) {
  with(key, [&](const Node& node) { value = vector(node, dimension); });
}

void Table::read(const std::string& key, int& value, int least) {
  with(key, [&](const Node& node) { value = whole_number(node, least); });
}

void Table::read(const std::string& key, bool& value) {
  with(key, [&](const Node& node) {
    want(node, Node::Kind::boolean);
    value = node.boolean;
  });
}

void Table::read(const std::string& key, std::string& value) {
  with(key, [&](const Node& node) {
    want(node, Node::Kind::text);
    value = node.text;
  });
}

void Table::read(const std::string& key, std::vector<int>& values) {
  with(key, [&](const Node& node) {
    want(node, Node::Kind::array);
    for (const Node& item : node.items) values.push_back(whole_number(item, 0));
  });
}

void Table::read(const std::string& key, Names& values) {
  with(key, [&](const Node& node) {
    want(node, Node::Kind::array);
    for (const Node& item : node.items) {
      want(item, Node::Kind::text);
      values.push_back(item.text);
    }
  });
}

void Table::read(const std::string& key, std::string& value, const Names& known) {
  read(key, value);
  if (has(key) && std::find(known.begin(), known.end(), value) == known.end())
    fail(key, "there is no such " + key + "; " + suggestion(value, known));
}

std::vector<Table> Table::tables(const std::string& key) {
  std::vector<Table> found;
  const Node* const node = take(key);
  if (!node) return found;
  if (node->kind == Node::Kind::table) {
    found.emplace_back(*node, "[" + key + "]");
    return found;
  }
  if (node->kind != Node::Kind::array) fail(key, "expected tables, as [[" + key + "]]");
  for (std::size_t i = 0; i < node->items.size(); ++i) {
    if (node->items[i].kind != Node::Kind::table) fail(key, "expected tables, as [[" + key + "]]");
    found.emplace_back(node->items[i], "[[" + key + "]] number " + std::to_string(i));
  }
  return found;
}

void Table::require(const std::string& key) {
  if (!take(key)) fail(key, "'" + key + "' is missing");
}

void Table::finish() const {
  for (const auto& [key, member] : node_->members)
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end())
      throw InputError(member.where + ": unknown " + (holds_tables(member) ? "table '" : "key '") + key +
                       "' in " + title_ + "; " + suggestion(key, asked_));
}

}  // namespace drape
