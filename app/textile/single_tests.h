// One specimen, one number: what `drape fit` compares with a measurement. Each returns NaN when the specimen
// did not come to rest. `edge` [m] is the longest edge of the mesh.
#pragma once

#include "app/textile/rig.h"

namespace drape::app {

// Where the middle of the free end of a strip of this length [m] hangs; the clamp ends at the origin. The
// strip is 25 mm wide, or four edges.
Vec3 hanging_tip(const Cut& cut, double length, double edge);

// The force per width [N/m] that holds a strip, kept flat between two clamps, at this strain.
double strip_load(const Cut& cut, double length, double width, double strain, double edge);

// The force [N] along the diagonal that holds a hinged square frame with this side [m], whose bars run along
// warp and weft, at a shear angle [rad]. The stored energy W and the distance d of the pulled corners give
// it:
//   F = (dW/dshear) / (dd/dshear),  d = sqrt(2) side (cos(shear/2) + sin(shear/2))
double frame_force(const Fabric& fabric, double side, double shear, double edge);

// G [N/m] of the frame's fabric by this law, whose stored energy is G sin^2(shear) / 2 per area.
double shear_of_frame(double side, double shear, double force);

}  // namespace drape::app
