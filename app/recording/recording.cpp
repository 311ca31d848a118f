#include "app/recording/recording.h"

#include <algorithm>

#include "app/base/pc2.h"
#include "app/recording/body_files.h"
#include "app/recording/frame_fields.h"
#include "mesh/obj/obj.h"

namespace drape::app {

namespace fs = std::filesystem;

void Recording::require_whole() const {
  if (!missing_.empty()) throw InputError(missing_.front());
}

double Recording::frame_rate() const {
  const double span = times_.back() - times_.front();
  return span > 0 ? static_cast<double>(frames() - 1) / span : 0;
}

std::vector<RecordedPlane> Recording::planes(int frame) const {
  std::vector<RecordedPlane> planes = planes_;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    if (plane_poses_[k].empty()) continue;
    const Pose& at = plane_poses_[k][std::min(static_cast<std::size_t>(frame), plane_poses_[k].size() - 1)];
    planes[k].point = at.to_world(planes[k].point);
    planes[k].normal = at.direction_to_world(planes[k].normal);
  }
  return planes;
}

std::vector<Vec3> Recording::positions(std::size_t k, int frame) const {
  std::vector<Vec3> positions = read_positions(k, frame);
  const std::size_t expected = shapes_[k].mesh.positions.size();
  const std::vector<int>& copy_of = sources_[k].copy_of;
  if (const std::size_t first = expected - copy_of.size(); positions.size() >= first)  // of an OBJ file
    for (std::size_t v = positions.size(); v < expected; ++v)
      positions.push_back(Vec3(positions[static_cast<std::size_t>(copy_of[v - first])]));
  if (positions.size() != expected)
    throw InputError(frame_path(folder_, shapes_[k].name, frame + 1).string() + ": has " +
                     counted(static_cast<long>(positions.size()), "vertex") + ", expected the " +
                     std::to_string(expected) + " of " + shapes_[k].name + ".obj; is it of another run?");
  return positions;
}

std::vector<Vec3> Recording::read_positions(std::size_t k, int frame) const {
  const RecordedShape& shape = shapes_[k];
  const Source& source = sources_[k];
  if (!shape.moves) return shape.mesh.positions;
  if (!source.cache.empty()) {
    std::vector<Vec3> positions;
    Pc2Reader reader(source.cache, Pc2Reader::Damaged::read);
    reader.seek(std::min(frame, reader.samples() - 1));
    reader.read(positions);
    return positions;
  }
  if (source.files) return read_obj(frame_path(folder_, shape.name, frame + 1)).positions;
  const Pose& at = source.poses[std::min(static_cast<std::size_t>(frame), source.poses.size() - 1)];
  std::vector<Vec3> positions = shape.mesh.positions;
  for (Vec3& x : positions) x = at.to_world(source.last.to_body(x));
  return positions;
}

std::vector<float> Recording::field(std::size_t k, const char* name, int frame) const {
  const Names& there = sources_[k].fields;
  if (!shapes_[k].moves || std::find(there.begin(), there.end(), name) == there.end()) return {};
  return NpyReader(field_path(folder_, shapes_[k].name, name)).frame(frame);
}

std::vector<Vec3> Recording::velocities(std::size_t k, int frame) const {
  const std::vector<float> numbers = field(k, "velocity", frame);
  std::vector<Vec3> velocities;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    velocities.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return velocities;
}

std::vector<double> Recording::strains(std::size_t k, int frame) const {
  const std::vector<float> numbers = field(k, "strain", frame);
  return {numbers.begin(), numbers.end()};
}

std::vector<Touch> Recording::touches(std::size_t k, int frame) const {
  std::vector<Touch> touches;
  for (const float number : field(k, "contact", frame)) touches.push_back(static_cast<Touch>(number));
  return touches;
}

}  // namespace drape::app
