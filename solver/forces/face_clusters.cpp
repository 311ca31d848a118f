#include "solver/forces/face_clusters.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "mesh/base/errors.h"
#include "mesh/triangles/topology.h"
#include "solver/forces/damping.h"
#include "solver/forces/noh_jung.h"
#include "solver/forces/woven.h"

namespace drape {
namespace {

using Axes = Eigen::Matrix<double, 3, 2>;
using Eigen::Matrix2d;

// R with R^T R = 1 that makes tr(R^T G) largest.
Axes polar(const Axes& G) {
  const Vec3 a = G.col(0), b = G.col(1);
  const double aa = a.squaredNorm(), ab = a.dot(b), bb = b.squaredNorm(), trace = aa + bb;
  const double root = a.cross(b).norm();  // of det(G^T G)
  constexpr double on_a_line = 1e-12;
  if (root > on_a_line * trace) {  // G (G^T G)^(-1/2), where sqrt(S) = (S + root 1) / sqrt(tr S + 2 root)
    const double scale = 1 / (root * std::sqrt(trace + 2 * root));
    Axes R;
    R.col(0) = scale * ((bb + root) * a - ab * b);
    R.col(1) = scale * ((aa + root) * b - ab * a);
    return R;
  }
  if (!(trace > 0)) return Axes::Identity();
  // G = s u w^T: u goes where w is, and across w any direction across u is as good.
  const Eigen::Vector2d w = (aa >= bb ? Eigen::Vector2d(aa, ab) : Eigen::Vector2d(ab, bb)).normalized();
  const Vec3 u = (G * w).normalized();
  Eigen::Index least;
  u.cwiseAbs().minCoeff(&least);
  const Vec3 across = (Vec3::Unit(least) - u[least] * u).normalized();
  return u * w.transpose() + across * Eigen::RowVector2d(-w[1], w[0]);
}

// F of the corners of a face in x, which may also be velocities.
Axes gradient(const FaceCluster& face, const VecX& x) {
  Axes F = Axes::Zero();
  for (int k = 0; k < 3; ++k)
    F += Vec3(x.segment<3>(3 * face.particles[static_cast<std::size_t>(k)])) * face.slopes.row(k);
  return F;
}

}  // namespace

std::vector<FaceCluster> face_clusters(const TriangleMesh& mesh, const TriangleMesh& rest, double stretch,
                                       int first) {
  const std::vector<RestCorners> corners = woven_corners(rest, {});
  std::vector<FaceCluster> faces;
  for (const int t : counted_triangles(mesh)) {
    const RestSlopes slopes = slopes_of(corners[static_cast<std::size_t>(t)]);
    if (!(slopes.area > 0) || !(stretch > 0)) continue;
    const Triangle& v = mesh.triangles[static_cast<std::size_t>(t)];
    faces.push_back({{first + v[0], first + v[1], first + v[2]}, slopes.weights, stretch * slopes.area});
  }
  return faces;
}

FaceClusterForce::FaceClusterForce(std::vector<FaceCluster> faces, double viscosity)
    : faces_(std::move(faces)), viscosity_(viscosity) {}

double FaceClusterForce::energy(const VecX& x) const {
  double sum = 0;
  for (const FaceCluster& face : faces_) {
    const Axes F = gradient(face, x);
    sum += face.stiffness / 2 * (F - polar(F)).squaredNorm();
  }
  return sum;
}

// Viscosity acts on the rate of F^T F, which no rigid motion changes: so it has no moment, whatever the
// strain.
void FaceClusterForce::add_force(const VecX& x, const VecX& v, VecX& f) const {
  for (const FaceCluster& face : faces_) {
    const Axes F = gradient(face, x);
    Axes pull = face.stiffness * (polar(F) - F);
    if (viscosity_ > 0) {
      const Matrix2d rate = F.transpose() * gradient(face, v);
      pull -= face.stiffness * viscosity_ / 2 * F * (rate + rate.transpose());
    }
    for (int k = 0; k < 3; ++k)
      f.segment<3>(3 * face.particles[static_cast<std::size_t>(k)]) += pull * face.slopes.row(k).transpose();
  }
}

void FaceClusterForce::begin_substep(int particles) {
  if (coloured_) return;
  colours_.make(static_cast<int>(faces_.size()), particles, [&](int e, const auto& f) {
    for (int p : faces_[static_cast<std::size_t>(e)].particles) f(p);
  });
  std::vector<FaceCluster> sorted;
  sorted.reserve(faces_.size());
  for (const int e : colours_.order()) sorted.push_back(faces_[static_cast<std::size_t>(e)]);
  faces_ = std::move(sorted);
  pulls_.assign(faces_.size(), Pull::Zero());
  coloured_ = true;
}

void FaceClusterForce::project(Substep& substep) {
  const auto relax_range = [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const auto face = static_cast<std::size_t>(k);
      if (substep.first) pulls_[face].setZero();
      relax(faces_[face], substep, pulls_[face]);
    }
  };
  colours_.run(relax_range, relax_range);
}

