#include "app/view/page_data.h"

#include <algorithm>
#include <bit>
#include <functional>

#include "app/base/interrupt.h"
#include "app/recording/drawn.h"
#include "app/view/track.h"
#include "mesh/obj/obj.h"

namespace drape::app {
namespace {

using FrameValues = std::function<std::vector<double>(int frame)>;  // component by component

// Twice through the frames: how far they go, then what they are.
Json track(PageBlocks& blocks, int frames, std::size_t components, std::size_t vertices,
           const FrameValues& values, long& not_finite) {
  std::vector<ValueRange> ranges(components);
  std::vector<char> any(components, 0);
  for (int frame = 0; frame < frames; ++frame) {
    end_if_interrupted();
    const std::vector<double> all = values(frame);
    for (std::size_t c = 0; c < components; ++c) {
      bool known = any[c] != 0;
      widen(ranges[c], known, all.data() + c * vertices, vertices);
      any[c] = known;
    }
  }
  TrackWriter writer(blocks, ranges, vertices);
  for (int frame = 0; frame < frames; ++frame) {
    end_if_interrupted();
    writer.add(values(frame));
  }
  not_finite += writer.not_finite();
  return writer.finish();
}

std::vector<double> by_component(const std::vector<Vec3>& points) {
  std::vector<double> all(3 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) all[c * points.size() + i] = points[i][static_cast<int>(c)];
  return all;
}

// A field of every vertex, where it is known in all frames.
Json field(PageBlocks& blocks, int frames, std::size_t vertices, const FrameValues& values,
           long& not_finite) {
  for (int frame = 0; frame < frames; ++frame)
    if (values(frame).size() != vertices) return {};
  return track(blocks, frames, 1, vertices, values, not_finite);
}

std::vector<double> speeds(const std::vector<Vec3>& velocities) {
  std::vector<double> all;
  all.reserve(velocities.size());
  for (const Vec3& v : velocities) all.push_back(v.norm());
  return all;
}

Json index_head(PageBlocks& blocks, const std::vector<int>& list) {
  return Json::Members{{"block", blocks.add(index_bytes(list))}, {"count", static_cast<long>(list.size())}};
}

std::vector<int> corners(const std::vector<Triangle>& triangles) {
  std::vector<int> list;
  for (const Triangle& t : triangles) list.insert(list.end(), t.begin(), t.end());
  return list;
}

std::vector<int> sides_of(const TriangleMesh& mesh, const DrawnShape& drawn) {
  if (!drawn.is_tube()) return polygon_sides(mesh);
  TriangleMesh tube;
  tube.triangles = drawn.triangles();
  return polygon_sides(tube);
}

Json shape_head(const Recording& recording, std::size_t s, PageBlocks& blocks, long& not_finite) {
  const RecordedShape& shape = recording.shapes()[s];
  const DrawnShape drawn(shape);
  const auto vertices = static_cast<std::size_t>(drawn.vertices(shape.mesh.vertex_count()));
  const int frames = shape.body && !shape.moves ? 1 : recording.frames();
  Json::Members head = {{"name", shape.name},
                        {"body", shape.body},
                        {"vertices", static_cast<long>(vertices)},
                        {"triangles", index_head(blocks, corners(drawn.triangles()))},
                        {"edges", index_head(blocks, sides_of(shape.mesh, drawn))}};
  if (drawn.is_tube()) head.emplace_back("sides", tube_sides);  // vertices for each point of a rope
  head.emplace_back(
      "positions",
      track(
          blocks, frames, 3, vertices,
          [&](int k) { return by_component(drawn.positions(recording.positions(s, k))); }, not_finite));
  if (shape.body) return head;
  const auto known = [&](const char* name, const FrameValues& values) {
    head.emplace_back(
        name, field(
                  blocks, frames, vertices, [&](int k) { return drawn.values(values(k)); }, not_finite));
  };
  known("speed", [&](int k) { return speeds(recording.velocities(s, k)); });
  known("strain", [&](int k) { return recording.strains(s, k); });
  known("contact", [&](int k) {
    std::vector<double> all;
    for (const Touch touch : recording.touches(s, k)) all.push_back(static_cast<double>(touch));
    return all;
  });
  return head;
}

Json vector_json(const Vec3& v) { return Json::List{v[0], v[1], v[2]}; }

// Once where it stands, else in every frame.
Json planes_json(const Recording& recording) {
  const std::size_t count = recording.planes(0).size();
  std::vector<Json::List> points(count), normals(count);
  std::vector<bool> moves(count, false);
  std::vector<RecordedPlane> first = recording.planes(0);
  for (int frame = 0; frame < recording.frames(); ++frame) {
    const std::vector<RecordedPlane> planes = recording.planes(frame);
    for (std::size_t p = 0; p < count; ++p) {
      points[p].push_back(vector_json(planes[p].point));
      normals[p].push_back(vector_json(planes[p].normal));
      if (planes[p].point != first[p].point || planes[p].normal != first[p].normal) moves[p] = true;
    }
  }
  Json::List list;
  for (std::size_t p = 0; p < count; ++p) {
    if (!moves[p]) points[p].resize(1), normals[p].resize(1);
    list.emplace_back(Json::Members{{"name", first[p].name}, {"points", points[p]}, {"normals", normals[p]}});
  }
  return list;
}

// Columns of 32-bit floating point numbers, one after the other, little endian.
Json steps_json(const RecordedSteps& steps, PageBlocks& blocks) {
  const auto time = std::find(steps.columns.begin(), steps.columns.end(), "time");
  if (steps.rows.empty() || time == steps.columns.end()) return {};
  std::string bytes;
  for (std::size_t c = 0; c < steps.columns.size(); ++c)
    for (const std::vector<double>& row : steps.rows) {
      const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(row[c]));
      for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(bits >> shift & 255);
    }
  return Json::Members{{"columns", steps.columns},
                       {"rows", static_cast<long>(steps.rows.size())},
                       {"block", blocks.add(bytes)}};
}

bool known_of_cloths(const Json::List& shapes, const char* field) {
  return std::all_of(shapes.begin(), shapes.end(), [&](const Json& shape) {
    return std::get<bool>(shape["body"].value) || !shape[field].is_null();
  });
}

Names notes_of(const Json::List& shapes, int frames, long not_finite) {
  Names notes;
  double step = 0;
  for (const Json& shape : shapes)
    for (const Json& component : shape["positions"]["step"].items())
      step = std::max(step, component.number(0));
  notes.push_back("Positions are kept to " + rounded(500 * step, 2) + " mm.");
  if (!known_of_cloths(shapes, "speed"))
    notes.push_back(frames > 1 ? "Velocities were not recorded: speeds are from the frames before and after."
                               : "Velocities were not recorded.");
  if (!known_of_cloths(shapes, "strain")) notes.push_back("Strains were not recorded.");
  if (!known_of_cloths(shapes, "contact")) notes.push_back("Contacts were not recorded.");
  if (frames == 1) notes.push_back("There is one frame.");
  if (not_finite > 0)
    notes.push_back("Not finite, and shown as last known: " + counted(not_finite, "number") + ".");
  return notes;
}

}  // namespace

