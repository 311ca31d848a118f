// What is exported: a recording, and which of its frames.
#pragma once

#include <string>
#include <vector>

#include "app/recording/recording.h"

namespace drape {

struct ExportSource {
  const Recording& recording;
  std::vector<int> frames;  // of the recording, ascending; at least one
  std::string name;         // of a file that holds the whole scene
  int skipped = 0;          // frames whose time is that of the frame before

  std::size_t frame_count() const { return frames.size(); }
  std::size_t shape_count() const { return recording.shapes().size(); }
  const RecordedShape& shape(std::size_t s) const { return recording.shapes()[s]; }
  double time(std::size_t k) const { return recording.time(frames[k]); }  // s
  // m. Throws Interrupted: every format asks for this, frame by frame.
  std::vector<Vec3> positions(std::size_t s, std::size_t k) const;
  // Cloths and soft bodies always do: there is no use in a sequence for some and not for others.
  bool moves(std::size_t s) const { return !shape(s).body || shape(s).moves; }
};

// Every so many frames, beginning with the first. A run of more frames than steps has several of one time, as
// they were at the end of one step: the first of them is taken, since times must rise in most formats; times
// that are the same in float32 are, too. Throws InputError when there is no frame.
ExportSource export_source(const Recording& recording, int every);

// Frames a second: of the middle one of their spacings, since the last frame may come
// early; 24 of a single frame.
double usual_frame_rate(const ExportSource& source);

}  // namespace drape
