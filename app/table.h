// Reads one table of a scene or fabric file: a value keeps its default when its key is absent; a wrong type,
// unit, sign or name is an InputError "scene.toml:12: bend = "10 N/m": expected a bending rigidity such as
// "10 uN.m"". finish() finds the keys that nobody asked for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/toml_file.h"
#include "app/units.h"
#include "app/words.h"
#include "mesh/triangle_mesh.h"

namespace drape {

enum class Range { any, not_negative, positive };

class Table {
 public:
  Table(const Node& node, std::string title) : node_(&node), title_(std::move(title)) {}

  bool has(const std::string& key) const { return node_->members.contains(key); }

  void read(const std::string& key, double& value, const Dimension& dimension, Range range = Range::any);
  void read(const std::string& key, std::optional<double>& value, const Dimension& dimension,
            Range range = Range::any);
  void read(const std::string& key, Vec3& value, const Dimension& dimension);
  void read(const std::string& key, int& value, int least);
  void read(const std::string& key, bool& value);
  void read(const std::string& key, std::string& value);
  void read(const std::string& key, std::string& value, const Names& known);  // one of the known names
  void read(const std::string& key, std::vector<int>& values);
  void read(const std::string& key, Names& values);

  // A table, or each of an array of tables (a table alone is an array of one). Absent: none.
  std::vector<Table> tables(const std::string& key);
  const Node* take(const std::string& key);  // any kind, null when absent

  void require(const std::string& key);  // throws when it is absent
  template <class Value, class... How>
  void read_required(const std::string& key, Value& value, const How&... how) {
    require(key);
    read(key, value, how...);
  }
  void finish() const;  // throws on a key that was not asked for

  const std::string& where() const { return node_->where; }
  [[noreturn]] void fail(const std::string& key, const std::string& what) const;

 private:
  template <class F>
  void with(const std::string& key, const F& f);

  const Node* node_;
  std::string title_;  // "[simulation]"
  Names asked_;
};

// A number in SI units or a text with a unit, in a range.
double quantity(const Node& node, const Dimension& dimension, Range range);
Vec3 vector(const Node& node, const Dimension& dimension);

}  // namespace drape
