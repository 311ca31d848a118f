// Exports each cloth and soft body as a table, with a row for each vertex of each frame: frame (of the run,
// from 1), time [s], vertex (from 0), x y z [m], vx vy vz [m/s], strain (0.01 = 1 %), contact (0 free, 1
// slides, 2 sticks, 3 on cloth, 4 stopped). Cells are empty where the run recorded nothing.
#pragma once

#include "app/export/files.h"
#include "app/export/source.h"

namespace drape::app {

Names csv_files(const ExportSource& source);  // NAME.csv of each cloth and soft body
void write_csv(const ExportSource& source, ExportFiles& files, Names& notes);

}  // namespace drape::app
