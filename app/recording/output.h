// Writes the output folder of a run. Every file is written under another name; finish() gives all of them
// their names once all are complete. Only frames as OBJ files appear one by one.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "app/base/pc2.h"
#include "app/recording/body_files.h"
#include "app/recording/frame_fields.h"
#include "app/recording/run_json.h"
#include "app/recording/steps_csv.h"
#include "app/simulation/simulation.h"

namespace drape::app {

// Makes the folder and tries to write into it. Throws InputError when that fails, or when one of `files`
// could not be written there: at once, not when everything has been computed.
void make_output_folder(const std::filesystem::path& folder, const std::vector<std::string>& files = {});

class Output {
 public:
  // Makes the folder and tries it. Throws InputError when it cannot be written, or when the run would
  // overwrite a file that the scene is made from.
  Output(std::filesystem::path folder, const Scene& scene, const Simulation& simulation, Frames frames);

  // Adds a frame with its fields: a sample of the PC2 files, or OBJ files numbered from 1.
  void frame(const State& state);
  void step(const StepRow& row) { steps_->add(row); }
  void finish(const State& state, RunRecord& record);  // adds to the record what was written

  // A file or folder that finish() left, and how much there is in it: "25 frames", or empty.
  struct Written {
    std::filesystem::path path;
    std::string amount;
  };
  const std::vector<Written>& written() const { return written_; }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path cloth_path(const Cloth& cloth, const char* extension) const;
  void spare_inputs(const Scene& scene) const;
  void remove_earlier(bool all) const;
  void add_frames(std::vector<std::filesystem::path>& paths) const;
  int frame_count() const { return static_cast<int>(frame_times_.size()); }
  void list_written();

  std::filesystem::path folder_;
  const Simulation& simulation_;
  Frames frames_;
  bool was_run_before_;  // in this folder
  BodyFiles bodies_;
  std::vector<double> frame_times_;  // s
  std::vector<Pc2Writer> caches_;
  std::vector<FrameFields> fields_;
  std::optional<StepsWriter> steps_;
  std::vector<Written> written_;
};

}  // namespace drape::app
