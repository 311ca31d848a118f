// Where a picture is taken from: a pinhole far away. y is up.
//   front  looks along -z, so that x goes to the right; the azimuth turns the eye about y towards +x, the
//   elevation lifts it. right: from +x, left: from -x, back: from -z, top: from +y, with -z above.
// A point p is seen at pixel (x, y) = middle + (e . right, -e . up) / (-e . toward) / slope, e = p - eye.
#pragma once

#include <string>
#include <vector>

#include "app/base/words.h"
#include "mesh/base/vectors.h"

namespace drape::drawing {

struct View {
  double azimuth = 30, elevation = 20;  // degrees
};
Names named_views();
View view_named(const std::string& text);  // a name or "azimuth,elevation"; throws InputError

// A part of a picture, in pixels.
struct PixelBox {
  double x = 0, y = 0, width = 0, height = 0;
};

struct Camera {
  Vec3 eye, right, up, toward;  // m; unit vectors, toward: to the viewer
  double slope = 0;             // of the ray through the next pixel
  double middle_x = 0, middle_y = 0;

  Vec3 direction(double x, double y) const;  // of the ray from the eye through a pixel, unit
};

// The axes only.
Camera facing(const View& view);

// The nearest eye that has all points [m] within the box, in the middle of it.
class Framing {
 public:
  Framing(const View& view, const PixelBox& box);
  void add(const Vec3& point);
  Camera camera() const;  // of one point at least

 private:
  Camera camera_;            // without its eye
  double across_, upwards_;  // slopes of the box's sides
  // The largest x + a z, a z - x, y + b z, b z - y of all points in the camera's axes; z.
  double right_, left_, above_, below_, nearest_, farthest_;
};

}  // namespace drape::drawing
