// The sheet of `drape compare --sizes`: 1 m x 1 m, pinned at two corners, a grid of any number of vertices.
#pragma once

#include "app/simulation/simulation.h"

namespace drape::app {

// The scene of the sheet, without its mesh: 0.2 kg/m^2, stretch 2000 N/m, bend 10 uN.m, h = 0.01 s. Settings
// may change everything in it but the mesh.
Scene hung_sheet_scene(const std::vector<Setting>& settings);

int sheet_side(int vertices);  // number of vertices along an edge, for the nearest square

// The sheet of side x side vertices, with the simulation options and the fabric of the scene.
Simulation make_hung_sheet(const Scene& scene, int side);

}  // namespace drape::app
