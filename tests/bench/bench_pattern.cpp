// How long a pattern of about 100,000 triangles takes: two half rings of cloth, sewn on both sides, from the
// polygons to the mesh with its document. One thread; the median of five.
#include <cstdio>

#include "mesh/pattern/pattern.h"
#include "tests/bench/bench.h"

namespace {

using namespace drape;

Panel half_ring(const std::string& name, double x) {
  const auto at = [&](double dx) { return Vec2(x + dx, 0); };
  Panel panel;
  panel.name = name;
  panel.outline.where = name;
  panel.outline.names = {"left", "waist", "right", "hem"};
  panel.outline.segments = {
      line_segment(at(-0.62), at(-0.122)), arc_segment(at(-0.122), at(0.122), 0.122, 0.122, 0, false, true),
      line_segment(at(0.122), at(0.62)), arc_segment(at(0.62), at(-0.62), 0.62, 0.62, 0, false, false)};
  return panel;
}

}  // namespace

int main() {
  Pattern pattern;
  pattern.panels = {half_ring("front", 0), half_ring("back", 2)};
  pattern.seams = {{"front.left", "back.right", false, "bench"},
                   {"front.right", "back.left", false, "bench"}};
  int triangles = 0;
  const double ms =
      bench::timed(5, [&] { triangles = triangulate(pattern, {.edge = 0.0075}).mesh.triangle_count(); });
  std::printf("pattern: %d triangles in %.0f ms, one thread\n", triangles, ms);
}
