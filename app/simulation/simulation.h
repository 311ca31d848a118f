// A scene made ready to run: meshes loaded and looked over, one system of all cloths,
// their pins and obstacles.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/load_mesh.h"
#include "app/simulation/sewing.h"
#include "mesh/lattice/embedding.h"
#include "mesh/obj/examine.h"
#include "solver/integrators/integrator.h"

namespace drape {

// A pair of particles whose strain is watched, l / L - 1.
struct RestEdge {
  int i, j;
  double L;  // m
};

// Springs of a soft body.
struct LatticeCounts {
  int structural, shear, bend;
};

// What is simulated as particles and written as a mesh.
struct Cloth {
  std::string name;
  TriangleMesh mesh;  // as the file has it, placed
  MeshReport report;
  int first_particle = 0, end_particle = 0;  // of the system
  Embedding embedding;                       // of the mesh in the particles
  TriangleMesh rest;                         // its triangle k is the mesh's (solver/forces/noh_jung.h)
  std::vector<RestEdge> edges;
  std::optional<LatticeCounts> soft;  // a soft body, and no cloth
  std::function<std::vector<std::unique_ptr<Force>>(int first_particle)> springs;  // of a soft body

  struct Stitched {
    OpenSeam seam;
    Force* force;  // of the system; null: there is nothing left to close
  };
  std::vector<Stitched> seams;  // that are open

  // Particle i is number[i] from now on.
  void renumber(const std::vector<int>& number);
};

// A mesh or an obstacle as it was loaded, for `drape check`.
struct Body {
  std::string name;
  MeshReport report;      // of a mesh; of a level set from a .vdb file only the box
  std::string level_set;  // of a level set: its voxels and its error
};

struct Simulation {
  std::vector<Cloth> cloths;  // those of the scene, then its soft bodies
  std::vector<Body> bodies;
  std::unique_ptr<System> system;
  std::unique_ptr<Constraints> constraints;
  std::unique_ptr<Integrator> integrator;  // refers to the two above
  State state;
  std::vector<State> outgrown;         // as it was when particles became one: arrays may look at it still
  Names messages;                      // "warning: ..." and "note: ...", one line each
  std::shared_ptr<const Scene> scene;  // what it was made from
  // Makes the integrator, now and again when particles have become one.
  std::function<std::unique_ptr<Integrator>(System&, Constraints&)> make_integrator;

  double given = 0;  // J, by seams so far: their pull, and what the cloth gets when they are merged

  // One step, h [s]. Seams go on closing; those that have closed are merged.
  StepReport advance(double h);
  // Takes another integrator from now on.
  void use(std::function<std::unique_ptr<Integrator>(System&, Constraints&)> make);

  const Cloth& cloth_of(int particle) const;
};

// Throws InputError when a mesh cannot be read or simulated, or a pin selects nothing. Level sets that are
// made are kept beside their meshes (app/scene/level_set_cache.h), or not.
Simulation make_simulation(const Scene& scene, bool keep_level_sets = true);

}  // namespace drape
