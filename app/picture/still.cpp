#include "app/picture/still.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "mesh/obj.h"

namespace drape {
namespace {

// A ball that moves has eight sectors of two tones, or nobody could see that it turns: of what moves, the
// bodies whose vertices are all as far from their middle. Others have none.
std::vector<char> ball_marks(const TriangleMesh& mesh, const std::vector<Vec3>& first) {
  Vec3 low = first[0], high = first[0];
  for (const Vec3& p : first) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec3 middle = (low + high) / 2;
  const double radius = (high - low).maxCoeff() / 2;
  for (const Vec3& p : first)
    if (std::abs((p - middle).norm() - radius) > 0.02 * radius) return {};
  std::vector<char> marks;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 out = (first[t[0]] + first[t[1]] + first[t[2]]) / 3 - middle;
    marks.push_back(std::lround(std::floor(std::atan2(out.z(), out.x()) / (std::numbers::pi / 4))) % 2 == 0);
  }
  return marks;
}

RecordedShape file_shape(const std::string& path, bool body) {
  return {std::filesystem::path(path).stem().string(), body, false, read_obj(path)};
}

const char* name_of(Field field) {
  return field == Field::strain ? "strain" : field == Field::speed ? "speed" : "contact";
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
    marks_.push_back(shape.body && shape.moves && !shape.mesh.positions.empty()
                         ? ball_marks(shape.mesh, recording_->positions(k, 0))
                         : std::vector<char>());
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
  if (field == Field::speed)
    for (const Vec3& v : recording_->velocities(shape, frame)) values.push_back(v.norm());
  if (field == Field::contact)
    for (Touch touch : recording_->touches(shape, frame)) values.push_back(static_cast<double>(touch));
  return values;
}

Still Subject::still(int frame, std::optional<Field> field) const {
  Still still;
  int cloths = 0;
  bool coloured = false;
  const auto add = [&](const RecordedShape& shape, std::vector<Vec3> positions) -> StillPart& {
    still.parts.push_back(
        {shape.body, shape.body ? 0 : cloths++, std::move(positions), &shape.mesh.triangles, nullptr, {}});
    return still.parts.back();
  };
  for (std::size_t k = 0; recording_ && k < recording_->shapes().size(); ++k) {
    const RecordedShape& shape = recording_->shapes()[k];
    StillPart& part = add(shape, recording_->positions(k, frame));
    if (!marks_[k].empty()) part.marked = &marks_[k];
    if (field && !shape.body) part.values = values(k, frame, *field);
    coloured = coloured || !part.values.empty();
  }
  for (const RecordedShape& shape : meshes_) add(shape, shape.mesh.positions);
  if (recording_) still.planes = recording_->planes(frame);
  if (field && !coloured) {
    const std::string name = name_of(*field);
    throw InputError(path_ + (recording_ ? ": frame " + std::to_string(frame + 1) + " has no " + name +
                                               " of its cloths; run it again to record that"
                                         : ": a mesh has no " + name +
                                               " to be coloured by; only an output "
                                               "folder of a run has"));
  }
  return still;
}

}  // namespace drape
