// Quantities with units: what is read, and what is refused with which words.
#include <catch2/catch.hpp>
#include <string>

#include "app/base/units.h"
#include "mesh/base/errors.h"

using namespace drape;
using namespace drape::app;
using Catch::Contains;

namespace {

struct Good {
  const char* text;
  Dimension dimension;
  double si;
};

struct Bad {
  const char* text;
  Dimension dimension;
  const char* message;
};

}  // namespace

TEST_CASE("quantities are read in SI units", "[units]") {
  const Good table[] = {
      {"0.3", dimension::length, 0.3},
      {"30 cm", dimension::length, 0.3},
      {" 30cm ", dimension::length, 0.3},
      {"+12 inch", dimension::length, 0.3048},
      {"-5 um", dimension::length, -5e-6},
      {"5 \xC2\xB5m", dimension::length, 5e-6},
      {"10 ms", dimension::time, 0.01},
      {"1 min", dimension::time, 60},
      {"25 Hz", dimension::rate, 25},
      {"25 fps", dimension::rate, 25},
      {"25 1/s", dimension::rate, 25},
      {"1 mm/s", dimension::speed, 1e-3},
      {"25 cm/s", dimension::speed, 0.25},
      {"9.81 m/s^2", dimension::acceleration, 9.81},
      {"9.81 m/s2", dimension::acceleration, 9.81},
      {"90 deg", dimension::angle, 1.5707963267948966},
      {"90deg", dimension::angle, 1.5707963267948966},
      {"1 rad", dimension::angle, 1},
      {"-2", dimension::angular_rate, -2},
      {"90 deg/s", dimension::angular_rate, 1.5707963267948966},
      {"30 rpm", dimension::angular_rate, 3.1415926535897932},
      {"0.5 turn/s", dimension::angular_rate, 3.1415926535897932},
      {"180 \xC2\xB0/min", dimension::angular_rate, 0.05235987755982988},
      {"3 mrad/ms", dimension::angular_rate, 3},
      {"500 g", dimension::mass, 0.5},
      {"1 oz", dimension::mass, 0.028349523},
      {"2e-3 kg.m^2", dimension::moment_of_inertia, 2e-3},
      {"20 g cm2", dimension::moment_of_inertia, 2e-6},
      {"180 g/m^2", dimension::area_density, 0.18},
      {"180g/m2", dimension::area_density, 0.18},
      {"180 gsm", dimension::area_density, 0.18},
      {"1 oz/yd^2", dimension::area_density, 0.0339057475},
      {"500 N/m", dimension::stretch, 500},
      {"1 gf/cm", dimension::stretch, 0.980665},
      {"2 kN/m", dimension::stretch, 2000},
      {"12 uN.m", dimension::bend, 1.2e-5},
      {"12uN.m", dimension::bend, 1.2e-5},
      {"12 uN m", dimension::bend, 1.2e-5},
      {"12 uN*m", dimension::bend, 1.2e-5},
      {"0.1 gf.cm^2/cm", dimension::bend, 9.80665e-6},
      {"1 dyn.cm", dimension::bend, 1e-7},
      {"1e-7 N.m^2", dimension::bend_spring, 1e-7},
      {"0.01 N.s/m", dimension::damping, 0.01},
      {"30 %", dimension::number, 0.3},
      {"0.118 gf.cm^2/cm", dimension::sheet_bend, 1.1571847e-5},
      {"0.124 gf.cm/cm", dimension::sheet_moment, 1.2160246e-3},
      {"1 gf/(cm.deg)", dimension::sheet_shear, 56.18797},
      {"1 gf/(cm deg)", dimension::sheet_shear, 56.18797},
      {"1 gf/cm/degree", dimension::sheet_shear, 56.18797},
      {"1 gf/cm/\xC2\xB0", dimension::sheet_shear, 56.18797},
      {"40 N/(m.rad)", dimension::sheet_shear, 40},
      {"2.1 gf/cm", dimension::sheet_force, 2.0593965},
      {"3.5 %", dimension::sheet_extension, 0.035},
      {"21 mm", dimension::sheet_length, 0.021},
  };
  for (const Good& row : table) {
    INFO(row.text);
    CHECK(parse_quantity(row.text, row.dimension) == Approx(row.si).epsilon(1e-6));
  }
}

TEST_CASE("other quantities are refused with the reason", "[units]") {
  const Bad table[] = {
      {"10 N/m", dimension::bend, "expected a bending rigidity such as \"10 uN.m\""},
      {"10 N.m", dimension::stretch, "expected a membrane stiffness"},
      {"100 Hz", dimension::time, "expected a time"},  // not 10 ms
      {"10 ms", dimension::rate, "expected a rate"},
      {"30 cm", dimension::angle, "expected an angle"},
      {"90 deg", dimension::angular_rate, "expected a rate of turning such as \"90 deg/s\""},
      {"1 Hz", dimension::angular_rate, "'Hz' names no angle: write rpm, deg/s or rad/s"},  // or 2 pi rad/s?
      {"1 1/s", dimension::angular_rate, "names no angle"},
      {"0.8", dimension::sheet_shear, "has no unit; expected a shear stiffness with its unit"},
      {"0.8 gf/cm", dimension::sheet_shear, "'gf/cm' is not per angle: write gf/(cm.deg)"},
      {"0.8 gf/cm.deg", dimension::sheet_shear, "is not per angle"},  // as udunits reads it: times an angle
      {"40 N/m", dimension::sheet_shear, "is not per angle"},
      {"3.5", dimension::sheet_extension,
       "has no unit; expected an extension with its unit such as \"3.5 %\""},
      {"3.5 mm", dimension::sheet_extension, "expected an extension"},
      {"5 kg.m", dimension::moment_of_inertia, "expected a moment of inertia"},
      {"5 kg", dimension::area_density, "expected a mass per area"},
      {"", dimension::time, "does not begin with a number"},
      {"ms", dimension::time, "does not begin with a number"},
      {"ten ms", dimension::time, "does not begin with a number"},
      {"10 mz", dimension::time, "'mz' is not a unit"},
      {"10 20", dimension::time, "is not a unit"},
      {"10 s 20", dimension::time, "is not a unit"},  // udunits: 200 s
      {"10 s since 2020-01-01", dimension::time, "is not a unit"},
      {"10 s @ 3", dimension::time, "is not a unit"},
      {"10-20 s", dimension::time, "is not a unit"},
      {"nan s", dimension::time, "not a finite number"},
      {"inf", dimension::time, "not a finite number"},
      {"1e999 s", dimension::time, "not a finite number"},
      {"1e308 km", dimension::length, "not a finite number"},
  };
  for (const Bad& row : table) {
    INFO(row.text);
    CHECK_THROWS_WITH(parse_quantity(row.text, row.dimension), Contains(row.message));
    CHECK_THROWS_AS(parse_quantity(row.text, row.dimension), InputError);
  }
}
