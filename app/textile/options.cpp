#include "app/textile/options.h"

#include <algorithm>
#include <cmath>

#include "app/base/table.h"
#include "mesh/base/errors.h"

namespace drape::app {

Names names_in(const std::string& list) {
  Names words;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::size_t first = std::min(list.find_first_not_of(' ', begin), end);
    words.push_back(list.substr(first, end - first));
    begin = end + 1;
  }
  return words;
}

std::string millimetres(double length) { return rounded(1000 * length, 3) + " mm"; }

double specimen_length(const std::string& word, const char* option, double least, double most) {
  try {
    const double value = quantity(parse_toml_value(word, option), dimension::length, Range::positive);
    if (value < least || value > most)
      throw InputError("expected a length from " + millimetres(least) + " to " + millimetres(most));
    return value;
  } catch (const InputError& error) {
    throw InputError(std::string(option) + " " + word + ": " + error.what());
  }
}

int repeats_of(const std::string& word) {
  try {
    const double repeats = quantity(parse_toml_value(word, "--repeats"), dimension::number, Range::positive);
    if (repeats > 1000 || repeats != std::floor(repeats))
      throw InputError("expected a whole number from 1 to 1000");
    return static_cast<int>(repeats);
  } catch (const InputError& error) {
    throw InputError("--repeats " + word + ": " + error.what());
  }
}

void check_widths(const NamedFabric& named) {
  const Fabric& fabric = named.fabric;
  if (!fabric.stretch_spring && !fabric.bend_spring && fabric.stretch > 0 && fabric.bend > 0) return;
  throw InputError("fabric " + named.name +
                   ": a specimen needs stretch and bend per width, both above 0; stretch_spring and "
                   "bend_spring are of the connections of one mesh");
}

void check_overhang(double radius, double plate_radius, double edge) {
  const double overhang = radius - plate_radius;
  if (!(overhang > 0))
    throw InputError("--plate " + millimetres(2 * plate_radius) + ": is as wide as the disc of " +
                     millimetres(2 * radius) +
                     " that lies on it; take a smaller --plate or a larger --specimen");
  if (overhang < 2.5 * edge)
    throw InputError(
        "--mesh " + millimetres(edge) + ": is too coarse for the " + millimetres(overhang) +
        " of fabric that hang over the plate; take a finer mesh, a larger --specimen or a smaller --plate");
}

}  // namespace drape::app
