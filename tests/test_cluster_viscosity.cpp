// Laws of the viscosity of clusters: it takes the energy of the deformation as told, and leaves rigid motion
// as it is.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <complex>
#include <numeric>

#include "solver/forces/cluster_body.h"
#include "solver/forces/cluster_force.h"
#include "solver/integrators/integrator.h"
#include "tests/clusters.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double k = 4e4;  // 1/s^2

struct Body {
  Lattice lattice;
  System system;
  Constraints constraints;
  State state;
  std::vector<double> own;

  Body(const std::array<int, 3>& size, int clusters, double viscosity, double stiffness = k)
      : lattice(box_lattice(size, Vec3::Constant(0.1))),
        system(masses(lattice, SoftMaterial{})),
        state{0, stacked(lattice.positions), VecX::Zero(3 * lattice.particle_count())},
        own(system.masses()) {
    std::vector<std::pair<int, int>> pairs;
    for (const LatticePair& p : lattice.structural) pairs.emplace_back(p.i, p.j);
    system.add(std::make_unique<ClusterForce>(
        Clusters(overlapping_sets(lattice.positions, pairs, clusters, 1, "body"), own, state.x, "body"),
        stiffness, viscosity));
    system.add(Gravity{Vec3::Zero()});
  }
  void run(int substeps, double h, int steps) {
    StepOptions options;
    options.projection.substeps = substeps;
    auto stepper = make_integrator("pbd", system, constraints, make_linear_solver("mpcg"), options);
    for (int n = 0; n < steps; ++n) REQUIRE(stepper->advance(state, h).done);
  }
  Vec3 place(int i) const { return state.x.segment<3>(3 * i); }
  Vec3 sum(const VecX& u, bool angular) const {
    Vec3 all = Vec3::Zero();
    for (int i = 0; i < system.particles(); ++i) {
      const Vec3 p = own[static_cast<std::size_t>(i)] * u.segment<3>(3 * i);
      all += angular ? place(i).cross(p) : p;
    }
    return all;
  }
};

}  // namespace

TEST_CASE("a cluster that swells swings and dies away as a damped oscillator does", "[clusters][pbd]") {
  const double omega = std::sqrt(k);
  for (const double tau : {0.0, 1e-3, 4e-3, 3e-2}) {  // the last one is overdamped
    Body body({3, 3, 3}, 1, tau);
    const VecX rest = body.state.x;
    body.state.x *= 1.1;
    const double rate = omega * omega * tau / 2, t = 0.02;
    body.run(2000, t, 1);
    const std::complex<double> root = std::sqrt(std::complex<double>(rate * rate - omega * omega)),
                               p = -rate + root, q = -rate - root;
    const double expected = 0.1 * ((p * std::exp(q * t) - q * std::exp(p * t)) / (p - q)).real();
    INFO("tau = " << tau);
    CHECK((body.state.x - rest).dot(rest) / rest.squaredNorm() == Approx(expected).margin(0.001));
  }
}

TEST_CASE("the energy of a body that swings dies away as told, however many clusters it has",
          "[clusters][pbd]") {
  for (const int clusters : {1, 4, 9}) {
    const auto energy = [&](double tau) {
      Body body({4, 4, 4}, clusters, tau);
      const VecX u = random_vector(body.state.x.size(), 0.3, 3);
      body.state.v = u;
      body.run(4000, 0.1, 1);
      return body.system.total_energy(body.state);
    };
    INFO(clusters << " clusters");
    CHECK(energy(1e-3) < energy(2e-4));
    CHECK(energy(2e-4) < energy(0));
    if (clusters > 1) continue;  // of one all modes have the same frequency
    Body free({4, 4, 4}, 1, 0);
    free.state.v = random_vector(free.state.x.size(), 0.3, 3);
    const auto cluster = Clusters({[&] {
                                    std::vector<int> all(static_cast<std::size_t>(free.system.particles()));
                                    std::iota(all.begin(), all.end(), 0);
                                    return all;
                                  }()},
                                  free.own, free.state.x, "all");
    const ClusterBody b = body_of(cluster[0], free.state.x);
    const ClusterMotion m = motion_of(cluster[0], b, free.state.x, free.state.v);
    VecX rigid = free.state.v;
    for (int i = 0; i < free.system.particles(); ++i)
      rigid.segment<3>(3 * i) = m.at(Vec3(free.place(i) - b.centre));
    const double kept = free.system.kinetic_energy(rigid), all = free.system.kinetic_energy(free.state.v);
    // Kinetic and elastic energy together fall with exp(-k tau t); what the method itself takes is the same
    // with and without.
    for (const double tau : {2e-4, 5e-4})
      CHECK((energy(tau) - kept) / (energy(0) - kept) == Approx(std::exp(-k * tau * 0.1)).epsilon(0.05));
    CHECK(kept < 0.5 * all);
  }
}

TEST_CASE("viscosity resists no rigid motion: a shape that is kept is not pulled", "[clusters][pbd]") {
  for (const int clusters : {1, 5}) {
    for (const double tau : {0.0, 0.01, 1.0}) {
      Body body({3, 4, 3}, clusters, tau);
      const Quaternion turn(Eigen::AngleAxisd(0.2, Vec3(1, 2, 3).normalized()));
      const VecX start = body.state.x;
      VecX moved = start;
      for (int i = 0; i < body.system.particles(); ++i)
        moved.segment<3>(3 * i) = turn * Vec3(start.segment<3>(3 * i)) + Vec3(0.1, 0.2, 0.3);
      body.state.v = (moved - start) / 0.01;
      body.run(1, 0.01, 1);
      INFO(clusters << " clusters, tau = " << tau);
      CHECK((body.state.x - moved).cwiseAbs().maxCoeff() < 1e-13);
    }
    // A body that turns: with and without viscosity it keeps the same momentum and spin.
    std::array<Vec3, 2> turning, going;
    for (const int viscous : {0, 1}) {
      Body body({3, 4, 3}, clusters, viscous * 0.005);
      for (int i = 0; i < body.system.particles(); ++i)
        body.state.v.segment<3>(3 * i) = Vec3(0.1, -0.2, 0.3) + Vec3(0.5, 0.2, -0.3).cross(body.place(i));
      body.run(20, 0.01, 30);
      turning[static_cast<std::size_t>(viscous)] = body.sum(body.state.v, true);
      going[static_cast<std::size_t>(viscous)] = body.sum(body.state.v, false);
    }
    CHECK((turning[1] - turning[0]).norm() < 1e-4 * turning[0].norm());
    CHECK((going[1] - going[0]).norm() < 1e-12 * going[0].norm());
  }
}

TEST_CASE("viscosity of clusters keeps momentum and angular momentum to round-off", "[clusters]") {
  for (const int clusters : {1, 6}) {
    Body body({4, 3, 5}, clusters, 0.02);
    body.state.x += random_vector(body.state.x.size(), 0.01, 7);
    const VecX v = random_vector(body.state.x.size(), 1, 8);
    VecX with = VecX::Zero(v.size()), without = with;
    body.system.forces()[0]->add_force(body.state.x, v, with);
    body.system.forces()[0]->add_force(body.state.x, 0 * v, without);
    const VecX drag = with - without;
    CHECK(drag.norm() > 1);
    CHECK(drag.dot(v) < 0);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    for (int i = 0; i < body.system.particles(); ++i) {
      force += drag.segment<3>(3 * i);
      moment += body.place(i).cross(Vec3(drag.segment<3>(3 * i)));
    }
    CHECK(force.norm() < 1e-12 * drag.norm());
    CHECK(moment.norm() < 1e-12 * drag.norm());
  }
}
