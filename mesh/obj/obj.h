// Reads and writes Wavefront OBJ files without losing what the solver does not use.
//   The order of the vertices is kept exactly. Polygons are cut into triangles for the simulation and written
//   back whole. Texture coordinates, normals, groups, objects, materials, smoothing, lines, points and
//   comments survive a round trip.
// Errors are InputError in one line: "FILE:LINE: what was found, what to do". Lines and vertices count from
// 1, as in the file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/base/errors.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape {

// A list of short texts in one block of memory. A std::string for each would cost 32 bytes more per text.
class TextList {
 public:
  std::size_t size() const { return ends_.size(); }
  bool empty() const { return ends_.empty(); }
  void push_back(std::string_view line) {
    text_ += line;
    ends_.push_back(text_.size());
  }
  std::string_view operator[](std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : ends_[i - 1];
    return std::string_view(text_).substr(begin, ends_[i] - begin);
  }
  bool operator==(const TextList&) const = default;

 private:
  std::string text_;
  std::vector<std::size_t> ends_;
};

struct ObjCorner {
  int v;        // vertex, from 0
  int vt = -1;  // texture coordinate, from 0; -1 when there is none
  int vn = -1;  // normal, from 0; -1 when there is none
  bool operator==(const ObjCorner&) const = default;
};

// A line that is kept as it is ('g', 'o', 'usemtl', 'mtllib', 's', comments and others), and where it stood
// in the file. In 'l' and 'p' lines relative numbers have been replaced by absolute ones.
struct ObjStatement {
  std::size_t before_face;  // the number of faces that stand before it
  std::string text;
  bool before_vertices = false;  // it stood before the first vertex
  bool operator==(const ObjStatement&) const = default;
};

struct ObjDocument {
  // For each vertex, the text after x y z (w, a colour, a comment). The list is empty when no vertex has one.
  TextList vertex_extras;
  TextList texcoords;                    // the text after "vt " of each texture coordinate
  std::vector<Vec3> normals;             // as they were read
  std::vector<ObjCorner> corners;        // of all faces, one face after the other
  std::vector<std::size_t> face_start;   // number of faces + 1 entries: where each face begins in `corners`
  std::vector<ObjStatement> statements;  // in file order
  std::vector<std::string> warnings;     // what was ignored: one message for each kind, with its first line

  std::size_t face_count() const { return face_start.empty() ? 0 : face_start.size() - 1; }
};

// What a file must have at least: a surface, or lines, such as those of ropes.
enum class ObjNeed { faces, faces_or_lines };

// Throws InputError when the file is missing, a directory, binary or empty, when it has no vertices or not
// what it needs, when a number is not finite, or when a face refers to a vertex that is not there.
TriangleMesh read_obj(const std::filesystem::path& path, ObjNeed need = ObjNeed::faces);

// The same from memory; `name` stands in error messages.
TriangleMesh parse_obj(std::string_view text, const std::string& name, ObjNeed need = ObjNeed::faces);

// A chain of vertices from 'l' lines. Its name is that of the 'g' line before it (the first word), or else
// that of the 'o' line.
struct Polyline {
  std::string name;           // empty when there was neither
  std::vector<int> vertices;  // in order; a closed line ends with its first vertex again
};
// The 'l' lines of the mesh's document, in the order of the file. A line that begins where the line before it
// ended, under the same name, continues that line. Lines that refer to vertices which are not there were left
// out when the file was read.
std::vector<Polyline> polylines(const TriangleMesh& mesh);
// A mesh without triangles whose document has one line through these points, under 'o' and this name.
TriangleMesh line_mesh(const std::vector<Vec3>& points, const std::string& name);

// Writes the mesh's document (or only its triangles when it has none) with these positions [m]. Normals are
// computed anew where the file had normals. The text goes into a temporary file beside `path`, which is then
// renamed. Throws InputError when it cannot be written.
void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh,
               const std::vector<Vec3>& positions);

// The text of such a file. All corners at one vertex that share a vn entry share their new normal too, the
// normalised sum of the area-weighted normals of their faces: so smooth edges stay smooth and hard edges stay
// An entry that served several vertices (some exporters write one vn for a whole flat sheet) is split where
// the normals of those vertices differ; the new entries come after the others.
std::string format_obj(const TriangleMesh& mesh, const std::vector<Vec3>& positions);

}  // namespace drape
