// Frames of vertices that became more while the frames were written, as where cloth tears.
#pragma once

#include <cstddef>
#include <vector>

#include "app/base/atomic_file.h"

namespace drape::app {

// Gives all frames of a file as many vertices as there are at the end, in place: one that a frame does not
// have is where its original is. The first frame begins at byte `start`, a vertex has `size` bytes, and frame
// k has vertices[k] vertices. Vertex n + k is a copy of vertex copy_of[k]; n: vertices that there were at
// first.
void pad_frames(AtomicFile& file, std::size_t start, std::size_t size, const std::vector<int>& vertices,
                int n, const std::vector<int>& copy_of);

}  // namespace drape::app
