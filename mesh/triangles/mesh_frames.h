// Where the vertices of a deforming body are at a series of times: straight lines between the frames, so that
// a vertex's velocity is the difference of two frames over the time between them. Before the first frame and
// after the last one the body stands.
//   positions  of each frame as float, 12 bytes a vertex (a frame of 27 k triangles takes 160 kB): to 6e-8 of
//              their distance from the origin
#pragma once

#include <array>
#include <vector>

#include "mesh/base/vectors.h"

namespace drape {

class MeshFrames {
 public:
  // Throws InputError when the time [s] is not after that of the frame before, the number of vertices is not
  // that of the first frame, or a position [m] is not finite or beyond the range of float.
  void add(double time, const std::vector<Vec3>& positions);

  int frame_count() const { return static_cast<int>(times_.size()); }
  int vertex_count() const { return vertices_; }
  double first_time() const { return times_.front(); }  // s
  double last_time() const { return times_.back(); }    // s

  // The places [m] at a time [s]; there must be a frame. Allocates nothing when `out` has the size already.
  void positions_at(double time, std::vector<Vec3>& out) const;

 private:
  int vertices_ = 0;
  std::vector<double> times_;
  std::vector<std::vector<std::array<float, 3>>> frames_;
};

}  // namespace drape
