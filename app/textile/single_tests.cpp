#include "app/textile/single_tests.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/scene/laboratory.h"

namespace drape::app {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// How far the pulled corners of a frame move apart for a change of the angle [m/rad].
double corners_apart(double side, double shear) {
  return side * (std::cos(0.5 * shear) - std::sin(0.5 * shear)) / std::sqrt(2.0);
}

}  // namespace

Vec3 hanging_tip(const Cut& cut, double length, double edge) {
  const Specimen strip = overhanging_strip(length, std::max(0.025, 4 * edge), edge);
  Rig rig(strip, cut, {0, -standard_gravity, 0}, [](const Vec3& x) { return x; });
  if (!rig.settle(0.1 * std::sqrt(length), 1e-6, 8000)) return Vec3::Constant(nan);
  Vec3 sum = Vec3::Zero();
  int at_end = 0;
  for (int i = 0; i < strip.mesh.vertex_count(); ++i)
    if (strip.mesh.positions[static_cast<std::size_t>(i)].x() > length * (1 - 1e-9)) {
      sum += rig.place(i);
      ++at_end;
    }
  return sum / at_end;
}

double strip_load(const Cut& cut, double length, double width, double strain, double edge) {
  const Specimen strip = strip_between_clamps(length, width, edge);
  Rig rig(strip, cut, Vec3::Zero(), [&](const Vec3& x) { return Vec3((1 + strain) * x.x(), 0, x.z()); });
  return rig.relax() ? rig.pull_on(strip.held).x() / width : nan;
}

double frame_force(const Fabric& fabric, double side, double shear, double edge) {
  const double c = std::cos(0.5 * shear), s = std::sin(0.5 * shear);
  const Specimen frame = hinged_frame(side, edge);
  Rig rig(frame, {fabric, ClothModel::woven, 0}, Vec3::Zero(),
          [&](const Vec3& x) { return Vec3(c * x.x() + s * x.z(), 0, s * x.x() + c * x.z()); });
  if (!rig.relax()) return nan;
  double slope = 0;  // dW/dshear
  for (const std::vector<int>* bars : {&frame.held, &frame.moved})
    for (int i : *bars) {
      const Vec3& x = frame.mesh.positions[static_cast<std::size_t>(i)];
      const Vec3 motion(0.5 * (c * x.z() - s * x.x()), 0, 0.5 * (c * x.x() - s * x.z()));
      slope -= rig.pull_on({i}).dot(motion);
    }
  return slope / corners_apart(side, shear);
}

double shear_of_frame(double side, double shear, double force) {
  return force * corners_apart(side, shear) / (side * side * std::sin(shear) * std::cos(shear));
}

}  // namespace drape::app
