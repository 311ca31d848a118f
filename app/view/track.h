// Numbers that change with time, as the page stores them: 16-bit integers q = round((x - min) / step), with
// step = (max - min) / 65535 for each component, so that x is accurate to half a step.
//   A frame holds one component after the other, and all vertices within a component. Frames are grouped into
//   chunks, each with a code of its own. order 1 predicts q(k) = q(k-1), order 2 q(k) = 2 q(k-1) - q(k-2).
//   (The q before the first frame is 0; the one before the second frame equals the first.) The chunk stores
//   the error of the prediction; with `neighbours`, the difference of that error to the error of the vertex
//   before. All is modulo 2^16 and written as 2 r or -2 r - 1 (small when r is small), first all low bytes,
//   then all high bytes. Each chunk uses the code whose numbers have the fewest bits. A number that is not
//   finite is stored as the last value of its vertex.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/base/json.h"
#include "app/view/page_blocks.h"

namespace drape::app {

struct ValueRange {
  double low = 0, high = 0;

  double step() const { return (high - low) / 65535; }
};

// Extends the range by those of the `count` values that are finite. `any` says whether the range holds a
// value yet.
void widen(ValueRange& range, bool& any, const double* values, std::size_t count);

struct ChunkCode {
  int order = 1;
  bool neighbours = false;
};

// The bytes of frames of integers. The first `before` (0, 1 or 2) of the frames only serve to predict the
// others.
std::string chunk_bytes(const std::vector<std::vector<std::uint16_t>>& frames, std::size_t before,
                        std::size_t vertices, ChunkCode code);
ChunkCode best_code(const std::vector<std::vector<std::uint16_t>>& frames, std::size_t before,
                    std::size_t vertices);

class TrackWriter {
 public:
  TrackWriter(PageBlocks& blocks, std::vector<ValueRange> components, std::size_t vertices);

  void add(const std::vector<double>& frame);  // one component after the other
  Json finish();                               // {min, step, chunks}
  long not_finite() const { return not_finite_; }

 private:
  void write_chunk();

  PageBlocks& blocks_;
  std::vector<ValueRange> components_;
  std::size_t vertices_;
  std::vector<std::vector<std::uint16_t>> frames_;  // including those before the chunk
  std::size_t before_ = 0;
  Json::List chunks_;
  long not_finite_ = 0;
};

}  // namespace drape::app
