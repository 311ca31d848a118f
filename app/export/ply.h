// Exports Stanford PLY, binary little endian, one file for each frame.                      [Turk 1994]
//   element vertex: float x y z [m], and float s t where every vertex has one uv
//   element face: list uchar int vertex_indices, the polygons of the input (uint in place of uchar where one
//   has more than 255 corners)
#pragma once

#include "app/export/faces.h"
#include "app/export/files.h"
#include "app/export/source.h"

namespace drape::app {

// The bytes of a file. `uv` has one entry for each vertex, or is empty; `time` is in s.
std::string ply_bytes(const std::vector<Vec3>& positions, const std::vector<Uv>& uv, const Faces& faces,
                      double time);

Names ply_files(const ExportSource& source);
void write_ply(const ExportSource& source, ExportFiles& files, Names& notes);

}  // namespace drape::app
