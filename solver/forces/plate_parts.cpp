#include "solver/forces/plate_parts.h"

#include <Eigen/LU>

namespace drape {

PlateParts::PlateParts(const std::vector<PlatePart>& parts, double time, int first) : time_(time) {
  for (const PlatePart& part : parts) {
    const std::size_t begin = shares_.size();
    for (const PlatePart::Share& share : part.shares)
      shares_.push_back({first + share.vertex, share.weights});
    parts_.push_back({part.stiffness, begin, shares_.size()});
  }
}

void PlateParts::colour(int particles) {
  if (coloured_) return;
  coloured_ = true;
  colours_.make(static_cast<int>(parts_.size()), particles, [&](int e, const auto& f) {
    const Part& part = parts_[static_cast<std::size_t>(e)];
    for (std::size_t k = part.begin; k < part.end; ++k) f(shares_[k].vertex);
  });
  lambda_.resize(parts_.size());
}

void PlateParts::run(Substep& substep) {
  const auto relax_range = [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const auto number = static_cast<std::size_t>(colours_.order()[static_cast<std::size_t>(k)]);
      Mat3 lambda = substep.first ? Mat3(Mat3::Zero()) : lambda_[number];
      relax(parts_[number], substep, lambda);
      if (!substep.last) lambda_[number] = lambda;
    }
  };
  colours_.run(relax_range, relax_range);
}

void PlateParts::relax(const Part& part, Substep& substep, Mat3& lambda) const {
  const double h = substep.h;
  Mat3 d = Mat3::Zero(), W = Mat3::Zero();
  for (std::size_t k = part.begin; k < part.end; ++k) {
    const PlatePart::Share& share = shares_[k];
    const auto x = substep.x.segment<3>(3 * share.vertex);
    if (time_ == 0)
      d += x * share.weights.transpose();
    else
      d += (x + time_ / h * (x - substep.start.segment<3>(3 * share.vertex))) * share.weights.transpose();
    W += substep.mobility[static_cast<std::size_t>(share.vertex)] * share.weights * share.weights.transpose();
  }
  const Mat3 inner = Mat3::Identity() + h * (h + time_) * W * part.stiffness;
  const Mat3 change = -(lambda + h * d * part.stiffness) * inner.inverse();
  lambda += change;
  for (std::size_t k = part.begin; k < part.end; ++k) {
    const PlatePart::Share& share = shares_[k];
    substep.x.segment<3>(3 * share.vertex) +=
        h * substep.mobility[static_cast<std::size_t>(share.vertex)] * (change * share.weights);
  }
}

}  // namespace drape
