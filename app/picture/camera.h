// Where a picture is taken from: a pinhole camera far away. y is up.
//   front  looks along -z, with x to the right. The azimuth turns the eye about y towards +x, the elevation
//          raises it. right: from +x, left: from -x, back: from -z, top: from +y, with -z at the top.
// A point p appears at pixel (x, y) = middle + (e . right, -e . up) / (-e . toward) / slope,  e = p - eye.
#pragma once

#include <string>
#include <vector>

#include "app/base/words.h"
#include "mesh/base/vectors.h"

namespace drape::app::drawing {

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
  Vec3 eye, right, up, toward;  // eye in m; the others are unit vectors, `toward` points to the viewer
  double slope = 0;             // how much the slope of the ray changes from one pixel to the next
  double middle_x = 0, middle_y = 0;

  Vec3 direction(double x, double y) const;  // unit vector from the eye through a pixel
};

// A camera with the axes only.
Camera facing(const View& view);

// Finds the nearest eye from which all points [m] appear within the box, centred in it.
class Framing {
 public:
  Framing(const View& view, const PixelBox& box);
  void add(const Vec3& point);
  Camera camera() const;  // needs at least one point

 private:
  Camera camera_;            // its eye is not set
  double across_, upwards_;  // slopes of the box's sides
  // The largest x + a z, a z - x, y + b z, b z - y of all points in the axes of the camera; the range of z.
  double right_, left_, above_, below_, nearest_, farthest_;
};

}  // namespace drape::app::drawing
