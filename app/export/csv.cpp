#include "app/export/csv.h"

#include "app/export/numbers.h"

namespace drape::app {
namespace {

struct CsvFrame {
  std::vector<Vec3> positions, velocities;
  std::vector<double> strains;
  std::vector<Touch> touches;
};

void append_vector(std::string& text, const std::vector<Vec3>& vectors, std::size_t i) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    text += ',';
    if (!vectors.empty()) append_text(text, vectors[i][k]);
  }
}

std::string rows(const std::string& start, const CsvFrame& frame) {
  std::string text;
  for (std::size_t i = 0; i < frame.positions.size(); ++i) {
    text += start + std::to_string(i);
    append_vector(text, frame.positions, i);
    append_vector(text, frame.velocities, i);
    text += ',';
    if (!frame.strains.empty()) append_text(text, frame.strains[i]);
    text += ',';
    if (!frame.touches.empty()) text += std::to_string(static_cast<int>(frame.touches[i]));
    text += '\n';
  }
  return text;
}

}  // namespace

Names csv_files(const ExportSource& source) {
  Names names;
  for (const RecordedShape& shape : source.recording.shapes())
    if (!shape.body) names.push_back(shape.name + ".csv");
  return names;
}

void write_csv(const ExportSource& source, ExportFiles& files, Names&) {
  const Recording& recording = source.recording;
  for (std::size_t s = 0; s < source.shape_count(); ++s) {
    if (source.shape(s).body) continue;
    AtomicFile& file = files.open(source.shape(s).name + ".csv");
    file.write("frame,time,vertex,x,y,z,vx,vy,vz,strain,contact\n");
    for (std::size_t k = 0; k < source.frame_count(); ++k) {
      const int frame = source.frames[k];
      const std::string start = std::to_string(frame + 1) + "," + shortest(source.time(k)) + ",";
      file.write(rows(start, {source.positions(s, k), recording.velocities(s, frame),
                              recording.strains(s, frame), recording.touches(s, frame)}));
    }
  }
}

}  // namespace drape::app
