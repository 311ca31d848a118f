// Particles that part: where cloth tears, a particle stays with the triangles on one side, and those on the
// other get a copy of it.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

namespace drape {

struct Parting {
  std::vector<int> number;  // what particle i of before is called now
  std::vector<int> source;  // particle i of now was particle source[i] of before, or is a copy of it
  // The triangles that get a copy for a corner, in the numbers of before and of now; sorted by `before`.
  struct Face {
    std::array<int, 3> before, now;
  };
  std::vector<Face> faces;

  // What a triangle of before is now.
  std::array<int, 3> face(const std::array<int, 3>& before) const {
    const auto at = std::lower_bound(faces.begin(), faces.end(), before,
                                     [](const Face& f, const auto& key) { return f.before < key; });
    if (at != faces.end() && at->before == before) return at->now;
    std::array<int, 3> now;
    for (std::size_t k = 0; k < 3; ++k) now[k] = number[static_cast<std::size_t>(before[k])];
    return now;
  }
};

}  // namespace drape
