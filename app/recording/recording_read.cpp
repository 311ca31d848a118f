#include "app/recording/recording.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "app/base/csv_file.h"
#include "app/base/pc2.h"
#include "app/base/text_file.h"
#include "app/recording/body_files.h"
#include "app/recording/frame_fields.h"
#include "mesh/obj/obj.h"

namespace drape::app {
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
  read_times();
}

void Recording::read_times() {
  const Json::List& told = run_["frame_times"].items();
  double last = -std::numeric_limits<double>::infinity();
  for (const Json& time : told) {
    times_.push_back(time.number(std::numeric_limits<double>::quiet_NaN()));
    if (!(times_.back() >= last)) {  // nor is it a number
      miss(folder_ / "run.json", "frame_times are not times that rise");
      times_.clear();
      return;
    }
    last = times_.back();
  }
  times_told_ = !run_["frame_times"].is_null();
}

// Runs of earlier versions do not tell: then what is there counts.
bool Recording::wrote(std::string_view frames) const {
  const std::string told = run_["frames"].text();
  return told.empty() || told == frames;
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
    const auto told = static_cast<std::size_t>(std::max(0.0, run_["steps"].number(0)));
    if (steps_.rows.size() < told)
      throw InputError(file.string() + ": has " + std::to_string(steps_.rows.size()) + " of " +
                       std::to_string(told) + " steps; was it cut short?");
  } catch (const InputError& error) {
    missing_.push_back(error.what());
  }
}

std::map<std::string, std::vector<Pose>> Recording::read_poses() {
  std::map<std::string, std::vector<Pose>> poses;
  const fs::path file = folder_ / "bodies.csv";
  if (!fs::exists(file) || (times_told_ && times_.empty())) return poses;
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
  if (name.empty() || name.front() == '.' || name.find_first_of("/\\") != name.npos)
    return miss(folder_ / "run.json", "'" + one_line(name) + "' is no name of a file");
  try {
    shapes_.push_back({name, body, false, read_obj(file, ObjNeed::faces_or_lines)});
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
      // Any folder may hold meshes; one without traces of a run is none.
      if (!fs::exists(folder_ / "steps.csv") && !fs::exists(folder_ / (name + ".pc2")) &&
          !fs::exists(frame_path(folder_, name, 1)))
        continue;
      add_shape(name, fs::exists(last) ? last : frame_path(folder_, name, 1), false);
    }
  }
  for (const char* kind : {"cloths", "softs", "ropes"})
    for (const Json& part : run_[kind].items()) {
      const std::size_t before = shapes_.size();
      add_shape(part["name"].text(), folder_ / (part["name"].text() + ".obj"), false);
      if (shapes_.size() == before) continue;
      shapes_.back().radius = part["material"]["radius"].number(0);
      read_copies(part["copy_of"]);
    }
  for (std::size_t k = 0; k < shapes_.size(); ++k) find_frames(k);

  if (run_.is_null())
    for (const std::string& name : obj_names(folder_ / "bodies", ".obj"))
      add_shape(name, folder_ / "bodies" / (name + ".obj"), true);
  frame_counts_.resize(shapes_.size(), 0);
  Names cloths, bodies;
  for (const RecordedShape& shape : shapes_) cloths.push_back(shape.name);
  for (const Json& body : run_["bodies"].items()) bodies.push_back(body["name"].text());
  const Names files = body_file_names(bodies, cloths);
  for (std::size_t k = 0; k < bodies.size(); ++k) add_body(run_["bodies"].items()[k], files[k], poses);
}

// Of the shape that was added last: of which of its vertices the last ones are copies.
void Recording::read_copies(const Json& copies) {
  const int vertices = shapes_.back().mesh.vertex_count();
  const auto count = static_cast<int>(copies.items().size());
  std::vector<int>& copy_of = sources_.back().copy_of;
  for (const Json& copy : copies.items()) {
    const double of = copy.number(-1);
    if (count >= vertices || !(of >= 0 && of < vertices - count + static_cast<int>(copy_of.size()))) {
      copy_of.clear();
      return miss(folder_ / "run.json",
                  "copy_of of '" + shapes_.back().name + "' names no vertices before them");
    }
    copy_of.push_back(static_cast<int>(of));
  }
}

// name: of its files.
void Recording::add_body(const Json& body, const std::string& name,
                         const std::map<std::string, std::vector<Pose>>& poses) {
  // moves: the body moves as a whole.
  const bool deforms = body["deforms"].is(true), moves = body["moves"].is(true) || body["reacts"].is(true);
  const auto found = poses.find(name);
  const std::vector<Pose> moved = moves && found != poses.end() ? found->second : std::vector<Pose>();
  const Pose last = place_of(body["place"]);
  const bool lost = moves && times_told_ && moved.size() < times_.size();
  const auto miss_places = [&] {
    if (lost)
      miss(folder_ / "bodies.csv", "has " + counted(static_cast<long>(moved.size()), "place") + " of '" +
                                       name + "', expected " + std::to_string(times_.size()) +
                                       "; it is shown where it was last known");
  };
  if (!body["normal"].is_null()) {
    planes_.push_back(
        {name, vector_of(body["point"], Vec3::Zero()), vector_of(body["normal"], Vec3::UnitY())});
    plane_poses_.push_back(moved.empty() ? std::vector<Pose>{last} : moved);
  }
  if (body["file"].is_null()) return miss_places();
  const std::size_t k = shapes_.size();
  add_shape(name, folder_ / "bodies" / (name + ".obj"), true);
  if (shapes_.size() == k) return;  // it was missing
  miss_places();
  frame_counts_.push_back(0);
  Source& source = sources_[k];
  source.last = last;
  const fs::path cache = folder_ / "bodies" / (name + ".pc2");
  if (deforms && wrote("pc2") && times_told_ && !times_.empty())
    use_cache(k, cache);
  else if (deforms && wrote("obj") && count_frame_files(folder_, name) > 0)
    source.files = true;
  else
    source.poses = moved;
  shapes_[k].moves = !source.cache.empty() || source.files || !source.poses.empty();
}

