#include "app/compare/plain_system.h"

#include "solver/linear/projected.h"

namespace drape::app {
namespace {

VecX by_particle(const LinearSystem& system, const VecX& rows) {
  VecX all(rows.size());
  to_particles(system.A.pattern(), rows, all);
  return all;
}

PlainSystem plain(const LinearSystem& system, const Filter& filter) {
  ProjectedSystem projected;  // its matrix is the lower triangle, in row order
  projected.project(system.A, system.b, filter, system.options);
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> to_particle(3 * system.A.rows());
  for (int row = 0; row < system.A.rows(); ++row)
    for (int k = 0; k < 3; ++k)
      to_particle.indices()[3 * row + k] = 3 * system.A.pattern().particle_of()[row] + k;
  PlainMatrix unsorted;
  unsorted = projected.matrix().selfadjointView<Eigen::Lower>().twistedBy(to_particle);
  return {unsorted.transpose(),
          by_particle(system, projected.right_side())};  // transposing sorts each column
}

}  // namespace

PlainSystem plain_system(const LinearSystem& system) { return plain(system, Filter()); }

PlainSystem projected_system(const LinearSystem& system) { return plain(system, system.filter); }

PlainFilter plain_filter(const LinearSystem& system) {
  PlainFilter plain{std::vector<Mat3>(static_cast<std::size_t>(system.A.rows()), Mat3::Identity()),
                    VecX::Zero(system.b.size())};
  for (const FilterEntry& e : system.filter.entries()) {
    const int particle = system.A.pattern().particle_of()[e.particle];
    plain.S[particle] = e.S;
    plain.z.segment<3>(3 * particle) = e.z;
  }
  return plain;
}

VecX solution_within_constraints(const LinearSystem& system, const VecX& y) {
  VecX rows(y.size());
  to_rows(system.A.pattern(), y, rows);
  system.filter.impose(rows);
  return by_particle(system, rows);
}

}  // namespace drape::app
