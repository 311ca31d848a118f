// The output folder of a run, read back: what was draped, over what, frame by frame. Viewer, pictures and
// exports all start here.
//   A run without frames has one, its last state. Frames count from 0, vertices are the file's.
//   What is missing or damaged is told as data (missing()); what is left is there to be looked at.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/base/json.h"
#include "app/base/words.h"
#include "app/recording/touch.h"
#include "constraints/pose.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape {

struct RecordedShape {
  std::string name;    // of its files, NAME.obj
  bool body = false;   // what is draped over; else a cloth or a soft body
  bool moves = false;  // else it stands at mesh.positions in every frame
  TriangleMesh mesh;   // faces, uv, groups as in the input; positions at the end of the run [m]
};

// A body without end; it may move.
struct RecordedPlane {
  std::string name;
  Vec3 point, normal;  // m, unit
};

// steps.csv: rows[step][column]; what is not a number there is nan.
struct RecordedSteps {
  Names columns;
  std::vector<std::vector<double>> rows;
};

class Recording {
 public:
  // Reads run.json, steps.csv and the shapes; frames are read from their files when they are asked for.
  // Throws InputError when there is no such folder, or nothing in it that can be shown.
  explicit Recording(std::filesystem::path folder);

  // Throws InputError with the first of missing(): for what must not go on with half a result.
  void require_whole() const;
  const Names& missing() const { return missing_; }  // a line each, with the file; empty: all is there

  const std::filesystem::path& folder() const { return folder_; }
  const Json& run() const { return run_; }  // run.json; null when it is missing
  const RecordedSteps& steps() const { return steps_; }

  int frames() const { return static_cast<int>(times_.size()); }
  double time(int frame) const { return times_[static_cast<std::size_t>(frame)]; }  // s
  double frame_rate() const;  // 1/s, the mean; 0 of a single frame

  const std::vector<RecordedShape>& shapes() const { return shapes_; }  // cloths, soft bodies, then bodies
  std::vector<RecordedPlane> planes(int frame) const;

  std::vector<Vec3> positions(std::size_t shape, int frame) const;  // m
  // Of each vertex of a cloth or soft body; empty where the run did not record it, and of bodies.
  std::vector<Vec3> velocities(std::size_t shape, int frame) const;  // m/s
  std::vector<double> strains(std::size_t shape, int frame) const;   // l / L - 1 of its most stretched edge
  std::vector<Touch> touches(std::size_t shape, int frame) const;

 private:
  // Where the places of a shape or a plane are.
  struct Source {
    std::filesystem::path cache;  // a PC2 file; or empty
    bool files = false;           // frames/NAME_0001.obj
    std::vector<Pose> poses;      // of each frame; empty: it is not moved as a whole
    Pose last;                    // where it is drawn
    Names fields;                 // that are there and whole
  };

  void read_run();
  void read_times();
  void read_steps();
  void add_shape(const std::string& name, const std::filesystem::path& file, bool body);
  void add_body(const Json& body, const std::string& name,
                const std::map<std::string, std::vector<Pose>>& poses);
  void find_shapes();
  void find_frames(std::size_t shape);
  void use_cache(std::size_t shape, const std::filesystem::path& cache);
  bool wrote(std::string_view frames) const;  // this kind, as far as run.json tells
  void find_field(std::size_t shape, const char* name);
  void settle_frames();
  std::map<std::string, std::vector<Pose>> read_poses();
  void miss(const std::filesystem::path& file, const std::string& what);
  std::vector<Vec3> read_positions(std::size_t shape, int frame) const;
  std::vector<float> field(std::size_t shape, const char* name, int frame) const;

  std::filesystem::path folder_;
  Names missing_;
  Json run_;
  bool times_told_ = false;  // by run.json
  RecordedSteps steps_;
  std::vector<double> times_;
  std::vector<RecordedShape> shapes_;
  std::vector<Source> sources_;        // of shapes_
  std::vector<RecordedPlane> planes_;  // as they were drawn
  std::vector<std::vector<Pose>> plane_poses_;
  std::vector<int> frame_counts_;  // of shapes_; 0: it stands
};

}  // namespace drape
