#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "app/base/interrupt.h"
#include "app/scene/laboratory.h"
#include "app/textile/virtual_tests.h"

namespace drape::app {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = 3.14159265358979323846;
constexpr double finer =
    0.04;  // by which share the edges of a repeat may be shorter, so that its mesh is another

// Numbers from 0 to 1, the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : numbers_(seed) {}
  double operator()() { return static_cast<double>(numbers_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 numbers_;
};

Random numbers_of(int repeat) { return Random(static_cast<std::uint64_t>(repeat) + 1); }

bool come_to_rest(Rig& rig, const DrapeTest& test) {
  constexpr double step = 0.02;  // s
  // Gravity is nothing at the start, and so is its energy.
  int calm = 0;
  for (int k = 1; k * step < test.longest && calm < 10 && !interrupted(); ++k) {
    const double share = std::min(1.0, k * step / test.lowering);
    rig.set_gravity({0, -share * standard_gravity, 0});
    if (!rig.step(step)) return false;
    const bool still = share == 1 && rig.kinetic_energy() < -1e-6 * rig.gravity_energy();
    calm = still ? calm + 1 : 0;
  }
  return calm == 10;
}

}  // namespace

Specimen draped_disc(const DrapeTest& test, double edge, int repeat) {
  return disc_on_plate(test.radius, test.plate_radius, edge * (1 - finer * numbers_of(repeat)()));
}

Values drape_test(const Fabric& fabric, ClothModel model, double edge, const DrapeTest& test,
                  const std::function<void(int repeat, const Shadow&)>& each) {
  const double reach = 1.05 * test.radius, plate = Shadow(test.plate_radius, reach).area();
  Values values = {{"drape coefficient", {"%", "1", 0.01}, {}, {}},
                   {"nodes", {"", "1", 1}, {}, {}},
                   {"amplitude of the nodes", {"mm", "m", 1e-3}, {}, {}}};
  for (int repeat = 0; repeat < test.repeats && !interrupted(); ++repeat) {
    Random random = numbers_of(repeat);
    random();  // has made the mesh
    const Specimen disc = draped_disc(test, edge, repeat);
    Shadow before(test.plate_radius, reach);
    before.add(disc.mesh.triangles, disc.mesh.positions);
    const double whole = before.area(), angle = 2 * pi * random();
    Rig rig(disc, {fabric, model, angle}, {0, 0, 0}, [&](const Vec3& x) {
      const double up = 1e-4 * (2 * random() - 1);
      return Vec3(x.x(), x.norm() > test.plate_radius + edge ? up : 0, x.z());
    });
    if (!come_to_rest(rig, test)) {
      for (Value& value : values) value.found.push_back(nan);
      continue;
    }
    Shadow shadow(test.plate_radius, reach);
    shadow.add(disc.mesh.triangles, unstacked(rig.state().x));
    const Waves rim = waves(shadow.outline(), 0.05 * (test.radius - test.plate_radius));
    values[0].found.push_back((shadow.area() - plate) / (whole - plate));
    values[1].found.push_back(rim.nodes);
    values[2].found.push_back(rim.amplitude);
    each(repeat, shadow);
  }
  return values;
}

}  // namespace drape::app
