// Universal Scene Description as text: a Mesh for each shape with polygons, uv of the corners, and by time
// points, extent, normals and velocities.
//   Metres, y up; one time code is a frame of the usual spacing, time = code / timeCodesPerSecond.
//   A prim's name is the shape's as far as it can be one (letters, digits, _); displayName is the shape's.
#pragma once

#include "app/export/files.h"
#include "app/export/source.h"

namespace drape {

// Different ones for different shapes.
Names usd_names(const Names& shapes);
std::string usd_string(std::string_view text);  // in quotes, escaped

Names usda_files(const ExportSource& source);
void write_usda(const ExportSource& source, ExportFiles& files, Names& notes);

}  // namespace drape
