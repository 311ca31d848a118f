#include "app/base/pc2.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "app/base/padded_frames.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

constexpr long points_at = 16, samples_at = 28;  // places of their numbers in the header
constexpr std::uintmax_t header_size = 32;
constexpr char signature[12] = "POINTCACHE2";

void append(std::vector<unsigned char>& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<unsigned char>(word >> shift));
}
void append(std::vector<unsigned char>& bytes, int number) {
  append(bytes, static_cast<std::uint32_t>(number));
}
void append(std::vector<unsigned char>& bytes, float number) {
  append(bytes, std::bit_cast<std::uint32_t>(number));
}

std::uint32_t word_at(const unsigned char* bytes) {
  std::uint32_t word = 0;
  for (int k = 3; k >= 0; --k) word = word << 8 | bytes[k];
  return word;
}
int number_at(const unsigned char* bytes) { return static_cast<int>(word_at(bytes)); }
float float_at(const unsigned char* bytes) { return std::bit_cast<float>(word_at(bytes)); }

}  // namespace

Pc2Writer::Pc2Writer(std::filesystem::path path, int points) : file_(std::move(path)), points_(points) {
  bytes_.assign(signature, signature + sizeof signature);
  append(bytes_, 1);
  append(bytes_, points);
  append(bytes_, 0.0f);
  append(bytes_, 1.0f);
  append(bytes_, 0);
  file_.write(bytes_.data(), bytes_.size());
}

void Pc2Writer::add(const std::vector<Vec3>& positions) {
  bytes_.clear();
  for (const Vec3& x : positions)
    for (double coordinate : x) append(bytes_, static_cast<float>(coordinate));
  file_.write(bytes_.data(), bytes_.size());
  points_of_each_.push_back(static_cast<int>(positions.size()));
}

void Pc2Writer::close(const std::vector<int>& copy_of) {
  if (!copy_of.empty()) pad_frames(file_, header_size, 12, points_of_each_, points_, copy_of);
  write_number(points_at, points_ + static_cast<int>(copy_of.size()));
  write_number(samples_at, static_cast<int>(points_of_each_.size()));
  file_.close();
}

void Pc2Writer::write_number(long place, int number) {
  bytes_.clear();
  append(bytes_, number);
  file_.seek(place);
  file_.write(bytes_.data(), bytes_.size());
}

Pc2Reader::Pc2Reader(const std::filesystem::path& path, Damaged damaged)
    : path_(path), file_(path, std::ios::binary) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || !file_) fail("cannot be read" + (error ? ": " + error.message() : std::string()));
  unsigned char header[header_size] = {};
  file_.read(reinterpret_cast<char*>(header), header_size);
  if (size < header_size || !std::equal(signature, signature + sizeof signature, header))
    fail("is not a PC2 point cache: it does not begin with POINTCACHE2 and a header of 32 bytes");
  const int version = number_at(header + 12);
  if (version != 1) fail("is a PC2 point cache of version " + std::to_string(version) + ", expected 1");
  points_ = number_at(header + 16);
  spacing_ = float_at(header + 24);
  samples_ = number_at(header + samples_at);
  if (points_ < 1 || samples_ < 1)
    fail("has " + std::to_string(points_) + " points and " + std::to_string(samples_) +
         " samples; expected at least one of each");
  if (!std::isfinite(spacing_) || !(spacing_ > 0)) fail("has a sample rate that is not a number above zero");
  const std::uintmax_t sample_size = 12 * static_cast<std::uintmax_t>(points_);
  const std::uintmax_t whole = (size - header_size) / sample_size;
  const auto told = static_cast<std::uintmax_t>(samples_);
  if (whole < told)
    damage_ = "is cut short: it holds " + std::to_string(whole) + " whole samples of the " +
              std::to_string(samples_) + " that its header tells";
  else if (size != header_size + sample_size * told)
    damage_ = "is longer than the " + std::to_string(samples_) + " samples of " + std::to_string(points_) +
              " points that its header tells";
  if (!damage_.empty() && (damaged == Damaged::refused || whole == 0)) fail(damage_);
  samples_ = static_cast<int>(std::min(whole, told));
  bytes_.resize(sample_size);
}

void Pc2Reader::read(std::vector<Vec3>& positions) {
  if (!file_.read(reinterpret_cast<char*>(bytes_.data()), static_cast<std::streamsize>(bytes_.size())))
    fail("cannot be read to its end");
  positions.resize(static_cast<std::size_t>(points_));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      positions[i][static_cast<Eigen::Index>(k)] = float_at(bytes_.data() + 12 * i + 4 * k);
    if (!positions[i].allFinite())
      fail("point " + std::to_string(i) + " of sample " + std::to_string(next_) + " is not a finite number");
  }
  ++next_;
}

void Pc2Reader::seek(int sample) {
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(header_size + bytes_.size() * static_cast<std::size_t>(sample)));
  next_ = sample;
}

void Pc2Reader::fail(const std::string& what) const { throw InputError(path_.string() + ": " + what); }

}  // namespace drape::app
