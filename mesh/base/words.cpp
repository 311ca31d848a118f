#include "mesh/base/words.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace drape {
namespace {

// Levenshtein's distance: how many letters must be inserted, left out or changed to make b of a.
int distance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i) + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const int replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string listed(const Names& names) {
  if (names.empty()) return "(none)";
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string nearest(std::string_view word, const Names& known) {
  std::string best;
  int best_distance = 1 + static_cast<int>(word.size()) / 3;
  for (const std::string& name : known) {
    const int d = distance(word, name);
    if (d <= best_distance && (best.empty() || d < best_distance)) {
      best = name;
      best_distance = d;
    }
  }
  return best;
}

std::string suggestion(std::string_view word, const Names& known) {
  const std::string near = nearest(word, known);
  return (near.empty() ? "" : "did you mean '" + near + "'? ") + "known are: " + listed(known);
}

std::string counted(long count, std::string_view noun) {
  std::string text = std::to_string(count) + " " + std::string(noun);
  if (count == 1) return text;
  if (text.ends_with("vertex")) return text.substr(0, text.size() - 2) + "ices";
  return text + "s";
}

std::string shortest(double value) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return std::string(buffer, end);
}

std::string rounded(double value, int digits) {
  char buffer[40];
  if (std::abs(value) < 1e4 && std::abs(value) >= std::pow(10, digits) - 0.5) {  // 100 rather than 1e+02
    std::snprintf(buffer, sizeof buffer, "%.0f", value);
    return buffer;
  }
  std::snprintf(buffer, sizeof buffer, "%.*g", digits, value);
  return buffer;
}

std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  return text;
}

}  // namespace drape
