#include "solver/integrators/newton_matrix.h"

#include <algorithm>

#include <cmath>

#include "mesh/base/parallel.h"

namespace drape {

bool NewtonMatrix::follow_system() {
  const auto& pattern = system_.bind();
  if (A_ && &A_->pattern() == pattern.get()) return false;
  A_ = std::make_unique<BlockMatrix>(system_.matrix());
  const Eigen::Index n = 3 * system_.particles();
  for (VecX* vector : {&b_rows_, &dv_rows_, &r_rows_, &d_rows_, &Ad_rows_}) vector->setZero(n);
  filter_.reserve(static_cast<std::size_t>(system_.particles()));
  rubs_.reserve(2 * static_cast<std::size_t>(system_.particles()));
  A_->keep();  // so that no step allocates
  kept_b_.setZero(n);
  return true;
}

void NewtonMatrix::assemble(const Linearisation& at, const std::vector<double>& masses, VecX& b, bool keep) {
  A_->set_to_mass(masses);
  add(at, false, b);
  if (keep) {
    A_->keep();
    kept_b_ = b;
  }
  add(at, true, b);
  A_->leave_out_zeros();
}

void NewtonMatrix::assemble_changing(const Linearisation& at, VecX& b) {
  A_->take_kept();
  b = kept_b_;
  add(at, true, b);
  A_->leave_out_zeros();
}

// Adds the forces that differ between the solves of a step, which are those of contact and those whose
// stencils come and go, or all others.
void NewtonMatrix::add(const Linearisation& at, bool changing, VecX& b) {
  for (const auto& force : system_.forces())
    if ((force->changes() || force->from_contact()) == changing)
      force->add_linearised(at.x, at.v, at.y, at.c, at.stiffness, *A_, b);
}

LinearReport NewtonMatrix::solve(const VecX& b, const Filter& filter, const LinearOptions& options,
                                 VecX& dv) {
  const BlockPattern& pattern = A_->pattern();
  to_rows(pattern, b, b_rows_);
  to_rows(pattern, dv, dv_rows_);
  filter_ = filter;
  filter_.renumber(pattern.row_of());
  const LinearReport report = solver_->solve(*A_, b_rows_, filter_, options, dv_rows_);
  to_particles(pattern, dv_rows_, dv);
  return report;
}

void NewtonMatrix::reaction(VecX& r) {
  A_->multiply(dv_rows_, r_rows_);
  r_rows_ -= b_rows_;
  r.resize(r_rows_.size());
  to_particles(A_->pattern(), r_rows_, r);
}

double NewtonMatrix::curvature(const VecX& v, const VecX& from) {
  to_rows(A_->pattern(), v, d_rows_);
  to_rows(A_->pattern(), from, Ad_rows_);
  d_rows_ -= Ad_rows_;
  A_->multiply(d_rows_, Ad_rows_);
  return dot(d_rows_, Ad_rows_);
}

std::string NewtonMatrix::stiffest_force(int particle, const Linearisation& at) {
  const int slot = A_->pattern().diagonal(row(particle));
  std::string stiffest;
  double most = -1;
  VecX b = VecX::Zero(at.x.size());
  for (const auto& force : system_.forces()) {
    A_->set_to_mass(std::vector<double>(system_.masses().size(), 0.0));
    force->add_linearised(at.x, at.v, at.y, 1.0, Stiffness::majorant, *A_, b);
    const double size = A_->at(slot).norm();
    if (size <= most) continue;
    stiffest = force->name();
    if (!std::isfinite(size)) break;
    most = size;
  }
  return stiffest;
}

// One block for every row.
void NewtonMatrix::add_up_rows(std::vector<DiagonalBlock>& blocks) {
  const auto before = [](const DiagonalBlock& a, const DiagonalBlock& b) { return a.row < b.row; };
  std::sort(blocks.begin(), blocks.end(), before);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < blocks.size(); ++k)
    if (kept > 0 && blocks[kept - 1].row == blocks[k].row)
      blocks[kept - 1].block += blocks[k].block;
    else
      blocks[kept++] = blocks[k];
  blocks.resize(kept);
}

}  // namespace drape
