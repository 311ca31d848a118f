// Appends numbers to the bytes of a file, in the byte order of the file, whatever the byte order of the
// machine.
#pragma once

#include <bit>
#include <cstdint>
#include <string>

#include "mesh/base/vectors.h"

namespace drape::app {

template <std::endian order>
void append_word(std::string& bytes, std::uint32_t word) {
  for (int k = 0; k < 4; ++k) {
    const int shift = order == std::endian::little ? 8 * k : 24 - 8 * k;
    bytes += static_cast<char>(static_cast<unsigned char>(word >> shift));
  }
}

template <std::endian order>
void append_int(std::string& bytes, int number) {
  append_word<order>(bytes, static_cast<std::uint32_t>(number));
}

template <std::endian order>
void append_float(std::string& bytes, double number) {
  append_word<order>(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(number)));
}

template <std::endian order>
void append_floats(std::string& bytes, const std::vector<Vec3>& vectors) {
  bytes.reserve(bytes.size() + 12 * vectors.size());
  for (const Vec3& vector : vectors)
    for (const double coordinate : vector) append_float<order>(bytes, coordinate);
}

}  // namespace drape::app
