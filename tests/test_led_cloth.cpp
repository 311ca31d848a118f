// Cloth that is led, under cloth that it touches: what does not rub on it is not taken along, however
// suddenly it starts.
#include <catch2/catch.hpp>
#include <numeric>

#include "solver/assembly/assembly.h"
#include "tests/integrators.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

TEST_CASE("cloth that is led away from under another leaves it where it is, without friction",
          "[self-contact]") {
  const Fabric poplin{.area_density = 0.12, .stretch = 500, .bend = 8e-6};
  for (const Kind kind : kinds)
    for (const int n : {7, 11})
      for (const double h : {0.01, 0.005, 0.0025}) {
        INFO(n << " x " << n << " of kind " << static_cast<int>(kind) << ", " << h << " s");
        Assembly both({0, -9.81, 0});
        const auto flat = [](double y) { return [y](double, double) { return y; }; };
        const auto add = [&](const TriangleMesh& mesh) {
          both.add({.mesh = mesh,
                    .fabric = poplin,
                    .model = ClothModel::woven,
                    .imperfection = 0,
                    .self_contact = SelfContactOptions{.thickness = 1e-3, .friction = 0}});
        };
        add(bent(4 * n, kind, 0.3, flat(0)));
        std::vector<int> led(static_cast<std::size_t>(both.state.particles()));
        std::iota(led.begin(), led.end(), 0);
        add(bent(n, kind, 0.06, flat(1e-3)));
        both.use("implicit-euler", "auto", {});
        both.constraints->pin_along(led, Motion::constant({1, 0, 0}, Vec3::Zero(), Vec3::Zero(), 0.02),
                                    both.state.x, 0);
        while (both.state.time < 0.1 - 0.5 * h) REQUIRE(both.advance(h).done);
        Vec3 mean = Vec3::Zero();
        const int count = both.state.particles() - static_cast<int>(led.size());
        for (int i = static_cast<int>(led.size()); i < both.state.particles(); ++i)
          mean += both.state.v.segment<3>(3 * i) / count;
        CHECK(both.state.v[0] == Approx(1));
        CHECK(std::hypot(mean[0], mean[2]) < 5e-3);
      }
}
