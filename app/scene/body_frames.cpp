#include "app/scene/body_frames.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <system_error>
#include <utility>

#include "app/base/pc2.h"
#include "app/base/text_file.h"
#include "app/scene/load_mesh.h"
#include "mesh/obj/obj.h"

namespace drape::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* expected_frames =
    "expected a pattern with one %d or %04d such as \"walk/body_%04d.obj\", a list of OBJ files, or a .pc2 "
    "file";

bool has_extension(const fs::path& path, std::string_view wanted) { return lower_extension(path) == wanted; }

// "body_%04d.obj" taken apart: what stands before the number and after it, and its least number of digits.
struct Pattern {
  fs::path folder;
  std::string before, after;
  std::size_t digits = 1;

  fs::path file(long number) const {
    std::string text = std::to_string(number);
    if (text.size() < digits) text.insert(0, digits - text.size(), '0');
    return folder / (before + text + after);
  }
};

std::optional<Pattern> parse_pattern(const fs::path& path) {
  const std::string name = path.filename().string();
  const std::size_t percent = name.find('%'), d = name.find('d', percent == name.npos ? 0 : percent);
  if (percent == name.npos || d == name.npos || name.find('%', percent + 1) != name.npos) return std::nullopt;
  Pattern pattern{path.parent_path(), name.substr(0, percent), name.substr(d + 1)};
  const std::string width = name.substr(percent + 1, d - percent - 1);  // "", or 04
  if (width.empty()) return pattern;
  const auto [end, error] = std::from_chars(width.data(), width.data() + width.size(), pattern.digits);
  const bool read = error == std::errc() && end == width.data() + width.size();
  if (!read || width[0] != '0' || pattern.digits < 1 || pattern.digits > 18) return std::nullopt;
  return pattern;
}

// The number in a file's name, when the pattern writes that name for it.
std::optional<long> number_of(const Pattern& pattern, const std::string& name) {
  const std::size_t around = pattern.before.size() + pattern.after.size();
  if (name.size() <= around || !name.starts_with(pattern.before) || !name.ends_with(pattern.after))
    return std::nullopt;
  const std::string_view digits = std::string_view(name).substr(pattern.before.size(), name.size() - around);
  long number = -1;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size() || number < 0) return std::nullopt;
  return pattern.file(number).filename() == name ? std::optional(number) : std::nullopt;
}

std::vector<fs::path> files_of(const Pattern& pattern, const std::string& where) {
  std::vector<long> numbers;
  std::error_code error;
  const fs::path folder = pattern.folder.empty() ? "." : pattern.folder;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (const auto number = number_of(pattern, entry.path().filename().string())) numbers.push_back(*number);
  std::sort(numbers.begin(), numbers.end());
  if (numbers.empty())
    throw InputError(where + ": frames: there is no file such as " + pattern.file(1).string());
  std::vector<fs::path> files;
  for (long number : numbers) {
    const long due = numbers.front() + static_cast<long>(files.size());
    if (number != due)
      throw InputError(where + ": frames: " + pattern.file(due).string() + " is missing: there are frames " +
                       std::to_string(numbers.front()) + " to " + std::to_string(numbers.back()));
    files.push_back(pattern.file(number));
  }
  return files;
}

void want_count(const fs::path& file, int count, const char* noun, const ObstacleEntry& entry, int vertices) {
  if (count != vertices)
    throw InputError(file.string() + ": has " + std::to_string(count) + " " + noun + ", the rest mesh " +
                     entry.mesh.string() + " has " + std::to_string(vertices) +
                     " vertices; the frames of a body must have the vertices of its mesh, in the same order");
}

double mean_edge(const TriangleMesh& mesh) {  // m
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) sum += (mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]).norm();
  return sum / (3 * std::max(mesh.triangle_count(), 1));
}

// Bodies breathe, and do not tear: where edges are several times as long as in the frame before, the file is
// most often another one than was meant. edge: the mean length of an edge [m] in the frame before, and then
// in this one.
void want_same_edges(const TriangleMesh& frame, const fs::path& file, const ObstacleEntry& entry,
                     double& edge) {
  constexpr double most = 3;
  const double now = mean_edge(frame), before = std::exchange(edge, now);
  if (now <= most * before && before <= most * now) return;
  throw InputError(file.string() + ": its edges are " + rounded(now / before, 3) +
                   " times as long as before, on average; are its vertices in another order than those of " +
                   entry.mesh.string() +
                   " (Blender's exporter has 'Keep Vertex Order'), or is it in another unit?");
}

