// Fabric, named fabrics, and masses and forces made from them.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "app/base/words.h"
#include "app/python/arrays.h"
#include "app/python/forces.h"
#include "app/scene/fabrics.h"
#include "solver/forces/air.h"
#include "solver/forces/choi_ko.h"
#include "solver/forces/noh_jung.h"
#include "solver/forces/soft.h"
#include "solver/forces/woven.h"

namespace drape::app::python {
namespace {

DampingKind damping_kind(const std::string& name) {
  if (name == "relative") return DampingKind::relative;
  if (name == "axial") return DampingKind::axial;
  throw py::value_error("damping_kind: there is no '" + name + "'; " +
                        suggestion(name, {"relative", "axial"}));
}

const char* damping_name(DampingKind kind) { return kind == DampingKind::axial ? "axial" : "relative"; }

Bending bending_named(const std::string& name) {
  const Names names = bending_names();
  if (std::find(names.begin(), names.end(), name) != names.end()) return bending_of(name);
  throw py::value_error("bending: there is no '" + name + "'; " + suggestion(name, names));
}

using Given = std::optional<double>;

Fabric made(double area_density, double stretch, double bend, Given stretch_spring, Given bend_spring,
            Given buckling_clamp, double damping, const std::string& kind, bool neighbour_weighting,
            Given stretch_weft, Given shear, double poisson, double compression, Given bend_weft,
            Given bend_bias, double bend_poisson, double stretch_time, double shear_time, double bend_time,
            double rest_angle, double bend_friction, Given bend_friction_weft, double bend_friction_onset,
            const std::string& bending) {
  Fabric fabric{area_density,       stretch,        bend,    stretch_spring,
                bend_spring,        buckling_clamp, damping, damping_kind(kind),
                neighbour_weighting};
  fabric.weave = {.stretch_weft = stretch_weft,
                  .shear = shear,
                  .poisson = poisson,
                  .compression = compression,
                  .bend_weft = bend_weft,
                  .bend_bias = bend_bias,
                  .bend_poisson = bend_poisson,
                  .bending = bending_named(bending),
                  .bend_friction = bend_friction,
                  .bend_friction_weft = bend_friction_weft,
                  .bend_friction_onset = bend_friction_onset,
                  .stretch_time = stretch_time,
                  .shear_time = shear_time,
                  .bend_time = bend_time,
                  .rest_angle = rest_angle};
  check(fabric);
  return fabric;
}

std::string text(const Fabric& fabric) {
  std::string all = "Fabric(area_density=" + rounded(fabric.area_density, 6) + " kg/m^2";
  all += fabric.stretch_spring ? ", stretch_spring=" + rounded(*fabric.stretch_spring, 6) + " N/m"
                               : ", stretch=" + rounded(fabric.stretch, 6) + " N/m";
  all += fabric.bend_spring ? ", bend_spring=" + rounded(*fabric.bend_spring, 6) + " N m^2"
                            : ", bend=" + rounded(fabric.bend, 6) + " N m";
  all += ", damping=" + rounded(fabric.damping, 6) + " N s/m";
  // What differs from a fabric that is the same in all directions.
  const Weave &w = fabric.weave, usual;
  const auto given = [&](const char* name, const Given& value, const char* unit) {
    if (value) all += std::string(", ") + name + "=" + rounded(*value, 6) + unit;
  };
  const auto other = [&](const char* name, double value, double otherwise, const char* unit) {
    if (value != otherwise) given(name, value, unit);
  };
  given("stretch_weft", w.stretch_weft, " N/m");
  given("shear", w.shear, " N/m");
  other("poisson", w.poisson, usual.poisson, "");
  other("compression", w.compression, usual.compression, "");
  given("bend_weft", w.bend_weft, " N m");
  given("bend_bias", w.bend_bias, " N m");
  other("bend_poisson", w.bend_poisson, usual.bend_poisson, "");
  if (w.bending != usual.bending) all += ", bending=" + name_of(w.bending);
  other("stretch_time", w.stretch_time, 0, " s");
  other("shear_time", w.shear_time, 0, " s");
  other("bend_time", w.bend_time, 0, " s");
  other("bend_friction", w.bend_friction, 0, " N");
  given("bend_friction_weft", w.bend_friction_weft, " N");
  other("bend_friction_onset", w.bend_friction_onset, usual.bend_friction_onset, " 1/m");
  return all + ")";
}

void add_fabric(py::module_& m) {
  using namespace py::literals;
  py::class_<Fabric>(
      m, "Fabric",
      "What a cloth is made of, in numbers a textile laboratory gives. SI units:\n"
      "area_density [kg/m^2], stretch [N/m] membrane stiffness per width, bend [N m] bending rigidity\n"
      "per width; stretch_spring [N/m] and bend_spring [N m^2] replace these two by the same constant\n"
      "for every connection; buckling_clamp [N/m]; damping [N s/m] of every connection, 'relative' or\n"
      "'axial'; neighbour_weighting after Noh & Jung, eq. 1-3. For woven(): stretch and bend are along\n"
      "the warp; stretch_weft, shear [N/m], poisson, compression, bend_weft, bend_bias [N m],\n"
      "bend_poisson; stretch_time, shear_time, bend_time [s], viscosity over stiffness; rest_angle, the\n"
      "share of the mesh's folds with which it rests; bend_friction, bend_friction_weft [N], the moment of "
      "dry\n"
      "friction per width against bending, half of the width 2HB of KES-FB2's loop [Kawabata 1980], and\n"
      "bend_friction_onset [1/m], the change of curvature within which it sets in; bending, 'plate',\n"
      "'hinges' (the angles between triangles [Grinspun et al. 2003]) or 'quadratic-hinges' (their\n"
      "quadratic form, which rests flat [Bergou et al. 2006]).")
      .def(py::init(&made), py::kw_only(), "area_density"_a = 0.15, "stretch"_a = 500.0, "bend"_a = 1e-5,
           "stretch_spring"_a = py::none(), "bend_spring"_a = py::none(), "buckling_clamp"_a = py::none(),
           "damping"_a = 0.0, "damping_kind"_a = "relative", "neighbour_weighting"_a = false,
           "stretch_weft"_a = py::none(), "shear"_a = py::none(), "poisson"_a = 0.3, "compression"_a = 1.0,
           "bend_weft"_a = py::none(), "bend_bias"_a = py::none(), "bend_poisson"_a = 0.0,
           "stretch_time"_a = 0.0, "shear_time"_a = 0.0, "bend_time"_a = 0.0, "rest_angle"_a = 0.0,
           "bend_friction"_a = 0.0, "bend_friction_weft"_a = py::none(), "bend_friction_onset"_a = 50.0,
           "bending"_a = "plate",
           "ValueError names a value that is negative, not finite, or zero where it may not be.")
      .def_readwrite("area_density", &Fabric::area_density, "kg/m^2")
      .def_readwrite("stretch", &Fabric::stretch, "N/m, membrane stiffness per width")
      .def_readwrite("bend", &Fabric::bend, "N m, bending rigidity per width")
      .def_readwrite("stretch_spring", &Fabric::stretch_spring, "N/m, of every edge; replaces stretch")
      .def_readwrite("bend_spring", &Fabric::bend_spring, "N m^2, of every diagonal; replaces bend")
      .def_readwrite("buckling_clamp", &Fabric::buckling_clamp, "N/m, of every diagonal; None: chosen")
      .def_readwrite("damping", &Fabric::damping, "N s/m, of every connection")
      .def_property(
          "damping_kind", [](const Fabric& fabric) { return damping_name(fabric.damping_kind); },
          [](Fabric& fabric, const std::string& kind) { fabric.damping_kind = damping_kind(kind); },
          "'relative' or 'axial'")
      .def_readwrite("neighbour_weighting", &Fabric::neighbour_weighting, "Noh & Jung, eq. 1-3")
      .def_property(
          "stretch_weft", [](const Fabric& fabric) { return fabric.weave.stretch_weft; },
          [](Fabric& fabric, Given value) { fabric.weave.stretch_weft = value; },
          "N/m, along the weft; None: as along the warp")
      .def_property(
          "shear", [](const Fabric& fabric) { return fabric.weave.shear; },
          [](Fabric& fabric, Given value) { fabric.weave.shear = value; },
          "N/m; None: that of an isotropic fabric")
      .def_property(
          "poisson", [](const Fabric& fabric) { return fabric.weave.poisson; },
          [](Fabric& fabric, double value) { fabric.weave.poisson = value; },
          "geometric mean of the two Poisson's ratios")
      .def_property(
          "compression", [](const Fabric& fabric) { return fabric.weave.compression; },
          [](Fabric& fabric, double value) { fabric.weave.compression = value; },
          "share of the resistance to compression that stays, from 0 to 1")
      .def_property(
          "bend_weft", [](const Fabric& fabric) { return fabric.weave.bend_weft; },
          [](Fabric& fabric, Given value) { fabric.weave.bend_weft = value; },
          "N m, along the weft; None: as along the warp")
      .def_property(
          "bend_bias", [](const Fabric& fabric) { return fabric.weave.bend_bias; },
          [](Fabric& fabric, Given value) { fabric.weave.bend_bias = value; },
          "N m, at 45 degrees; None: that of an isotropic fabric")
      .def_property(
          "bend_poisson", [](const Fabric& fabric) { return fabric.weave.bend_poisson; },
          [](Fabric& fabric, double value) { fabric.weave.bend_poisson = value; },
          "Poisson's ratio of bending")
      .def_property(
          "stretch_time", [](const Fabric& fabric) { return fabric.weave.stretch_time; },
          [](Fabric& fabric, double value) { fabric.weave.stretch_time = value; },
          "s, viscosity over stiffness, of stretch")
      .def_property(
          "shear_time", [](const Fabric& fabric) { return fabric.weave.shear_time; },
          [](Fabric& fabric, double value) { fabric.weave.shear_time = value; }, "s, of shear")
      .def_property(
          "bend_time", [](const Fabric& fabric) { return fabric.weave.bend_time; },
          [](Fabric& fabric, double value) { fabric.weave.bend_time = value; }, "s, of bending")
      .def_property(
          "rest_angle", [](const Fabric& fabric) { return fabric.weave.rest_angle; },
          [](Fabric& fabric, double value) { fabric.weave.rest_angle = value; },
          "share of the mesh's folds with which it rests: 0 is flat, 1 the mesh")
      .def_property(
          "bend_friction", [](const Fabric& fabric) { return fabric.weave.bend_friction; },
          [](Fabric& fabric, double value) { fabric.weave.bend_friction = value; },
          "N, moment of dry friction per width against bending; 0: there is none")
      .def_property(
          "bend_friction_weft", [](const Fabric& fabric) { return fabric.weave.bend_friction_weft; },
          [](Fabric& fabric, Given value) { fabric.weave.bend_friction_weft = value; },
          "N, along the weft; None: as along the warp")
      .def_property(
          "bend_friction_onset", [](const Fabric& fabric) { return fabric.weave.bend_friction_onset; },
          [](Fabric& fabric, double value) { fabric.weave.bend_friction_onset = value; },
          "1/m, the change of curvature within which the friction sets in")
      .def_property(
          "bending", [](const Fabric& fabric) { return name_of(fabric.weave.bending); },
          [](Fabric& fabric, const std::string& name) { fabric.weave.bending = bending_named(name); },
          "'plate', 'hinges' or 'quadratic-hinges'")
      .def(
          "copy", [](const Fabric& fabric) { return Fabric(fabric); },
          "Another fabric with the same numbers.")
      .def("__copy__", [](const Fabric& fabric) { return Fabric(fabric); })
      .def("__deepcopy__", [](const Fabric& fabric, const py::object&) { return Fabric(fabric); })
      .def("__repr__", &text);

  py::class_<NamedFabric>(m, "NamedFabric",
                          "A fabric with its name, its source, and what nobody measured of it.")
      .def_readonly("name", &NamedFabric::name)
      .def_readonly("description", &NamedFabric::description)
      .def_readonly("source", &NamedFabric::source)
      .def_readonly("measured", &NamedFabric::measured, "keys that were measured")
      .def_readonly("converted", &NamedFabric::converted, "keys that follow from what was measured")
      .def_readonly("fitted", &NamedFabric::fitted, "keys with which virtual tests give what was measured")
      .def_readonly("assumed", &NamedFabric::assumed, "keys that nobody measured")
      .def_property_readonly(
          "measured_drape_coefficient",
          [](const NamedFabric& named) {
            return named.tests.drape ? Given(named.tests.drape->coefficient) : Given();
          },
          "from 0 to 1, of a drape test of the fabric; None: not known")
      .def_property_readonly(
          "measured_drape_nodes",
          [](const NamedFabric& named) { return named.tests.drape ? named.tests.drape->nodes : Given(); },
          "folds that were counted in it; None: not known")
      .def_property_readonly("fabric", [](const NamedFabric& named) { return Fabric(named.fabric); })
      .def("__repr__", [](const NamedFabric& named) {
        return "NamedFabric('" + named.name + "', " + text(named.fabric) + ")";
      });
  m.def("fabric_names", &fabric_names, "The names that load_fabric knows, sorted.");
  m.def(
      "load_fabric", [](const std::string& name) { return load_fabric(name); }, py::arg("name"),
      "A named fabric, or a fabric file: a path that ends in .toml. ValueError when there is none.");
  m.def("_set_data_folder", &set_data_folder, py::arg("folder"),
        "Where the package keeps its named fabrics.");
}

void add_soft_bodies(py::module_& m) {
  using namespace py::literals;
  py::class_<Lattice, std::shared_ptr<Lattice>>(m, "Lattice",
                                                "Particles on the corners of cells, joined by springs.")
      .def_property_readonly(
          "positions", [](const Lattice& lattice) { return copied_rows(lattice.positions); },
          "(n, 3) [m], of the particles")
      .def_property_readonly("particles", &Lattice::particle_count)
      .def("__repr__", [](const Lattice& lattice) {
        return "Lattice(" + counted(lattice.particle_count(), "particle") + ")";
      });
  m.def(
      "box_lattice",
      [](const std::array<int, 3>& particles, const Vec3& spacing) {
        for (const int count : particles)
          if (count < 2) throw py::value_error("particles: a lattice has at least 2 along each axis");
        if (!(spacing.minCoeff() > 0) || !spacing.allFinite())
          throw py::value_error("spacing: a spacing is greater than zero");
        return box_lattice(particles, spacing);
      },
      "particles"_a, "spacing"_a,
      "So many particles along x, y, z, at least 2, this far apart [m], centred.");
  m.def(
      "filled_lattice",
      [](const TriangleMesh& surface, double spacing) {
        if (!(spacing > 0)) throw py::value_error("spacing: a spacing is greater than zero");
        return filled_lattice(surface, spacing, "the mesh");
      },
      "surface"_a, "spacing"_a,
      "Cubes of this edge [m] inside a closed mesh. ValueError where it is not closed.");

  py::class_<SoftMaterial>(m, "SoftMaterial", "What a soft body is made of; SI units.")
      .def(py::init([](double density, Given mass, Given young, double structural, double shear, double bend,
                       double damping, const std::string& kind) {
             const SoftMaterial material{
                 density, mass, false, young, structural, shear, bend, damping, damping_kind(kind)};
             check(material);
             return material;
           }),
           py::kw_only(), "density"_a = 300.0, "mass"_a = py::none(), "young"_a = 20e3, "structural"_a = 0.0,
           "shear"_a = 0.0, "bend"_a = 0.0, "damping"_a = 0.0, "damping_kind"_a = "axial",
           "density [kg/m^3] or mass [kg] of the whole body; young [Pa], or None and the stiffness of every\n"
           "structural, shear and bend spring [N/m]; damping [N s/m].")
      .def_readonly("density", &SoftMaterial::density, "kg/m^3")
      .def_readonly("mass", &SoftMaterial::mass, "kg, of the whole body; replaces density")
      .def_readonly("young", &SoftMaterial::young, "Pa; replaces the three below")
      .def_readonly("structural", &SoftMaterial::structural, "N/m")
      .def_readonly("shear", &SoftMaterial::shear, "N/m")
      .def_readonly("bend", &SoftMaterial::bend, "N/m")
      .def_readonly("damping", &SoftMaterial::damping, "N s/m");
}

}  // namespace

void add_fabrics(py::module_& m) {
  using namespace py::literals;
  add_fabric(m);
  add_soft_bodies(m);

  py::class_<Forces>(m, "Forces", "Forces that were made and belong to no system yet: see System.add.")
      .def_property_readonly("names", &Forces::names)
      .def("__len__", [](const Forces& forces) { return forces.all.size(); })
      .def("__repr__", [](const Forces& forces) { return "Forces(" + listed(forces.names()) + ")"; });

  m.def(
      "masses", [](const TriangleMesh& mesh, const Fabric& fabric) { return copied(masses(mesh, fabric)); },
      "mesh"_a, "fabric"_a, "(n,) [kg]: lumped, weighted by neighbours if the fabric says so.");
  m.def(
      "masses",
      [](const Lattice& lattice, const SoftMaterial& material) { return copied(masses(lattice, material)); },
      "lattice"_a, "material"_a, "(n,) [kg]: an eighth of each cell to each of its corners.");
  m.def(
      "noh_jung",
      [](const TriangleMesh& mesh, const Fabric& fabric, int first) {
        return Forces{noh_jung(mesh, fabric, first)};
      },
      "mesh"_a, "fabric"_a, "first_particle"_a = 0,
      "Stretch, buckling and damping of any triangle mesh that rests as it is.\n"
      "[Noh & Jung, section 2; Choi & Ko 2002, eq. 9-13]\n"
      "Vertex 0 is the particle `first_particle` of the system.");
  m.def(
      "choi_ko",
      [](const TriangleMesh& mesh, const Fabric& fabric, int first) {
        return Forces{choi_ko(mesh, fabric, first)};
      },
      "mesh"_a, "fabric"_a, "first_particle"_a = 0,
      "The same for a regular grid of quads. [Choi & Ko 2002, section 3] ValueError when the mesh is none.");
  m.def(
      "woven",
      [](const TriangleMesh& mesh, const Fabric& fabric, const std::optional<Vec3>& warp, int first) {
        return Forces{woven(mesh, mesh, fabric, warp, first)};
      },
      "mesh"_a, "fabric"_a, "warp"_a = py::none(), "first_particle"_a = 0,
      "A membrane of triangles and a plate, of any triangle mesh that rests as it is, but flat where it is\n"
      "folded, unless fabric.rest_angle says otherwise. [Baraff & Witkin 1998, 4.2; Morley 1968] `warp` (3,) "
      "is a direction in the mesh, needed "
      "where\n"
      "the fabric differs along warp and weft. ValueError where the numbers make no law.");
  m.def(
      "air_drag",
      [](const TriangleMesh& mesh, const Vec3& wind, double density, double drag, double skin_friction,
         bool quads, int first) {
        const Air air{wind, density, drag, skin_friction};
        std::vector<std::unique_ptr<Force>> forces;
        forces.push_back(quads ? air_drag_of_quads(mesh, air, first) : air_drag(mesh, air, first));
        return Forces{std::move(forces)};
      },
      "mesh"_a, py::kw_only(), "wind"_a = Vec3(0, 0, 0), "density"_a = 1.2, "drag"_a = 1.2,
      "skin_friction"_a = 0.0, "quads"_a = false, "first_particle"_a = 0,
      "The air around a cloth: wind (3,) [m/s], density [kg/m^3], and the coefficients of a plate square to\n"
      "the wind and along it. `quads`: of a regular grid of quads, whose corners feel the same as they "
      "weigh\n"
      "(choi_ko_mass). ValueError where a value is negative or not finite, or the mesh no such grid.");
  m.def(
      "soft_body",
      [](const Lattice& lattice, const SoftMaterial& material, int first) {
        return Forces{soft_body(lattice, material, first)};
      },
      "lattice"_a, "material"_a, "first_particle"_a = 0, "Springs and damping of a lattice.");
}

}  // namespace drape::app::python
