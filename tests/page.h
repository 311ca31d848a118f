// A page of drape view taken apart again: written from the words of app/view/track.h, not from its code.
#pragma once

#include <zlib.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "app/base/json.h"

namespace drape::test {

using namespace app;

inline std::string from_base64(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(letters.find(c));
    if ((count += 6) >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
  }
  return bytes;
}

// The bytes of block `id` of a page.
inline std::string block(const std::string& html, long id) {
  const std::string open = "id=\"drape-block-" + std::to_string(id) + "\">";
  const std::size_t begin = html.find(open);
  REQUIRE(begin != std::string::npos);
  const std::size_t start = begin + open.size();
  const std::string packed = from_base64(html.substr(start, html.find('<', start) - start));
  std::string bytes(64'000'000, '\0');
  uLongf size = bytes.size();
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                     reinterpret_cast<const Bytef*>(packed.data()), packed.size()) == Z_OK);
  bytes.resize(size);
  return bytes;
}

inline std::uint16_t unfolded(unsigned z) { return static_cast<std::uint16_t>(z & 1 ? ~(z >> 1) : z >> 1); }

// All values of a track, frame by frame.
inline std::vector<std::vector<double>> unpacked(const std::string& html, const Json& track,
                                                 std::size_t vertices) {
  const std::size_t row = vertices * track["min"].items().size();
  std::vector<std::vector<std::uint16_t>> q;
  for (const Json& chunk : track["chunks"].items()) {
    const std::string bytes = block(html, static_cast<long>(chunk["block"].number(-1)));
    const auto count = static_cast<std::size_t>(chunk["frames"].number(0));
    REQUIRE(bytes.size() == 2 * count * row);
    for (std::size_t k = 0; k < count; ++k) {
      std::vector<std::uint16_t> frame(row);
      std::uint16_t change = 0;
      for (std::size_t i = 0; i < row; ++i) {
        const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
        const std::uint16_t rest = unfolded(byte(k * row + i) | unsigned{byte((count + k) * row + i)} << 8);
        const bool sums = std::get<bool>(chunk["neighbours"].value) && i % vertices != 0;
        change = static_cast<std::uint16_t>(sums ? change + rest : rest);
        int expected = 0;
        if (!q.empty()) expected = q.back()[i];
        if (q.size() > 1 && chunk["order"].number(0) == 2) expected += q.back()[i] - q[q.size() - 2][i];
        frame[i] = static_cast<std::uint16_t>(expected + change);
      }
      q.push_back(frame);
    }
  }
  std::vector<std::vector<double>> values;
  for (const auto& frame : q) {
    values.emplace_back(row);
    for (std::size_t i = 0; i < row; ++i)
      values.back()[i] = track["min"].items()[i / vertices].number(NAN) +
                         track["step"].items()[i / vertices].number(NAN) * frame[i];
  }
  return values;
}

}  // namespace drape::test
