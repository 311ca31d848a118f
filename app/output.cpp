#include "app/output.h"

#include <charconv>
#include <cstdio>
#include <system_error>
#include <utility>

#include "app/body_frames.h"
#include "mesh/obj.h"

namespace drape {
namespace {

namespace fs = std::filesystem;

std::vector<Vec3> positions_of(const Cloth& cloth, const State& state) {
  return unstacked(state.x.segment(3 * cloth.first_particle, 3 * cloth.mesh.vertex_count()));
}

// Results are named after the cloth and must not replace what they are made from.
void spare_inputs(const fs::path& folder, const Scene& scene, Frames frames) {
  const auto same = [](const fs::path& a, const fs::path& b) {
    std::error_code error;
    return fs::equivalent(a, b, error) && !error;
  };
  const auto spare = [&](const fs::path& input) {
    for (const ClothEntry& cloth : scene.cloths) {
      bool replaced = same(folder / (cloth.name + ".obj"), input);
      if (frames == Frames::pc2) replaced = replaced || same(folder / (cloth.name + ".pc2"), input);
      if (frames == Frames::obj)
        replaced = replaced || (input.filename().string().starts_with(cloth.name + "_") &&
                                same(folder / "frames", input.parent_path()));
      if (replaced)
        throw InputError(input.string() +
                         ": is a mesh of the scene and would be overwritten; choose another --out");
    }
  };
  for (const ClothEntry& cloth : scene.cloths) spare(cloth.mesh);
  for (const ObstacleEntry& obstacle : scene.obstacles) {
    if (!obstacle.mesh.empty()) spare(obstacle.mesh);
    for (const fs::path& frame : frame_files(obstacle.frames)) spare(frame);
  }
}

}  // namespace

void make_output_folder(const fs::path& folder, const std::vector<std::string>& files) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw InputError(folder.string() + ": cannot be made an output folder: " +
                     (error ? error.message() : "it is a file") + "; choose another with --out");
  try {
    AtomicFile(folder / "try").write("try");  // not kept
  } catch (const InputError&) {
    throw InputError(folder.string() + ": the output folder cannot be written; choose another with --out");
  }
  for (const std::string& file : files) AtomicFile(folder / file);  // not kept
}

Output::Output(fs::path folder, const Scene& scene, const Simulation& simulation, Frames frames)
    : folder_(std::move(folder)), simulation_(simulation), frames_(frames) {
  spare_inputs(folder_, scene, frames_);
  std::vector<std::string> last = {"run.json"};  // written when the run is over
  for (const Cloth& cloth : simulation.cloths) last.push_back(cloth.name + ".obj");
  make_output_folder(folder_, last);
  if (frames_ == Frames::obj) make_output_folder(folder_ / "frames");
  if (frames_ == Frames::pc2)
    for (const Cloth& cloth : simulation.cloths)
      caches_.emplace_back(folder_ / (cloth.name + ".pc2"), cloth.mesh.vertex_count());
  steps_.emplace(folder_ / "steps.csv");
}

fs::path Output::frame_path(const Cloth& cloth, int number) const {
  char ending[24];
  std::snprintf(ending, sizeof ending, "_%04d.obj", number);
  return folder_ / "frames" / (cloth.name + ending);
}

// Those of an earlier, longer run: they would go on where this one ends.
void Output::remove_later_frames() const {
  std::vector<fs::path> later;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "frames"))
    for (const Cloth& cloth : simulation_.cloths) {
      const std::string name = entry.path().filename().string(), start = cloth.name + "_";
      int number = 0;
      if (!name.starts_with(start) ||
          std::from_chars(name.data() + start.size(), name.data() + name.size(), number).ec != std::errc())
        continue;
      if (number > frame_count_ && entry.path() == frame_path(cloth, number) && entry.is_regular_file())
        later.push_back(entry.path());
    }
  for (const fs::path& path : later) fs::remove(path);
}

void Output::frame(const State& state) {
  if (frames_ == Frames::none) return;
  ++frame_count_;
  for (std::size_t k = 0; k < simulation_.cloths.size(); ++k) {
    const Cloth& cloth = simulation_.cloths[k];
    if (frames_ == Frames::pc2) {
      caches_[k].add(state.x, cloth.first_particle);
      continue;
    }
    AtomicFile file(frame_path(cloth, frame_count_));
    file.write(format_obj(cloth.mesh, positions_of(cloth, state)));
    file.keep();
  }
}

void Output::finish(const State& state, const RunRecord& record) {
  for (Pc2Writer& cache : caches_) cache.close();
  steps_->close();
  std::vector<AtomicFile> texts;
  for (const Cloth& cloth : simulation_.cloths) {
    texts.emplace_back(folder_ / (cloth.name + ".obj"))
        .write(format_obj(cloth.mesh, positions_of(cloth, state)));
    texts.back().close();
  }
  texts.emplace_back(folder_ / "run.json").write(run_json(record));
  texts.back().close();

  for (Pc2Writer& cache : caches_) cache.keep();
  steps_->keep();
  for (AtomicFile& text : texts) text.keep();
  if (frames_ == Frames::obj && !record.interrupted && !record.failure) remove_later_frames();
  for (const Cloth& cloth : simulation_.cloths) written_.push_back(folder_ / (cloth.name + ".obj"));
  for (const Pc2Writer& cache : caches_) written_.push_back(cache.path());
  written_.push_back(folder_ / "steps.csv");
  written_.push_back(folder_ / "run.json");
  if (frames_ == Frames::obj) written_.push_back(folder_ / "frames");
}

}  // namespace drape
