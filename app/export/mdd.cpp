#include "app/export/mdd.h"

#include "app/export/bytes.h"

namespace drape::app {

std::string mdd_header(const std::vector<double>& times, int points) {
  std::string bytes;
  append_int<std::endian::big>(bytes, static_cast<int>(times.size()));
  append_int<std::endian::big>(bytes, points);
  for (const double time : times) append_float<std::endian::big>(bytes, time);
  return bytes;
}

std::string mdd_frame(const std::vector<Vec3>& positions) {
  std::string bytes;
  append_floats<std::endian::big>(bytes, positions);
  return bytes;
}

Names mdd_files(const ExportSource& source) {
  Names names;
  for (std::size_t s = 0; s < source.shape_count(); ++s)
    if (source.moves(s)) names.push_back(source.shape(s).name + ".mdd");
  return names;
}

void write_mdd(const ExportSource& source, ExportFiles& files, Names&) {
  std::vector<double> times;
  for (std::size_t k = 0; k < source.frame_count(); ++k) times.push_back(source.time(k));
  for (std::size_t s = 0; s < source.shape_count(); ++s) {
    if (!source.moves(s)) continue;
    AtomicFile& file = files.open(source.shape(s).name + ".mdd");
    file.write(mdd_header(times, source.shape(s).mesh.vertex_count()));
    for (std::size_t k = 0; k < source.frame_count(); ++k) file.write(mdd_frame(source.positions(s, k)));
  }
}

}  // namespace drape::app
