#include "app/export/source.h"

#include <algorithm>

#include "app/base/interrupt.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

bool rises(double before, double now) { return static_cast<float>(now) > static_cast<float>(before); }

}  // namespace

std::vector<Vec3> ExportSource::positions(std::size_t s, std::size_t k) const {
  end_if_interrupted();
  return recording.positions(s, frames[k]);
}

ExportSource export_source(const Recording& recording, int every) {
  const std::filesystem::path folder = std::filesystem::weakly_canonical(recording.folder());
  ExportSource source{recording, {}, folder.filename().string()};
  if (source.name.empty()) source.name = "drape";
  for (int frame = 0; frame < recording.frames(); frame += every) {
    if (source.frames.empty() || rises(recording.time(source.frames.back()), recording.time(frame)))
      source.frames.push_back(frame);
    else
      ++source.skipped;
  }
  if (source.frames.empty()) throw InputError(recording.folder().string() + ": has no frames to export");
  return source;
}

double usual_frame_rate(const ExportSource& source) {
  std::vector<double> spacings;
  for (std::size_t k = 1; k < source.frame_count(); ++k)
    spacings.push_back(source.time(k) - source.time(k - 1));
  if (spacings.empty()) return 24;
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  return 1 / *middle;
}

}  // namespace drape::app
