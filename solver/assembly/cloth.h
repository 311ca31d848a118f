// A cloth, a soft body or a rope: it is simulated as particles and written as a mesh.
//   The vertices of a cloth are particles, joined by the connections of its model. When a seam has been
//   merged, several vertices are one particle. A soft body is a lattice of particles; its mesh is the surface
//   of the lattice, or another one that the lattice carries.
//   The points of a rope are particles; its mesh has a line ('l' of an OBJ file) and no triangles.
// ClothPart, SoftPart and RopePart are plain data from which an Assembly (solver/assembly/assembly.h) makes a
// Cloth.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "constraints/pins.h"
#include "constraints/pose.h"
#include "mesh/lattice/lattice.h"
#include "mesh/obj/examine.h"
#include "mesh/tetrahedra/tetrahedral_mesh.h"
#include "solver/assembly/seam.h"
#include "solver/assembly/tearing.h"
#include "solver/forces/connections.h"
#include "solver/forces/plate_friction.h"
#include "solver/forces/rope.h"
#include "solver/forces/soft.h"
#include "solver/forces/woven.h"

namespace drape {

enum class ClothModel {
  noh_jung,  // springs, for any triangle mesh (solver/forces/noh_jung.h)
  choi_ko,   // springs, for a regular grid of quads (solver/forces/choi_ko.h)
  woven      // membrane and plate, for any triangle mesh (solver/forces/woven.h)
};

// How a cloth or a soft body meets itself and others that have this (constraints/self_contact.h). A soft body
// is met at the surface of its lattice.
struct SelfContactOptions {
  double thickness = 1e-3;  // m: two layers rest at the mean of their thicknesses
  double friction = 0.3;    // mu: between two cloths the root of the product of both
  // What is worn over what, from the inside out (SelfFace::layer), of a cloth or of groups of its mesh. A
  // layer starts 5 um farther out than the one below it, so that sheets at one place have an order, too.
  std::optional<int> layer = {};
  struct Group {
    std::string group;
    int layer;
  };
  std::vector<Group> group_layers = {};
};

struct ClothPart {
  std::string name = "cloth";             // used in messages
  TriangleMesh mesh;                      // as the cloth starts
  std::optional<TriangleMesh> rest = {};  // as in solver/forces/noh_jung.h; unset: as the cloth starts
  Fabric fabric = {};
  ClothModel model = ClothModel::noh_jung;
  std::optional<Vec3> warp = {};            // direction in the rest shape, of a woven cloth
  std::vector<GroupWarp> group_warps = {};  // the same of groups of the mesh, instead of that
  // How far the start is off `mesh` [m] (solver/assembly/imperfection.h). Unset: woven_imperfection of a
  // woven cloth, 0 of the others.
  std::optional<double> imperfection = {};
  std::vector<SeamPlan> seams = {};
  // Whether each face is a cluster in place of what stretches (solver/forces/face_clusters.h).
  bool clusters = false;
  // Whether vertices at exactly the same place become one particle; false: only those that edges of no length
  // join do, of cloth with self_contact.
  bool weld = false;
  std::optional<SelfContactOptions> self_contact = {};  // unset: the cloth passes through cloth
  // The strain l / L - 1 of an edge above which the cloth tears there (solver/assembly/tear_rule.h); unset:
  // it never tears.
  std::optional<double> tear = {};
  std::optional<MeshReport> report = {};  // what examine() says of the mesh; unset: examine() is called
};

// Clusters that hold a soft body together in place of springs (solver/forces/cluster.h).
struct SoftClusters {
  int count = 0;  // that overlap; 0: one for each cell or tetrahedron
};

struct SoftPart {
  std::string name = "soft";  // used in messages
  Lattice lattice;
  // Tetrahedra in place of the lattice: their vertices are the particles, and the mesh is their surface.
  std::optional<TetrahedralMesh> tetrahedra = {};
  std::optional<SoftClusters> clusters = {};  // unset: springs
  SoftMaterial material = {};
  // A closed mesh that the lattice carries; the mass is that of its volume. Unset: the mesh is the surface of
  // the lattice, and the mass is that of the cells.
  std::optional<TriangleMesh> mesh = {};
  Pose place = {};                                      // where lattice and mesh are placed
  std::optional<SelfContactOptions> self_contact = {};  // unset: cloth passes through it
};

// How a rope meets itself, other ropes, cloths and soft bodies that have the like
// (constraints/self_contact.h): as thick as its material's radius says.
struct RopeContact {
  double friction = 0.3;  // mu: as in SelfContactOptions
};

struct RopePart {
  std::string name = "rope";  // used in messages
  std::vector<Vec3> points;   // m, as the rope starts, which is as long as it rests
  RopeMaterial material = {};
  // An end that is joined is that particle of a part that was added before, and starts where it is.
  std::optional<int> first = {}, last = {};
  std::optional<RopeContact> self_contact = {};  // unset: it passes through all but rigid bodies
};

// A pair of particles whose strain l / L - 1 [-] is watched.
struct RestEdge {
  int i, j;
  double L;  // length at rest [m]
};

// How many springs of each kind a soft body has.
struct LatticeCounts {
  int structural, shear, bend;
};

struct Cloth {
  std::string name;
  TriangleMesh mesh;  // as the cloth starts, with the borders that it has now
  MeshReport report;
  int first_particle = 0, end_particle = 0;  // particles of the system
  Embedding embedding;                       // of the mesh in the particles
  TriangleMesh rest;                         // its triangle k is that of the mesh (solver/forces/noh_jung.h)
  std::vector<RestEdge> edges;

