// Parameters with which virtual tests give what a laboratory measured:
//   least over ln p of the sum of ((found(p) - measured) / tolerance)^2
// The parameters are the stiffnesses that the file does not give. The tests are deterministic, and so is the
// fit.
#pragma once

#include "app/textile/measurements.h"

namespace drape::app {

// bend: the same in all directions. bend.bias is fitted as what it has above least_bend_bias.
inline const Names fit_parameters = {"bend", "bend.warp", "bend.weft", "bend.bias", "stretch.shear"};

struct FittedParameter {
  std::string name;
  double value;        // SI
  double uncertainty;  // relative, if every measurement is off by its tolerance
};

struct FittedValue {
  std::string name;
  Unit unit;
  double measured, found, tolerance;  // SI
  bool bends;
  std::string beside;
  bool met() const;
};

struct Fitting {
  Fabric fabric;
  std::vector<FittedParameter> parameters;
  std::vector<FittedValue> comparisons;
  int tests = 0;      // virtual tests that were run
  int rounds = 0;     // of the method
  std::string ended;  // why it stopped
  SpecimenOptions specimens;
  bool met() const;  // whether every measurement is met
};

// The parameters that the file does not give and that a measurement of it can give. Empty: formulas do for
// it.
Names parameters_to_fit(const NamedFabric& fabric);

// `parameters` empty: parameters_to_fit(). `say` receives a line for every trial. Throws InputError when the
// measurements cannot give the parameters, and Interrupted.
Fitting fit_fabric(const NamedFabric& fabric, Names parameters, const SpecimenOptions& specimens,
                   const std::function<void(const std::string&)>& say);

std::string parameter_text(const FittedParameter& parameter);               // "bend 9.8 uN.m"
std::string fitting_text(const Fitting& fitting, const std::string& from);  // for people to read, lines

}  // namespace drape::app
