// The sheet of `drape compare --sizes`: 1 m x 1 m, two corners pinned, a grid of any number of vertices.
#pragma once

#include "app/simulation/simulation.h"

namespace drape {

// A scene of it without its mesh: 0.2 kg/m^2, stretch 2000 N/m, bend 10 uN.m, h = 0.01 s. Settings may change
// it, but not its mesh.
Scene hung_sheet_scene(const std::vector<Setting>& settings);

int sheet_side(int vertices);  // how many vertices along an edge: the nearest square

// The sheet of side x side vertices, with the simulation options and the fabric of the scene.
Simulation make_hung_sheet(const Scene& scene, int side);

}  // namespace drape
