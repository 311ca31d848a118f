#include "app/base/padded_frames.h"

#include <algorithm>
#include <numeric>

namespace drape::app {

// From the last frame to the first: no frame begins farther on than its padded place, so that nothing is
// overwritten before it was read.
void pad_frames(AtomicFile& file, std::size_t start, std::size_t size, const std::vector<int>& vertices,
                int n, const std::vector<int>& copy_of) {
  const std::size_t all = static_cast<std::size_t>(n) + copy_of.size();
  std::size_t from = std::accumulate(vertices.begin(), vertices.end(), std::size_t{0});
  std::vector<unsigned char> frame(all * size);
  for (std::size_t k = vertices.size(); k-- > 0;) {
    const auto there = static_cast<std::size_t>(vertices[k]);
    from -= there;
    file.seek(static_cast<long>(start + from * size));
    file.read(frame.data(), there * size);
    for (std::size_t v = there; v < all; ++v) {
      const auto original = static_cast<std::size_t>(copy_of[v - static_cast<std::size_t>(n)]);
      std::copy_n(frame.data() + original * size, size, frame.data() + v * size);
    }
    file.seek(static_cast<long>(start + k * all * size));
    file.write(frame.data(), frame.size());
  }
}

}  // namespace drape::app