void add(MeshFrames& frames, double time, std::vector<Vec3> positions, const fs::path& file,
         const ObstacleEntry& entry, const TriangleMesh& rest, double& edge) {
  TriangleMesh frame;
  frame.positions = std::move(positions);
  frame.triangles = rest.triangles;
  frame = placed(std::move(frame), entry.placement, file.string());
  if (std::ranges::all_of(frame.positions, [](const Vec3& p) { return p.allFinite(); }))
    want_same_edges(frame, file, entry, edge);
  try {
    frames.add(time, frame.positions);
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

}  // namespace

FramesEntry read_frames(Table& table, const fs::path& folder) {
  FramesEntry entry;
  entry.where = table.where();
  const About about(
      "where its vertices are in time: a pattern \"walk/body_%04d.obj\" (one %d or %04d; from the lowest "
      "number "
      "that exists, without a gap), a list of OBJ files, or a .pc2 file; as many vertices as `mesh`, which "
      "tells "
      "the faces; placed as `mesh` is");
  const Node* const node = table.take("frames", "a text, or a list of texts", about);
  if (!node) {
    for (const char* key : {"frame_rate", "frames_start"})
      if (table.has(key))
        table.fail(key, "belongs to `frames`, which is not there: " + std::string(expected_frames));
    return entry;
  }
  entry.where = node->where;
  Names texts;
  if (node->kind == Node::Kind::array) {
    table.read("frames", texts, about);
  } else {
    texts.emplace_back();
    table.read("frames", texts.front(), about);
  }
  for (const std::string& text : texts) {
    if (text.empty()) table.fail("frames", expected_frames);
    entry.files.push_back((folder / text).lexically_normal());
  }
  if (entry.files.empty()) table.fail("frames", expected_frames);
  const bool listed = node->kind == Node::Kind::array;
  if (!listed && !has_extension(entry.files[0], ".pc2")) {
    entry.pattern = true;
    if (!parse_pattern(entry.files[0])) table.fail("frames", expected_frames);
  }
  table.read(
      "frame_rate", entry.rate, dimension::rate, Range::positive,
      "of frames; a PC2 file's sample rate counts frames from one sample to the next, its start frame is "
      "passed over");
  table.read(
      "frames_start", entry.start, dimension::time, Range::any,
      "time of the first frame; before it and after the last one the body stands, between two frames its "
      "vertices go straight");
  return entry;
}

std::vector<fs::path> frame_files(const FramesEntry& entry) {
  if (entry.pattern) return files_of(*parse_pattern(entry.files[0]), entry.where);
  for (const fs::path& file : entry.files)
    if (!fs::exists(file)) throw InputError(entry.where + ": frames: " + file.string() + ": no such file");
  return entry.files;
}

namespace {

std::shared_ptr<const MeshFrames> load(const std::vector<fs::path>& files, const ObstacleEntry& entry,
                                       const TriangleMesh& rest) {
  const auto frames = std::make_shared<MeshFrames>();
  const auto time = [&](double frame) { return entry.frames.start + frame / entry.frames.rate; };
  std::vector<Vec3> positions;
  double edge = mean_edge(rest);
  if (files.size() == 1 && has_extension(files[0], ".pc2")) {
    Pc2Reader cache(files[0]);
    want_count(files[0], cache.points(), "points", entry, rest.vertex_count());
    for (int k = 0; k < cache.samples(); ++k) {
      cache.read(positions);
      add(*frames, time(k * cache.spacing()), positions, files[0], entry, rest, edge);
    }
    return frames;
  }
  for (std::size_t k = 0; k < files.size(); ++k) {
    positions = read_obj(files[k]).positions;
    want_count(files[k], static_cast<int>(positions.size()), "vertices", entry, rest.vertex_count());
    add(*frames, time(static_cast<double>(k)), positions, files[k], entry, rest, edge);
  }
  return frames;
}

}  // namespace

std::shared_ptr<const MeshFrames> load_frames(const ObstacleEntry& entry, const TriangleMesh& rest) {
  const std::vector<fs::path> files = frame_files(entry.frames);
  try {
    return load(files, entry, rest);
  } catch (const InputError& error) {
    throw InputError(entry.frames.where + ": frames: " + error.what());
  }
}

}  // namespace drape::app
