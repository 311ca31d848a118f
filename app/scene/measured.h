// What tests of a fabric gave that no formula turns into parameters: keys of a fabric file. They change
// nothing in a run. `drape test-fabric` shows the drape test beside its own; `drape fit` looks for the
// parameters with which its virtual tests give the same.
#pragma once

#include <optional>
#include <vector>

#include "app/scene/laboratory.h"

namespace drape::app {

// What a drape tester of Cusick's kind found.                                            [BS 5058, ISO 9073-9]
struct MeasuredDrape {
  double coefficient = 0;               // from 0 to 1
  std::optional<double> nodes = {};     // how many folds; a mean of several tests may be no whole number
  double specimen = 0.3, plate = 0.18;  // m, diameters of the disc and of the plate that it lies on
};

// A strip of this length leaves a clamp horizontally. Its free end comes to hang lower by the droop.
struct MeasuredCantilever {
  double length = 0;  // m
  Directions droop;   // m
};

// A strip cut at 45 degrees between two clamps, pulled along its length.
struct MeasuredBiasExtension {
  double length = 0, width = 0;  // m, of the fabric between the clamps
  double load = 0;               // N/m, force per width
  double extension = 0;          // over the length
};

// A square frame of four hinged bars, along warp and weft, pulled at two opposite corners.
struct MeasuredFrame {
  double side = 0;   // m
  double shear = 0;  // rad, by which the right angle has changed
  double force = 0;  // N, that pulls the corners apart
};

struct MeasuredTests {
  std::optional<MeasuredDrape> drape;
  std::vector<MeasuredCantilever> cantilevers;
  std::vector<MeasuredBiasExtension> bias_extensions;
  std::vector<MeasuredFrame> frames;
};

// Throws InputError, which names file and line.
MeasuredTests read_measured(Table& fabric_file);

}  // namespace drape::app