// What is damaged is told; the whole samples are used.
void Recording::use_cache(std::size_t k, const fs::path& cache) {
  try {
    const Pc2Reader reader(cache, Pc2Reader::Damaged::read);
    if (!reader.damage().empty()) miss(cache, reader.damage());
    if (reader.points() != shapes_[k].mesh.vertex_count())
      throw InputError(cache.string() + ": has " + std::to_string(reader.points()) + " points, but " +
                       shapes_[k].name + ".obj has " + std::to_string(shapes_[k].mesh.vertex_count()) +
                       " vertices");
    sources_[k].cache = cache;
    frame_counts_[k] = reader.samples();
  } catch (const InputError& error) {
    missing_.push_back(error.what());
  }
}

// Of a cloth. Of a run without frames nothing is missing.
void Recording::find_frames(std::size_t k) {
  const std::string& name = shapes_[k].name;
  const fs::path cache = folder_ / (name + ".pc2");
  frame_counts_.push_back(0);
  if (times_told_ && times_.empty()) return;
  if (wrote("pc2") && fs::exists(cache)) {
    use_cache(k, cache);
  } else if (const int files = wrote("obj") ? count_frame_files(folder_, name) : 0; files > 0) {
    sources_[k].files = true;
    frame_counts_[k] = files;
  } else {
    miss(cache, "is missing, and so is frames/" + name + "_0001.obj: only the last shape is there");
  }
  shapes_[k].moves = frame_counts_[k] > 0;
  for (const char* field : {"velocity", "strain", "contact"}) find_field(k, field);
  find_triangles(k);
}

// How the run cut polygons. Without the file, as of runs without frames, they are cut as their last shape
// suggests.
void Recording::find_triangles(std::size_t k) {
  const fs::path path = field_path(folder_, shapes_[k].name, "triangles");
  TriangleMesh& mesh = shapes_[k].mesh;
  if (frame_counts_[k] == 0 || !has_polygons(mesh) || !fs::exists(path)) return;  // else it is of another run
  try {
    NpyReader reader(path);
    if (reader.frame_shape() != std::vector<int>{3} ||
        reader.frames() != static_cast<int>(mesh.triangles.size()))
      throw InputError(path.string() + ": expected " + std::to_string(mesh.triangles.size()) +
                       " triangles, as " + shapes_[k].name + ".obj has");
    std::vector<Triangle> triangles;
    for (int t = 0; t < reader.frames(); ++t) {
      const std::vector<float> corners = reader.frame(t);
      for (const float corner : corners)
        if (!(corner >= 0 && corner < static_cast<float>(mesh.vertex_count())))
          throw InputError(path.string() + ": names a vertex that " + shapes_[k].name + ".obj does not have");
      triangles.push_back(
          {static_cast<int>(corners[0]), static_cast<int>(corners[1]), static_cast<int>(corners[2])});
    }
    mesh.triangles = std::move(triangles);
  } catch (const InputError& error) {
    missing_.push_back(error.what());
  }
}

// Runs of earlier versions have none, nor do they tell of frames: no loss.
void Recording::find_field(std::size_t k, const char* name) {
  const fs::path path = field_path(folder_, shapes_[k].name, name);
  if (frame_counts_[k] == 0) return;
  if (!fs::exists(path) && run_["frames"].is_null()) return;
  try {
    if (!fs::exists(path)) throw InputError(path.string() + ": is missing");
    const NpyReader reader(path);
    std::vector<int> expected = {shapes_[k].mesh.vertex_count()};
    if (std::string_view(name) == "velocity") expected.push_back(3);
    if (reader.frame_shape() != expected)
      throw InputError(path.string() + ": has other numbers in a frame than " + shapes_[k].name +
                       ".obj has " + counted(expected.front(), "vertex"));
    if (times_told_ && reader.frames() < std::min(frame_counts_[k], static_cast<int>(times_.size())))
      throw InputError(path.string() + ": has only " + counted(reader.frames(), "frame"));
    sources_[k].fields.push_back(name);
  } catch (const InputError& error) {
    missing_.push_back(error.what());
  }
}

// As many frames as every shape has that has any, and no more than the run tells: others are of another run.
void Recording::settle_frames() {
  int frames = 0;
  for (const int count : frame_counts_)
    if (count > 0) frames = frames == 0 ? count : std::min(frames, count);
  const auto told = static_cast<int>(times_.size());
  if (times_told_) {
    if (frames > 0 && frames < told && missing_.empty())
      miss(folder_, "has " + std::to_string(frames) + " of the " + std::to_string(told) +
                        " frames that run.json tells");
    frames = std::min(frames, told);
  }
  if (frames == 0) {
    times_ = {run_["simulated_seconds"].number(0)};
    for (RecordedShape& shape : shapes_) shape.moves = false;
    for (std::vector<Pose>& poses : plane_poses_)
      if (poses.size() > 1) poses.erase(poses.begin(), poses.end() - 1);
    return;
  }
  times_.resize(static_cast<std::size_t>(frames));
  if (!times_told_)
    for (int k = 0; k < frames; ++k) times_[k] = k / usual_rate;
}

}  // namespace drape::app
