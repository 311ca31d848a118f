#include "app/export/gltf_buffer.h"

#include <limits>

#include "app/export/bytes.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

constexpr auto little = std::endian::little;
// Numbers of OpenGL.
constexpr int float_type = 5126, uint_type = 5125, vertex_target = 34962, index_target = 34963;

int components(const std::string& kind) { return kind == "SCALAR" ? 1 : kind.back() - '0'; }

}  // namespace

int GltfBuffer::add(GltfUse use, std::size_t count, const std::string& kind) {
  const std::uint64_t length = 4 * static_cast<std::uint64_t>(components(kind)) * count;
  Json::Members view{
      {"buffer", 0}, {"byteOffset", static_cast<long>(size_)}, {"byteLength", static_cast<long>(length)}};
  if (use != GltfUse::animation)
    view.emplace_back("target", use == GltfUse::indices ? index_target : vertex_target);
  size_ += length;
  accessors_.push_back(Json::Members{{"bufferView", static_cast<long>(views_.size())},
                                     {"componentType", use == GltfUse::indices ? uint_type : float_type},
                                     {"count", static_cast<long>(count)},
                                     {"type", kind}});
  views_.push_back(std::move(view));
  return static_cast<int>(views_.size()) - 1;
}

void GltfBuffer::set_range(int accessor, const std::vector<double>& low, const std::vector<double>& high) {
  auto& members = std::get<Json::Members>(accessors_[accessor].value);
  members.emplace_back("min", low);
  members.emplace_back("max", high);
}

Eigen::AlignedBox3f float_range(const std::vector<Vec3>& vectors) {
  Eigen::AlignedBox3f box;
  if (vectors.empty()) box.extend(Eigen::Vector3f(Eigen::Vector3f::Zero()));
  for (const Vec3& vector : vectors) box.extend(Eigen::Vector3f(vector.cast<float>()));
  return box;
}

std::string glb_start(const std::string& json, std::uint64_t size, const std::string& file) {
  std::string text = json;
  text.append((4 - text.size() % 4) % 4, ' ');
  const std::uint64_t whole = 12 + 8 + text.size() + 8 + size;
  if (whole > std::numeric_limits<std::uint32_t>::max())
    throw InputError(file + ": would have " + std::to_string(whole >> 20) +
                     " MB, and a glTF file ends at 4096; leave out frames with --every");
  std::string bytes = "glTF";
  append_word<little>(bytes, 2);
  append_word<little>(bytes, static_cast<std::uint32_t>(whole));
  append_word<little>(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += "JSON" + text;
  append_word<little>(bytes, static_cast<std::uint32_t>(size));
  bytes += std::string("BIN\0", 4);
  return bytes;
}

}  // namespace drape::app