  Fabric fabric;  // of a cloth
  ClothModel model = ClothModel::noh_jung;
  std::vector<Vec3> warp;  // direction in the rest shape, of each triangle; [0, 0, 0] where nothing says it
  bool face_clusters = false;  // in place of what stretches
  // Vertices that become one particle when the system is made: those that ClothPart::weld names, or of cloth
  // with self_contact those that edges of no length join, because two points at one place have no sides on
  // which other cloth could be kept. (Grids of choi_ko stay as they are.)
  std::vector<std::pair<int, int>> at_one_place;
  double imperfection = 0;             // m, how far the start is off `mesh`
  std::shared_ptr<BendMemory> memory;  // of a woven cloth whose threads rub
  std::optional<Tearing> tearing;      // set: it may tear; copies of vertices come after the others
  double limp_below = 0;  // curvature [1/m] below which the cloth is limp (solver/forces/connections.h)

  std::optional<LatticeCounts> soft;  // set: this is a soft body and no cloth
  // One of these, of a soft body.
  std::shared_ptr<const Lattice> lattice;
  std::shared_ptr<const TetrahedralMesh> tetrahedra;
  std::optional<SoftClusters> clusters;
  SoftMaterial material;
  std::optional<RopeMaterial> rope;  // set: this is a rope and no cloth

  struct Stitched {
    OpenSeam seam;
    Force* force;  // owned by the system; null: there is nothing left to close
  };
  std::vector<Stitched> seams;  // those that are open

  // Particle i gets the number number[i]; several may get the same.
  void renumber(const std::vector<int>& number);
};

// Largest relative stretch of an edge: max (l - L) / L; 0 when none is stretched.
double largest_strain(const std::vector<Cloth>& cloths, const VecX& x);

// The two factors by which the rest shape of a triangle is stretched, less 1: negative where it is
// compressed.
struct PrincipalStrains {
  double least, largest;
  double area, area_at_rest;  // m^2
};
// Nothing where the triangle is sewn shut or has no area at rest.
std::optional<PrincipalStrains> principal_strains(const Cloth& cloth, std::size_t triangle, const VecX& x);

// The strain that every particle of the system is shown with: of a woven cloth, of the principal strains of
// the triangles there, and of springs, of l / L - 1 of the edges there, the one of larger magnitude, with its
// sign. 0 where nothing meets.
void particle_strains(const Cloth& cloth, const VecX& x, std::vector<double>& strain);

// How the triangles of all cloths are strained, by their principal strains.
struct TriangleStrains {
  double least = 0, largest = 0;  // over all triangles; 0 where none is compressed, or none stretched
  double first_percent = 0;       // one triangle in a hundred is compressed further
  double area_least = 1;          // the least share of its area at rest that a triangle has kept
  double area_kept = 1;           // area of all over area at rest
};
// `smallest` is scratch: on return it has the smaller principal strain of every triangle, in some order.
TriangleStrains triangle_strains(const std::vector<Cloth>& cloths, const VecX& x,
                                 std::vector<double>& smallest);

// The particles that a pin holds: a box holds those inside it, and a choice of vertices all that carry them.
// Throws InputError when the rule selects nothing.
std::vector<int> pinned_particles(const PinRule& rule, const Cloth& cloth, const VecX& x);

}  // namespace drape
