// Numbers that change with time, as the page has them: whole numbers of 16 bits, q = round((x - min) / step)
// with step = (max - min) / 65535 of each component, so that x is told to half a step.
//   In a frame: component by component, of each all vertices. Frames are cut into chunks of their own
//   compression. order 1 expects q(k) = q(k-1), order 2 q(k) = 2 q(k-1) - q(k-2); (q before the first frame:
//   0, before the second: as the first). What is left of it, with `neighbours` the difference of that to the
//   vertex before, all modulo 2^16 and as 2 r or -2 r - 1 (small when r is small), is written as low bytes,
//   then high bytes. Each chunk takes the choice that leaves least. A number that is not finite is written as
//   the vertex's last one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/base/json.h"
#include "app/view/page_blocks.h"

namespace drape {

struct Range {
  double low = 0, high = 0;

  double step() const { return (high - low) / 65535; }
};

// Of the finite ones among values [begin, begin + count).
void widen(Range& range, bool& any, const double* values, std::size_t count);

struct ChunkCode {
  int order = 1;
  bool neighbours = false;
};

// Frames of whole numbers; `before`: how many of them only tell what is expected of the others (0, 1 or 2).
std::string chunk_bytes(const std::vector<std::vector<std::uint16_t>>& frames, std::size_t before,
                        std::size_t vertices, ChunkCode code);
ChunkCode best_code(const std::vector<std::vector<std::uint16_t>>& frames, std::size_t before,
                    std::size_t vertices);

class TrackWriter {
 public:
  TrackWriter(PageBlocks& blocks, std::vector<Range> components, std::size_t vertices);

  void add(const std::vector<double>& frame);  // component by component
  Json finish();                               // {min, step, chunks}
  long not_finite() const { return not_finite_; }

 private:
  void write_chunk();

  PageBlocks& blocks_;
  std::vector<Range> components_;
  std::size_t vertices_;
  std::vector<std::vector<std::uint16_t>> frames_;  // with those before the chunk
  std::size_t before_ = 0;
  Json::List chunks_;
  long not_finite_ = 0;
};

}  // namespace drape
