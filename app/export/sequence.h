// Writes one file for each frame of a shape that moves, NAME_0001 and so on, and one file NAME for a shape
// that does not.
#pragma once

#include "app/export/files.h"
#include "app/export/source.h"
#include "app/recording/run_files.h"

namespace drape::app {

Names sequence_files(const ExportSource& source, const std::string& ending);

// make(shape, frame of the source) returns the bytes of a file.
template <class Make>
void write_sequence(const ExportSource& source, const std::string& ending, ExportFiles& files,
                    const Make& make) {
  for (std::size_t s = 0; s < source.shape_count(); ++s) {
    const std::string& name = source.shape(s).name;
    if (!source.moves(s)) {
      files.write(name + ending, make(s, std::size_t{0}));
      continue;
    }
    for (std::size_t k = 0; k < source.frame_count(); ++k)
      files.write(numbered(name, k + 1, ending), make(s, k));
    files.end_sequence(name, source.frame_count(), ending);
  }
}

}  // namespace drape::app
