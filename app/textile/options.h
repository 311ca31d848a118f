// Words of the command line that `drape test-fabric` and `drape fit` share. All throw InputError.
#pragma once

#include <string>

#include "app/scene/fabrics.h"

namespace drape::app {

Names names_in(const std::string& list);  // of "10mm, 5mm"

std::string millimetres(double length);  // "10 mm"

// A length [m] from `least` to `most`. `option` is named in messages: "--mesh".
double specimen_length(const std::string& word, const char* option, double least, double most);

constexpr double least_edge = 1e-3, most_edge = 0.02;  // m, of the meshes of specimens

int repeats_of(const std::string& word);  // of "--repeats", a whole number from 1 to 1000

// Specimens have meshes of their own, for which constants of single connections mean nothing.
void check_widths(const NamedFabric& named);

// A disc needs some edges between the plate and its rim.
void check_overhang(double radius, double plate_radius, double edge);

}  // namespace drape::app
