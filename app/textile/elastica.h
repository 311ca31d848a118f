// A heavy strip that leaves a clamp horizontally and does not stretch: the elastica under its own weight.
//   theta'' = -Gamma (1 - s) cos theta,  theta(0) = 0, theta'(1) = 0,  Gamma = area_density g L^3 / B
#pragma once

namespace drape::app {

// The angle [rad] below the horizontal at which the chord from the clamp to the tip stands when the overhang
// is L. ASTM D1388 and ISO 9073-7 read the overhang at this angle: there L is twice the bending length c = (B
// / (area_density g))^(1/3), within 0.01 %.
inline constexpr double standard_chord_angle = 41.5 * 3.14159265358979323846 / 180;

// Gamma of the strip whose chord stands at this angle [rad], between 0.01 and 1.5.
double gamma_of_chord(double angle);

// Gamma of the strip whose free end hangs lower than the clamp by this share of its length, between 0.001 and
// 0.98.
double gamma_of_droop(double share);

}  // namespace drape::app
