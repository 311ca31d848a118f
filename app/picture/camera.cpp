#include "app/picture/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "mesh/base/errors.h"

namespace drape::app::drawing {
namespace {

const std::map<std::string, View>& views() {
  static const std::map<std::string, View> all = {{"front", {0, 0}},  {"back", {180, 0}}, {"left", {-90, 0}},
                                                  {"right", {90, 0}}, {"side", {90, 0}},  {"top", {0, 90}}};
  return all;
}

constexpr double half_field = 11;  // degrees, along the longer side of what is framed

double number(const std::string& text, const std::string& whole) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw InputError("--view " + whole + ": '" + text + "' is not a number; give degrees such as 30,20");
  return value;
}

}  // namespace

Names named_views() { return {"front", "back", "left", "right", "side", "top"}; }

View view_named(const std::string& text) {
  if (text.empty()) return {};
  if (const auto found = views().find(text); found != views().end()) return found->second;
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos)
    throw InputError("--view " + text + ": there is no such view; " + suggestion(text, named_views()) +
                     ", or degrees round and above such as 30,20");
  const View view{number(text.substr(0, comma), text), number(text.substr(comma + 1), text)};
  if (std::abs(view.elevation) > 90 || std::abs(view.azimuth) > 360)
    throw InputError("--view " + text + ": the first is -360 to 360 degrees, the second -90 to 90");
  return view;
}

Vec3 Camera::direction(double x, double y) const {
  return ((x - middle_x) * slope * right - (y - middle_y) * slope * up - toward).normalized();
}

Camera facing(const View& view) {
  const double a = view.azimuth * std::numbers::pi / 180, e = view.elevation * std::numbers::pi / 180;
  Camera camera;
  camera.right = {std::cos(a), 0, -std::sin(a)};
  camera.toward = {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
  camera.up = camera.toward.cross(camera.right);
  return camera;
}

// Seen is what has |X - x| <= a (z - Z) for the eye (x, y, z) in the camera's axes, a the slope of the box's
// side; so with R = max(X + a Z), L = max(-X + a Z): a z >= (R + L) / 2,
// and x = (R - L) / 2 is in the middle.
Framing::Framing(const View& view, const PixelBox& box) : camera_(facing(view)) {
  camera_.slope = std::tan(half_field * std::numbers::pi / 180) / (std::max(box.width, box.height) / 2);
  camera_.middle_x = box.x + box.width / 2;
  camera_.middle_y = box.y + box.height / 2;
  across_ = camera_.slope * box.width / 2;
  upwards_ = camera_.slope * box.height / 2;
  right_ = left_ = above_ = below_ = nearest_ = -std::numeric_limits<double>::infinity();
  farthest_ = -nearest_;
}

void Framing::add(const Vec3& p) {
  const double x = p.dot(camera_.right), y = p.dot(camera_.up), z = p.dot(camera_.toward);
  right_ = std::max(right_, x + across_ * z), left_ = std::max(left_, across_ * z - x);
  above_ = std::max(above_, y + upwards_ * z), below_ = std::max(below_, upwards_ * z - y);
  nearest_ = std::max(nearest_, z), farthest_ = std::min(farthest_, z);
}

Camera Framing::camera() const {
  double z = std::max((right_ + left_) / (2 * across_), (above_ + below_) / (2 * upwards_));
  z = std::max(z, nearest_ + std::max(nearest_ - farthest_, 1e-3));  // a line along the view, a point
  Camera camera = camera_;
  camera.eye = (right_ - left_) / 2 * camera.right + (above_ - below_) / 2 * camera.up + z * camera.toward;
  return camera;
}

}  // namespace drape::app::drawing
