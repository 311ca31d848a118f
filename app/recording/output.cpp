#include "app/recording/output.h"

#include <signal.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <string_view>
#include <system_error>
#include <utility>

#include "app/base/words.h"
#include "app/scene/body_frames.h"
#include "mesh/obj/obj.h"

namespace drape::app {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> inputs_of(const Scene& scene) {
  std::vector<fs::path> inputs;
  const auto add = [&](const fs::path& path) {
    if (!path.empty()) inputs.push_back(path);
  };
  for (const ClothEntry& cloth : scene.cloths) {
    add(cloth.mesh);
    for (const PinEntry& pin : cloth.pins) add(pin.source.poses);
  }
  for (const SoftEntry& soft : scene.softs) {
    add(soft.mesh);
    for (const PinEntry& pin : soft.pins) add(pin.source.poses);
  }
  for (const RopeEntry& rope : scene.ropes) {
    add(rope.mesh);
    for (const PinEntry& pin : rope.pins) add(pin.source.poses);
  }
  for (const ObstacleEntry& obstacle : scene.obstacles) {
    add(obstacle.mesh);
    add(obstacle.source.poses);
    for (const fs::path& frame : frame_files(obstacle.frames)) add(frame);
  }
  return inputs;
}

bool same(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) && !error;
}

// Whether the file is called NAME_0001.obj, with any number.
bool is_frame_of(const std::string& name, const std::string& file) {
  constexpr std::string_view ending = ".obj";
  const auto start = name.size() + 1;
  return file.size() > start + ending.size() && file.starts_with(name + "_") && file.ends_with(ending) &&
         std::all_of(file.begin() + static_cast<std::ptrdiff_t>(start), file.end() - ending.size(),
                     [](char c) { return c >= '0' && c <= '9'; });
}

// 0 where it is too large for a number of a frame.
int number_of(const std::string& name, const std::string& file) {
  int number = 0;
  const auto read = std::from_chars(file.data() + name.size() + 1, file.data() + file.size(), number);
  return read.ec == std::errc() ? number : 0;
}

bool is_frame_in(const fs::path& frames, const Names& names, const fs::path& input) {
  const fs::path folder = input.has_parent_path() ? input.parent_path() : ".";
  return same(frames, folder) && std::any_of(names.begin(), names.end(), [&](const std::string& name) {
           return is_frame_of(name, input.filename().string());
         });
}

// Whether this process is gone, on this machine.
bool is_gone(int process) { return process > 0 && kill(process, 0) != 0 && errno == ESRCH; }

// Removes halves of files, .NAME.PID.part, of programs that were killed. Those of the last hour may be of a
// program on another machine that writes into the same folder.
void remove_dead_parts(const fs::path& folder) {
  constexpr std::string_view ending = ".part";
  std::error_code ignored;
  std::vector<fs::path> dead;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(".") || !name.ends_with(ending) || name.size() == ending.size()) continue;
    const char* const end = name.data() + name.size() - ending.size();
    const char* begin = end;
    while (begin[-1] >= '0' && begin[-1] <= '9') --begin;  // ends at the dot that the name begins with
    int process = 0;
    if (begin[-1] != '.' || begin - 1 == name.data() ||
        std::from_chars(begin, end, process).ec != std::errc())
      continue;
    const auto age = fs::file_time_type::clock::now() - entry.last_write_time(ignored);
    if (entry.is_regular_file(ignored) && is_gone(process) && age > std::chrono::hours(1))
      dead.push_back(entry.path());
  }
  for (const fs::path& path : dead) fs::remove(path, ignored);
}

// In a folder whose frames appear one by one, until there is a run.json: so the next run knows them, should
// this one fail.
constexpr const char* unfinished = ".unfinished-run";

// Whether a run wrote here. Only then are files taken away that this run does not write.
bool was_run_in(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "run.json", ignored) || fs::exists(folder / "frames" / unfinished, ignored);
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
  remove_dead_parts(folder);
}

Output::Output(fs::path folder, const Scene& scene, const Simulation& simulation, Frames frames)
    : folder_(std::move(folder)),
      simulation_(simulation),
      frames_(frames),
      was_run_before_(was_run_in(folder_)),
      bodies_(folder_, simulation, frames) {
  spare_inputs(scene);
  std::vector<std::string> last = {"run.json"};  // written when the run is over
  for (const Cloth& cloth : simulation.cloths) last.push_back(cloth.name + ".obj");
  make_output_folder(folder_, last);
  if (frames_ == Frames::obj) make_output_folder(folder_ / "frames");
  if (bodies_.shapes() > 0) make_output_folder(folder_ / "bodies");
  if (frames_ != Frames::none) make_output_folder(folder_ / "fields");
  for (const Cloth& cloth : simulation.cloths) {
    if (frames_ == Frames::pc2) caches_.emplace_back(cloth_path(cloth, ".pc2"), cloth.mesh.vertex_count());
    if (frames_ != Frames::none) fields_.emplace_back(folder_, cloth);
  }
  bodies_.open();
  steps_.emplace(folder_ / "steps.csv");
  if (frames_ != Frames::obj) return;
  remove_earlier(true);
  AtomicFile mark(folder_ / "frames" / unfinished);
  mark.write("");
  mark.keep();
}

fs::path Output::cloth_path(const Cloth& cloth, const char* extension) const {
  return folder_ / (cloth.name + extension);
}

