#include "app/export/vtk.h"

#include "app/base/markup.h"
#include "app/export/bytes.h"
#include "app/export/sequence.h"

namespace drape::app {
namespace {

constexpr auto little = std::endian::little;

// What stands behind the XML: blocks of bytes, each with its length before it.
class Appended {
 public:
  // <DataArray .../> for a block of these bytes.
  std::string add(const std::string& type, const std::string& name, int components,
                  const std::string& bytes) {
    std::string element = "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                          std::to_string(components) + "\" format=\"appended\" offset=\"" +
                          std::to_string(blocks_.size()) + "\"/>\n";
    const std::uint64_t length = bytes.size();
    append_word<little>(blocks_, static_cast<std::uint32_t>(length));
    append_word<little>(blocks_, static_cast<std::uint32_t>(length >> 32));
    blocks_ += bytes;
    return element;
  }
  std::string add_vectors(const std::string& name, const std::vector<Vec3>& vectors) {
    std::string bytes;
    append_floats<little>(bytes, vectors);
    return add("Float32", name, 3, bytes);
  }
  const std::string& blocks() const { return blocks_; }

 private:
  std::string blocks_;
};

std::string point_data(const VtpData& data, Appended& appended) {
  std::string text = data.uv.empty() ? "<PointData>\n" : "<PointData TCoords=\"uv\">\n";
  if (!data.velocities.empty()) text += appended.add_vectors("velocity", data.velocities);
  if (!data.strains.empty()) {
    std::string bytes;
    for (const double strain : data.strains) append_float<little>(bytes, strain);
    text += appended.add("Float32", "strain", 1, bytes);
  }
  if (!data.touches.empty()) {
    std::string bytes;
    for (const Touch touch : data.touches) bytes += static_cast<char>(touch);
    text += appended.add("UInt8", "contact", 1, bytes);
  }
  if (!data.uv.empty()) {
    std::string bytes;
    for (const Uv& uv : data.uv)
      for (const double coordinate : uv) append_float<little>(bytes, coordinate);
    text += appended.add("Float32", "uv", 2, bytes);
  }
  return text + "</PointData>\n";
}

std::string polygons(const Faces& faces, Appended& appended) {
  std::string corners, ends;
  for (const int corner : faces.corners) append_int<little>(corners, corner);
  int end = 0;
  for (const int count : faces.counts) append_int<little>(ends, end += count);
  return "<Polys>\n" + appended.add("Int32", "connectivity", 1, corners) +
         appended.add("Int32", "offsets", 1, ends) + "</Polys>\n";
}

std::string line(const std::vector<int>& vertices, Appended& appended) {
  if (vertices.empty()) return {};
  std::string corners, end;
  for (const int v : vertices) append_int<little>(corners, v);
  append_int<little>(end, static_cast<int>(vertices.size()));
  return "<Lines>\n" + appended.add("Int32", "connectivity", 1, corners) +
         appended.add("Int32", "offsets", 1, end) + "</Lines>\n";
}

std::string pvd_text(const ExportSource& source) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (std::size_t k = 0; k < source.frame_count(); ++k) {
    for (std::size_t s = 0; s < source.shape_count(); ++s) {
      const std::string& name = source.shape(s).name;
      const std::string file = source.moves(s) ? numbered(name, k + 1, ".vtp") : name + ".vtp";
      text += "<DataSet timestep=\"" + shortest(source.time(k)) + "\" part=\"" + std::to_string(s) +
              "\" name=\"" + escaped(name) + "\" file=\"" + escaped(file) + "\"/>\n";
    }
  }
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace

std::string vtp_bytes(const VtpData& data, const Faces& faces, double time) {
  Appended appended;
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" "
      "NumberOfTuples=\"1\" format=\"ascii\">" +
      shortest(time) + "</DataArray>\n</FieldData>\n";
  text += "<Piece NumberOfPoints=\"" + std::to_string(data.positions.size()) + "\" NumberOfLines=\"" +
          (faces.line.empty() ? "0" : "1") + "\" NumberOfPolys=\"" + std::to_string(faces.counts.size()) +
          "\">\n";
  text += point_data(data, appended);
  text += "<Points>\n" + appended.add_vectors("Points", data.positions) + "</Points>\n";
  text += line(faces.line, appended);
  text += polygons(faces, appended);
  text += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  return text + appended.blocks() + "\n</AppendedData>\n</VTKFile>\n";
}

Names vtk_files(const ExportSource& source) {
  Names names = sequence_files(source, ".vtp");
  names.push_back(source.name + ".pvd");
  return names;
}

void write_vtk(const ExportSource& source, ExportFiles& files, Names& notes) {
  const Recording& recording = source.recording;
  std::vector<Faces> faces;
  std::vector<std::vector<Uv>> uv;
  for (const RecordedShape& shape : recording.shapes()) {
    faces.push_back(faces_of(shape.mesh));
    uv.push_back(uv_by_vertex(faces.back(), shape.mesh.positions.size()));
    if (uv.back().empty() && !faces.back().uv.empty())
      notes.push_back(shape.name + ": no uv, since some vertices have two and VTK has one for each");
  }
  write_sequence(source, ".vtp", files, [&](std::size_t s, std::size_t k) {
    const int frame = source.frames[k];
    return vtp_bytes({source.positions(s, k), recording.velocities(s, frame), recording.strains(s, frame),
                      recording.touches(s, frame), uv[s]},
                     faces[s], source.time(k));
  });
  files.write(source.name + ".pvd", pvd_text(source));
}

}  // namespace drape::app
