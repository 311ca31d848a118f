#include "app/base/npy.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <functional>
#include <iterator>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

#include "app/base/padded_frames.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

constexpr std::string_view signature("\x93NUMPY\x01\x00", 8);
constexpr std::size_t header_size = 128;
constexpr std::string_view descriptions[] = {"<f4", "<i4", "|u1"};  // of the kinds

std::uint32_t little_endian(const unsigned char* b) {
  return static_cast<std::uint32_t>(b[0]) | static_cast<std::uint32_t>(b[1]) << 8 |
         static_cast<std::uint32_t>(b[2]) << 16 | static_cast<std::uint32_t>(b[3]) << 24;
}

std::size_t size_of(NpyWriter::Kind kind) { return kind == NpyWriter::Kind::byte ? 1 : 4; }

float number_at(const unsigned char* bytes, std::size_t i, NpyWriter::Kind kind) {
  if (kind == NpyWriter::Kind::byte) return bytes[i];
  const std::uint32_t word = little_endian(bytes + 4 * i);
  return kind == NpyWriter::Kind::float32 ? std::bit_cast<float>(word)
                                          : static_cast<float>(std::bit_cast<std::int32_t>(word));
}

// What stands in the brackets of "'shape': (25, 958, 3)".
std::vector<int> shape_in(std::string_view header) {
  std::vector<int> shape;
  const std::size_t open = header.find('('), close = header.find(')');
  if (open == header.npos || close == header.npos || close < open) return shape;
  const char* at = header.data() + open + 1;
  const char* const end = header.data() + close;
  while (at < end) {
    int size = 0;
    const auto [next, error] = std::from_chars(at, end, size);
    if (error == std::errc()) shape.push_back(size);
    at = error == std::errc() ? next : at + 1;
  }
  return shape;
}

}  // namespace

NpyWriter::NpyWriter(std::filesystem::path path, Kind kind, std::vector<int> frame_shape)
    : file_(std::move(path)), kind_(kind), frame_shape_(std::move(frame_shape)) {
  write_header();
}

void NpyWriter::write_header() {
  std::string text = "{'descr': '" + std::string(descriptions[static_cast<std::size_t>(kind_)]) +
                     "', 'fortran_order': False, 'shape': (" + std::to_string(lengths_.size()) + ",";
  for (std::size_t k = 0; k < frame_shape_.size(); ++k)
    text += (k > 0 ? ", " : " ") + std::to_string(frame_shape_[k]);
  text += "), }";
  text.resize(header_size - signature.size() - 2, ' ');
  text.back() = '\n';
  const char length[2] = {static_cast<char>(text.size()), 0};
  file_.write(signature);
  file_.write(length, sizeof length);
  file_.write(text);
}

// Numbers of 32 bits, the lowest byte first.
template <class Numbers>
void NpyWriter::add_words(const Numbers& frame) {
  bytes_.clear();
  for (const auto number : frame)
    for (int shift = 0; shift < 32; shift += 8)
      bytes_.push_back(static_cast<unsigned char>(std::bit_cast<std::uint32_t>(number) >> shift));
  file_.write(bytes_.data(), bytes_.size());
  lengths_.push_back(static_cast<int>(frame.size()) / width());
}

void NpyWriter::add(const std::vector<float>& frame) { add_words(frame); }
void NpyWriter::add(const std::vector<std::int32_t>& frame) { add_words(frame); }

void NpyWriter::add(const std::vector<std::uint8_t>& frame) {
  file_.write(frame.data(), frame.size());
  lengths_.push_back(static_cast<int>(frame.size()) / width());
}

int NpyWriter::width() const {
  return std::accumulate(frame_shape_.begin() + 1, frame_shape_.end(), 1, std::multiplies<>());
}

void NpyWriter::close(const std::vector<int>& copy_of) {
  if (!copy_of.empty()) {
    const std::size_t size = size_of(kind_) * static_cast<std::size_t>(width());
    pad_frames(file_, header_size, size, lengths_, frame_shape_.front(), copy_of);
    frame_shape_.front() += static_cast<int>(copy_of.size());
  }
  file_.seek(0);
  write_header();
  file_.close();
}

NpyReader::NpyReader(const std::filesystem::path& path) : path_(path), file_(path, std::ios::binary) {
  unsigned char start[10] = {};
  if (!file_.read(reinterpret_cast<char*>(start), sizeof start) ||
      std::memcmp(start, signature.data(), signature.size()) != 0)
    fail("is no array of NumPy (.npy, version 1.0)");
  std::string header(static_cast<std::size_t>(start[8] | start[9] << 8), ' ');
  file_.read(header.data(), static_cast<std::streamsize>(header.size()));
  const auto* const found =
      std::find_if(std::begin(descriptions), std::end(descriptions),
                   [&](auto description) { return header.find(description) != header.npos; });
  frame_shape_ = shape_in(header);
  if (found == std::end(descriptions) || header.find("True") != header.npos || frame_shape_.size() < 2)
    fail("has another type or order than float32, int32 or bytes, a frame after the other");
  kind_ = static_cast<NpyWriter::Kind>(found - std::begin(descriptions));
  frames_ = frame_shape_.front();
  frame_shape_.erase(frame_shape_.begin());
  start_ = sizeof start + header.size();
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  for (const int along : frame_shape_) {
    if (along < 0 || frames_ < 0 || count_ > size) fail("has a shape that it cannot have");
    count_ *= static_cast<std::size_t>(along);
  }
  if (error || size != start_ + static_cast<std::uintmax_t>(frames_) * count_ * size_of(kind_))
    fail("has not the size that its header tells; was it cut short?");
}

std::vector<float> NpyReader::frame(int k) {
  std::vector<unsigned char> bytes(count_ * size_of(kind_));
  file_.seekg(static_cast<std::streamoff>(start_ + static_cast<std::size_t>(k) * bytes.size()));
  if (!file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
    fail("cannot be read to its end");
  std::vector<float> numbers(count_);
  for (std::size_t i = 0; i < count_; ++i) numbers[i] = number_at(bytes.data(), i, kind_);
  return numbers;
}

void NpyReader::fail(const std::string& what) const { throw InputError(path_.string() + ": " + what); }

}  // namespace drape::app
