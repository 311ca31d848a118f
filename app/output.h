// The output folder of a run. Every file is written beside its name; finish() renames them all once all are
// complete.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "app/pc2.h"
#include "app/run_json.h"
#include "app/simulation.h"
#include "app/steps_csv.h"

namespace drape {

// Throws InputError when the folder cannot be made or written, or one of these files of it: now, and not when
// all is computed.
void make_output_folder(const std::filesystem::path& folder, const std::vector<std::string>& files = {});

enum class Frames { pc2, obj, none };

class Output {
 public:
  // Makes the folder and tries it. Throws InputError when it cannot be written, or a file of it is a mesh of
  // the scene.
  Output(std::filesystem::path folder, const Scene& scene, const Simulation& simulation, Frames frames);

  void frame(const State& state);  // pc2: a sample; obj: a file, from number 1
  void step(const StepRow& row) { steps_->add(row); }
  void finish(const State& state, const RunRecord& record);

  const std::vector<std::filesystem::path>& written() const { return written_; }
  int frames() const { return frame_count_; }

 private:
  std::filesystem::path frame_path(const Cloth& cloth, int number) const;
  void remove_later_frames() const;

  std::filesystem::path folder_;
  const Simulation& simulation_;
  Frames frames_;
  int frame_count_ = 0;
  std::vector<Pc2Writer> caches_;
  std::optional<StepsWriter> steps_;
  std::vector<std::filesystem::path> written_;
};

}  // namespace drape
