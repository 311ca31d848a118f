#include "constraints/pin_set.h"

#include <algorithm>
#include <string>
#include <utility>

#include "mesh/base/errors.h"

namespace drape {

namespace {

std::vector<int> each_once(std::vector<int> particles) {
  std::sort(particles.begin(), particles.end());
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  return particles;
}

void require(const std::vector<int>& particles, Eigen::Index count) {
  for (const int i : particles)
    if (i < 0 || i >= count)
      throw InputError("pins: particle " + std::to_string(i) + " is pinned, but there are " +
                       std::to_string(count) + " particles, counted from 0");
}

}  // namespace

bool PinSet::has(int particle) const { return std::binary_search(pinned_.begin(), pinned_.end(), particle); }

void PinSet::pin(const std::vector<int>& particles) {
  pinned_.insert(pinned_.end(), particles.begin(), particles.end());
  pinned_ = each_once(std::move(pinned_));
}

void PinSet::pin_to_body(const std::vector<int>& particles, const MovingBody& body, const VecX& x) {
  require(particles, x.size() / 3);
  for (int i : each_once(particles))
    if (!has(i)) moving_.push_back({i, body.number(), -1, body.mark(x.segment<3>(3 * i))});
  pin(particles);
}

void PinSet::pin_along(const std::vector<int>& particles, const Motion& motion, const VecX& x, double t) {
  require(particles, x.size() / 3);
  const int path = static_cast<int>(paths_.size());
  paths_.push_back(motion);
  const Pose start = motion.at(t);
  for (int i : each_once(particles))
    if (!has(i)) moving_.push_back({i, -1, path, {start.to_body(x.segment<3>(3 * i)), {}}});
  pin(particles);
}

void PinSet::unpin(const std::vector<int>& particles) {
  std::vector<int> sorted = particles;
  std::ranges::sort(sorted);
  const auto is_among = [&](int i) { return std::ranges::binary_search(sorted, i); };
  std::erase_if(moving_, [&](const MovingPin& pin) { return is_among(pin.particle); });
  std::erase_if(pinned_, is_among);
}

void PinSet::renumber(const std::vector<int>& number_of) {
  const auto number = [&](int i) { return number_of[i]; };
  std::vector<int> first(number_of.size(), -1);  // new number -> the lowest pinned particle that gets it
  for (int i : pinned_)
    if (int& owner = first[number(i)]; owner < 0) owner = i;
  std::erase_if(moving_, [&](const MovingPin& pin) { return first[number(pin.particle)] != pin.particle; });
  for (MovingPin& pin : moving_) pin.particle = number(pin.particle);
  for (int& i : pinned_) i = number(i);
  std::sort(pinned_.begin(), pinned_.end());
  pinned_.erase(std::unique(pinned_.begin(), pinned_.end()), pinned_.end());
}

void PinSet::part(const Parting& parting) {
  std::vector<int> pinned;
  std::vector<MovingPin> moving;
  for (std::size_t i = 0; i < parting.source.size(); ++i) {
    const int original = parting.source[i];
    if (!has(original)) continue;
    pinned.push_back(static_cast<int>(i));
    const auto pin = std::find_if(moving_.begin(), moving_.end(),
                                  [&](const MovingPin& one) { return one.particle == original; });
    if (pin == moving_.end()) continue;
    moving.push_back(*pin);
    moving.back().particle = static_cast<int>(i);
  }
  pinned_ = std::move(pinned);
  moving_ = std::move(moving);
}

void PinSet::move(const std::vector<MovingBody>& bodies, const StepMotion& step) {
  if (moving_.empty()) return;
  velocity_.setZero(step.x.size());
  for (const MovingPin& pin : moving_) {
    const Vec3 end = pin.body < 0 ? paths_[pin.path].at(step.t + step.h).to_world(pin.mark.place)
                                  : bodies[pin.body].carried(pin.mark);
    velocity_.segment<3>(3 * pin.particle) = (end - step.place(pin.particle)) / step.h;
  }
}

void PinSet::filter(const StepMotion& step, const VecX& v, Filter& filter) const {
  for (int i = 0; i < static_cast<int>(step.held.size()); ++i)
    if (step.is_held(i))
      filter.constrain(
          i, Mat3::Zero(),
          moving_.empty() ? Vec3(-v.segment<3>(3 * i)) : Vec3(velocity(i) - v.segment<3>(3 * i)));
}

}  // namespace drape
