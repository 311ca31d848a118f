#include "app/picture/still.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/base/interrupt.h"
#include "app/simulation/sheets.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/extent.h"

namespace drape::app::drawing {
namespace {

// A ball that moves is drawn with sectors of two tones, or nobody could see that it turns. A ball is what has
// all vertices as far from its middle; of anything else nothing is returned.
std::vector<Vec3> ball_from_middle(std::vector<Vec3> positions) {
  const Eigen::AlignedBox3d box = box_of(positions);
  const Vec3 middle = box.center();
  const double radius = box.sizes().maxCoeff() / 2;
  for (Vec3& p : positions) {
    p -= middle;
    if (std::abs(p.norm() - radius) > 0.02 * radius) return {};
  }
  return positions;
}

RecordedShape file_shape(const std::string& path, bool body) {
  return {std::filesystem::path(path).stem().string(), body, false, read_obj(path)};
}

// Finds which triangles of all cloths cross others or a rope, and which segments of ropes do.
void mark_crossings(Still& still) {
  Sheets sheets;
  std::vector<StillPart*> parts;
  for (const bool ropes : {false, true})
    for (StillPart& part : still.parts) {
      if (part.body || part.is_rope() != ropes) continue;
      parts.push_back(&part);
      if (ropes)
        sheets.add_rope("", part.axis);
      else
        sheets.add("", *part.triangles, part.positions);
    }
  const std::vector<std::vector<int>> crossing = sheets.crossing_triangles();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    StillPart& part = *parts[k];
    part.crossing.assign(part.triangles->size(), 0);
    const int drawn = part.is_rope() ? triangles_of_segment : 1;
    for (const int t : crossing[k]) std::fill_n(part.crossing.begin() + t * drawn, drawn, char{1});
  }
}

}  // namespace

Subject::Subject(const std::string& path) : path_(path) {
  if (!std::filesystem::is_directory(path)) {
    meshes_.push_back(file_shape(path, false));
    return;
  }
  recording_ = std::make_unique<Recording>(path);
  for (std::size_t k = 0; k < recording_->shapes().size(); ++k) {
    const RecordedShape& shape = recording_->shapes()[k];
    drawn_.emplace_back(shape);
    sectors_.push_back(shape.body && shape.moves && !shape.mesh.positions.empty()
                           ? ball_from_middle(recording_->positions(k, 0))
                           : std::vector<Vec3>());
  }
}

void Subject::add_body(const std::string& path) { meshes_.push_back(file_shape(path, true)); }

std::string Subject::title() const {
  std::filesystem::path path(path_);
  if (!path.has_filename()) path = path.parent_path();  // "out/poncho/"
  return (is_run() ? path.filename() : path.stem()).string();
}

Names Subject::missing() const { return recording_ ? recording_->missing() : Names(); }

std::vector<double> Subject::values(std::size_t shape, int frame, Field field) const {
  std::vector<double> values;
  if (field == Field::strain) values = recording_->strains(shape, frame);
  if (field == Field::speed) {
    const std::vector<Vec3> velocities = recording_->velocities(shape, frame);
    values.reserve(velocities.size());
    for (const Vec3& v : velocities) values.push_back(v.norm());
  }
  if (field == Field::contact) {
    const std::vector<Touch> touches = recording_->touches(shape, frame);
    values.reserve(touches.size());
    for (Touch touch : touches) values.push_back(static_cast<double>(touch));
  }
  return values;
}

Still Subject::still(int frame, std::optional<Field> field) const {
  end_if_interrupted();
  Still still;
  int cloths = 0;
  bool coloured = false;
  const auto add = [&](bool body, std::vector<Vec3> positions,
                       const std::vector<Triangle>& triangles) -> StillPart& {
    StillPart& part = still.parts.emplace_back();
    part.body = body;
    part.cloth = body ? 0 : cloths++;
    part.positions = std::move(positions);
    part.triangles = &triangles;
    return part;
  };
  for (std::size_t k = 0; recording_ && k < recording_->shapes().size(); ++k) {
    const RecordedShape& shape = recording_->shapes()[k];
    std::vector<Vec3> own = recording_->positions(k, frame);
    StillPart& part = add(shape.body, drawn_[k].positions(own), drawn_[k].triangles());
    if (drawn_[k].is_tube()) part.axis = std::move(own);
    if (!sectors_[k].empty()) part.sectors = &sectors_[k];
    if (field && field != Field::crossing && !shape.body)
      part.values = drawn_[k].values(values(k, frame, *field));
    coloured = coloured || !part.values.empty();
  }
  for (const RecordedShape& shape : meshes_) add(shape.body, shape.mesh.positions, shape.mesh.triangles);
  if (recording_) still.planes = recording_->planes(frame);
  if (field == Field::crossing) {
    mark_crossings(still);
  } else if (field && !coloured) {
    const std::string name = field_names[static_cast<std::size_t>(*field)];
    throw InputError(path_ + (recording_ ? ": frame " + std::to_string(frame + 1) + " has no " + name +
                                               " of its cloths; run it again to record that"
                                         : ": a mesh has no " + name +
                                               " to be coloured by; only an output "
                                               "folder of a run has"));
  }
  return still;
}

}  // namespace drape::app::drawing
