// Reading and writing Wavefront OBJ files without losing what the solver does not use.
//   Vertex order is kept exactly; polygons are cut into triangles for the simulation and written back whole;
//   uv, normals, groups, objects, materials, smoothing, lines, points and comments survive a round trip.
// Errors: InputError "FILE:LINE: what was found, what to do", one line; it counts from 1, as the file does.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/base/errors.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape {

// A list of short texts in one block of memory: what a std::string per vertex would cost 32 bytes each for.
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
  int vt = -1;  // texture coordinate, -1: none
  int vn = -1;  // normal, -1: none
  bool operator==(const ObjCorner&) const = default;
};

// A line that is kept as it stands ('g', 'o', 'usemtl', 'mtllib', 's', comments, resolved 'l' and 'p', ...),
// and where it stood.
struct ObjStatement {
  std::size_t before_face;  // the number of faces before it
  std::string text;
  bool before_vertices = false;  // it stood before the first vertex
  bool operator==(const ObjStatement&) const = default;
};

struct ObjDocument {
  TextList vertex_extras;                // text after x y z (w, colour, comment) of each vertex, or empty
  TextList texcoords;                    // text after "vt "
  std::vector<Vec3> normals;             // as read
  std::vector<ObjCorner> corners;        // of all faces, one after the other
  std::vector<std::size_t> face_start;   // faces + 1 entries into corners
  std::vector<ObjStatement> statements;  // in file order
  std::vector<std::string> warnings;     // what was passed over: one for each kind, with its first line

  std::size_t face_count() const { return face_start.empty() ? 0 : face_start.size() - 1; }
};

// Throws InputError (missing, a directory, binary, empty, no vertices, no faces, nan or inf, faces beyond the
// vertices).
TriangleMesh read_obj(const std::filesystem::path& path);

// The same from memory; `name` stands in error messages.
TriangleMesh parse_obj(std::string_view text, const std::string& name);

// A line of vertices with the name of the 'g' (its first word) or else of the 'o' before it.
struct Polyline {
  std::string name;           // empty: neither was named
  std::vector<int> vertices;  // in order; a closed line ends with its first vertex again
};
// The 'l' lines of the mesh's document, in the file's order; one that goes on where the one before it ended,
// under the same name, is part of it. What broken lines named was left out when the file was read.
std::vector<Polyline> polylines(const TriangleMesh& mesh);

// The mesh's document (or its triangles when it has none) with these positions [m], normals recomputed where
// the file had them. Written to a temporary file beside `path`, then renamed. Throws InputError when it
// cannot be written.
void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh,
               const std::vector<Vec3>& positions);

// Normals: all corners at one vertex that share a vn entry share their new normal, the normalised sum of the
// area-weighted normals of their faces, so that smooth stays smooth and hard stays hard. An entry that served
// several vertices (exporters write one vn for a whole flat sheet) gets further entries, after the others,
// where those vertices no longer agree.
std::string format_obj(const TriangleMesh& mesh, const std::vector<Vec3>& positions);

}  // namespace drape