// Results are named after cloths and bodies and must not replace what they are made from.
void Output::spare_inputs(const Scene& scene) const {
  std::vector<fs::path> results = bodies_.results();
  results.push_back(folder_ / "steps.csv");
  Names framed = bodies_.frame_names();
  for (const Cloth& cloth : simulation_.cloths) {
    results.push_back(cloth_path(cloth, ".obj"));
    results.push_back(cloth_path(cloth, ".pc2"));  // which is removed where it is not written
    framed.push_back(cloth.name);
  }
  for (const fs::path& input : inputs_of(scene)) {
    bool replaced = false;
    for (const fs::path& result : results) replaced = replaced || same(result, input);
    replaced = replaced || is_frame_in(folder_ / "frames", framed, input);
    if (replaced)
      throw InputError(input.string() +
                       ": the scene is made from it and it would be overwritten; choose another --out");
  }
}

void Output::frame(const State& state) {
  if (frames_ == Frames::none) return;
  frame_times_.push_back(state.time);
  bodies_.frame(frame_count(), state.time);
  for (std::size_t k = 0; k < simulation_.cloths.size(); ++k) {
    const Cloth& cloth = simulation_.cloths[k];
    fields_[k].add(cloth, state, *simulation_.constraints);
    if (frames_ == Frames::pc2) {
      caches_[k].add(cloth.embedding.positions(state.x));
      continue;
    }
    AtomicFile file(frame_path(folder_, cloth.name, frame_count()));
    file.write(format_obj(cloth.mesh, cloth.embedding.positions(state.x)));
    file.keep();
  }
}

void Output::finish(const State& state, RunRecord& record) {
  record.frames = frames_ == Frames::pc2 ? "pc2" : frames_ == Frames::obj ? "obj" : "none";
  record.frame_times = frame_times_;
  for (std::size_t k = 0; k < simulation_.cloths.size(); ++k) {
    const Cloth& cloth = simulation_.cloths[k];
    if (frames_ == Frames::pc2) caches_[k].close(copies_since(cloth, caches_[k].points()));
    if (frames_ != Frames::none) fields_[k].close(cloth);
  }
  steps_->close();
  std::vector<AtomicFile> texts;
  for (const Cloth& cloth : simulation_.cloths) {
    texts.emplace_back(cloth_path(cloth, ".obj"))
        .write(format_obj(cloth.mesh, cloth.embedding.positions(state.x)));
    texts.back().close();
  }
  bodies_.finish(state.time, texts);
  texts.emplace_back(folder_ / "run.json").write(run_json(record));
  texts.back().close();

  for (Pc2Writer& cache : caches_) cache.keep();
  for (FrameFields& fields : fields_) fields.keep();
  steps_->keep();
  for (AtomicFile& text : texts) text.keep();
  remove_earlier(false);
  std::error_code ignored;
  fs::remove(folder_ / "frames" / unfinished, ignored);
  list_written();
}

// What an earlier run wrote of its frames and this one does not: it would show another motion beside the new
// mesh, or belong to another mesh of that name. At the start of a run whose frames appear one by one that is
// all of it.
void Output::remove_earlier(bool all) const {
  if (!was_run_before_) return;
  std::vector<fs::path> earlier = bodies_.not_written();
  for (const Cloth& cloth : simulation_.cloths) {
    if (frames_ != Frames::pc2) earlier.push_back(cloth_path(cloth, ".pc2"));
    if (frames_ == Frames::none || all)
      for (const char* field : {"velocity", "strain", "contact"})
        earlier.push_back(field_path(folder_, cloth.name, field));
    if (frames_ == Frames::none || all || !has_polygons(cloth.mesh))
      earlier.push_back(field_path(folder_, cloth.name, "triangles"));
  }
  if (all)
    for (const char* file : {"run.json", "steps.csv", "bodies.csv"}) earlier.push_back(folder_ / file);
  if (all || frames_ != Frames::obj) add_frames(earlier);
  for (const fs::path& path : earlier) fs::remove(path);
}

// Adds all frames/NAME_0001.obj and so on that there are.
void Output::add_frames(std::vector<fs::path>& paths) const {
  if (!fs::is_directory(folder_ / "frames")) return;
  Names names = bodies_.frame_names();
  for (const Cloth& cloth : simulation_.cloths) names.push_back(cloth.name);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "frames")) {
    const std::string file = entry.path().filename().string();
    for (const std::string& name : names)
      if (entry.is_regular_file() && is_frame_of(name, file) &&
          entry.path() == frame_path(folder_, name, number_of(name, file)))
        paths.push_back(entry.path());
  }
}

void Output::list_written() {
  const std::string frames = counted(frame_count(), "frame");
  for (const Cloth& cloth : simulation_.cloths) written_.push_back({cloth_path(cloth, ".obj"), ""});
  for (const Pc2Writer& cache : caches_) written_.push_back({cache.path(), frames});
  if (bodies_.shapes() > 0) written_.push_back({folder_ / "bodies", counted(bodies_.shapes(), "shape")});
  long arrays = 0;
  for (const FrameFields& fields : fields_) arrays += fields.arrays();
  if (arrays > 0) written_.push_back({folder_ / "fields", counted(arrays, "array")});
  if (bodies_.has_poses()) written_.push_back({folder_ / "bodies.csv", frames});
  written_.push_back({folder_ / "steps.csv", ""});
  written_.push_back({folder_ / "run.json", ""});
  if (frames_ == Frames::obj) written_.push_back({folder_ / "frames", frames});
}

}  // namespace drape::app
