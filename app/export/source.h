// What is exported: a recording, and which of its frames.
#pragma once

#include <string>
#include <vector>

#include "app/recording.h"

namespace drape {

struct ExportInterrupted {};  // by Ctrl-C

struct ExportSource {
  const Recording& recording;
  std::vector<int> frames;  // of the recording, ascending; at least one
  std::string name;         // of a file that holds the whole scene

  std::size_t frame_count() const { return frames.size(); }
  std::size_t shape_count() const { return recording.shapes().size(); }
  const RecordedShape& shape(std::size_t s) const { return recording.shapes()[s]; }
  double time(std::size_t k) const { return recording.time(frames[k]); }  // s
  // m. Throws ExportInterrupted: every format asks for this, frame by frame.
  std::vector<Vec3> positions(std::size_t s, std::size_t k) const;
  // Cloths and soft bodies always do: there is no use in a sequence for some and not for others.
  bool moves(std::size_t s) const { return !shape(s).body || shape(s).moves; }
};

// Every so many frames, beginning with the first. Throws InputError when there is none.
ExportSource export_source(const Recording& recording, int every);

// Frames a second: of the spacing that most frames have, since the last one may come early; 24 of a single
// frame.
double usual_frame_rate(const ExportSource& source);

}  // namespace drape