void FaceClusterForce::relax(const FaceCluster& face, Substep& substep, Pull& pull) const {
  const double h = substep.h;
  std::array<double, 3> mobility;
  Matrix2d C = Matrix2d::Zero();
  for (int k = 0; k < 3; ++k) {
    const auto corner = static_cast<std::size_t>(k);
    mobility[corner] = substep.mobility[static_cast<std::size_t>(face.particles[corner])];
    C += h * h * mobility[corner] * face.slopes.row(k).transpose() * face.slopes.row(k);
  }
  const Axes G = gradient(face, substep.x) - pull * C / h;
  Matrix2d B = Matrix2d::Identity();
  double softness = 1 / face.stiffness;
  if (viscosity_ > 0) {
    const Axes start = gradient(face, substep.start);
    const double viscosity = substep.counted(3 * viscosity_ * face.stiffness * C.trace() / h) * viscosity_;
    B += viscosity / (h + viscosity) * (polar(start).transpose() * start - B);
    softness /= 1 + viscosity / h;
  }
  C.diagonal().array() += softness;
  const Matrix2d S = C.inverse();
  const Axes R = polar(G * S * B);
  const Pull next = (R * B - G) * S * h;
  for (int k = 0; k < 3; ++k) {
    const auto corner = static_cast<std::size_t>(k);
    substep.x.segment<3>(3 * face.particles[corner]) +=
        h * mobility[corner] * (next - pull) * face.slopes.row(k).transpose();
  }
  pull = next;
}

std::vector<std::unique_ptr<Force>> clustered_noh_jung(const TriangleMesh& mesh, const TriangleMesh& rest,
                                                       const Fabric& fabric, int first) {
  if (fabric.stretch_spring || fabric.neighbour_weighting)
    throw InputError(std::string(fabric.stretch_spring ? "stretch_spring" : "neighbour_weighting") +
                     " is of springs, and faces that are clusters have none; give stretch");
  Connections connections = noh_jung_connections(mesh, rest, fabric);
  std::vector<std::unique_ptr<Force>> forces;
  if (fabric.damping > 0) {
    std::vector<PairDamping::Element> damped;
    for (const auto& s : connections.stretch) damped.push_back({.particles = {first + s.i, first + s.j}});
    for (const auto& b : connections.bend)
      if (b.k_b > 0) damped.push_back({.particles = {first + b.i, first + b.j}});
    forces.push_back(std::make_unique<PairDamping>(std::move(damped), fabric.damping, fabric.damping_kind));
  }
  connections.stretch.clear();
  forces.push_back(
      std::make_unique<FaceClusterForce>(face_clusters(mesh, rest, mean_stretch(fabric), first)));
  Fabric bends = fabric;
  bends.damping = 0;
  for (auto& force : forces_of(connections, bends, first)) forces.push_back(std::move(force));
  return forces;
}

std::vector<std::unique_ptr<Force>> clustered_woven(const TriangleMesh& mesh, const TriangleMesh& rest,
                                                    const Fabric& fabric, const std::vector<Vec3>& warp,
                                                    int first, std::shared_ptr<BendMemory> memory) {
  check(fabric);
  Fabric bends = fabric;
  bends.stretch = 0;
  bends.weave.stretch_weft.reset();
  bends.weave.shear.reset();
  bends.weave.compression = 1;
  bends.weave.stretch_time = bends.weave.shear_time = 0;
  std::vector<std::unique_ptr<Force>> forces = woven(mesh, rest, bends, warp, first, std::move(memory));
  forces.push_back(std::make_unique<FaceClusterForce>(face_clusters(mesh, rest, mean_stretch(fabric), first),
                                                      fabric.weave.stretch_time));
  return forces;
}

}  // namespace drape
