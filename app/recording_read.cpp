#include "app/recording.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "app/body_files.h"
#include "app/csv_file.h"
#include "app/frame_fields.h"
#include "app/pc2.h"
#include "app/text_file.h"
#include "mesh/obj.h"

namespace drape {
namespace {

namespace fs = std::filesystem;

constexpr double usual_rate = 25;  // 1/s, where nothing tells it

double number(const std::string& cell) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return value;
}

Vec3 vector_of(const Json& list, const Vec3& otherwise) {
  if (list.items().size() != 3) return otherwise;
  return {list.items()[0].number(0), list.items()[1].number(0), list.items()[2].number(0)};
}

Pose pose(const Vec3& translation, const std::array<double, 4>& q) {
  const Eigen::Quaterniond turn(q[0], q[1], q[2], q[3]);
  return {turn.norm() > 0 ? turn.normalized().toRotationMatrix() : Mat3::Identity(), translation};
}

Pose place_of(const Json& place) {
  const Json::List& q = place["rotation"].items();
  if (q.size() != 4) return {};
  return pose(vector_of(place["translation"], Vec3::Zero()),
              {q[0].number(1), q[1].number(0), q[2].number(0), q[3].number(0)});
}

// NAME of the files NAME.obj in a folder, or NAME_0001.obj; ascending.
std::set<std::string> obj_names(const fs::path& folder, std::string_view end) {
  std::set<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string file = entry.path().filename().string();
    if (file.ends_with(end) && file.size() > end.size() && file.front() != '.')
      names.insert(file.substr(0, file.size() - end.size()));
  }
  return names;
}

// frames/NAME_0001.obj and on, until one is missing.
int count_frame_files(const fs::path& folder, const std::string& name) {
  int count = 0;
  while (fs::exists(frame_path(folder, name, count + 1))) ++count;
  return count;
}

}  // namespace

Recording::Recording(fs::path folder) : folder_(std::move(folder)) {
  if (!fs::is_directory(folder_))
    throw InputError(folder_.string() + ": there is no such folder; expected the output of a run");
  read_run();
  find_shapes();
  if (shapes_.empty())
    throw InputError(
        folder_.string() +
        ": there is nothing to show; expected the output of a run, with run.json and NAME.obj of "
        "each cloth" +
        (missing_.empty() ? "" : " (" + missing_.front() + ")"));
  settle_frames();
  read_steps();
}

void Recording::miss(const fs::path& file, const std::string& what) {
  missing_.push_back(file.string() + ": " + what);
}

void Recording::read_run() {
  const fs::path file = folder_ / "run.json";
  try {
    run_ = parse_json(read_text(file, "JSON"), file.string());
  } catch (const InputError& error) {
    missing_.push_back(fs::exists(file) ? error.what()
                                        : file.string() +
                                              ": is missing; has the run not finished, or is this "
                                              "not the output of a run?");
  }
  for (const Json& time : run_["frame_times"].items()) times_.push_back(time.number(0));
}

void Recording::read_steps() {
  const fs::path file = folder_ / "steps.csv";
  try {
    const std::vector<CsvRow> rows = read_csv(file);
    if (rows.empty()) throw InputError(file.string() + ": has no header");
    steps_.columns = rows.front().cells;
    for (std::size_t k = 1; k < rows.size(); ++k) {
      if (rows[k].cells.size() != steps_.columns.size())
        throw InputError(rows[k].where + ": has " + std::to_string(rows[k].cells.size()) + " of " +
                         std::to_string(steps_.columns.size()) + " columns; was it cut short?");
      std::vector<double>& row = steps_.rows.emplace_back();
      for (const std::string& cell : rows[k].cells) row.push_back(number(cell));
    }
  } catch (const InputError& error) {
    missing_.push_back(error.what());
  }
}

std::map<std::string, std::vector<Pose>> Recording::read_poses() {
  std::map<std::string, std::vector<Pose>> poses;
  const fs::path file = folder_ / "bodies.csv";
  if (!fs::exists(file)) return poses;
  try {
    const std::vector<CsvRow> rows = read_csv(file);
    for (std::size_t k = 1; k < rows.size(); ++k) {
      const auto& c = rows[k].cells;
      if (c.size() != 10)
        throw InputError(rows[k].where + ": has " + std::to_string(c.size()) +
                         " of 10 columns; was it cut short?");
      poses[c[2]].push_back(pose({number(c[3]), number(c[4]), number(c[5])},
                                 {number(c[6]), number(c[7]), number(c[8]), number(c[9])}));
    }
  } catch (const InputError& error) {
    missing_.push_back(error.what());
  }
  return poses;
}

void Recording::add_shape(const std::string& name, const fs::path& file, bool body) {
  try {
    shapes_.push_back({name, body, false, read_obj(file)});
    sources_.emplace_back();
  } catch (const InputError& error) {
    missing_.push_back(error.what());
  }
}

