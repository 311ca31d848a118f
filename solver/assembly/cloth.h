// A cloth or a soft body: what is simulated as particles and written as a mesh.
//   A cloth's vertices are particles, joined by the connections of its model. When a seam has been merged several
//   vertices are one particle. A soft body is a lattice of particles; its mesh is the surface of the lattice, or
//   another one that the lattice carries.
// ClothPart and SoftPart are plain data, which an Assembly (solver/assembly/assembly.h) makes a Cloth of.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "constraints/pins.h"
#include "constraints/pose.h"
#include "mesh/lattice/lattice.h"
#include "mesh/obj/examine.h"
#include "solver/assembly/seam.h"
#include "solver/forces/connections.h"
#include "solver/forces/soft.h"

namespace drape {

enum class ClothModel {
  noh_jung,  // of any triangle mesh (solver/forces/noh_jung.h)
  choi_ko    // of a regular grid of quads (solver/forces/choi_ko.h)
};

struct ClothPart {
  std::string name = "cloth";             // stands in messages
  TriangleMesh mesh;                      // as it starts
  std::optional<TriangleMesh> rest = {};  // as in solver/forces/noh_jung.h; unset: it rests as it starts
  Fabric fabric = {};
  ClothModel model = ClothModel::noh_jung;
  std::vector<SeamPlan> seams = {};
  std::optional<MeshReport> report = {};  // what examine() says of the mesh; unset: it is asked
};

struct SoftPart {
  std::string name = "soft";  // stands in messages
  Lattice lattice;
  SoftMaterial material = {};
  // A closed mesh that the lattice carries; its volume has the mass. Unset: the surface of the lattice, whose
  // cells have it.
  std::optional<TriangleMesh> mesh = {};
  Pose place = {};  // of lattice and mesh
};

// A pair of particles whose strain is watched, l / L - 1.
struct RestEdge {
  int i, j;
  double L;  // m
};

// Springs of a soft body.
struct LatticeCounts {
  int structural, shear, bend;
};

struct Cloth {
  std::string name;
  TriangleMesh mesh;  // as it starts
  MeshReport report;
  int first_particle = 0, end_particle = 0;  // of the system
  Embedding embedding;                       // of the mesh in the particles
  TriangleMesh rest;                         // its triangle k is the mesh's (solver/forces/noh_jung.h)
  std::vector<RestEdge> edges;

  Fabric fabric;  // of a cloth
  ClothModel model = ClothModel::noh_jung;
  double limp_below = 0;  // 1/m, the curvature below which it is limp (solver/forces/connections.h)

  std::optional<LatticeCounts> soft;       // set: a soft body, and no cloth
  std::shared_ptr<const Lattice> lattice;  // of a soft body
  SoftMaterial material;

  struct Stitched {
    OpenSeam seam;
    Force* force;  // of the system; null: there is nothing left to close
  };
  std::vector<Stitched> seams;  // that are open

  // Particle i is number[i] from now on.
  void renumber(const std::vector<int>& number);
};

// Largest relative stretch of an edge: max (l - L) / L; 0 when none is stretched.
double largest_strain(const std::vector<Cloth>& cloths, const VecX& x);

// The particles that a pin holds: those in its box; of vertices, all that carry them. Throws InputError when it
// selects nothing.
std::vector<int> pinned_particles(const PinRule& rule, const Cloth& cloth, const VecX& x);

}  // namespace drape
