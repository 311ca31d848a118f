// A woven fabric: a membrane of triangles of constant strain (solver/forces/membrane.h) and a plate without a
// clamp (solver/forces/plate.h). Y, G, B and Poisson's ratios come out as they are given on any mesh, along
// warp, weft and between. B is that of a strip so wide that it does not curve across as well. With hinges in
// place of the plate (Weave::bending, solver/forces/hinge.h) B depends on where the edges run.
//
// The warp runs along a direction of the rest shape, laid into the plane of every triangle. Where the law is
// the same in all directions, none has to be given. The rest shape may be cut where the cloth is sewn, as in
// solver/forces/noh_jung.h. The plate rests flat, whatever folds the rest shape has in space, or with a share
// of the angles that the mesh itself has (Weave::rest_angle). Its threads may rub when they are bent
// (Weave::bend_friction).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "solver/forces/fabric.h"
#include "solver/forces/force.h"
#include "solver/forces/plate.h"
#include "solver/forces/plate_friction.h"

namespace drape {

// Of a fabric that check() takes. plate_of throws InputError where bend_bias is too small.
PlateStiffness plate_of(const Fabric& fabric);
PlateFrictionLaw plate_friction_of(const Fabric& fabric);
double least_bend_bias(const Fabric& fabric);  // N m; bend_bias is greater

// True when the fabric differs along warp and weft, so that it has to be known which is which.
bool has_directions(const Fabric& fabric);
// True when the law depends on where the warp runs: also where wrinkles or viscosity follow the threads.
bool needs_warp(const Fabric& fabric);

// The warp of a group of the mesh: a direction in the rest shape.
struct GroupWarp {
  std::string group;
  Vec3 direction;
};

// The corners of every triangle of the rest shape in its own plane, u along the warp [m]. `warp` has a
// direction for every triangle, [0, 0, 0] where any will do; empty: any for all. Throws InputError when a
// triangle is square to its direction.
std::vector<RestCorners> woven_corners(const TriangleMesh& rest, const std::vector<Vec3>& warp);

// Vertex 0 is the particle `first_particle` of the system. Triangles without area only hold together
// (solver/forces/held_corner.h). `memory` is that of friction against bending, of these triangles; null: a
// new one. Throws InputError when the fabric has directions and `warp` is missing.
std::vector<std::unique_ptr<Force>> woven(const TriangleMesh& mesh, const TriangleMesh& rest,
                                          const Fabric& fabric, const std::optional<Vec3>& warp = {},
                                          int first_particle = 0,
                                          std::shared_ptr<BendMemory> memory = nullptr);
// The same with a direction for every triangle; [0, 0, 0]: not known.
std::vector<std::unique_ptr<Force>> woven(const TriangleMesh& mesh, const TriangleMesh& rest,
                                          const Fabric& fabric, const std::vector<Vec3>& warp,
                                          int first_particle = 0,
                                          std::shared_ptr<BendMemory> memory = nullptr);

}  // namespace drape