// As run.json names them; without it, whatever OBJ files there are.
void Recording::find_shapes() {
  const auto poses = read_poses();
  if (run_.is_null()) {
    std::set<std::string> names = obj_names(folder_, ".obj");
    for (const std::string& name : obj_names(folder_ / "frames", "_0001.obj"))
      if (!poses.contains(name)) names.insert(name);  // else it is a body
    for (const std::string& name : names) {
      const fs::path last = folder_ / (name + ".obj");
      add_shape(name, fs::exists(last) ? last : frame_path(folder_, name, 1), false);
    }
  }
  for (const char* kind : {"cloths", "softs"})
    for (const Json& cloth : run_[kind].items())
      add_shape(cloth["name"].text(), folder_ / (cloth["name"].text() + ".obj"), false);
  for (std::size_t k = 0; k < shapes_.size(); ++k) find_frames(k);

  if (run_.is_null())
    for (const std::string& name : obj_names(folder_ / "bodies", ".obj"))
      add_shape(name, folder_ / "bodies" / (name + ".obj"), true);
  for (const Json& body : run_["bodies"].items()) add_body(body, poses);
  frame_counts_.resize(shapes_.size(), 0);
}

void Recording::add_body(const Json& body, const std::map<std::string, std::vector<Pose>>& poses) {
  const std::string file = body["file"].text();
  const std::string name = file.empty() ? body["name"].text() : fs::path(file).stem().string();
  const auto found = poses.find(name);
  if (!body["normal"].is_null()) {
    planes_.push_back(
        {name, vector_of(body["point"], Vec3::Zero()), vector_of(body["normal"], Vec3::UnitY())});
    plane_poses_.push_back(found == poses.end() ? std::vector<Pose>() : found->second);
  }
  if (file.empty()) return;
  add_shape(name, folder_ / file, true);
  if (shapes_.empty() || shapes_.back().name != name || !shapes_.back().body) return;  // it was missing
  const std::size_t k = shapes_.size() - 1;
  Source& source = sources_[k];
  source.last = place_of(body["place"]);
  if (fs::exists(folder_ / "bodies" / (name + ".pc2")))
    source.cache = folder_ / "bodies" / (name + ".pc2");
  else if (count_frame_files(folder_, name) > 0)
    source.files = true;
  else if (found != poses.end())
    source.poses = found->second;
  shapes_[k].moves = !source.cache.empty() || source.files || !source.poses.empty();
}

// Of a cloth. An empty cache of a run without frames is no loss.
void Recording::find_frames(std::size_t k) {
  const std::string& name = shapes_[k].name;
  const fs::path cache = folder_ / (name + ".pc2");
  const bool expected = run_.is_null() || !times_.empty();
  frame_counts_.resize(shapes_.size(), 0);
  if (fs::exists(cache)) {
    try {
      const Pc2Reader reader(cache, Pc2Reader::Damaged::read);
      if (!reader.damage().empty()) miss(cache, reader.damage());
      if (reader.points() != shapes_[k].mesh.vertex_count())
        throw InputError(cache.string() + ": has " + std::to_string(reader.points()) + " points, but " +
                         name + ".obj has " + std::to_string(shapes_[k].mesh.vertex_count()) + " vertices");
      sources_[k].cache = cache;
      frame_counts_[k] = reader.samples();
    } catch (const InputError& error) {
      missing_.push_back(error.what());
    }
  } else if (const int files = count_frame_files(folder_, name); files > 0) {
    sources_[k].files = true;
    frame_counts_[k] = files;
  } else if (expected) {
    miss(cache, "is missing, and so is frames/" + name + "_0001.obj: only the last shape is there");
  }
  shapes_[k].moves = frame_counts_[k] > 0;
  for (const char* field : {"velocity", "strain", "contact"}) find_field(k, field);
}

// Runs of earlier versions have none: no loss.
void Recording::find_field(std::size_t k, const char* name) {
  const fs::path path = field_path(folder_, shapes_[k].name, name);
  if (frame_counts_[k] == 0 || !fs::exists(path)) return;
  try {
    const NpyReader reader(path);
    const int vertices = shapes_[k].mesh.vertex_count();
    if (reader.frames() < frame_counts_[k] || reader.frame_shape().front() != vertices)
      throw InputError(path.string() + ": has " + std::to_string(reader.frames()) + " frames of " +
                       std::to_string(reader.frame_shape().front()) + " vertices, expected " +
                       std::to_string(frame_counts_[k]) + " of " + std::to_string(vertices));
    sources_[k].fields.push_back(name);
  } catch (const InputError& error) {
    missing_.push_back(error.what());
  }
}

// As many frames as every cloth has that has any.
void Recording::settle_frames() {
  int frames = 0;
  for (const int count : frame_counts_)
    if (count > 0) frames = frames == 0 ? count : std::min(frames, count);
  const auto told = static_cast<int>(times_.size());
  if (!run_.is_null() && frames > 0 && frames < told && missing_.empty())
    miss(folder_,
         "has " + std::to_string(frames) + " of the " + std::to_string(told) + " frames that run.json tells");
  if (frames == 0) {
    times_ = {run_["simulated_seconds"].number(0)};
    for (RecordedShape& shape : shapes_) shape.moves = false;
    return;
  }
  for (int k = told; k < frames; ++k) times_.push_back(k / usual_rate);
  times_.resize(static_cast<std::size_t>(frames));
}

}  // namespace drape
