// Bodies of one stiff cluster each, and what laws of rigid bodies ask of them.
#pragma once

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "mesh/triangles/generate.h"
#include "solver/forces/cluster_body.h"
#include "solver/forces/cluster_force.h"
#include "solver/forces/noh_jung.h"
#include "solver/forces/self_contact_force.h"
#include "solver/forces/soft.h"
#include "solver/integrators/integrator.h"
#include "tests/clusters.h"
#include "tests/tables.h"

namespace drape::test {

inline constexpr double stiff = 1e10;  // 1/s^2
inline constexpr double g = 9.81;

// Bodies of one cluster each, which are sets of particles after one another.
struct Bodies {
  std::vector<Vec3> places;
  std::vector<double> own;
  ParticleSets sets;
  std::unique_ptr<System> system;
  Constraints constraints;
  State state;
  double k = stiff;
  std::vector<SelfFace> faces;       // of the boxes
  bool meet = false, apart = false;  // apart: each body has a force of its own
  StepReport report;                 // of the last step
  TriangleMesh sheet;
  int sheet_first = 0;
  Fabric cloth = {.area_density = 0.2, .stretch = 2000, .bend = 1e-5, .damping = 1e-3};

  void add(const std::vector<Vec3>& points, const std::vector<double>& mass) {
    sets.emplace_back();
    for (std::size_t i = 0; i < points.size(); ++i) {
      sets.back().push_back(static_cast<int>(places.size()));
      places.push_back(points[i]);
      own.push_back(mass[i]);
    }
  }
  // A box of particles that is turned and moved.
  void add_box(const std::array<int, 3>& counts, const Quaternion& turn, const Vec3& at, double edge = 0.1,
               double density = SoftMaterial{}.density) {
    const Lattice box = box_lattice(counts, Vec3::Constant(edge));
    const int first = static_cast<int>(places.size()), number = static_cast<int>(sets.size());
    std::vector<Vec3> points;
    for (const Vec3& x : box.positions) points.push_back(turn * x + at);
    SoftMaterial material;
    material.density = density;
    add(points, masses(box, material));
    std::vector<int> on_surface;
    for (Triangle t : surface_of(box, on_surface).triangles) {
      for (int& v : t) v = first + on_surface[static_cast<std::size_t>(v)];
      faces.push_back({t, 0, 0, number});
    }
  }
  // A square sheet of springs about the point `at`, whose particles follow those of the boxes; it is in no
  // cluster.
  void add_sheet(int n, double size, const Vec3& at) {
    sheet_first = static_cast<int>(places.size());
    sheet = grid(n, n, size, size);
    for (Vec3& x : sheet.positions) {
      x += at;
      places.push_back(x);
    }
    for (const double m : masses(sheet, cloth)) own.push_back(m);
    for (const Triangle& t : sheet.triangles)
      faces.push_back({{sheet_first + t[0], sheet_first + t[1], sheet_first + t[2]}, 0, 0, 1000});
  }
  // All of these keep this distance [m], and rub.
  void let_meet(double thickness, double friction) {
    for (SelfFace& face : faces) face.thickness = thickness, face.friction = friction;
    constraints.add_self_faces(faces);
    meet = true;
  }
  void make(const Vec3& gravity) {
    system = std::make_unique<System>(own);
    state = {0, stacked(places), VecX::Zero(3 * static_cast<Eigen::Index>(places.size()))};
    if (apart)
      for (const std::vector<int>& set : sets)
        system->add(std::make_unique<ClusterForce>(Clusters({set}, own, stacked(places), "bodies"), k));
    else
      system->add(std::make_unique<ClusterForce>(clusters(), k));
    system->add(Gravity{gravity});
    if (sheet.vertex_count() > 0)
      for (auto& force : noh_jung(sheet, cloth, sheet_first)) system->add(std::move(force));
    if (meet) system->add(self_contact_force(constraints));
  }
  Clusters clusters() const { return Clusters(sets, own, stacked(places), "bodies"); }
  ClusterBody body(int b) const { return body_of(clusters()[b], state.x); }
  ClusterMotion motion(int b) const { return motion_of(clusters()[b], body(b), state.x, state.v); }
  Mat3 inertia(int b) const { return inertia_of(clusters()[b], body(b).centre, state.x); }
  void move(int b, const Vec3& velocity, const Vec3& spin) {
    const Vec3 c = body(b).centre;
    for (const int i : sets[static_cast<std::size_t>(b)])
      state.v.segment<3>(3 * i) = velocity + spin.cross(Vec3(state.x.segment<3>(3 * i)) - c);
  }
  double kinetic() const { return system->kinetic_energy(state.v); }
  void run(double h, int steps, const std::string& contact, int substeps = 20) {
    StepOptions options;
    options.projection.substeps = substeps;
    options.contact = contact == "restitution" ? ContactMode::restitution : ContactMode::velocity;
    auto stepper = make_integrator("pbd", *system, constraints, make_linear_solver("mpcg"), options);
    for (int n = 0; n < steps; ++n) {
      INFO("step " << n);
      report = stepper->advance(state, h);
      REQUIRE(report.done);
    }
  }
};

inline const Quaternion level = Quaternion::Identity();

}  // namespace drape::test
