// JSON as plain data, and its text. The only door to the JSON library.
//   A number that is not finite is written as null: JSON has no other word for it.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace drape {

struct Json {
  using List = std::vector<Json>;
  using Members = std::vector<std::pair<std::string, Json>>;  // in the order they are written
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
};

// Indented by two; bytes that are not UTF-8 are replaced.
std::string json_text(const Json& json);

}  // namespace drape
