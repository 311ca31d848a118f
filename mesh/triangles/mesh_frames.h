// The vertex positions of an animated body at a series of times. Between two frames every vertex goes
// straight, so its velocity is the difference of the two frames divided by the time between them. Before the
// first frame and after the last one the body is at rest.
//   positions  are stored as float, 12 bytes per vertex (160 kB for a frame of 27 k triangles): accurate to
//              6e-8 of their distance from the origin
#pragma once

#include <array>
#include <vector>

#include "mesh/base/vectors.h"

namespace drape {

class MeshFrames {
 public:
  // Adds a frame. Throws InputError when the time [s] is not later than that of the frame before, when the
  // number of vertices is not that of the first frame, or when a position [m] is not finite or beyond the
  // range of float.
  void add(double time, const std::vector<Vec3>& positions);

  int frame_count() const { return static_cast<int>(times_.size()); }
  int vertex_count() const { return vertices_; }
  double time(int frame) const { return times_[static_cast<std::size_t>(frame)]; }  // s
  double first_time() const { return times_.front(); }                              // s
  double last_time() const { return times_.back(); }                                // s

  // Writes the positions [m] at this time [s] into `out`. There must be a frame. Allocates nothing when `out`
  // already has the right size.
  void positions_at(double time, std::vector<Vec3>& out) const;

 private:
  int vertices_ = 0;
  std::vector<double> times_;
  std::vector<std::vector<std::array<float, 3>>> frames_;
};

}  // namespace drape
