#include "app/scene/fabric_read.h"

#include <algorithm>
#include <cmath>

#include "mesh/base/errors.h"

namespace drape::app {
namespace {

// A number, the same in all directions, or a table of directions. Null: the number was read, or nothing.
std::optional<Table> directions(Table& table, const std::string& key, double& value,
                                const Dimension& dimension, const char* kind, const About& about) {
  const Node* const node = table.take(key, kind, about);
  if (node && node->kind == Node::Kind::table) return table.inner(key);
  table.read(key, value, dimension, Range::not_negative, about);
  return {};
}

void check_ratio(const Table& table, double poisson) {
  if (!(std::abs(poisson) < 1)) table.fail("poisson", "Poisson's ratio is between -1 and 1");
}

void read_stretch(Table& table, Fabric& fabric) {
  std::optional<Table> both = directions(table, "stretch", fabric.stretch, dimension::stretch,
                                         "a membrane stiffness ≥ 0 [N/m], or a table",
                                         {"membrane stiffness: force per width for a strain of 1; by "
                                          "directions as a table, of which springs take the mean",
                                          "500 N/m"});
  if (!both) return;
  refuse_misplaced(*both, "stretch");
  Weave& weave = fabric.weave;
  both->read_required("warp", fabric.stretch, dimension::stretch, Range::positive,
                      "of a strip pulled along the warp");
  both->read("weft", weave.stretch_weft, dimension::stretch, Range::positive,
             {"of a strip pulled along the weft", "as along the warp"});
  both->read(
      "shear", weave.shear, dimension::stretch, Range::positive,
      {"force per width over the angle of a small shear [rad]", "sqrt(warp weft) / (2 (1 + poisson))"});
  both->read("poisson", weave.poisson, dimension::number, Range::any,
             "geometric mean of the Poisson's ratios of warp and weft");
  check_ratio(*both, weave.poisson);
  both->finish();
}

void read_bend(Table& table, Fabric& fabric) {
  std::optional<Table> both =
      directions(table, "bend", fabric.bend, dimension::bend, "a bending rigidity ≥ 0 [N.m], or a table",
                 {"bending rigidity: moment per width for a curvature of 1/m; by directions as a table, of "
                  "which springs take the mean",
                  "10 uN.m"});
  if (!both) return;
  refuse_misplaced(*both, "bend");
  Weave& weave = fabric.weave;
  both->read_required("warp", fabric.bend, dimension::bend, Range::positive, "of cloth bent along the warp");
  both->read("weft", weave.bend_weft, dimension::bend, Range::positive,
             {"of cloth bent along the weft", "as along the warp"});
  both->read("bias", weave.bend_bias, dimension::bend, Range::positive,
             {"of wide cloth bent at 45 degrees to the threads",
              "as of a fabric with poisson, and equal along warp and weft"});
  both->read("poisson", weave.bend_poisson, dimension::number, Range::any, "Poisson's ratio of bending");
  check_ratio(*both, weave.bend_poisson);
  both->finish();
}

void read_viscosity(Table& table, Weave& weave) {
  const Node* const node =
      table.take("viscosity", "a table", "of model = \"woven\": how long strains resist being changed");
  if (!node) return;
  if (node->kind != Node::Kind::table)
    table.fail("viscosity",
               "expected a table such as { stretch = \"1 ms\", shear = \"1 ms\", bend = \"5 ms\" }");
  Table times = table.inner("viscosity");
  times.read("stretch", weave.stretch_time, dimension::time, Range::not_negative,
             "viscosity over stiffness, of stretch");
  times.read("shear", weave.shear_time, dimension::time, Range::not_negative, "of shear");
  times.read("bend", weave.bend_time, dimension::time, Range::not_negative, "of bending");
  times.finish();
}

}  // namespace

Names bending_names() { return {"plate", "hinges", "quadratic-hinges"}; }

std::string name_of(Bending bending) { return bending_names()[static_cast<std::size_t>(bending)]; }

Bending bending_of(const std::string& name) {
  const Names names = bending_names();
  return static_cast<Bending>(std::find(names.begin(), names.end(), name) - names.begin());
}

void read_fabric(Table& table, Fabric& fabric, FabricRecord& record) {
  table.read("area_density", fabric.area_density, dimension::area_density, Range::positive, "mass per area");
  Weave& weave = fabric.weave;
  // A shear stiffness that was measured for itself stays where only the stretch of the fabric is replaced.
  const auto told_shear = record.given.find("shear");
  const std::optional<std::string> shear_given =
      told_shear == record.given.end() ? std::nullopt : std::optional(told_shear->second);
  const std::optional<double> shear = weave.shear;
  if (table.has("stretch")) {  // replaces all of a named fabric's
    fabric.stretch_spring.reset();
    weave.stretch_weft.reset();
    weave.shear.reset();
    weave.poisson = Weave().poisson;
  }
  if (table.has("bend")) {
    fabric.bend_spring.reset();
    weave.bend_weft.reset();
    weave.bend_bias.reset();
    weave.bend_poisson = Weave().bend_poisson;
  }
  read_stretch(table, fabric);
  table.read("stretch_spring", fabric.stretch_spring, dimension::spring, Range::not_negative,
             "instead of stretch: the constant of every edge, k_s");
  read_bend(table, fabric);
  table.read("bend_spring", fabric.bend_spring, dimension::bend_spring, Range::not_negative,
             "instead of bend: the stiffness of every diagonal, k_b");
  read_laboratory(table, fabric, record);
  if (shear_given && !weave.shear) {
    weave.shear = shear;
    record.given["shear"] = *shear_given;
  }
  table.read(
      "buckling_clamp", fabric.buckling_clamp, dimension::spring, Range::not_negative,
      {"c_b of every diagonal: how steeply its force sets in; a soft one makes the cloth limp where it is "
       "hardly bent",
       "chosen"});
  table.read("damping", fabric.damping, dimension::damping, Range::not_negative, "of every connection");
  table.read("thickness", record.thickness, dimension::length, Range::positive,
             {"of the fabric: with self_contact two layers rest at the mean of their thicknesses", "1 mm"});
  std::string kind = fabric.damping_kind == DampingKind::axial ? "axial" : "relative";
  table.read("damping_kind", kind, Names{"relative", "axial"},
             "relative: of every difference of velocity of two neighbours; axial: of what goes along their "
             "connection");
  fabric.damping_kind = kind == "axial" ? DampingKind::axial : DampingKind::relative;
  table.read("neighbour_weighting", fabric.neighbour_weighting,
             "forces at a vertex times the largest number of neighbours over its own: Noh & Jung, eq. 1-3");
  table.read(
      "compression", fabric.weave.compression, dimension::number, Range::not_negative,
      {"of model = \"woven\": the share of the resistance to compression that stays; below 1 the fabric "
       "wrinkles finer than the mesh; from 0 to 1",
       "0.1 with a fabric by name or file, else 1"});
  if (table.has("compression") && fabric.weave.compression > 1)
    table.fail("compression", "the share of the resistance to compression is from 0 to 1");
  read_viscosity(table, fabric.weave);
  try {
    check(fabric);
  } catch (const InputError& error) {
    throw InputError(table.where() + ": " + error.what());
  }
}

}  // namespace drape::app
