// The bodies of a run in its output folder, so that a result can be looked at with what it lies on.
//   bodies/NAME.obj        the last shape and place of each body but planes and level sets
//   bodies/NAME.pc2        every frame of a body that deforms, where frames are PC2
//   bodies.csv             frame, time [s], body, x y z [m] and the unit quaternion qw qx qy qz, a row for
//                          each frame and body that is moved or reacts: x = R X + t, X a point of the body
//                          as it was drawn
//   frames/NAME_0001.obj   where frames are OBJ files, of those bodies and of those that deform
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <vector>

#include "app/base/atomic_file.h"
#include "app/base/pc2.h"
#include "app/recording/run_json.h"
#include "app/simulation/simulation.h"

namespace drape {

enum class Frames { pc2, obj, none };

// "frames/NAME_0001.obj" below the output folder; frames count from 1.
std::filesystem::path frame_path(const std::filesystem::path& folder, const std::string& name, int frame);

// The name of each body's files: its own as far as it can be one,
// numbered where it is taken, also by a cloth.
Names body_file_names(const Names& bodies, const Names& cloths);

// What run.json says of the bodies.
std::vector<BodyRecord> body_records(const Simulation& simulation);

class BodyFiles {
 public:
  BodyFiles(std::filesystem::path folder, const Simulation& simulation, Frames frames);

  void open();  // the folder exists: begins bodies.csv
  void frame(int number, double time);
  // Writes and closes what is left to be written; bodies.csv is complete, too. To be kept with the others.
  void finish(double time, std::vector<AtomicFile>& files);

  // Everything that is written, but for the frames.
  std::vector<std::filesystem::path> results() const;
  Names frame_names() const;                                                // NAME of frames/NAME_0001.obj
  bool has_poses() const { return any_moves_ && frames_ != Frames::none; }  // bodies.csv
  int shapes() const;                                                       // files in bodies/

 private:
  struct Entry {
    std::string name;                // of its files
    bool moves, deforms, has_shape;  // moves: also by what acts on it; has_shape: is no plane
    Eigen::Quaterniond turn_before =
        Eigen::Quaterniond::Identity();   // q and -q are one turn: rows do not jump
    std::optional<Pc2Writer> cache = {};  // of a body that deforms
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

}  // namespace drape
