// The tests of a textile laboratory, made with simulated specimens: what a fabric comes out as on a mesh,
// beside what it was asked to be. Lengths of the specimens are those of the standards.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/textile/rig.h"
#include "app/textile/shadow.h"

namespace drape::app {

struct Unit {
  const char *name, *si;  // the unit for people, and that of SI
  double in_si;
};

struct Value {
  std::string quantity;  // "bending length, warp"
  Unit unit;
  std::optional<double> asked;  // SI; unset: the parameters of the fabric do not say
  // One for each repeat, in SI. Not a number: this specimen did not come to rest, or the test does not apply.
  std::vector<double> found;
};
using Values = std::vector<Value>;

// Bending length by ASTM D1388, Peirce's cantilever: a strip 25 mm wide slides over an edge until its chord
// stands at 41.5 degrees. Along warp, weft and bias; with the rigidity B = area_density g c^3 that follows.
Values cantilever_test(const Fabric& fabric, ClothModel model, double edge);

// Strips of 200 x 50 mm [ISO 13934-1] cut along warp, weft and bias, pulled to a strain of 0.2 %. Strains are
// fitted over the middle half, as an extensometer would: the modulus, and how much narrower the strip
// becomes.
Values tensile_test(const Fabric& fabric, ClothModel model, double edge);

// 50 mm of fabric between clamps of 200 mm [KES-FB1], sheared by half a degree and kept flat; the force is
// that on the middle half of a clamp. And a hinged square frame of 100 mm, sheared as much: its energy.
Values shear_test(const Fabric& fabric, ClothModel model, double edge);

struct DrapeTest {
  double plate_radius = 0.09, radius = 0.15;  // m [BS 5058, ISO 9073-9]
  int repeats = 3;
  double lowering = 5;  // s
  double longest = 60;  // s, in which the specimen has to come to rest
};

// The disc of a repeat, 0 the first: its edges are up to 4 % shorter than `edge` [m], so that every repeat
// has a mesh of its own.
Specimen draped_disc(const DrapeTest& test, double edge, int repeat);

// The drape test: a disc of fabric hangs over a plate. It is let down slowly, as by a tester whose table
// sinks: its weight grows from nothing to all of it while it is lowered. Every repeat has a mesh of its own;
// it turns the warp on the mesh and pushes the vertices up or down by up to 0.1 mm at the start, by random
// numbers of its own. At rest: the kinetic energy stays below 1e-6 of the energy that the fall has set free,
// for 0.2 s. `each` is called with every shadow.
Values drape_test(const Fabric& fabric, ClothModel model, double edge, const DrapeTest& test,
                  const std::function<void(int repeat, const Shadow&)>& each);

}  // namespace drape::app
