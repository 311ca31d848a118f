// A table a cloth, a row for each vertex of each frame: frame (from 1, of the run), time [s], vertex (from
// 0), x y z [m], vx vy vz [m/s], strain (0.01 = 1 %), contact (0 free, 1 slides, 2 sticks). What the run did
// not record is empty.
#pragma once

#include "app/export/files.h"
#include "app/export/source.h"

namespace drape {

Names csv_files(const ExportSource& source);  // NAME.csv of each cloth and soft body
void write_csv(const ExportSource& source, ExportFiles& files, Names& notes);

}  // namespace drape
