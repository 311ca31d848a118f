// The output folder of a run. Every file is written beside its name;
// finish() renames them all once all are complete.
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

namespace drape {

// Throws InputError when the folder cannot be made or written, or one of these files of it: now,
// and not when all is computed.
void make_output_folder(const std::filesystem::path& folder, const std::vector<std::string>& files = {});

class Output {
 public:
  // Makes the folder and tries it. Throws InputError when it cannot be written, or the scene is made from
  // a file of it.
  Output(std::filesystem::path folder, const Scene& scene, const Simulation& simulation, Frames frames);

  void frame(const State& state);  // pc2: a sample; obj: a file, from number 1; and its fields
  void step(const StepRow& row) { steps_->add(row); }
  void finish(const State& state, RunRecord& record);  // adds to it what was written

  // What finish() left, and how much of it: "25 frames", or nothing.
  struct Written {
    std::filesystem::path path;
    std::string amount;
  };
  const std::vector<Written>& written() const { return written_; }

 private:
  std::filesystem::path cloth_path(const Cloth& cloth, const char* extension) const;
  void spare_inputs(const Scene& scene) const;
  void remove_later_frames() const;
  int frame_count() const { return static_cast<int>(frame_times_.size()); }
  void list_written();

  std::filesystem::path folder_;
  const Simulation& simulation_;
  Frames frames_;
  BodyFiles bodies_;
  std::vector<double> frame_times_;  // s
  std::vector<Pc2Writer> caches_;
  std::vector<FrameFields> fields_;
  std::optional<StepsWriter> steps_;
  std::vector<Written> written_;
};

}  // namespace drape
