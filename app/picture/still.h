// What is drawn: cloths and bodies at one time, from an output folder or from OBJ files.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/picture/colours.h"
#include "app/recording/drawn.h"
#include "app/recording/recording.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape::app::drawing {

struct StillPart {
  bool body = false;
  int cloth = 0;                                     // its number, from 0, which decides its colour
  std::vector<Vec3> positions;                       // m
  const std::vector<Triangle>* triangles = nullptr;  // owned by the Subject
  // For a ball, the positions [m] of its vertices relative to its middle in the first frame; else null.
  const std::vector<Vec3>* sectors = nullptr;
  std::vector<Vec3> axis;      // m, points of a rope, which is drawn as a tube round them; empty: it is none
  std::vector<char> crossing;  // by triangle, whether it crosses another; empty: it was not looked for
  std::vector<double> values;  // colours come from these values at the vertices; empty: the part's own colour
  bool is_rope() const { return !axis.empty(); }
};

struct Still {
  std::vector<StillPart> parts;
  std::vector<RecordedPlane> planes;
};

class Subject {
 public:
  // An output folder, or an OBJ file, which counts as a cloth. Throws InputError.
  explicit Subject(const std::string& path);
  void add_body(const std::string& path);  // an OBJ file

  const std::string& path() const { return path_; }
  std::string title() const;  // the last component of the path
  bool is_run() const { return recording_ != nullptr; }
  Names missing() const;  // what a folder lacks, one line each
  int frames() const { return recording_ ? recording_->frames() : 1; }
  double time(int frame) const { return recording_ ? recording_->time(frame) : 0; }  // s

  // Throws InputError when the run has no such field, and Interrupted, because every picture calls this for
  // each frame.
  Still still(int frame, std::optional<Field> field) const;

 private:
  std::vector<double> values(std::size_t shape, int frame, Field field) const;

  std::string path_;
  std::unique_ptr<Recording> recording_;
  std::vector<DrawnShape> drawn_;           // the shapes of the recording
  std::vector<RecordedShape> meshes_;       // read from OBJ files
  std::vector<std::vector<Vec3>> sectors_;  // for each shape of the recording; empty when it is not a ball
};

}  // namespace drape::app::drawing
