#include "app/commands/crossings.h"

#include <algorithm>
#include <cstdio>

#include "app/base/words.h"
#include "app/export/files.h"
#include "app/simulation/sheets.h"
#include "mesh/base/errors.h"
#include "mesh/obj/obj.h"
#include "mesh/obj/obj_mark.h"

namespace drape::app {
namespace {

constexpr std::size_t most_told = 5;  // contours that are described
constexpr const char* group = "crossing";

struct Sheet {
  std::string name;
  const TriangleMesh* mesh;
  std::vector<Vec3> positions;  // m
};

std::string where(const Vec3& place) {
  return "(" + rounded(place[0], 4) + ", " + rounded(place[1], 4) + ", " + rounded(place[2], 4) + ") m";
}

std::string pairs(int count) {
  if (count == most_crossing_pairs) return "at least " + std::to_string(count) + " pairs of triangles cross";
  return count == 1 ? "1 pair of triangles crosses" : std::to_string(count) + " pairs of triangles cross";
}

void print(const Sheets& sheets, const std::vector<CrossingContour>& contours) {
  for (std::size_t k = 0; k < std::min(contours.size(), most_told); ++k) {
    const CrossingContour& contour = contours[k];
    const std::string &first = sheets.name_of(contour.pairs.front().first),
                      &second = sheets.name_of(contour.pairs.front().second);
    std::string text = first;
    text += first == second ? " with itself: " : " with " + second + ": ";
    text += counted(static_cast<long>(contour.pairs.size()), "pair");
    text += contour.closed ? ", a closed contour, at " : ", a contour that ends, at ";
    text += where(contour.place);
    std::printf("  %s\n", one_line(text).c_str());
  }
  if (contours.size() > most_told)
    std::printf("  and %s\n", counted(static_cast<long>(contours.size() - most_told), "contour").c_str());
}

// Returns whether any triangles cross.
bool print(const Sheets& sheets, const char* title = "crossings") {
  const std::vector<CrossingContour> contours = sheets.contours();
  if (contours.empty()) {
    std::printf("%s: none\n", title);
    return false;
  }
  std::printf("%s: %s, in %s\n", title, pairs(crossing_count(contours)).c_str(),
              counted(static_cast<long>(contours.size()), "contour").c_str());
  print(sheets, contours);
  return true;
}

// `parts` are those of `sheets`, in their order. A rope has no faces that could be marked.
void write_marked(const std::filesystem::path& folder, const Sheets& sheets,
                  const std::vector<Sheet>& parts) {
  const std::vector<std::vector<int>> crossing = sheets.crossing_triangles();
  const auto is_marked = [&](std::size_t k) {
    return !crossing[k].empty() && parts[k].mesh->triangle_count() > 0;
  };
  Names names;
  for (std::size_t k = 0; k < parts.size(); ++k)
    if (is_marked(k)) names.push_back(parts[k].name + ".obj");
  if (names.empty()) {
    std::printf("nothing is written, for nothing crosses\n");
    return;
  }
  require_new_folder(folder);
  ExportFiles files(folder, names, false, {});
  std::size_t next = 0;
  std::string told;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (!is_marked(k)) continue;
    TriangleMesh mesh = *parts[k].mesh;
    mesh.document = std::make_shared<ObjDocument>(with_group(mesh, crossing[k], group));
    files.write(names[next], format_obj(mesh, parts[k].positions));
    told += one_line("wrote " + (folder / names[next++]).string() + ": the faces of " +
                     counted(static_cast<long>(crossing[k].size()), "triangle") + " are the group " + group) +
            "\n";
  }
  files.keep();
  std::printf("%s", told.c_str());
}

// At the end the places are those of the OBJ files, which have all digits.
Sheets sheets_of(const Recording& recording, int frame) {
  Sheets sheets;
  for (const bool ropes : {false, true})
    for (std::size_t s = 0; s < recording.shapes().size(); ++s) {
      const RecordedShape& shape = recording.shapes()[s];
      const bool is_rope = shape.radius > 0;
      if (shape.body || is_rope != ropes) continue;
      const std::vector<Vec3>& places =
          frame + 1 == recording.frames() ? shape.mesh.positions : recording.positions(s, frame);
      if (is_rope)
        sheets.add_rope(shape.name, places);
      else
        sheets.add(shape.name, shape.mesh.triangles, places);
    }
  return sheets;
}

bool has_polygon(const std::vector<std::size_t>& face_start) {
  for (std::size_t k = 1; k < face_start.size(); ++k)
    if (face_start[k] - face_start[k - 1] > 3) return true;
  return false;
}

}  // namespace

void require_new_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::exists(folder, error)) return;
  if (!std::filesystem::is_directory(folder, error) || !std::filesystem::is_empty(folder, error))
    throw InputError(folder.string() + ": is there already and is no empty folder; give --mark a new one");
}

void print_crossings(const std::string& name, const TriangleMesh& mesh, const std::filesystem::path& mark) {
  Sheets sheets;
  sheets.add(name, mesh.triangles, mesh.positions);
  const bool has_polygons = mesh.document && has_polygon(mesh.document->face_start);
  if (print(sheets) && has_polygons)
    std::printf(
        "note: some faces have more than three corners; a bent one is another surface along each diagonal: "
        "'drape check' of the folder of a run cuts them as the run did\n");
  if (!mark.empty()) write_marked(mark, sheets, {{name, &mesh, mesh.positions}});
}

void print_crossings(const std::vector<Cloth>& cloths, const VecX& x, const std::filesystem::path& mark) {
  const Sheets sheets(cloths, x);
  print(sheets);
  if (mark.empty()) return;
  std::vector<Sheet> parts;
  parts.reserve(cloths.size());
  for (const Cloth& cloth : cloths) parts.push_back({cloth.name, &cloth.mesh, cloth.embedding.positions(x)});
  write_marked(mark, sheets, parts);
}

void print_crossings(const Recording& recording, const std::filesystem::path& mark) {
  const int last = recording.frames() - 1;
  int most = 0, worst = 0;
  for (int frame = 0; frame < last; ++frame) {
    const int count = sheets_of(recording, frame).crossings();
    if (frame == 0) std::printf("crossings at the start: %d\n", count);
    if (count <= most) continue;
    most = count;
    worst = frame;
  }
  if (most > 0)
    std::printf("crossings before the end: at most %d, in frame %d (%s s)\n", most, worst + 1,
                rounded(recording.time(worst), 4).c_str());
  const Sheets sheets = sheets_of(recording, last);
  print(sheets, last > 0 ? "crossings at the end" : "crossings");
  if (mark.empty()) return;
  std::vector<Sheet> parts;
  for (const RecordedShape& shape : recording.shapes())
    if (!shape.body) parts.push_back({shape.name, &shape.mesh, shape.mesh.positions});
  write_marked(mark, sheets, parts);
}

}  // namespace drape::app
