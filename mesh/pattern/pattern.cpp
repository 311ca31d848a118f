#include "mesh/pattern/pattern.h"

namespace drape {

double enclosed_area(const Chain& loop) {
  double twice = 0;
  const Vec2 origin = loop.segments.front().start;
  for (const Segment& s : loop.segments) {
    constexpr int parts = 64;
    for (int i = 0; i < parts; ++i) {
      const Vec2 a = point(s, double(i) / parts) - origin, b = point(s, double(i + 1) / parts) - origin;
      twice += a.x() * b.y() - a.y() * b.x();
    }
  }
  return twice / 2;
}

}  // namespace drape
