#include "app/textile/measurements.h"

#include <algorithm>
#include <cmath>

#include "app/textile/elastica.h"
#include "app/textile/options.h"
#include "app/textile/single_tests.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

constexpr double pi = 3.14159265358979323846;
// Folds come and go as a disc becomes stiffer, so that its drape coefficient is rough; strips are smooth.
constexpr double rough_step = 0.4, smooth_step = 0.1;
constexpr double tolerance_of_coefficient = 0.05, share_of_others = 0.1;
constexpr Unit percent{"%", "1", 0.01}, cm{"cm", "m", 0.01}, per_width{"N/m", "N/m", 1}, newton{"N", "N", 1};

std::string centimetres(double length) { return rounded(100 * length, 4) + " cm"; }

// A specimen of four edges bends and shears as the fabric does, within some percent.
void check_size(const char* what, double length, double edge) {
  if (length < 4 * edge * (1 - 1e-9))
    throw InputError("--mesh " + millimetres(edge) + ": is too coarse for " + what + " of " +
                     centimetres(length) + "; take a mesh of at most a quarter of that");
}

// The mean of the specimens that came to rest.
Found draped(const Fabric& fabric, const MeasuredDrape& measured, const SpecimenOptions& options) {
  const DrapeTest test{
      .plate_radius = 0.5 * measured.plate, .radius = 0.5 * measured.specimen, .repeats = options.repeats};
  const Values values = drape_test(fabric, ClothModel::woven, options.edge, test, [](int, const Shadow&) {});
  double sum = 0, squares = 0, nodes = 0;
  int rested = 0;
  for (std::size_t k = 0; k < values[0].found.size(); ++k) {
    const double one = values[0].found[k];
    if (!std::isfinite(one)) continue;
    sum += one;
    squares += one * one;
    nodes += values[1].found[k];
    ++rested;
  }
  const double mean = sum / rested;
  std::string beside;
  if (rested > 1)
    beside = "± " + rounded(100 * std::sqrt(std::max(0.0, (squares - sum * mean) / (rested - 1))), 2) +
             " among specimens, ";
  beside += rounded(nodes / rested, 3) + " nodes";
  if (measured.nodes) beside += " (" + rounded(*measured.nodes, 3) + " were counted)";
  return {mean, beside};
}

void add_cantilever(std::vector<Measurement>& all, const MeasuredCantilever& measured, double edge) {
  check_size("a strip", measured.length, edge);
  const auto add = [&](const char* direction, double angle, double droop) {
    all.push_back({"droop of " + centimetres(measured.length) + ", " + direction, cm, droop,
                   share_of_others * droop, true, smooth_step,
                   [=, length = measured.length](const Fabric& fabric) {
                     return Found{-hanging_tip({fabric, ClothModel::woven, angle}, length, edge).y(), ""};
                   }});
  };
  const Directions& droop = measured.droop;
  add("warp", 0, droop.warp);
  if (droop.weft) add("weft", pi / 2, *droop.weft);
  if (droop.bias) add("bias", pi / 4, *droop.bias);
}

}  // namespace

std::vector<Measurement> measurements_of(const MeasuredTests& tests, const SpecimenOptions& options) {
  const double edge = options.edge;
  std::vector<Measurement> all;
  if (tests.drape) {
    check_overhang(0.5 * tests.drape->specimen, 0.5 * tests.drape->plate, edge);
    all.push_back(
        {"drape coefficient", percent, tests.drape->coefficient, tolerance_of_coefficient, true, rough_step,
         [=, drape = *tests.drape](const Fabric& fabric) { return draped(fabric, drape, options); }});
  }
  for (const MeasuredCantilever& cantilever : tests.cantilevers) add_cantilever(all, cantilever, edge);
  for (const MeasuredBiasExtension& strip : tests.bias_extensions) {
    check_size("a strip", std::min(strip.length, strip.width), edge);
    all.push_back({"load of the bias strip at " + rounded(100 * strip.extension, 4) + " %", per_width,
                   strip.load, share_of_others * strip.load, false, smooth_step, [=](const Fabric& fabric) {
                     return Found{strip_load({fabric, ClothModel::woven, pi / 4}, strip.length, strip.width,
                                             strip.extension, edge),
                                  ""};
                   }});
  }
  for (const MeasuredFrame& frame : tests.frames) {
    check_size("a frame", frame.side, edge);
    all.push_back({"force of the frame at " + rounded(frame.shear * 180 / pi, 4) + " deg", newton,
                   frame.force, share_of_others * frame.force, false, smooth_step, [=](const Fabric& fabric) {
                     return Found{frame_force(fabric, frame.side, frame.shear, edge), ""};
                   }});
  }
  return all;
}

std::optional<double> measured_value(const NamedFabric& fabric, const std::string& quantity) {
  const MeasuredTests& tests = fabric.tests;
  if (quantity == "drape coefficient" && tests.drape) return tests.drape->coefficient;
  if (quantity == "nodes" && tests.drape) return tests.drape->nodes;
  if (quantity == "shear modulus, picture frame" && !tests.frames.empty()) return shear_to_start_from(tests);
  if (quantity == "shear modulus, between clamps" && tests.frames.empty() && !tests.bias_extensions.empty())
    return shear_to_start_from(tests);
  const std::size_t comma = quantity.find(", ");
  const std::string test = quantity.substr(0, comma);
  if (comma == quantity.npos || (test != "bending length" && test != "bending rigidity")) return {};
  const std::string direction = quantity.substr(comma + 2);
  for (const MeasuredCantilever& strip : tests.cantilevers) {
    const Directions& droop = strip.droop;
    const bool alike = !droop.weft && !droop.bias;  // one number is of all directions
    const std::optional<double> one = direction == "warp" || alike ? std::optional(droop.warp)
                                      : direction == "weft"        ? droop.weft
                                                                   : droop.bias;
    if (!one) continue;
    const double gamma = gamma_of_droop(std::clamp(*one / strip.length, 0.002, 0.95));
    return test == "bending length"
               ? strip.length / std::cbrt(gamma)
               : fabric.fabric.area_density * standard_gravity * std::pow(strip.length, 3) / gamma;
  }
  return {};
}

double bend_to_start_from(const MeasuredTests& tests, double area_density, const std::string& direction) {
  const double weight = area_density * standard_gravity;
  for (const MeasuredCantilever& c : tests.cantilevers) {
    const double droop = direction == "weft"   ? c.droop.weft.value_or(c.droop.warp)
                         : direction == "bias" ? c.droop.bias.value_or(c.droop.warp)
                                               : c.droop.warp;
    return weight * std::pow(c.length, 3) / gamma_of_droop(std::clamp(droop / c.length, 0.002, 0.95));
  }
  if (!tests.drape) return Fabric().bend;
  // From c = 0.12 to 0.42 times the width of the ring that hangs the coefficient grows from 0 to 1.
  const double ring = 0.5 * (tests.drape->specimen - tests.drape->plate);
  return weight * std::pow(ring * (0.12 + 0.3 * tests.drape->coefficient), 3);
}

double shear_to_start_from(const MeasuredTests& tests) {
  if (!tests.frames.empty()) {
    const MeasuredFrame& frame = tests.frames.front();
    return shear_of_frame(frame.side, frame.shear, frame.force);
  }
  if (tests.bias_extensions.empty()) return 50;  // N/m, a usual fabric
  return tests.bias_extensions.front().load / (4 * tests.bias_extensions.front().extension);
}

}  // namespace drape::app
