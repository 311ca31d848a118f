// The letters of an OBJ file: lines, words and numbers.
//   line      ends with LF, CRLF or (in a file without any LF) CR; a backslash at its end joins the next one,
//             unless it stands in a comment
//   comment   from '#' to the end of the line, where '#' begins the line or follows a blank
//   number    [+-] digits [. digits] [e [+-] digits], at least one digit; read by std::from_chars, no locale
#pragma once

#include <charconv>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>

namespace drape::internal::obj {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

inline std::string_view trim(std::string_view s) {
  while (!s.empty() && is_blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && is_blank(s.back())) s.remove_suffix(1);
  return s;
}

// Where the comment starts, or s.size() when there is no comment.
inline std::size_t comment_start(std::string_view s) {
  std::size_t at = s.find('#');
  while (at != std::string_view::npos && at > 0 && !is_blank(s[at - 1])) at = s.find('#', at + 1);
  return at == std::string_view::npos ? s.size() : at;
}

// Takes the next word off the front of `s`. The word is empty at the end of `s`.
inline std::string_view next_word(std::string_view& s) {
  const char* p = s.data();
  const char* const end = p + s.size();
  while (p != end && is_blank(*p)) ++p;
  const char* const begin = p;
  while (p != end && !is_blank(*p)) ++p;
  s = std::string_view(p, static_cast<std::size_t>(end - p));
  return std::string_view(begin, static_cast<std::size_t>(p - begin));
}

enum class Number { good, missing, malformed, not_finite };

// Reads a word that must be one number. A number too small for a double becomes 0; one too large is not
// finite.
inline Number parse_number(std::string_view word, double& value) {
  if (word.empty()) return Number::missing;
  const char* begin = word.data();
  const char* const end = begin + word.size();
  if (*begin == '+') {
    ++begin;
    if (begin != end && (*begin == '-' || *begin == '+')) return Number::malformed;
  }
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error == std::errc::invalid_argument || stop != end) return Number::malformed;
  if (error == std::errc::result_out_of_range) {
    const bool tiny = word.find("e-") != word.npos || word.find("E-") != word.npos;
    if (!tiny) return Number::not_finite;
    value = 0;
  }
  return std::isfinite(value) ? Number::good : Number::not_finite;
}

class LineScanner {
 public:
  explicit LineScanner(std::string_view text) : rest_(text) {
    if (rest_.substr(0, 3) == "\xEF\xBB\xBF") rest_.remove_prefix(3);
    if (rest_.find('\n') == rest_.npos) end_of_line_ = '\r';
  }

  // Gives the next line, trimmed and with its continuations joined; returns false at the end of the text.
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    line_ = next_line_;
    line = take();
    if (continues(line)) line = join(line);
    return true;
  }

  int line() const {
    return line_;
  }  // number of the line that next() gave, from 1 (its first one when joined)

 private:
  std::string_view take() {
    const void* found = std::memchr(rest_.data(), end_of_line_, rest_.size());
    const std::size_t length =
        found ? static_cast<std::size_t>(static_cast<const char*>(found) - rest_.data()) : rest_.size();
    const std::string_view line = trim(rest_.substr(0, length));
    rest_.remove_prefix(found ? length + 1 : length);
    ++next_line_;
    return line;
  }

  static bool continues(std::string_view line) {
    return !line.empty() && line.back() == '\\' && comment_start(line) == line.size();
  }

  std::string_view join(std::string_view line) {
    joined_.clear();
    for (; continues(line) && !rest_.empty(); line = take()) {
      joined_ += line.substr(0, line.size() - 1);
      joined_ += ' ';
    }
    joined_ += continues(line) ? line.substr(0, line.size() - 1) : line;
    return trim(joined_);
  }

  std::string_view rest_;
  std::string joined_;
  char end_of_line_ = '\n';
  int line_ = 0, next_line_ = 1;
};

}  // namespace drape::internal::obj
