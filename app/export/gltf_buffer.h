// The bytes of a glTF file by their plan: what lies where is known before any of it is made, so that nothing
// but one frame is ever in memory.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "app/base/json.h"
#include "mesh/base/vectors.h"

namespace drape {

// What the JSON says of a block of numbers.
enum class GltfUse { indices, vertices, animation };

class GltfBuffer {
 public:
  // Adds a block of `count` elements and returns the number of its accessor. `kind` is SCALAR, VEC2, VEC3 or
  // VEC4; all components have four bytes, float32 or (indices) uint32.
  int add(GltfUse use, std::size_t count, const std::string& kind);
  // The range that is asked for of positions and times.
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

// Header and JSON of a file whose binary part of `size` bytes follows. Throws InputError when it is more than
// the 4 GiB that a file can tell.
std::string glb_start(const std::string& json, std::uint64_t size, const std::string& file);

}  // namespace drape
