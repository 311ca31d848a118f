#include "solver/forces/membrane.h"

#include <cmath>

namespace drape {

Membrane::Common membrane_of(const Fabric& fabric) {
  const Weave& weave = fabric.weave;
  const double warp = fabric.stretch, weft = weave.stretch_weft.value_or(warp), mean = std::sqrt(warp * weft),
               nu = weave.poisson, full = 1 / (1 - nu * nu);
  return {.warp = warp,
          .weft = weft,
          .cross = nu * mean,
          .uu = full * warp,
          .uv = full * nu * mean,
          .vv = full * weft,
          .shear = weave.shear.value_or(mean / (2 * (1 + nu))),
          .compression = weave.compression,
          .stretch_time = weave.stretch_time,
          .shear_time = weave.shear_time};
}

}  // namespace drape
