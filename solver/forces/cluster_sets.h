// Which particles make a cluster (solver/forces/cluster.h): one set for each tetrahedron, cell or triangle,
// or n sets that overlap. All lists are the same on every machine and number of threads.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "mesh/lattice/lattice.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape {

using ParticleSets = std::vector<std::vector<int>>;

ParticleSets sets_of(const std::vector<std::array<int, 4>>& tetrahedra);
// The eight corners of each filled cell, in the order of the cells.
ParticleSets sets_of_cells(const Lattice& lattice);
// The corners of every triangle that counts (mesh/triangles/topology.h).
ParticleSets sets_of_faces(const TriangleMesh& mesh);

// `count` sets of particles that lie together, by k-means: the first seed is the particle farthest from the
// middle of all, each further one the farthest from the seeds before it; then every particle goes to the
// nearest centre and every centre to the middle of its particles, until nothing changes [Lloyd 1982; the
// seeds: Gonzalez 1985]. A centre that loses all of its particles to others on the way, which is rare, makes
// no set.
// Then each set takes in the particles that `pairs` join to one of its own, `rings` times, so that neighbours
// overlap. Where two are equally far or near the one with the lower number is taken.
// Throws InputError, after `name`, when count is below 1 or above the number of different places.
ParticleSets overlapping_sets(const std::vector<Vec3>& positions,
                              const std::vector<std::pair<int, int>>& pairs, int count, int rings,
                              const std::string& name);

}  // namespace drape
