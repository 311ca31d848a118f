// Reads one table of a scene or fabric file. A value keeps its default when its key is absent. A wrong type,
// unit, sign or name is an InputError "scene.toml:12: bend = "10 N/m": expected a bending rigidity such as
// "10 uN.m"". finish() refuses keys that nobody asked for. Every key is explained where it is read.
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

namespace drape::app {

enum class Range { any, not_negative, positive };

class Table {
 public:
  // `notes` receives what is said of the keys; it is null when nobody needs that.
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
  // The name of a part of this build, one of those that `drape list` prints.
  void read_part(const std::string& key, std::string& value, const Names& parts, const About& about);

  // The tables under a key: one, or each of an array of tables; none when the key is absent.
  std::vector<Table> tables(const std::string& key, const About& about);
  // The only table under a key; none when the key is absent. Throws where there are several.
  std::optional<Table> one(const std::string& key, const About& about);
  // The value of a key, of any kind; null when it is absent. `kind` says in words what may stand there.
  const Node* take(const std::string& key, const char* kind, const About& about);
  Table inner(const std::string& key) const;  // the table under a key that has been taken

  void require(const std::string& key);  // throws when it is absent
  template <class Value, class... How>
  void read_required(const std::string& key, Value& value, const How&... how) {
    require(key);
    read(key, value, how...);
  }
  void finish() const;  // throws when the table has a key that was not asked for

  // What is read from here on belongs to tables of this kind only; empty: to all tables.
  void only_of(std::string kind) { kind_ = std::move(kind); }

  const std::string& where() const { return node_->where; }
  [[noreturn]] void fail(const std::string& key, const std::string& what) const;

 private:
  const Node* ask(const std::string& key);  // null when absent
  std::vector<Table> asked_tables(const std::string& key);
  template <class F>
  void with(const std::string& key, const F& f);
  void note(const std::string& key, const std::string& kind, std::string_view unit, const std::string& value,
            const About& about);

  const Node* node_;
  std::string title_;  // "[simulation]"
  KeyNotes* notes_;
  std::string name_, kind_;  // of the table, and of what is read at present; for the notes
  Names asked_, required_;
};

// A number in SI units or a text with a unit, within the range. Throws InputError.
double quantity(const Node& node, const Dimension& dimension, Range range);
Vec3 vector(const Node& node, const Dimension& dimension);

}  // namespace drape::app
