#include "app/picture/options.h"

#include <charconv>
#include <cmath>
#include <numeric>
#include <string_view>

#include "app/base/words.h"
#include "mesh/base/errors.h"

namespace drape::app::drawing {
namespace {

constexpr int smallest = 16, largest = 8192;  // pixels

std::optional<int> whole(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

int frame_named(const std::string& text, int count, const std::string& where) {
  if (text == "last") return count - 1;
  const std::optional<int> number = whole(text);
  if (!number)
    throw InputError("--frame " + text +
                     ": is neither a number from 1 nor 'last' nor 'all'; several are "
                     "given as 1,5,last");
  if (*number < 1 || *number > count)
    throw InputError("--frame " + text + ": " + where + " has " + counted(count, "frame") +
                     (count == 1 ? ", number 1" : ", numbers 1 to " + std::to_string(count)));
  return *number - 1;
}

}  // namespace

std::pair<int, int> size_named(const std::string& text) {
  if (text.empty()) return {1280, 960};
  const std::size_t cross = text.find('x');
  const auto width = whole(text.substr(0, cross));
  const auto height = cross == text.npos ? std::nullopt : whole(text.substr(cross + 1));
  if (!width || !height)
    throw InputError("--size " + text + ": give width and height in pixels, such as 1280x960");
  if (std::min(*width, *height) < smallest || std::max(*width, *height) > largest)
    throw InputError("--size " + text + ": a picture is " + std::to_string(smallest) + " to " +
                     std::to_string(largest) + " pixels wide and high");
  return {*width, *height};
}

std::optional<Field> field_asked(const std::string& text) {
  if (text.empty()) return std::nullopt;
  if (const auto field = field_named(text)) return field;
  throw InputError("--color " + text + ": there is nothing of this name to colour by; " +
                   suggestion(text, Names(field_names.begin(), field_names.end())));
}

std::vector<int> frames_named(const std::string& text, int count, int several, const std::string& where) {
  std::vector<int> frames;
  if (text == "all") {
    frames.resize(static_cast<std::size_t>(count));
    std::iota(frames.begin(), frames.end(), 0);
  } else if (text.empty() && several > 1 && count > 1) {
    const int shown = std::min(several, count);
    frames.reserve(static_cast<std::size_t>(shown));
    for (int k = 0; k < shown; ++k)
      frames.push_back(static_cast<int>(std::lround(double(k) * (count - 1) / (shown - 1))));
  } else if (text.empty()) {
    frames.push_back(count - 1);
  } else {
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      frames.push_back(frame_named(text.substr(begin, end - begin), count, where));
      begin = end + 1;
    }
  }
  return frames;
}

}  // namespace drape::app::drawing
