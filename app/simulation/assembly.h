// The particles of a scene: cloths and soft bodies are loaded, and one system is made of them, again whenever
// a seam has closed.
#pragma once

#include "app/simulation/simulation.h"
#include "app/simulation/soft_body.h"

namespace drape {

struct Particles {
  std::vector<double> masses;         // kg
  std::vector<ClothFace> soft_faces;  // of soft bodies
};

// Fills in the cloths, and the state at the start.
Particles load_particles(const Scene& scene, Simulation& simulation);

// Corners and rims of bodies are kept off the inside of triangles, too.
void add_faces(const Scene& scene, const Particles& particles, Simulation& simulation);

// The system of all that is simulated, as it is sewn by now.
void assemble(Simulation& simulation, std::vector<double> masses, Names& messages);

// Seams that have closed: their particles become one, and the cloth one piece. False: there were none.
bool merge_closed_seams(Simulation& simulation);

}  // namespace drape
