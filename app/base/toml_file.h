// A TOML file as plain data, every value with the place it came from. The only door to the TOML library.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace drape {

struct Node {
  enum class Kind { boolean, integer, number, text, array, table };

  Kind kind = Kind::table;
  bool boolean = false;
  std::int64_t integer = 0;
  double number = 0;                    // of an integer, too
  std::string text;                     // dates and times are texts
  std::vector<Node> items;              // of an array
  std::map<std::string, Node> members;  // of a table
  std::string where;                    // "scene.toml:12", or the option it came from

  static Node of_text(std::string text, std::string where);
  static Node of_number(double number, std::string where);
  static Node of_list(std::vector<Node> items, std::string where);
  static Node of_table(std::string where);
};

std::string written(const Node& node);  // as TOML writes it, shortened when it is long

// Throw InputError "scene.toml:3: is not TOML: ...".
Node read_toml(const std::filesystem::path& path);
Node parse_toml(std::string_view text, const std::string& name);

// What may stand on the right of an equals sign; anything else is a text: 5 -> integer, 5 uN.m -> text.
Node parse_toml_value(std::string_view text, const std::string& where);

}  // namespace drape
