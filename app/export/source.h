// What is exported: a recording, and some of its frames.
#pragma once

#include <string>
#include <vector>

#include "app/recording/recording.h"

namespace drape::app {

struct ExportSource {
  const Recording& recording;
  std::vector<int> frames;  // frame numbers in the recording, ascending; at least one
  std::string name;         // for a file that holds the whole scene
  int skipped = 0;          // number of frames left out because they have the time of the frame before

  std::size_t frame_count() const { return frames.size(); }
  std::size_t shape_count() const { return recording.shapes().size(); }
  const RecordedShape& shape(std::size_t s) const { return recording.shapes()[s]; }
  double time(std::size_t k) const { return recording.time(frames[k]); }  // s
  // Positions [m] of shape s in frame k of this list. Throws Interrupted, because every format calls this for
  // each frame.
  std::vector<Vec3> positions(std::size_t s, std::size_t k) const;
  // Cloths and soft bodies always count as moving, because a sequence for some of them only would be of no
  // use.
  bool moves(std::size_t s) const { return !shape(s).body || shape(s).moves; }
};

// Takes every so many frames, beginning with the first. When a run has more frames than steps, several frames
// show the end of one step and have the same time; only the first of them is taken, since most formats demand
// times that rise. Times that are equal in float32 count as the same. Throws InputError when there is no
// frame.
ExportSource export_source(const Recording& recording, int every);

// Frames per second, from the median of the spacings, since the last frame may come early; 24 for a single
// frame.
double usual_frame_rate(const ExportSource& source);

}  // namespace drape::app
