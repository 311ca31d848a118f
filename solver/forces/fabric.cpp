#include "solver/forces/fabric.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "mesh/triangles/topology.h"
#include "solver/forces/require.h"

namespace drape {
namespace {

void check(const Weave& w) {
  for (const auto& [field, value, unit] :
       {std::tuple{"stretch_weft", w.stretch_weft, "N/m"}, std::tuple{"shear", w.shear, "N/m"},
        std::tuple{"bend_weft", w.bend_weft, "N.m"}, std::tuple{"bend_bias", w.bend_bias, "N.m"}})
    if (value) require(*value > 0, field, *value, unit, "a stiffness in one direction is greater than zero");
  for (const auto& [field, value] :
       {std::pair{"poisson", w.poisson}, std::pair{"bend_poisson", w.bend_poisson}})
    require(std::abs(value) < 1, field, value, "", "Poisson's ratio is between -1 and 1");
  require(w.compression >= 0 && w.compression <= 1, "compression", w.compression, "",
          "the share of the resistance to compression is from 0 to 1");
  require(w.rest_angle >= 0 && w.rest_angle <= 1, "rest_angle", w.rest_angle, "",
          "the share of the mesh's own angles is from 0 (flat) to 1");
  require(w.rest_angle == 0 || w.bending != Bending::quadratic_hinges, "rest_angle", w.rest_angle, "",
          "quadratic hinges rest flat, with 0; take hinges or a plate");
  require(w.bend_friction >= 0, "bend_friction", w.bend_friction, "N", "a frictional moment is not negative");
  if (w.bend_friction_weft) {
    require(*w.bend_friction_weft > 0, "bend_friction_weft", *w.bend_friction_weft, "N",
            "a frictional moment in one direction is greater than zero");
    require(w.bend_friction > 0, "bend_friction", w.bend_friction, "N",
            "with a frictional moment along the weft it is greater than zero");
  }
  require(w.bend_friction_onset > 0, "bend_friction_onset", w.bend_friction_onset, "1/m",
          "a change of curvature is greater than zero");
  for (const auto& [field, value] :
       {std::pair{"stretch_time", w.stretch_time}, std::pair{"shear_time", w.shear_time},
        std::pair{"bend_time", w.bend_time}})
    require(value >= 0, field, value, "s", "a time is not negative");
}

double mean(double warp, const std::optional<double>& weft) { return weft ? 0.5 * (warp + *weft) : warp; }

void check_density(double area_density) {
  require(area_density > 0, "area_density", area_density, "kg/m^2", "an area density is greater than zero");
}

}  // namespace

void check(const Fabric& f) {
  check_density(f.area_density);
  require(f.stretch >= 0, "stretch", f.stretch, "N/m", "a stiffness is not negative");
  require(f.bend >= 0, "bend", f.bend, "N.m", "a bending rigidity is not negative");
  if (f.stretch_spring)
    require(*f.stretch_spring >= 0, "stretch_spring", *f.stretch_spring, "N/m",
            "a stiffness is not negative");
  if (f.bend_spring)
    require(*f.bend_spring >= 0, "bend_spring", *f.bend_spring, "N.m^2", "a stiffness is not negative");
  if (f.buckling_clamp)
    require(*f.buckling_clamp >= 0, "buckling_clamp", *f.buckling_clamp, "N/m",
            "a stiffness is not negative");
  require(f.damping >= 0, "damping", f.damping, "N.s/m", "a damping coefficient is not negative");
  check(f.weave);
  require(f.stretch > 0 || !(f.weave.stretch_weft || f.weave.shear), "stretch", f.stretch, "N/m",
          "with a stiffness along the weft or of shear it is greater than zero");
  require(f.bend > 0 || !(f.weave.bend_weft || f.weave.bend_bias), "bend", f.bend, "N.m",
          "with a rigidity along the weft or in the bias it is greater than zero");
  require(f.bend > 0 || f.weave.bend_friction == 0, "bend", f.bend, "N.m",
          "with friction against bending it is greater than zero");
}

double mean_stretch(const Fabric& f) { return mean(f.stretch, f.weave.stretch_weft); }
double mean_bend(const Fabric& f) { return mean(f.bend, f.weave.bend_weft); }

std::vector<double> mass_of_areas(std::vector<double> areas, const TriangleMesh& mesh, double area_density) {
  check_density(area_density);
  std::vector<char> used(areas.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (int i : t) used[i] = 1;
  double total = 0;
  int count = 0;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    total += areas[i];
    count += used[i];
  }
  for (std::size_t i = 0; i < areas.size(); ++i)
    areas[i] = area_density * (used[i] ? std::max(areas[i], 1e-3 * total / count) : 0.0);
  return areas;
}

std::vector<double> lumped_mass(const TriangleMesh& mesh, const TriangleMesh& rest, double area_density) {
  return mass_of_areas(vertex_areas(mesh, rest), mesh, area_density);
}

std::vector<double> lumped_mass(const TriangleMesh& mesh, double area_density) {
  return lumped_mass(mesh, mesh, area_density);
}

}  // namespace drape
