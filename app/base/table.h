// Reads one table of a scene or fabric file: a value keeps its default when its key is absent; a wrong type,
// unit, sign or name is an InputError "scene.toml:12: bend = "10 N/m": expected a bending rigidity such as
// "10 uN.m"". finish() finds the keys that nobody asked for. Every key is explained where it is read.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/base/key_notes.h"
#include "app/base/toml_file.h"
#include "app/base/units.h"
#include "app/base/words.h"
#include "mesh/base/vectors.h"

namespace drape {

enum class Range { any, not_negative, positive };

class Table {
 public:
  // notes: where to note what is said of the keys, when somebody wants to know.
  Table(const Node& node, std::string title, KeyNotes* notes = nullptr, std::string name = {})
      : node_(&node), title_(std::move(title)), notes_(notes), name_(std::move(name)) {}

  bool has(const std::string& key) const { return node_->members.contains(key); }
  const Node* find(const std::string& key) const;  // null when absent

  void read(const std::string& key, double& value, const Dimension& dimension, Range range,
            const About& about);
  void read(const std::string& key, std::optional<double>& value, const Dimension& dimension, Range range,
            const About& about);
  void read(const std::string& key, Vec3& value, const Dimension& dimension, const About& about);
  void read(const std::string& key, int& value, int least, const About& about);
  void read(const std::string& key, bool& value, const About& about);
  void read(const std::string& key, std::string& value, const About& about);
  void read(const std::string& key, std::string& value, const Names& known, const About& about);
  void read(const std::string& key, std::vector<int>& values, const About& about);
  void read(const std::string& key, Names& values, const About& about);
  // One of the parts of this build, those of `drape list`.
  void read_part(const std::string& key, std::string& value, const Names& parts, const About& about);

  // A table, or each of an array of tables (a table alone is an array of one). Absent: none.
  std::vector<Table> tables(const std::string& key, const About& about);
  // Any kind; null when absent. kind: what may stand there, in words.
  const Node* take(const std::string& key, const char* kind, const About& about);
  Table inner(const std::string& key) const;  // the table that a key is, which was taken

  void require(const std::string& key);  // throws when it is absent
  template <class Value, class... How>
  void read_required(const std::string& key, Value& value, const How&... how) {
    require(key);
    read(key, value, how...);
  }
  void finish() const;  // throws on a key that was not asked for

  // What is read from here on is of tables of this kind only; empty: of all.
  void only_of(std::string kind) { kind_ = std::move(kind); }

  const std::string& where() const { return node_->where; }
  [[noreturn]] void fail(const std::string& key, const std::string& what) const;

 private:
  const Node* ask(const std::string& key);  // null when absent
  template <class F>
  void with(const std::string& key, const F& f);
  void note(const std::string& key, const std::string& kind, std::string_view unit, const std::string& value,
            const About& about);

  const Node* node_;
  std::string title_;  // "[simulation]"
  KeyNotes* notes_;
  std::string name_, kind_;  // of the table and of what is read now, for the notes
  Names asked_, required_;
};

// A number in SI units or a text with a unit, in a range.
double quantity(const Node& node, const Dimension& dimension, Range range);
Vec3 vector(const Node& node, const Dimension& dimension);

}  // namespace drape
