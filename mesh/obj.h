// Reading and writing Wavefront OBJ files without losing what the solver does not use.
//   Vertex order is kept exactly; polygons are cut into triangles for the simulation and written back whole;
//   uv, normals, groups, objects, materials, smoothing groups, lines, points and comments survive a round trip.
// Errors: std::runtime_error "FILE:LINE: what was found, what to do".
#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace drape {

// A user's mistake in a file or an option: the message is one line that says where, what and what to do.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct ObjCorner {
  int v;        // vertex, from 0
  int vt = -1;  // texture coordinate, -1: none
  int vn = -1;  // normal, -1: none
};

// A line that is kept as it stands ('g', 'o', 'usemtl', 'mtllib', 's', comments, resolved 'l' and 'p'),
// and the number of faces before it.
struct ObjStatement {
  std::size_t before_face;
  std::string text;
};

struct ObjDocument {
  std::vector<std::string> vertex_extras;     // text after x y z (w or colour) of each vertex; empty: none in the file
  std::vector<std::string> texcoords;         // text after "vt "
  std::vector<Vec3> normals;                  // as read
  std::vector<ObjCorner> corners;             // of all faces, one after the other
  std::vector<std::size_t> face_start;        // faces + 1 entries into corners
  std::vector<ObjStatement> statements;       // in file order
  std::vector<std::string> warnings;          // what was passed over, with line numbers
};

// Throws InputError (missing, a directory, binary, empty, no vertices, no faces, nan or inf, faces beyond the vertices).
TriangleMesh read_obj(const std::filesystem::path& path);

// The same from memory; `name` stands in error messages.
TriangleMesh parse_obj(std::string_view text, const std::string& name);

// The mesh's document (or its triangles when it has none) with these positions [m], normals recomputed where the file had
// them. Written to a temporary file beside `path`, then renamed. Throws InputError when it cannot be written.
void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh, const std::vector<Vec3>& positions);

std::string format_obj(const TriangleMesh& mesh, const std::vector<Vec3>& positions);

}  // namespace drape
