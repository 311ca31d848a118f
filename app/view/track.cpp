#include "app/view/track.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace drape::app {
namespace {

using Frame = std::vector<std::uint16_t>;

constexpr std::size_t chunk_values = 8'000'000;  // a block's text must stay far below what browsers allow

std::uint16_t expected(const std::vector<Frame>& frames, std::size_t k, std::size_t i, int order) {
  if (k == 0) return 0;
  const std::uint16_t last = frames[k - 1][i];
  if (order == 1 || k == 1) return last;
  return static_cast<std::uint16_t>(2 * last - frames[k - 2][i]);
}

std::uint16_t folded(std::uint16_t residual) {
  const auto r = static_cast<std::int16_t>(residual);
  return static_cast<std::uint16_t>(r >= 0 ? 2 * r : -2 * r - 1);
}

// Calls write(folded residual) for all values of frame k in order.
template <class Write>
void for_residuals(const std::vector<Frame>& frames, std::size_t k, std::size_t vertices, ChunkCode code,
                   Write write) {
  std::uint16_t beside = 0;
  for (std::size_t i = 0; i < frames[k].size(); ++i) {
    if (i % vertices == 0) beside = 0;
    const auto change = static_cast<std::uint16_t>(frames[k][i] - expected(frames, k, i, code.order));
    write(folded(code.neighbours ? static_cast<std::uint16_t>(change - beside) : change));
    beside = change;
  }
}

}  // namespace

void widen(ValueRange& range, bool& any, const double* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(values[i])) continue;
    range = any ? ValueRange{std::min(range.low, values[i]), std::max(range.high, values[i])}
                : ValueRange{values[i], values[i]};
    any = true;
  }
}

std::string chunk_bytes(const std::vector<Frame>& frames, std::size_t before, std::size_t vertices,
                        ChunkCode code) {
  std::string low, high;
  for (std::size_t k = before; k < frames.size(); ++k)
    for_residuals(frames, k, vertices, code, [&](std::uint16_t z) {
      low += static_cast<char>(z & 255);
      high += static_cast<char>(z >> 8);
    });
  return low + high;
}

// By the bits of what is left, which is near enough to what the compression makes of it.
ChunkCode best_code(const std::vector<Frame>& frames, std::size_t before, std::size_t vertices) {
  ChunkCode best;
  long least = -1;
  for (const ChunkCode code :
       {ChunkCode{1, false}, ChunkCode{1, true}, ChunkCode{2, false}, ChunkCode{2, true}}) {
    long bits = 0;
    for (std::size_t k = before; k < frames.size(); ++k)
      for_residuals(frames, k, vertices, code, [&](std::uint16_t z) { bits += std::bit_width(z); });
    if (least < 0 || bits < least) best = code, least = bits;
  }
  return best;
}

TrackWriter::TrackWriter(PageBlocks& blocks, std::vector<ValueRange> components, std::size_t vertices)
    : blocks_(blocks), components_(std::move(components)), vertices_(vertices) {}

void TrackWriter::add(const std::vector<double>& frame) {
  Frame whole(frame.size());
  for (std::size_t i = 0; i < frame.size(); ++i) {
    const ValueRange& range = components_[i / vertices_];
    if (std::isfinite(frame[i])) {
      const double place = range.step() > 0 ? (frame[i] - range.low) / range.step() : 0;
      whole[i] = static_cast<std::uint16_t>(std::clamp(std::round(place), 0.0, 65535.0));
    } else {
      whole[i] = frames_.empty() ? 0 : frames_.back()[i];
      ++not_finite_;
    }
  }
  frames_.push_back(std::move(whole));
  if ((frames_.size() - before_) * frame.size() >= chunk_values) write_chunk();
}

void TrackWriter::write_chunk() {
  const std::size_t count = frames_.size() - before_;
  if (count == 0) return;
  const ChunkCode code = best_code(frames_, before_, vertices_);
  chunks_.push_back(Json::Members{{"frames", static_cast<long>(count)},
                                  {"order", code.order},
                                  {"neighbours", code.neighbours},
                                  {"block", blocks_.add(chunk_bytes(frames_, before_, vertices_, code))}});
  before_ = std::min<std::size_t>(2, frames_.size());
  frames_.erase(frames_.begin(), frames_.end() - static_cast<std::ptrdiff_t>(before_));
}

Json TrackWriter::finish() {
  write_chunk();
  Json::List min, step;
  for (const ValueRange& range : components_) {
    min.emplace_back(range.low);
    step.emplace_back(range.step());
  }
  return Json::Members{{"min", std::move(min)}, {"step", std::move(step)}, {"chunks", chunks_}};
}

}  // namespace drape::app
