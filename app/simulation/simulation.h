// A scene made ready to run: the meshes loaded and examined, one system for all cloths, their
// pins, and the obstacles.
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

// Two particles whose strain l / L - 1 is watched; l is their distance.
struct RestEdge {
  int i, j;
  double L;  // m
};

// How many springs of each kind a soft body has.
struct LatticeCounts {
  int structural, shear, bend;
};

// A cloth or a soft body: it is simulated as particles and written as a mesh.
struct Cloth {
  std::string name;
  TriangleMesh mesh;  // as the file has it, after the placement
  MeshReport report;
  int first_particle = 0, end_particle = 0;  // its particles in the system: first <= i < end
  Embedding embedding;                       // where the vertices of the mesh are among the particles
  TriangleMesh rest;  // rest shape; its triangle k is the mesh's triangle k (solver/forces/noh_jung.h)
  std::vector<RestEdge> edges;
  std::optional<LatticeCounts> soft;  // set for a soft body, empty for a cloth
  // Of a soft body: makes its springs.
  std::function<std::vector<std::unique_ptr<Force>>(int first_particle)> springs;

  struct Stitched {
    OpenSeam seam;
    Force* force;  // part of the system; null when nothing is left to close
  };
  std::vector<Stitched> seams;  // the seams that are still open

  // Renames the particles: particle i becomes number[i].
  void renumber(const std::vector<int>& number);
};

// A mesh or level set of an obstacle as it was loaded, for `drape check`.
struct Body {
  std::string name;
  MeshReport report;      // of a mesh; for a level set from a .vdb file it has the box only
  std::string level_set;  // of a level set: its voxels and its error, in words
};

struct Simulation {
  std::vector<Cloth> cloths;  // the cloths of the scene, then its soft bodies
  std::vector<Body> bodies;
  std::unique_ptr<System> system;
  std::unique_ptr<Constraints> constraints;
  std::unique_ptr<Integrator> integrator;  // refers to the two above
  State state;
  // States from before particles were merged. They are kept because arrays of Python may still refer to them.
  std::vector<State> outgrown;
  Names messages;                      // one line each, "warning: ..." or "note: ..."
  std::shared_ptr<const Scene> scene;  // the scene that it was made from
  // Makes the integrator: at the start, and again whenever particles have been merged.
  std::function<std::unique_ptr<Integrator>(System&, Constraints&)> make_integrator;

  // Energy [J] that the seams have put in so far: their pull, and what the cloth gains when
  // particles are merged.
  double given = 0;

  // Computes one step of h [s]. Seams go on closing, and those that have closed are merged.
  StepReport advance(double h);
  // Uses another integrator from now on.
  void use(std::function<std::unique_ptr<Integrator>(System&, Constraints&)> make);

  // The cloth or soft body that has this particle.
  const Cloth& cloth_of(int particle) const;
};

// Throws InputError when a mesh cannot be read or simulated, or when a pin selects nothing. keep_level_sets:
// whether a level set that had to be made is kept beside its mesh (app/scene/level_set_cache.h).
Simulation make_simulation(const Scene& scene, bool keep_level_sets = true);

}  // namespace drape
