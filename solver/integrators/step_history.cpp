#include "solver/integrators/step_history.h"

#include <algorithm>

namespace drape {

void StepHistory::forget(const System& system) {
  touched_.assign(static_cast<std::size_t>(system.particles()), 0);
  filter_.reserve(touched_.size());
  k_.scale.assign(touched_.size(), 1);
  last_h_ = 0;
}

void StepHistory::begin(const State& state, const Piece& piece, const ContactStep& contacts) {
  const double h = piece.h;
  // BDF2 is stable as long as each step is less than 1 + sqrt(2) times the last.
  //                                                                   [Hairer, Norsett & Wanner, III.5]
  const bool smooth = piece.halvings == 0 && !piece.order_1 && last_h_ > 0 && h <= 2 * last_h_ &&
                      state.x.size() == end_.x.size() && state.x == end_.x && state.v == end_.v;
  k_.h = h;
  k_.ahead = order_ == 2 && smooth ? h / last_h_ : 0;
  k_.back = k_.ahead * k_.ahead / (1 + 2 * k_.ahead);
  k_.c = (1 + k_.ahead) / (1 + 2 * k_.ahead) * h;
  k_.scale.assign(touched_.size(), 1);
  k_.fall.assign(touched_.size(), k_.c);
  if (k_.order_2()) restart_touching(contacts);
}

void StepHistory::restart_touching(const ContactStep& contacts) {
  if (!k_.order_2()) return;
  mark_touching(contacts);
  for (std::size_t i = 0; i < touched_.size(); ++i)
    if (touched_[i]) {
      k_.scale[i] = k_.c / k_.h;
      k_.fall[i] = k_.h;
    }
}

void StepHistory::first_point(const State& state, Point& point) const {
  point.x = state.x;
  point.v = state.v;
  if (!k_.order_2()) return;
  point.v = state.v + k_.ahead * (state.v - begin_.v);
  for (int i = 0; i < state.particles(); ++i)
    if (restarts(i)) point.v.segment<3>(3 * i) = state.v.segment<3>(3 * i);
  point.x = state.x + k_.back * (state.x - begin_.x) + k_.c * point.v;
}

void StepHistory::update(const System& system, const State& state, const ContactStep& contacts) {
  k_.x_bar = state.x;
  k_.v_bar = state.v;
  k_.mass = system.masses();
  if (k_.order_2()) {
    k_.x_bar += k_.back * (state.x - begin_.x);
    k_.v_bar += k_.back * (state.v - begin_.v);
    for (int i = 0; i < state.particles(); ++i) {
      if (!restarts(i)) continue;
      k_.mass[i] *= k_.scale[i];
      k_.v_bar.segment<3>(3 * i) = state.v.segment<3>(3 * i);
      k_.x_bar.segment<3>(3 * i) = state.x.segment<3>(3 * i) + (k_.h - k_.c) * state.v.segment<3>(3 * i);
    }
    contacts.filter(state.v, filter_);
    for (const FilterEntry& e : filter_.entries())
      if (restarts(e.particle)) k_.x_bar.segment<3>(3 * e.particle) += (k_.h - k_.c) * e.z;
  }
  if (contacts.correction().size() > 0) k_.x_bar += contacts.correction();
}

void StepHistory::remember(const State& state, const Point& end, const ContactStep& contacts) {
  if (order_ == 1) return;
  begin_.x = state.x;
  begin_.v = state.v;
  end_ = end;
  last_h_ = k_.h;
  std::fill(touched_.begin(), touched_.end(), 0);
  mark_touching(contacts);
}

void StepHistory::mark_touching(const ContactStep& contacts) {
  for (const Contact& c : contacts.touching()) touched_[c.particle] = 1;
  for (const MovingPin& p : contacts.moving_pins()) touched_[p.particle] = 1;
  for (const FaceContact& c : contacts.touching_faces())
    if (c.active)
      for (int i : c.particles) touched_[i] = 1;
  for (const SelfContact& c : contacts.touching_cloth())
    for (std::size_t k = 0; k < 4; ++k)
      if (c.body >= 0 && c.active && c.weights[k] != 0) touched_[c.particles[k]] = 1;
}

}  // namespace drape
