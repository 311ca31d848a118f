// What is drawn: cloths and bodies as they are at one time, out of an output folder or of OBJ files.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/picture/colours.h"
#include "app/recording/recording.h"
#include "mesh/triangles/triangle_mesh.h"

namespace drape::drawing {

struct StillPart {
  bool body = false;
  int cloth = 0;                                     // which one, from 0: its colour
  std::vector<Vec3> positions;                       // m
  const std::vector<Triangle>* triangles = nullptr;  // of the Subject
  const std::vector<Vec3>* sectors = nullptr;        // of a ball: its vertices from its middle at first, m
  std::vector<double> values;  // of vertices, to be coloured by; empty: a colour of its own
};

struct Still {
  std::vector<StillPart> parts;
  std::vector<RecordedPlane> planes;
};

class Subject {
 public:
  // An output folder, or an OBJ file that counts as a cloth. Throws InputError.
  explicit Subject(const std::string& path);
  void add_body(const std::string& path);  // an OBJ file

  const std::string& path() const { return path_; }
  std::string title() const;  // the last word of the path
  bool is_run() const { return recording_ != nullptr; }
  Names missing() const;  // of a folder, a line each
  int frames() const { return recording_ ? recording_->frames() : 1; }
  double time(int frame) const { return recording_ ? recording_->time(frame) : 0; }  // s

  // Throws InputError where the run has no such field, and Interrupted:
  // all pictures ask for this, frame by frame.
  Still still(int frame, std::optional<Field> field) const;

 private:
  std::vector<double> values(std::size_t shape, int frame, Field field) const;

  std::string path_;
  std::unique_ptr<Recording> recording_;
  std::vector<RecordedShape> meshes_;       // of files
  std::vector<std::vector<Vec3>> sectors_;  // of the recording's shapes; empty: is no ball
};

}  // namespace drape::drawing
