// What theory says of a strip on edge: tests/lateral_buckling.h.
#include <catch2/catch.hpp>

#include "tests/lateral_buckling.h"
#include "tests/strips.h"

using namespace drape;
using namespace drape::test;

TEST_CASE("a strip on edge stands below the weight of lateral buckling and topples above it", "[woven]") {
  for (StripMesh kind : strip_meshes)
    for (int cells : {32, 48, 64}) {
      INFO(name(kind) << ", " << cells << " cells; not a number: a step failed");
      CHECK(lean_growth(kind, 0.95 * critical_gamma, cells) < 0.8);
      CHECK(lean_growth(kind, 1.1 * critical_gamma, cells) > 1.2);
    }
}
