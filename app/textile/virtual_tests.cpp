#include "app/textile/virtual_tests.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>

#include "app/base/interrupt.h"
#include "app/scene/laboratory.h"
#include "app/textile/elastica.h"
#include "app/textile/single_tests.h"
#include "solver/forces/membrane.h"
#include "solver/forces/woven.h"

namespace drape::app {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr Unit mm{"mm", "m", 1e-3}, micro_newton_metre{"uN.m", "N.m", 1e-6},
    newton_per_metre{"N/m", "N/m", 1}, number{"", "1", 1};

struct Direction {
  const char* name;
  double angle;  // rad, from the warp
};
constexpr std::array directions = {Direction{"warp", 0}, Direction{"weft", pi / 2},
                                   Direction{"bias", pi / 4}};

// What the parameters say of a strip that is cut at this angle to the warp. Springs take means.
double bend_asked(const Fabric& fabric, ClothModel model, double angle) {
  if (model != ClothModel::woven) return mean_bend(fabric);
  const PlateStiffness D = plate_of(fabric);
  const double c = std::pow(std::cos(angle), 2), s = std::pow(std::sin(angle), 2);
  return D.warp * c * c + D.weft * s * s + (2 * D.cross + 4 * D.twist) * c * s;
}

double stretch_asked(const Fabric& fabric, ClothModel model, double angle) {
  if (model != ClothModel::woven) return mean_stretch(fabric);
  const Membrane::Common m = membrane_of(fabric);
  const double c = std::pow(std::cos(angle), 2), s = std::pow(std::sin(angle), 2);
  return 1 / (c * c / m.warp + s * s / m.weft + c * s * (1 / m.shear - 2 * m.cross / (m.warp * m.weft)));
}

double bending_length(double B, double area_density) {
  return std::cbrt(B / (area_density * standard_gravity));
}

// The bending length that a strip shows, or NaN.
double shown_bending_length(const Cut& cut, double edge, double expected) {
  const double shortest = 2 * edge;  // of a strip that can bend beyond its clamp
  double length = std::max(2 * expected, shortest);
  for (int round = 0; round < 5 && !interrupted(); ++round) {
    if (length < shortest) return nan;  // the mesh is too coarse for this fabric
    const Vec3 tip = hanging_tip(cut, length, edge);
    if (!tip.allFinite()) return nan;
    const double angle = std::atan2(-tip.y(), tip.x());
    if (!(angle > 0.01 && angle < 1.5)) {  // far from a bending length: try another strip
      length *= angle > 1 ? 0.5 : 2;
      continue;
    }
    const double c = length / std::cbrt(gamma_of_chord(angle));
    if (std::abs(angle - standard_chord_angle) < 0.01) return c;
    length = 2 * c;
  }
  return nan;
}

// The displacement gradient [-] in the plane, fitted to the vertices whose x lies in a range.
struct Gradient {
  double ux, uz, wx, wz;
};
Gradient gradient_within(const Specimen& specimen, const Rig& rig, double from, double to) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
  for (int i = 0; i < specimen.mesh.vertex_count(); ++i) {
    const Vec3& X = specimen.mesh.positions[static_cast<std::size_t>(i)];
    if (X.x() < from || X.x() > to) continue;
    const Eigen::Vector3d row(1, X.x(), X.z());
    const Vec3 u = rig.place(i) - X;
    normal += row * row.transpose();
    right += row * Eigen::RowVector2d(u.x(), u.z());
  }
  const Eigen::Matrix<double, 3, 2> fit = normal.ldlt().solve(right);
  return {fit(1, 0), fit(2, 0), fit(1, 1), fit(2, 1)};
}

}  // namespace

Values cantilever_test(const Fabric& fabric, ClothModel model, double edge) {
  Values values;
  for (const Direction& direction : directions) {
    const double B = bend_asked(fabric, model, direction.angle),
                 asked = bending_length(B, fabric.area_density);
    const double c = shown_bending_length({fabric, model, direction.angle}, edge, asked);
    values.push_back({std::string("bending length, ") + direction.name, mm, asked, {c}});
    values.push_back({std::string("bending rigidity, ") + direction.name,
                      micro_newton_metre,
                      B,
                      {fabric.area_density * standard_gravity * c * c * c}});
  }
  return values;
}

Values tensile_test(const Fabric& fabric, ClothModel model, double edge) {
  constexpr double length = 0.2, width = 0.05, strain = 2e-3;
  Values values;
  const Specimen strip = strip_between_clamps(length, width, edge);
  for (const Direction& direction : directions) {
    Rig rig(strip, {fabric, model, direction.angle}, Vec3::Zero(),
            [](const Vec3& x) { return Vec3((1 + strain) * x.x(), 0, x.z()); });
    double modulus = nan, narrower = nan;
    if (rig.relax()) {
      const Gradient middle = gradient_within(strip, rig, 0.25 * length, 0.75 * length);
      modulus = rig.pull_on(strip.held).x() / (width * middle.ux);
      narrower = -middle.wz / middle.ux;
    }
    values.push_back({std::string("tensile modulus, ") + direction.name,
                      newton_per_metre,
                      stretch_asked(fabric, model, direction.angle),
                      {modulus}});
    std::optional<double> poisson;
    if (model == ClothModel::woven && direction.angle != pi / 4) {
      const Membrane::Common m = membrane_of(fabric);
      poisson = m.cross / (direction.angle == 0 ? m.weft : m.warp);
    }
    values.push_back({std::string("Poisson's ratio, ") + direction.name, number, poisson, {narrower}});
  }
  return values;
}

Values shear_test(const Fabric& fabric, ClothModel model, double edge) {
  constexpr double apart = 0.05, width = 0.2, shear = 0.5 * pi / 180;
  std::optional<double> asked;
  if (model == ClothModel::woven) asked = membrane_of(fabric).shear;
  const auto sheared = [](const Vec3& x) { return Vec3(x.x(), 0, x.z() + shear * x.x()); };
  Values values;
  {
    const Specimen specimen = strip_between_clamps(apart, width, edge);
    Rig rig(specimen, {fabric, model, 0}, Vec3::Zero(), sheared);
    double modulus = nan;
    if (rig.relax()) {
      // The share of the clamp whose fabric is sheared alike, and the length that belongs to its vertices.
      std::vector<int> middle;
      double low = width, high = -width;
      for (int i : specimen.moved)
        if (const double z = specimen.mesh.positions[static_cast<std::size_t>(i)].z();
            std::abs(z) < 0.25 * width) {
          middle.push_back(i);
          low = std::min(low, z);
          high = std::max(high, z);
        }
      const double length =
          (high - low) * static_cast<double>(middle.size()) / static_cast<double>(middle.size() - 1);
      modulus = -rig.pull_on(middle).z() / (length * shear);
    }
    values.push_back({"shear modulus, between clamps", newton_per_metre, asked, {modulus}});
  }
  constexpr double side = 0.1;
  const Specimen frame = hinged_frame(side, edge);
  Rig rig(frame, {fabric, model, 0}, Vec3::Zero(), sheared);
  const double modulus = rig.relax() ? 2 * rig.stored_energy() / (side * side * shear * shear) : nan;
  values.push_back({"shear modulus, picture frame", newton_per_metre, asked, {modulus}});
  return values;
}

}  // namespace drape::app
