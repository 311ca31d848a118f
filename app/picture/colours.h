// The colours of a picture. Light is linear; pixels are sRGB (IEC 61966-2-1).
//   cloths   Okabe & Ito 2008, colours that everybody can tell apart
//   strain   from blue (compressed) over white to red (stretched), ColorBrewer's RdBu; symmetric about 0
//   speed    viridis, from 0
//   contact  free, slides, sticks on a body: grey, orange, blue; on cloth: green; stopped: pink
//   crossing triangles that cross none, or another one: grey, red
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>

#include "app/picture/image.h"

namespace drape::app::drawing {

using Light = Eigen::Array3f;  // linear red, green and blue

Light light(const Pixel& pixel);
Pixel pixel(const Light& light);  // clamped to what a screen can show

inline constexpr Pixel background = {255, 255, 255}, ink = {45, 45, 50};
inline constexpr Pixel body_colour = {208, 206, 202}, body_mark = {150, 148, 146};

Pixel cloth_colour(int cloth);  // cloth counts from 0; the colours repeat after seven

enum class Field { strain, speed, contact, crossing };
inline constexpr std::array field_names = {"strain", "speed", "contact", "crossing"};
std::optional<Field> field_named(const std::string& name);
// What the values 0, 1, ... of a field mean; empty when it is measured, not counted.
std::span<const char* const> words_of(Field field);

// The values at the two ends of a colour map. For contact they are the numbers of Touch.
struct Scale {
  Field field = Field::strain;
  double low = 0, high = 1;
};
// A value beyond an end has the colour of that end; what is not a number is grey.
Pixel colour_of(const Scale& scale, double value);

// A step of 1, 2 or 5 times a power of ten, of which about `count` fit into `range` > 0.
double round_step(double range, int count);

}  // namespace drape::app::drawing
