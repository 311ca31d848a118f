#include "app/export/ply.h"

#include <algorithm>

#include "app/export/bytes.h"
#include "app/export/sequence.h"

namespace drape::app {
namespace {

constexpr auto little = std::endian::little;

std::string header(std::size_t vertices, bool has_uv, std::size_t faces, bool wide, std::size_t edges,
                   double time) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment drape, " + shortest(time) + " s\n";
  text += "element vertex " + std::to_string(vertices) + "\n";
  for (const char* axis : {"x", "y", "z"}) (text += "property float ") += std::string(axis) + "\n";
  if (has_uv) text += "property float s\nproperty float t\n";
  text += "element face " + std::to_string(faces) + "\n";
  text += std::string("property list ") + (wide ? "uint" : "uchar") + " int vertex_indices\n";
  if (edges > 0)
    text += "element edge " + std::to_string(edges) + "\nproperty int vertex1\nproperty int vertex2\n";
  return text + "end_header\n";
}

}  // namespace

std::string ply_bytes(const std::vector<Vec3>& positions, const std::vector<Uv>& uv, const Faces& faces,
                      double time) {
  const bool wide = std::any_of(faces.counts.begin(), faces.counts.end(), [](int n) { return n > 255; });
  const std::size_t edges = faces.line.empty() ? 0 : faces.line.size() - 1;
  std::string bytes = header(positions.size(), !uv.empty(), faces.counts.size(), wide, edges, time);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (const double coordinate : positions[i]) append_float<little>(bytes, coordinate);
    if (uv.empty()) continue;
    for (const double coordinate : uv[i]) append_float<little>(bytes, coordinate);
  }
  std::size_t next = 0;
  for (const int count : faces.counts) {
    if (wide)
      append_int<little>(bytes, count);
    else
      bytes += static_cast<char>(static_cast<unsigned char>(count));
    for (int k = 0; k < count; ++k) append_int<little>(bytes, faces.corners[next++]);
  }
  for (std::size_t k = 0; k < edges; ++k)
    for (const std::size_t end : {k, k + 1}) append_int<little>(bytes, faces.line[end]);
  return bytes;
}

Names ply_files(const ExportSource& source) { return sequence_files(source, ".ply"); }

void write_ply(const ExportSource& source, ExportFiles& files, Names& notes) {
  struct Rest {
    Faces faces;
    std::vector<Uv> uv;
  };
  std::vector<Rest> rests;
  for (const RecordedShape& shape : source.recording.shapes()) {
    Faces faces = faces_of(shape.mesh);
    std::vector<Uv> uv = uv_by_vertex(faces, shape.mesh.positions.size());
    if (uv.empty() && !faces.uv.empty())
      notes.push_back(shape.name + ": no uv, since some vertices have two and PLY has one for each");
    rests.push_back({std::move(faces), std::move(uv)});
  }
  write_sequence(source, ".ply", files, [&](std::size_t s, std::size_t k) {
    return ply_bytes(source.positions(s, k), rests[s].uv, rests[s].faces, source.time(k));
  });
}

}  // namespace drape::app
