// Plans the binary part of a glTF file. The place of every block is known before any block is made, so only
// one frame at a time is in memory.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "app/base/json.h"
#include "mesh/base/vectors.h"

namespace drape::app {

// What a block of numbers is used for, as the JSON says it.
enum class GltfUse { indices, vertices, animation };

class GltfBuffer {
 public:
  // Adds a block of `count` elements and returns the number of its accessor. `kind` is SCALAR, VEC2, VEC3 or
  // VEC4. Every component has four bytes: float32, or uint32 for indices.
  int add(GltfUse use, std::size_t count, const std::string& kind);
  // Sets the range of the numbers, which glTF demands for positions and times.
  void set_range(int accessor, const std::vector<double>& low, const std::vector<double>& high);

  std::uint64_t size() const { return size_; }  // bytes
  Json accessors() const { return accessors_; }
  Json views() const { return views_; }

 private:
  Json::List accessors_, views_;
  std::uint64_t size_ = 0;
};

// The box of the numbers as they are written; from 0 to 0 when there are none.
Eigen::AlignedBox3f float_range(const std::vector<Vec3>& vectors);

// The header and the JSON of a file whose binary part has `size` bytes. Throws InputError when the file would
// be larger than 4 GiB, the most that the header can express.
std::string glb_start(const std::string& json, std::uint64_t size, const std::string& file);

}  // namespace drape::app
