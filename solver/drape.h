// The library in one header: #include <drape/drape.h>
#pragma once

#include "constraints/constraints.h"
#include "mesh/embedding.h"
#include "mesh/examine.h"
#include "mesh/flat_pattern.h"
#include "mesh/generate.h"
#include "mesh/lattice.h"
#include "mesh/mesh_frames.h"
#include "mesh/obj.h"
#include "mesh/quad_grid.h"
#include "mesh/threads.h"
#include "mesh/topology.h"
#include "solver/bdf.h"
#include "solver/choi_ko.h"
#include "solver/noh_jung.h"
#include "solver/soft.h"
#include "solver/system.h"
