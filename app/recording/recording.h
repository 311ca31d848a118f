// Reads the output folder of a run: what was draped, over what, frame by frame. The viewer, the pictures and
// the exports all start here.
//   A run without frames has a single one, its last state. Frames count from 0; vertices have the order of
//   the input file.
//   Where a cloth tears, vertices part. All frames have the vertices of the end; before they part they are at one place.
//   What is missing or damaged is reported as data (missing()), and the rest can still be shown.
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

namespace drape::app {

struct RecordedShape {
  std::string name;    // of its files, NAME.obj
  bool body = false;   // true for a body that is draped over, false for a cloth, a soft body or a rope
  bool moves = false;  // false when it stays at mesh.positions in every frame
  TriangleMesh mesh;   // faces, uv, groups as in the input; positions [m] at the end of the run
  double radius = 0;   // m, of a rope, whose mesh has a line and no triangles; 0 of all others
};

// A plane, which has no end; it may move.
struct RecordedPlane {
  std::string name;
  Vec3 point, normal;  // m; unit vector
};

// steps.csv as rows[step][column]; an entry that is not a number is NaN.
struct RecordedSteps {
  Names columns;
  std::vector<std::vector<double>> rows;
};

class Recording {
 public:
  // Reads run.json, steps.csv and the shapes. The frames are read from their files when they are asked for.
  // Throws InputError when there is no such folder, or nothing in it that can be shown.
  explicit Recording(std::filesystem::path folder);

  // Throws InputError with the first line of missing(), for work that must not go on with half a result.
  void require_whole() const;
  const Names& missing() const { return missing_; }  // a line for each file; empty: all is there

  const std::filesystem::path& folder() const { return folder_; }
  const Json& run() const { return run_; }  // run.json; null when it is missing
  const RecordedSteps& steps() const { return steps_; }

  int frames() const { return static_cast<int>(times_.size()); }
  double time(int frame) const { return times_[frame]; }  // s
  double frame_rate() const;  // 1/s, mean over the run; 0 when there is a single frame

  const std::vector<RecordedShape>& shapes() const {
    return shapes_;
  }  // cloths, soft bodies, ropes, then bodies
  std::vector<RecordedPlane> planes(int frame) const;

  std::vector<Vec3> positions(std::size_t shape, int frame) const;  // m
  // For each vertex of a cloth or soft body; empty when the run did not record it, and for bodies.
  std::vector<Vec3> velocities(std::size_t shape, int frame) const;  // m/s
  // l / L - 1 of the most stretched edge at each vertex.
  std::vector<double> strains(std::size_t shape, int frame) const;
  std::vector<Touch> touches(std::size_t shape, int frame) const;

 private:
  // Where the positions of a shape come from.
  struct Source {
    std::filesystem::path cache;  // a PC2 file; else empty
    bool files = false;           // true when they are frames/NAME_0001.obj
    std::vector<Pose> poses;      // of each frame; empty when it is not moved as a whole
    Pose last;                    // the pose that the mesh is in
    std::vector<int> copy_of;     // of a cloth that tore: the last vertices of the mesh are copies of these
    Names fields;                 // names of the fields that are there and complete
  };

  void read_run();
  void read_times();
  void read_steps();
  void add_shape(const std::string& name, const std::filesystem::path& file, bool body);
  void add_body(const Json& body, const std::string& name,
                const std::map<std::string, std::vector<Pose>>& poses);
  void find_shapes();
  void read_copies(const Json& copies);
  void find_frames(std::size_t shape);
  void use_cache(std::size_t shape, const std::filesystem::path& cache);
  // Whether the run wrote frames of this kind, as far as run.json tells.
  bool wrote(std::string_view frames) const;
  void find_field(std::size_t shape, const char* name);
  void find_triangles(std::size_t shape);
  void settle_frames();
  std::map<std::string, std::vector<Pose>> read_poses();
  void miss(const std::filesystem::path& file, const std::string& what);
  std::vector<Vec3> read_positions(std::size_t shape, int frame) const;
  std::vector<float> field(std::size_t shape, const char* name, int frame) const;

  std::filesystem::path folder_;
  Names missing_;
  Json run_;
  bool times_told_ = false;  // whether run.json has the times
  RecordedSteps steps_;
  std::vector<double> times_;
  std::vector<RecordedShape> shapes_;
  std::vector<Source> sources_;        // one for each of shapes_
  std::vector<RecordedPlane> planes_;  // as they are drawn in the scene
  std::vector<std::vector<Pose>> plane_poses_;
  std::vector<int> frame_counts_;  // one for each of shapes_; 0: it does not move
};

}  // namespace drape::app
