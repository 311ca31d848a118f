// A woven fabric: a membrane of triangles of constant strain (solver/forces/membrane.h) and a plate without a
// clamp (solver/forces/plate.h). Y, G, B and Poisson's ratios come out as they are given on any mesh, along warp,
// weft and between.
//
// The warp runs along a direction of the rest shape, laid into the plane of every triangle. Where the fabric is
// the same along warp and weft, any direction will do and none has to be given. The rest shape may be cut where
// the cloth is sewn, as in solver/forces/noh_jung.h. It is flat: a fold of a rest shape in space is bent cloth.
#pragma once

#include <memory>
#include <optional>

#include "solver/forces/fabric.h"
#include "solver/forces/force.h"
#include "solver/forces/membrane.h"
#include "solver/forces/plate.h"

namespace drape {

// Both throw InputError, which names the field, where the numbers make no law.
Membrane::Common membrane_of(const Fabric& fabric);
PlateStiffness plate_of(const Fabric& fabric);

// True when the fabric differs along warp and weft, so that it has to be known which is which.
bool has_directions(const Fabric& fabric);

// The corners of every triangle of the rest shape in its own plane, u along the warp [m]. Throws InputError
// when a triangle is square to the direction `warp`.
std::vector<Corners> woven_corners(const TriangleMesh& rest, const std::optional<Vec3>& warp);

// Vertex 0 is the particle `first_particle` of the system. Triangles without area give no force. Throws
// InputError when the fabric has directions and `warp` is missing.
std::vector<std::unique_ptr<Force>> woven(const TriangleMesh& mesh, const TriangleMesh& rest,
                                          const Fabric& fabric, const std::optional<Vec3>& warp = {},
                                          int first_particle = 0);

}  // namespace drape