std::string index_bytes(const std::vector<int>& list) {
  std::string planes[4];
  int last = 0;
  for (const int index : list) {
    const int d = index - last;
    const auto z = static_cast<std::uint32_t>(d >= 0 ? 2 * d : -2 * d - 1);
    for (int p = 0; p < 4; ++p) planes[p] += static_cast<char>(z >> (8 * p) & 255);
    last = index;
  }
  return planes[0] + planes[1] + planes[2] + planes[3];
}

std::vector<int> polygon_sides(const TriangleMesh& mesh) {
  std::vector<std::pair<int, int>> sides;
  const auto add = [&](int a, int b) { sides.emplace_back(std::min(a, b), std::max(a, b)); };
  if (const ObjDocument* const document = mesh.document.get(); document && document->face_count() > 0) {
    for (std::size_t f = 0; f < document->face_count(); ++f) {
      const std::size_t begin = document->face_start[f], end = document->face_start[f + 1];
      for (std::size_t k = begin; k < end; ++k)
        add(document->corners[k].v, document->corners[k + 1 < end ? k + 1 : begin].v);
    }
  } else {
    for (const Triangle& t : mesh.triangles) add(t[0], t[1]), add(t[1], t[2]), add(t[2], t[0]);
  }
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  std::vector<int> list;
  for (const auto& [a, b] : sides) list.insert(list.end(), {a, b});
  return list;
}

std::string title_of(const Recording& recording) {
  const std::filesystem::path scene(recording.run()["scene"].text());  // of a drop, its command line
  if (scene.extension() == ".toml") return one_line(scene.stem().string());
  const std::filesystem::path folder = std::filesystem::absolute(recording.folder() / "").parent_path();
  return one_line(folder.filename().string());
}

PageData page_data(const Recording& recording) {
  PageData page;
  Json::List shapes, times;
  long not_finite = 0;
  for (std::size_t s = 0; s < recording.shapes().size(); ++s)
    shapes.push_back(shape_head(recording, s, page.blocks, not_finite));
  for (int frame = 0; frame < recording.frames(); ++frame) times.emplace_back(recording.time(frame));
  Json steps = steps_json(recording.steps(), page.blocks), planes = planes_json(recording);
  Names notes = notes_of(shapes, recording.frames(), not_finite);
  page.head = Json::Members{
      {"title", title_of(recording)},   {"missing", recording.missing()},
      {"facts", page_facts(recording)}, {"warnings", Json::List(recording.run()["warnings"].items())},
      {"notes", std::move(notes)},      {"times", std::move(times)},
      {"shapes", std::move(shapes)},    {"planes", std::move(planes)},
      {"steps", std::move(steps)}};
  return page;
}

}  // namespace drape::app
