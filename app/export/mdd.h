// Exports LightWave point caches, all big endian:
//   int32 frames, int32 points, float32 time [s] of each frame, then for each frame the float32 x y z of
//   every point [m].
#pragma once

#include "app/export/files.h"
#include "app/export/source.h"

namespace drape::app {

std::string mdd_header(const std::vector<double>& times, int points);  // s
std::string mdd_frame(const std::vector<Vec3>& positions);             // m

// The names NAME.mdd, one for each cloth and each body that moves.
Names mdd_files(const ExportSource& source);
void write_mdd(const ExportSource& source, ExportFiles& files, Names& notes);

}  // namespace drape::app
