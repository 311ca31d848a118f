// Exports Universal Scene Description as text: a Mesh for each shape, with polygons, uv of the corners, and
// samples in time of points, extent, normals and velocities.
//   Metres, y up. One time code is one frame of the usual spacing: time = code / timeCodesPerSecond.
//   The name of a prim is the shape's name as far as a prim can have it (letters, digits, _); displayName is
//   the shape's name itself.
#pragma once

#include "app/export/files.h"
#include "app/export/source.h"

namespace drape::app {

// Names of prims, different for different shapes.
Names usd_names(const Names& shapes);
std::string usd_string(std::string_view text);  // in quotes, escaped

Names usda_files(const ExportSource& source);
void write_usda(const ExportSource& source, ExportFiles& files, Names& notes);

}  // namespace drape::app
