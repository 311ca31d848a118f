#include "app/base/csv_text.h"

#include "app/base/toml_file.h"
#include "app/base/words.h"

namespace drape::app {
namespace {

// As RFC 4180: quoted when it must be.
std::string csv_cell(const Json& json) {
  if (std::holds_alternative<std::monostate>(json.value)) return "";
  if (const bool* b = std::get_if<bool>(&json.value)) return *b ? "1" : "0";
  if (const long* i = std::get_if<long>(&json.value)) return std::to_string(*i);
  if (const double* x = std::get_if<double>(&json.value)) return shortest(*x);
  std::string text = one_line(std::get<std::string>(json.value));
  if (text.find_first_of(",\"") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::string csv_header(const Json::Members& members) {
  std::string line;
  for (const auto& [key, value] : members) line += (line.empty() ? "" : ",") + key;
  return line + "\n";
}

std::string csv_line(const Json::Members& members) {
  std::string line;
  for (const auto& [key, value] : members) line += csv_cell(value) + ",";
  line.back() = '\n';
  return line;
}

}  // namespace drape::app
