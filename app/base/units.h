// Quantities: "12 uN.m" -> 1.2e-5 in SI units, with a check that it is the kind of quantity that is wanted.
//   text   a number, then a unit as udunits writes it (N.m, N m, N*m, g/m^2, g/m2, gf.cm^2/cm, um, deg);
//          a number without a unit is in SI units. Beyond udunits these are known: deg, gsm (g/m^2), oz (of
//          mass), fps (frames per second).
#pragma once

#include <limits>
#include <numbers>
#include <string>
#include <string_view>

namespace drape::app {

// udunits takes an angle for a plain number, so that these are asked for by name.
enum class Angle {
  any,        // the unit may name one
  in_it,      // the unit names one: deg/s, not Hz
  divides_it  // the unit is per angle: gf/(cm.deg), neither gf/cm nor gf/cm.deg
};

struct Dimension {
  std::string_view unit;     // SI unit
  std::string_view noun;     // "a bending rigidity"
  std::string_view example;  // "10 uN.m"
  Angle angle = Angle::any;
  // Whether a number alone is refused: it may be meant in the unit that a laboratory's sheet prints.
  bool needs_unit = false;
  // A number alone is refused beyond this: it may be meant in another unit.
  double most_alone = std::numeric_limits<double>::infinity();
};

namespace dimension {
inline constexpr Dimension length{"m", "a length", "30 cm"};
inline constexpr Dimension time{"s", "a time", "10 ms"};
inline constexpr Dimension rate{"1/s", "a rate", "25 Hz"};
inline constexpr Dimension speed{"m/s", "a speed", "1 mm/s"};
inline constexpr Dimension acceleration{"m/s^2", "an acceleration", "9.81 m/s^2"};
inline constexpr Dimension angle{"rad", "an angle", "90 deg", Angle::any, false, 2 * std::numbers::pi};
inline constexpr Dimension angular_rate{"rad/s", "a rate of turning", "90 deg/s", Angle::in_it};  // or rpm
inline constexpr Dimension mass{"kg", "a mass", "500 g"};
inline constexpr Dimension moment_of_inertia{"kg.m^2", "a moment of inertia", "2e-3 kg.m^2"};
inline constexpr Dimension density{"kg/m^3", "a density", "300 kg/m^3"};
inline constexpr Dimension pressure{"Pa", "a modulus", "20 kPa"};
inline constexpr Dimension area_density{"kg/m^2", "a mass per area", "150 g/m^2"};
inline constexpr Dimension force{"N", "a force", "0.3 N"};
inline constexpr Dimension line_density{"kg/m", "a mass per length", "65 g/m"};
inline constexpr Dimension rope_bend{"N.m^2", "a bending stiffness of a rope", "1e-3 N.m^2"};
inline constexpr Dimension rope_damping{"N.s", "a damping of a rope", "5 N.s"};
inline constexpr Dimension rope_bend_damping{"N.m^2.s", "a damping of the bending of a rope", "1e-4 N.m^2.s"};
inline constexpr Dimension stretch{"N/m", "a membrane stiffness", "500 N/m"};
inline constexpr Dimension spring{"N/m", "a spring constant", "200 N/m"};
inline constexpr Dimension bend{"N.m", "a bending rigidity", "10 uN.m"};
inline constexpr Dimension bend_spring{"N.m^2", "a bending stiffness of a connection", "1e-7 N.m^2"};
inline constexpr Dimension damping{"N.s/m", "a damping", "0.01 N.s/m"};
inline constexpr Dimension share{"1", "a share", "45 %"};
inline constexpr Dimension number{"1", "a number", "0.3"};

// As laboratories print them (app/scene/laboratory.h).
inline constexpr Dimension sheet_bend{"N.m", "a bending rigidity with its unit", "0.118 gf.cm^2/cm",
                                      Angle::any, true};
inline constexpr Dimension sheet_moment{"N", "a hysteresis of bending with its unit", "0.12 gf.cm/cm",
                                        Angle::any, true};
inline constexpr Dimension sheet_shear{"N/m", "a shear stiffness with its unit", "0.8 gf/(cm.deg)",
                                       Angle::divides_it, true};
inline constexpr Dimension sheet_force{"N/m", "a force per width with its unit", "2.1 gf/cm", Angle::any,
                                       true};
inline constexpr Dimension sheet_extension{"1", "an extension with its unit", "3.5 %", Angle::any, true};
inline constexpr Dimension sheet_length{"m", "a length with its unit", "21 mm", Angle::any, true};
}  // namespace dimension

// The quantity in SI units. Throws InputError "expected a bending rigidity such as "10 uN.m""; when the text
// is some other quantity, the message begins with the reason.
double parse_quantity(std::string_view text, const Dimension& dimension);

std::string expected(const Dimension& dimension);  // "expected a bending rigidity such as "10 uN.m""

}  // namespace drape::app
