// A TOML file as plain data, every value with its place. The only file that includes the TOML library is
// toml_file.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace drape::app {

struct Node {
  enum class Kind { boolean, integer, number, text, array, table };

  Kind kind = Kind::table;
  bool boolean = false;
  std::int64_t integer = 0;
  double number = 0;                    // also set for an integer
  std::string text;                     // a date or a time is a text too
  std::vector<Node> items;              // of an array
  std::map<std::string, Node> members;  // of a table
  std::string where;                    // "scene.toml:12", or the command-line option that set it

  static Node of_text(std::string text, std::string where);
  static Node of_number(double number, std::string where);
  static Node of_list(std::vector<Node> items, std::string where);
  static Node of_table(std::string where);
};

std::string toml_text(const Node& node);  // as it stands in TOML, in one line
std::string written(const Node& node);    // the same for a message, shortened when it is long

// Both throw InputError "scene.toml:3: is not TOML: ...".
Node read_toml(const std::filesystem::path& path);
Node parse_toml(std::string_view text, const std::string& name);

// Reads the value that would stand on the right of an equals sign. A text that is not TOML becomes a string:
// 5 -> integer, 5 uN.m -> text.
Node parse_toml_value(std::string_view text, const std::string& where);

}  // namespace drape::app
