// The letters of a .msh file: words between blanks, or numbers as they stand in memory. Sections have the
// same fields in the same order either way, so the reader asks for fields and need not know which way it is.
//   text     every field is a word
//   binary   integer: 4 bytes, size: 8 bytes, real: 8 bytes, in the byte order of this machine; names of sections are words
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>

#include "mesh/base/errors.h"

namespace drape::internal {

class MshWords {
 public:
  MshWords(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

  bool binary = false;

  std::size_t place() const { return start_; }  // where the last field began

  [[noreturn]] void fail(const std::string& what) const { fail_at(start_, what); }
  [[noreturn]] void fail_at(std::size_t place, const std::string& what) const {
    if (binary) throw InputError(name_ + ": byte " + std::to_string(place) + ": " + what);
    const std::string_view before = text_.substr(0, place);
    throw InputError(name_ + ":" + std::to_string(1 + std::count(before.begin(), before.end(), '\n')) + ": " +
                     what);
  }

  [[noreturn]] void fail_whole(const std::string& what) const { throw InputError(name_ + ": " + what); }

  bool at_end() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    return at_ == text_.size();
  }

  // The next word; `what` says in a message what is missing where the file ends.
  std::string_view word(const std::string& what) {
    const bool end = at_end();
    start_ = at_;
    if (end) ends(what);
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(start_, at_ - start_);
  }
  // What stands between the next two quotes.
  std::string_view quoted(const std::string& what) {
    const std::size_t open = text_.find('"', at_),
                      close = text_.find('"', std::min(open, text_.size() - 1) + 1);
    if (close == text_.npos) ends(what);
    start_ = open, at_ = close + 1;
    return text_.substr(open + 1, close - open - 1);
  }
  // The end of the line, behind which binary numbers begin.
  void end_line() {
    const std::size_t end = text_.find('\n', at_);
    at_ = end == text_.npos ? text_.size() : end + 1;
  }
  // Goes to the first place where this stands, behind the end of this line or of a later one.
  void skip_to(const std::string& end) {
    const std::size_t found = text_.find("\n" + end, at_ - 1);
    if (found == text_.npos) ends(end);
    at_ = found + 1;
  }

  long long integer(const std::string& what) { return binary ? raw<std::int32_t>(what) : whole(what); }
  long long size(const std::string& what) {
    const long long value = binary ? static_cast<long long>(raw<std::int64_t>(what)) : whole(what);
    if (value < 0) fail(what + " is " + std::to_string(value));
    return value;
  }
  double real(const std::string& what) {
    double value = 0;
    if (binary) {
      value = raw<double>(what);
    } else {
      const std::string_view digits = word(what);
      const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
      if (error == std::errc::result_out_of_range && digits.find("e-") != digits.npos)
        value = 0;
      else if (error == std::errc::result_out_of_range)
        fail(what + " '" + short_of(digits) + "' is not a finite number");
      else if (error != std::errc() || stop != digits.data() + digits.size())
        fail(what + " '" + short_of(digits) + "' is not a number");
    }
    if (!std::isfinite(value)) fail(what + " is not a finite number");
    return value;
  }
  // A whole number that is written as a word, also in a binary file.
  long long whole(const std::string& what) {
    const std::string_view digits = word(what);
    long long value = 0;
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || stop != digits.data() + digits.size())
      fail(what + " '" + short_of(digits) + "' is not a whole number");
    return value;
  }

  static std::string short_of(std::string_view word) { return std::string(word.substr(0, 40)); }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  [[noreturn]] void ends(const std::string& what) const {
    fail_at(text_.size(), "the file ends where " + what + " is expected; it was cut short, save it again");
  }
  template <class T>
  T raw(const std::string& what) {
    start_ = at_;
    if (text_.size() - at_ < sizeof(T)) ends(what);
    T value;
    std::memcpy(&value, text_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }

  std::string_view text_;
  std::string name_;
  std::size_t at_ = 0, start_ = 0;
};

}  // namespace drape::internal
