// What a laboratory measured and no formula turns into parameters, each beside the virtual test that has to
// give the same.
#pragma once

#include "app/scene/fabrics.h"
#include "app/textile/virtual_tests.h"

namespace drape::app {

struct Found {
  double value;        // SI; not a number when no specimen came to rest
  std::string beside;  // what else the test showed: "± 1.2, 7 nodes (4 were counted)"
};

struct Measurement {
  std::string name;  // "drape coefficient"
  Unit unit;
  double measured;   // SI
  double tolerance;  // SI; the test is met when it is no further off
  bool bends;        // false: the specimen stays flat, and bending has no part in it
  double step;       // the relative change of a stiffness that it answers beyond its own roughness
  std::function<Found(const Fabric&)> test;
};

struct SpecimenOptions {
  double edge = 0.01;  // m, longest edge of the meshes
  int repeats = 3;     // specimens of a drape test
};

// Tolerances: 5 points of a drape coefficient, 10 % of a length or a force. The count of nodes is shown and
// not compared: it jumps. Throws InputError when a specimen is too small for the mesh.
std::vector<Measurement> measurements_of(const MeasuredTests& tests, const SpecimenOptions& options);

// What the file of a fabric says was measured of a quantity of the virtual tests, in SI units: a drape
// coefficient and its nodes as they are, a bending length or rigidity from the droop of a strip by the
// elastica, a shear modulus from a frame that is sheared evenly or from a long strip in the bias. Of several
// results the first that has it.
std::optional<double> measured_value(const NamedFabric& fabric, const std::string& quantity);

// Parameters to start from: those of the elastica, of a frame whose fabric is sheared evenly, of a long strip
// in the bias, and of a drape coefficient that grows with the bending length.
double bend_to_start_from(const MeasuredTests& tests, double area_density, const std::string& direction);
double shear_to_start_from(const MeasuredTests& tests);

}  // namespace drape::app
