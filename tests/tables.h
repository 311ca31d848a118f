// What several tests need: reference tables, random states with fixed seeds, small systems.
#pragma once

#include <string>
#include <vector>

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
#include "tests/places.h"

namespace drape::test {

// Rows of numbers of data/reference/NAME: comments and the header are passed over.
std::vector<std::vector<double>> reference_table(const std::string& name);

VecX random_vector(Eigen::Index n, double size, unsigned seed);

Mat3 rotation(double angle, const Vec3& axis);

VecX moved_rigidly(const VecX& x, const Mat3& R, const Vec3& t);

// A chain of `links` springs of the same rest length along `direction` from the origin,
// lumped masses (half at the ends).
struct Chain {
  System system;
  State state;
  Constraints constraints;

  Chain(int links, double length, double mass, double stiffness, const Vec3& direction);
};

// A cloth of one fabric at rest, under gravity.
struct Sheet {
  TriangleMesh mesh;
  System system;
  Constraints constraints;
  State state;

  explicit Sheet(TriangleMesh m, const Fabric& fabric = {});

  ImplicitEuler stepper(const StepOptions& options = {});
  double energy() const;  // J
};

// 1 m x 1 m, flat at first, hung by two neighbouring corners.
struct HungSheet : Sheet {
  HungSheet(int side, double stretch, double bend);
};

bool same_bits(const VecX& a, const VecX& b);

struct ThreadsRestored {
  int before = threads();
  ~ThreadsRestored() { set_threads(before); }
};

double max_speed(const State& state);

}  // namespace drape::test
