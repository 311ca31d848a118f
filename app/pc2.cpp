#include "app/pc2.h"

#include <bit>
#include <cstring>
#include <utility>

namespace drape {
namespace {

constexpr long samples_at = 28;  // place of the number of samples in the header

void append(std::vector<unsigned char>& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<unsigned char>(word >> shift));
}
void append(std::vector<unsigned char>& bytes, int number) {
  append(bytes, static_cast<std::uint32_t>(number));
}
void append(std::vector<unsigned char>& bytes, float number) {
  append(bytes, std::bit_cast<std::uint32_t>(number));
}

}  // namespace

Pc2Writer::Pc2Writer(std::filesystem::path path, int points) : file_(std::move(path)), points_(points) {
  const char signature[12] = "POINTCACHE2";
  bytes_.assign(signature, signature + sizeof signature);
  append(bytes_, 1);
  append(bytes_, points);
  append(bytes_, 0.0f);
  append(bytes_, 1.0f);
  append(bytes_, 0);
  file_.write(bytes_.data(), bytes_.size());
}

void Pc2Writer::add(const VecX& x, int first_particle) {
  bytes_.clear();
  for (int i = 0; i < 3 * points_; ++i) append(bytes_, static_cast<float>(x[3 * first_particle + i]));
  file_.write(bytes_.data(), bytes_.size());
  ++samples_;
}

void Pc2Writer::close() {
  bytes_.clear();
  append(bytes_, samples_);
  file_.seek(samples_at);
  file_.write(bytes_.data(), bytes_.size());
  file_.close();
}

}  // namespace drape
