// The library in one header: #include <drape/drape.h>
#pragma once

#include "constraints/constraints.h"
#include "mesh/base/threads.h"
#include "mesh/lattice/embedding.h"
#include "mesh/lattice/lattice.h"
#include "mesh/obj/examine.h"
#include "mesh/obj/obj.h"
#include "mesh/obj/quad_grid.h"
#include "mesh/pattern/flat_pattern.h"
#include "mesh/triangles/generate.h"
#include "mesh/triangles/mesh_frames.h"
#include "mesh/triangles/topology.h"
#include "solver/forces/choi_ko.h"
#include "solver/forces/noh_jung.h"
#include "solver/forces/soft.h"
#include "solver/integrators/bdf.h"
#include "solver/system/system.h"
