#include "solver/system/system.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "mesh/base/errors.h"
#include "mesh/base/parallel.h"

namespace drape {

State at_rest(const TriangleMesh& mesh) {
  return {0, stacked(mesh.positions), VecX::Zero(3 * static_cast<Eigen::Index>(mesh.positions.size()))};
}

VecX stacked(const std::vector<Vec3>& points) {
  VecX x(3 * static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) x.segment<3>(3 * static_cast<Eigen::Index>(i)) = points[i];
  return x;
}

std::vector<Vec3> unstacked(const VecX& numbers) {
  std::vector<Vec3> points(static_cast<std::size_t>(numbers.size() / 3));
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = numbers.segment<3>(3 * static_cast<Eigen::Index>(i));
  return points;
}

System::System(std::vector<double> masses) : masses_(std::move(masses)) {
  for (std::size_t i = 0; i < masses_.size(); ++i)
    if (!(masses_[i] >= 0) || !std::isfinite(masses_[i]))
      throw InputError("system: particle " + std::to_string(i) + " has mass " + std::to_string(masses_[i]) +
                       " kg; a mass is finite and not negative");
}

void System::add(std::unique_ptr<Force> force) {
  forces_.push_back(std::move(force));
  pattern_.reset();
}

void System::add(std::vector<std::unique_ptr<Force>> forces) {
  for (auto& force : forces) add(std::move(force));
}

void System::add(const Gravity& gravity) {
  if (!gravity.g.allFinite()) throw InputError("gravity: an acceleration is three finite numbers");
  gravity_ = gravity.g;
}

const std::shared_ptr<const BlockPattern>& System::bind() {
  if (!pattern_) {
    std::vector<ParticlePair> pairs;
    for (const auto& force : forces_) force->list_pairs(pairs);
    pattern_ = std::make_shared<const BlockPattern>(particles(), std::move(pairs));
    overlay_ = std::make_shared<BlockOverlay>();
    cover_changing();
    for (const auto& force : forces_) force->bind(BlockLayout(*pattern_, *overlay_));
  }
  return pattern_;
}

void System::cover_changing() {
  changing_.clear();
  for (const auto& force : forces_) force->list_changing_pairs(changing_);
  overlay_->assign(*pattern_, changing_);
}

void System::begin_step(const StepStart& start) {
  find_stencils(start, [](const Force&) { return true; });
}

void System::find_contacts(const StepStart& start) {
  find_stencils(start, [](const Force& force) { return force.from_contact(); });
}

template <class Which>
void System::find_stencils(const StepStart& start, const Which& which) {
  bind();
  bool changed = false;
  for (const auto& force : forces_)
    if (which(*force) && force->begin_step(start)) changed = true;
  if (!changed) return;
  cover_changing();
  for (const auto& force : forces_)
    if (force->changes()) force->bind(BlockLayout(*pattern_, *overlay_));
}

void System::end_step(const VecX& x) {
  for (const auto& force : forces_) force->end_step(x);
}

void System::keep() {
  for (const auto& force : forces_) force->keep();
}

void System::go_back() {
  for (const auto& force : forces_) force->go_back();
}

BlockMatrix System::matrix() {
  bind();
  return BlockMatrix(pattern_, overlay_);
}

double System::elastic_energy(const VecX& x) const {
  double sum = 0;
  for (const auto& force : forces_)
    if (!force->from_contact()) sum += force->energy(x);
  return sum;
}

double System::contact_energy(const VecX& x) const {
  double sum = 0;
  for (const auto& force : forces_)
    if (force->from_contact()) sum += force->energy(x);
  return sum;
}

double System::stored_energy(const VecX& x) const { return elastic_energy(x) + contact_energy(x); }

double System::total_energy(const State& state) const {
  return kinetic_energy(state.v) + stored_energy(state.x) + gravity_energy(state.x);
}

double System::kinetic_energy(const VecX& v) const {
  return sum_chunks(particles(), [&](int begin, int end) {
    double sum = 0;
    for (int i = begin; i < end; ++i) sum += 0.5 * masses_[i] * v.segment<3>(3 * i).squaredNorm();
    return sum;
  });
}

double System::gravity_energy(const VecX& x) const {
  return sum_chunks(particles(), [&](int begin, int end) {
    double sum = 0;
    for (int i = begin; i < end; ++i) sum -= masses_[i] * gravity_.dot(x.segment<3>(3 * i));
    return sum;
  });
}

VecX System::force(const VecX& x, const VecX& v) const {
  VecX f(x.size());
  for (int i = 0; i < particles(); ++i) f.segment<3>(3 * i) = masses_[i] * gravity_;
  for (const auto& force : forces_) force->add_force(x, v, f);
  return f;
}

double System::given_power(const VecX& x, const VecX& v) const {
  double sum = 0;
  for (const auto& force : forces_) sum += force->given_power(x, v);
  return sum;
}

bool System::goes_slack() const {
  return std::any_of(forces_.begin(), forces_.end(), [](const auto& force) { return force->goes_slack(); });
}

std::string_view System::not_finite_force(const VecX& x, const VecX& v) const {
  if (!gravity_.allFinite()) return "gravity";
  for (const auto& force : forces_) {
    VecX f = VecX::Zero(x.size());
    force->add_force(x, v, f);
    if (!f.allFinite()) return force->name();
  }
  return {};
}

}  // namespace drape
