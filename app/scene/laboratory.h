// What textile laboratories print, as keys of a fabric, and the parameters that follow by direct formulas.
//   bending length c [m]    B = g sigma c^3, sigma [kg/m^2] the area density           [Peirce 1930; ASTM D1388]
//   overhang L [m]          of a strip that bends down to 41.5 degrees: c = L / 2                   [ASTM D1388]
//   KES                     B [N m] and G [N/m per rad] as they are; Y = 490.3 N/m / EMT       [Kawabata 1980]
//   FAST                    c = C; G as it is, or 4.903 N/m / (4 EB5); Y from E5, E20, E100    [De Boos & Tester 1994]
// Y from an extension at a load is a secant, load over extension: what a cloth does under that load, and no
// modulus of small strains, of which a woven cloth has a lower one as long as its threads are crimped.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "app/base/table.h"
#include "solver/forces/fabric.h"

namespace drape::app {

// A quantity of a fabric that differs along warp and weft. Unset: as along the warp; in the bias as of a
// fabric that is the same in all directions.
struct Directions {
  double warp = 0;
  std::optional<double> weft = {}, bias = {};
};

// What is known of a fabric beside its parameters.
struct FabricRecord {
  // What gave a quantity, as it was written: "bend" -> "bending_length = \"2.1 cm\"". Of area_density,
  // stretch, shear and bend; nothing where the default holds.
  std::map<std::string, std::string> given;
  // Widths of the hysteresis that KES prints. That of bending is friction inside the fabric, where it is
  // asked for; no model has that of shear.
  std::optional<Directions> bending_hysteresis;  // 2HB [N]
  std::optional<Directions> shear_hysteresis;    // 2HG [N/m]
  std::optional<double> thickness;               // m
};

inline constexpr double standard_gravity = 9.80665;  // m/s^2, that of gf

double bend_of_length(double bending_length, double area_density);  // N m

// Gives the fabric the friction against bending that its record has. Throws InputError where the record has
// none.
void use_hysteresis(const FabricRecord& record, Fabric& fabric);

// A quantity that is given as one number or as a table of directions; unset: the key is not there.
std::optional<Directions> read_directions(Table& table, const std::string& key, const Dimension& dimension,
                                          bool bias, const About& about);

// The parameters that the keys bending_length, overhang, kes and fast give. area_density has been read.
// Throws InputError when two keys give the same parameter.
void read_laboratory(Table& table, Fabric& fabric, FabricRecord& record);

// Throws InputError, which names docs/fabrics.md, when the table has a word of a laboratory that does not
// belong in it. `table` is what the table is called: "kes"; "" of a fabric or a cloth, "scene" of a scene.
void refuse_misplaced(const Table& table, const std::string& name);

}  // namespace drape::app
