// FNV-1a with 64 bits: a short number that differs, except in rare cases, as soon as one byte differs.
//   h <- (h xor byte) * 1099511628211, for one byte after the other, from h = 14695981039346656037
//                                                  [Fowler, Noll & Vo 1991; offset and prime as in RFC 9923]
// Numbers are hashed by the bytes that hold them, so 0 and -0 differ.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace drape {

class Fnv1a {
 public:
  Fnv1a& add(const void* data, std::size_t bytes) {
    const auto* const byte = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i) value_ = (value_ ^ byte[i]) * 1099511628211u;
    return *this;
  }
  // Adds the bytes of a list of numbers: a vector of the standard library or of Eigen.
  template <class List>
  Fnv1a& add_all(const List& numbers) {
    return add(numbers.data(), static_cast<std::size_t>(numbers.size()) * sizeof(*numbers.data()));
  }

  std::uint64_t value() const { return value_; }
  std::string text() const {  // 16 hexadecimal digits
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value_));
    return digits;
  }

 private:
  std::uint64_t value_ = 14695981039346656037u;
};

}  // namespace drape
