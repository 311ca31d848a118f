// Writes the bodies of a run into its output folder, so that a result can be shown together with what it lies
// on.
//   bodies/NAME.obj        the last shape and place of each body, except planes and level sets
//   bodies/NAME.pc2        every frame of an animated body, when frames are PC2
//   bodies.csv             frame, time [s], body, x y z [m] and the unit quaternion qw qx qy qz; one row for
//                          each frame and each body that is moved or reacts: x = R X + t, X a point of the
//                          body as it is drawn in the scene
//   frames/NAME_0001.obj   when frames are OBJ files, of those bodies and of the animated ones
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <vector>

#include "app/base/atomic_file.h"
#include "app/base/pc2.h"
#include "app/recording/run_json.h"
#include "app/simulation/simulation.h"

namespace drape::app {

enum class Frames { pc2, obj, none };

// The path "frames/NAME_0001.obj" in the output folder; frames count from 1.
std::filesystem::path frame_path(const std::filesystem::path& folder, const std::string& name, int frame);

// The name of each body's files: the body's own name as far as files can have it, with a number when a cloth
// or an earlier body has it already.
Names body_file_names(const Names& bodies, const Names& cloths);

// The records of the bodies in run.json.
std::vector<BodyRecord> body_records(const Simulation& simulation);

class BodyFiles {
 public:
  BodyFiles(std::filesystem::path folder, const Simulation& simulation, Frames frames);

  // Begins bodies.csv. The folder must exist.
  void open();
  void frame(int number, double time);
  // Writes and closes all remaining files, among them bodies.csv, and adds them to `files`, to be kept
  // together with others.
  void finish(double time, std::vector<AtomicFile>& files);

  // All files that are written, or removed because an earlier run may have written them, except the frames.
  std::vector<std::filesystem::path> results() const;
  // Those of them that this run does not write.
  std::vector<std::filesystem::path> not_written() const;
  Names frame_names() const;  // each NAME of frames/NAME_0001.obj
  // Whether bodies.csv is written.
  bool has_poses() const { return any_moves_ && frames_ != Frames::none; }
  int shapes() const;  // number of OBJ files in bodies/

 private:
  struct Entry {
    std::string name;  // of its files
    // moves: it is moved or reacts. has_shape: it has a mesh; planes and level sets have none.
    bool moves, deforms, has_shape;
    // The last quaternion written. q and -q are one rotation; the sign is chosen so that rows do not jump.
    Eigen::Quaterniond turn_before = Eigen::Quaterniond::Identity();
    std::optional<Pc2Writer> cache = {};  // of an animated body
  };
  const MovingBody& body(std::size_t k) const { return simulation_.constraints->bodies()[k]; }
  static bool has_frames(const Entry& entry) { return entry.has_shape && (entry.moves || entry.deforms); }
  std::filesystem::path shape_path(const Entry& entry) const;
  std::filesystem::path cache_path(const Entry& entry) const;
  void add_pose(int number, double time, std::size_t k);

  std::filesystem::path folder_;
  const Simulation& simulation_;
  Frames frames_;
  bool any_moves_ = false;
  std::vector<Entry> entries_;
  std::optional<AtomicFile> poses_;
};

}  // namespace drape::app
