#include "app/export/usda.h"

#include <algorithm>
#include <cmath>

#include "app/export/faces.h"
#include "app/export/numbers.h"
#include "mesh/triangles/extent.h"

namespace drape::app {
namespace {

void append_tuple(std::string& text, const auto& numbers) {
  const char* before = "(";
  for (const double number : numbers) {
    text += before;
    append_text(text, number);
    before = ", ";
  }
  text += ')';
}

std::string list_of(const auto& items, const auto& append) {
  std::string text = "[";
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += ", ";
    append(text, items[i]);
  }
  return text + "]";
}

std::string tuples(const auto& items) {
  return list_of(items, [](std::string& text, const auto& item) { append_tuple(text, item); });
}

std::string integers(const std::vector<int>& numbers) {
  return list_of(numbers, [](std::string& text, int number) { text += std::to_string(number); });
}

// radius [m]: how far what is at the positions reaches around them.
std::string extent(const std::vector<Vec3>& positions, double radius = 0) {
  if (positions.empty()) return "[]";
  const Eigen::AlignedBox3d box = box_of(positions);
  const Vec3 around = Vec3::Constant(radius);
  return tuples(std::vector<Vec3>{box.min() - around, box.max() + around});
}

class UsdaWriter {
 public:
  UsdaWriter(const ExportSource& source, AtomicFile& file)
      : source_(source), file_(file), rate_(usual_frame_rate(source)) {}

  void write() {
    Names shapes;
    for (const RecordedShape& shape : source_.recording.shapes()) shapes.push_back(shape.name);
    const Names names = usd_names(shapes);
    header(usd_names({source_.name}).front());
    for (std::size_t s = 0; s < source_.shape_count(); ++s)
      source_.shape(s).mesh.triangles.empty() ? curve(s, names[s]) : mesh(s, names[s]);
    file_.write("}\n");
  }

 private:
  // Frames of the usual spacing have whole codes.
  std::string code(std::size_t k) const { return shortest(std::round(source_.time(k) * rate_ * 1e6) / 1e6); }

  void header(const std::string& root) {
    const std::string rate = shortest(std::round(rate_ * 1e9) / 1e9);
    file_.write("#usda 1.0\n(\n    defaultPrim = \"" + root + "\"\n    doc = \"drape\"\n");
    file_.write("    endTimeCode = " + code(source_.frame_count() - 1) + "\n    framesPerSecond = " + rate);
    file_.write("\n    metersPerUnit = 1\n    startTimeCode = " + code(0));
    file_.write("\n    timeCodesPerSecond = " + rate + "\n    upAxis = \"Y\"\n)\n\n");
    file_.write("def Xform \"" + root + "\" (\n    displayName = " + usd_string(source_.name) + "\n)\n{\n");
  }

  void line(const std::string& text) { file_.write("        " + text + "\n"); }

  // The attribute in every frame, or once where the shape stands. value(k): its text.
  void attribute(const std::string& name, std::size_t s, const auto& value) {
    if (!source_.moves(s)) return line(name + " = " + value(std::size_t{0}));
    line(name + ".timeSamples = {");
    for (std::size_t k = 0; k < source_.frame_count(); ++k) line("    " + code(k) + ": " + value(k) + ",");
    line("}");
  }

  void velocities(std::size_t s) {
    if (source_.recording.velocities(s, source_.frames[0]).empty()) return;
    attribute("vector3f[] velocities", s,
              [&](std::size_t k) { return tuples(source_.recording.velocities(s, source_.frames[k])); });
  }

  // A rope, as thick as it is.
  void curve(std::size_t s, const std::string& name) {
    const RecordedShape& shape = source_.shape(s);
    file_.write("    def BasisCurves \"" + name + "\" (\n        displayName = " + usd_string(shape.name) +
                "\n    )\n    {\n");
    line("int[] curveVertexCounts = [" + std::to_string(shape.mesh.vertex_count()) + "]");
    attribute("float3[] extent", s,
              [&](std::size_t k) { return extent(source_.positions(s, k), shape.radius); });
    attribute("point3f[] points", s, [&](std::size_t k) { return tuples(source_.positions(s, k)); });
    line("uniform token type = \"linear\"");
    velocities(s);
    line("float[] widths = [" + shortest(2 * shape.radius) + "] (");
    line("    interpolation = \"constant\"");
    line(")");
    line("uniform token wrap = \"nonperiodic\"");
    file_.write("    }\n");
  }

  void mesh(std::size_t s, const std::string& name) {
    const RecordedShape& shape = source_.shape(s);
    const Faces faces = faces_of(shape.mesh);
    file_.write("    def Mesh \"" + name + "\" (\n        displayName = " + usd_string(shape.name) +
                "\n    )\n    {\n");
    line("uniform bool doubleSided = 1");
    attribute("float3[] extent", s, [&](std::size_t k) { return extent(source_.positions(s, k)); });
    line("int[] faceVertexCounts = " + integers(faces.counts));
    line("int[] faceVertexIndices = " + integers(faces.corners));
    const Corners corners = split_corners(shape.mesh, {}, crease_of(shape.body));
    if (corners.size() == shape.mesh.positions.size()) {  // else it has hard edges: flat faces show them
      attribute("normal3f[] normals", s,
                [&](std::size_t k) { return tuples(normals_of(corners, source_.positions(s, k))); });
    }
    attribute("point3f[] points", s, [&](std::size_t k) { return tuples(source_.positions(s, k)); });
    if (!faces.uv.empty()) {
      line("texCoord2f[] primvars:st = " + tuples(faces.uv) + " (");
      line("    interpolation = \"faceVarying\"");
      line(")");
    }
    line("uniform token subdivisionScheme = \"none\"");
    velocities(s);
    file_.write("    }\n");
  }

  const ExportSource& source_;
  AtomicFile& file_;
  double rate_;
};

}  // namespace

Names usd_names(const Names& shapes) {
  Names names;
  for (const std::string& shape : shapes) {
    std::string start;
    for (const char c : shape) {
      const bool allowed = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
      start += allowed ? c : '_';
    }
    if (start.empty() || (start.front() >= '0' && start.front() <= '9')) start.insert(0, "_");
    std::string name = start;
    for (int n = 2; std::find(names.begin(), names.end(), name) != names.end(); ++n)
      name = start + "_" + std::to_string(n);
    names.push_back(name);
  }
  return names;
}

std::string usd_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c >= 0 && c < 32 ? ' ' : c;
  }
  return quoted + '"';
}

Names usda_files(const ExportSource& source) { return {source.name + ".usda"}; }

void write_usda(const ExportSource& source, ExportFiles& files, Names&) {
  UsdaWriter(source, files.open(source.name + ".usda")).write();
}

}  // namespace drape::app
