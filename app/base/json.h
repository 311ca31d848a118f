// JSON as plain data, and its text. The only file that includes the JSON library is json.cpp.
//   A number that is not finite is written as null, because JSON cannot express it.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace drape::app {

struct Json {
  using List = std::vector<Json>;
  using Members = std::vector<std::pair<std::string, Json>>;  // in the order in which they are written
  std::variant<std::monostate, bool, long, double, std::string, List, Members> value;

  Json() = default;
  Json(bool b) : value(b) {}
  Json(int i) : value(static_cast<long>(i)) {}
  Json(long i) : value(i) {}
  Json(double x) : value(x) {}
  Json(std::string text) : value(std::move(text)) {}
  Json(std::string_view text) : value(std::string(text)) {}
  Json(const char* text) : value(std::string(text)) {}
  Json(List list) : value(std::move(list)) {}
  Json(Members members) : value(std::move(members)) {}
  Json(const std::vector<std::string>& texts) : value(List(texts.begin(), texts.end())) {}
  Json(const std::vector<int>& numbers) : value(List(numbers.begin(), numbers.end())) {}
  Json(const std::vector<double>& numbers) : value(List(numbers.begin(), numbers.end())) {}

  bool is(bool b) const { return std::holds_alternative<bool>(value) && std::get<bool>(value) == b; }
  bool is_null() const { return std::holds_alternative<std::monostate>(value); }
  // These read without checks: a member that is absent is null, and a value that is not a list has no items.
  const Json& operator[](std::string_view member) const;
  const List& items() const;
  std::string text() const;  // empty when the value is not a text
  // `otherwise` when the value is not a number; integers are numbers too.
  double number(double otherwise) const;
};

// The text of the JSON, indented by two blanks, with a line end. Bytes that are not UTF-8 are replaced.
std::string json_text(const Json& json);
std::string compact_json_text(const Json& json);  // in one line

bool is_utf8(std::string_view text);

// Reads JSON from a text. Throws InputError "run.json:3: is not JSON: ...".
Json parse_json(std::string_view text, const std::string& name);

}  // namespace drape::app
