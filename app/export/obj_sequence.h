// Exports Wavefront OBJ, one file for each frame, with the polygons, uv, groups and materials of the input,
// as in OUT/NAME.obj.
#pragma once

#include "app/export/files.h"
#include "app/export/source.h"

namespace drape::app {

Names obj_files(const ExportSource& source);
void write_obj_sequence(const ExportSource& source, ExportFiles& files, Names& notes);

}  // namespace drape::app
