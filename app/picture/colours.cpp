#include "app/picture/colours.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/recording/recording.h"

namespace drape::app::drawing {
namespace {

constexpr std::array<Pixel, 7> cloths = {{{0, 114, 178},
                                          {213, 94, 0},
                                          {0, 158, 115},
                                          {204, 121, 167},
                                          {230, 159, 0},
                                          {86, 180, 233},
                                          {240, 228, 66}}};

constexpr std::array<Pixel, 11> red_blue = {{{5, 48, 97},
                                             {33, 102, 172},
                                             {67, 147, 195},
                                             {146, 197, 222},
                                             {209, 229, 240},
                                             {247, 247, 247},
                                             {253, 219, 199},
                                             {244, 165, 130},
                                             {214, 96, 77},
                                             {178, 24, 43},
                                             {103, 0, 31}}};

constexpr std::array<Pixel, 9> viridis = {{{68, 1, 84},
                                           {71, 45, 123},
                                           {59, 82, 139},
                                           {44, 114, 142},
                                           {33, 145, 140},
                                           {40, 174, 128},
                                           {94, 201, 98},
                                           {173, 220, 48},
                                           {253, 231, 37}}};

constexpr std::array<Pixel, touch_names.size()> touches = {
    {{200, 200, 200}, {230, 159, 0}, {0, 114, 178}, {0, 158, 115}, {204, 121, 167}}};  // as Touch counts
constexpr std::array crossing_names = {"crosses nothing", "crosses"};
constexpr std::array<Pixel, crossing_names.size()> crossings = {{{200, 200, 200}, {214, 39, 40}}};
constexpr Pixel unknown = {170, 170, 170};

template <std::size_t N>
Pixel between(const std::array<Pixel, N>& map, double share) {
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(N - 1);
  const std::size_t k = std::min(static_cast<std::size_t>(at), N - 2);
  const double t = at - static_cast<double>(k);
  Pixel mixed{};
  for (std::size_t c = 0; c < 3; ++c)
    mixed[c] = static_cast<std::uint8_t>(std::lround((1 - t) * map[k][c] + t * map[k + 1][c]));
  return mixed;
}

}  // namespace

Light light(const Pixel& pixel) {
  Light linear;
  for (int k = 0; k < 3; ++k) {
    const float s = static_cast<float>(pixel[k]) / 255;
    linear[k] = s <= 0.04045F ? s / 12.92F : std::pow((s + 0.055F) / 1.055F, 2.4F);
  }
  return linear;
}

Pixel pixel(const Light& light) {
  Pixel result{};
  for (int k = 0; k < 3; ++k) {
    const float l = std::clamp(light[k], 0.0F, 1.0F);
    const float s = l <= 0.0031308F ? 12.92F * l : 1.055F * std::pow(l, 1 / 2.4F) - 0.055F;
    result[k] = static_cast<std::uint8_t>(std::lround(255 * s));
  }
  return result;
}

Pixel cloth_colour(int cloth) { return cloths[static_cast<std::size_t>(cloth) % cloths.size()]; }

std::optional<Field> field_named(const std::string& name) {
  for (std::size_t k = 0; k < field_names.size(); ++k)
    if (name == field_names[k]) return static_cast<Field>(k);
  return std::nullopt;
}

std::span<const char* const> words_of(Field field) {
  if (field == Field::contact) return touch_names;
  if (field == Field::crossing) return crossing_names;
  return {};
}

Pixel colour_of(const Scale& scale, double value) {
  if (!std::isfinite(value)) return unknown;
  if (const std::size_t words = words_of(scale.field).size(); words > 0) {
    const long word = std::clamp(std::lround(value), 0L, static_cast<long>(words) - 1);
    return scale.field == Field::contact ? touches[word] : crossings[word];
  }
  const double share = (value - scale.low) / (scale.high - scale.low);
  return scale.field == Field::strain ? between(red_blue, share) : between(viridis, share);
}

double round_step(double range, int count) {
  const double rough = range / count, power = std::pow(10.0, std::floor(std::log10(rough)));
  for (double digit : {1.0, 2.0, 5.0})
    if (rough <= digit * power * (1 + 1e-9)) return digit * power;
  return 10 * power;
}

}  // namespace drape::app::drawing
