#include "mesh/triangles/mesh_frames.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "mesh/base/errors.h"

namespace drape {
namespace {

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

void MeshFrames::add(double time, const std::vector<Vec3>& positions) {
  if (!std::isfinite(time) || (!times_.empty() && !(time > times_.back())))
    throw InputError("a frame must be later than the one before, it is at " + short_number(time) + " s");
  if (!times_.empty() && static_cast<int>(positions.size()) != vertices_)
    throw InputError("a frame has " + std::to_string(positions.size()) + " vertices, the first one has " +
                     std::to_string(vertices_));
  std::vector<std::array<float, 3>> frame(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      frame[i][k] = static_cast<float>(positions[i][k]);
      if (!std::isfinite(frame[i][k]))
        throw InputError("vertex " + std::to_string(i) + " of a frame has no finite position");
    }
  vertices_ = static_cast<int>(positions.size());
  times_.push_back(time);
  frames_.push_back(std::move(frame));
}

void MeshFrames::positions_at(double time, std::vector<Vec3>& out) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  const std::size_t next = std::min<std::size_t>(after - times_.begin(), times_.size() - 1);
  const std::size_t last = after == times_.begin() ? 0 : static_cast<std::size_t>(after - times_.begin()) - 1;
  const double s = next == last ? 0 : (time - times_[last]) / (times_[next] - times_[last]);
  const auto &from = frames_[last], &to = frames_[next];
  out.resize(from.size());
  for (std::size_t i = 0; i < from.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double start = from[i][k], end = to[i][k];
      out[i][k] = start + s * (end - start);
    }
}

}  // namespace drape
