// A rope of a scene: its points or a line of a file, divided and placed; its ends joined to vertices of other
// parts, or fastened to bodies.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "app/scene/load_mesh.h"
#include "app/simulation/parts.h"
#include "mesh/base/errors.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/line.h"

namespace drape::app {
namespace {

std::string in_mm(double length) { return rounded(1000 * length, 3) + " mm"; }
std::string in_words(const Vec3& x) {
  return "(" + rounded(x[0], 4) + ", " + rounded(x[1], 4) + ", " + rounded(x[2], 4) + ") m";
}
std::string end_of(bool last) { return last ? "its last end" : "its first end"; }

// Pieces that meet end to end, in any order, as one line, which goes as the first of them goes: programs
// write an 'l' for each edge. Nothing where they branch, close a ring or are apart.
std::optional<Polyline> end_to_end(const std::vector<const Polyline*>& pieces) {
  std::map<int, std::vector<std::size_t>> at;  // vertex -> the pieces that end there
  for (std::size_t k = 0; k < pieces.size(); ++k)
    for (const int v : {pieces[k]->vertices.front(), pieces[k]->vertices.back()}) at[v].push_back(k);
  const auto free_end = [&](int v) { return at[v].size() == 1; };
  const auto first = std::ranges::find_if(pieces, [&](const Polyline* piece) {
    return free_end(piece->vertices.front()) || free_end(piece->vertices.back());
  });
  if (first == pieces.end()) return std::nullopt;
  Polyline line{(*first)->name, {}};
  int end = free_end((*first)->vertices.front()) ? (*first)->vertices.front() : (*first)->vertices.back();
  std::size_t used = 0;
  for (std::vector<std::size_t>* next = &at[end]; next->size() == 1; next = &at[end]) {
    const std::size_t k = next->front();
    std::vector<int> vertices = pieces[k]->vertices;
    if (vertices.front() != end) std::ranges::reverse(vertices);
    line.vertices.insert(line.vertices.end(), vertices.begin() + (used > 0), vertices.end());
    for (const int v : {vertices.front(), vertices.back()}) std::erase(at[v], k);
    end = vertices.back();
    ++used;
  }
  std::vector<int> sorted = line.vertices;
  std::ranges::sort(sorted);
  if (used != pieces.size() || std::ranges::adjacent_find(sorted) != sorted.end()) return std::nullopt;
  const auto place = [&](int v) { return std::ranges::find(line.vertices, v); };
  if (place(pieces.front()->vertices.front()) > place(pieces.front()->vertices.back()))
    std::ranges::reverse(line.vertices);
  return line;
}

// The one line of this name, or of any name when there is none.
Polyline line_of(const RopeEntry& entry, const TriangleMesh& mesh) {
  const std::vector<Polyline> lines = polylines(mesh);
  Names names;
  std::vector<const Polyline*> found;
  for (const Polyline& line : lines) {
    names.push_back(line.name);
    if (entry.line.empty() || line.name == entry.line) found.push_back(&line);
  }
  const std::string start = entry.where + ": line: " + entry.mesh.string() + " has ";
  if (lines.empty()) {
    const std::vector<std::string>& warnings = mesh.document->warnings;
    const auto left_out = std::ranges::find_if(
        warnings, [](const std::string& text) { return text.find("line or point element") != text.npos; });
    throw InputError(start + "no lines ('l'); expected one that the rope goes along" +
                     (left_out == warnings.end() ? "" : " (" + *left_out + ")"));
  }
  if (found.empty())
    throw InputError(start + "no line '" + one_line(entry.line) + "'; " + suggestion(entry.line, names));
  const bool of_one_name =
      std::ranges::all_of(found, [&](const Polyline* line) { return line->name == found.front()->name; });
  if (found.size() > 1 && of_one_name)
    if (std::optional<Polyline> line = end_to_end(found)) return *line;
  if (found.size() > 1 && of_one_name)
    throw InputError(
        start + counted(static_cast<long>(found.size()), "line") +
        (found.front()->name.empty() ? " without a name" : " named '" + one_line(found.front()->name) + "'") +
        "; expected one, or pieces that meet end to end");
  if (found.size() > 1)
    throw InputError(start + counted(static_cast<long>(found.size()), "line") +
                     "; expected the name of one: " + listed(names));
  const std::vector<int>& along = found.front()->vertices;
  if (along.size() < 2)
    throw InputError(start + "a line of one vertex; a rope goes through two points at least");
  if (along.front() == along.back())
    throw InputError(
        start + "a line that ends where it begins, at vertex " + std::to_string(along.front() + 1) +
        "; a rope has two ends: leave out the last piece, or make two ropes and join their ends");
  return *found.front();
}

std::vector<Vec3> points_of(const RopeEntry& entry) {
  TriangleMesh mesh;
  mesh.positions = entry.points;
  if (!entry.mesh.empty()) {
    require_file(entry.mesh, entry.where);
    mesh = read_obj(entry.mesh, ObjNeed::faces_or_lines);
    std::vector<Vec3> along;
    for (const int v : line_of(entry, mesh).vertices)
      along.push_back(mesh.positions[static_cast<std::size_t>(v)]);
    mesh.positions = std::move(along);
  }
  mesh = placed(std::move(mesh), entry.placement, entry.mesh.empty() ? entry.where : entry.mesh.string());
  std::optional<int> parts = entry.segments;
  constexpr double most = 1e6;  // segments
  const double asked =
      entry.spacing ? std::round(length_of(mesh.positions) / *entry.spacing) : parts.value_or(1);
  if (!(asked <= most))
    throw InputError(entry.where + ": a rope of " + rounded(length_of(mesh.positions), 3) + " m would have " +
                     rounded(asked, 3) + " segments; expected a million at most: give a longer spacing");
  if (entry.spacing) parts = std::max(1, static_cast<int>(asked));
  return parts ? evenly_divided(mesh.positions, *parts) : mesh.positions;
}

// The particle that the end becomes.
int joined_to(const JoinEntry& join, const RopeEntry& entry, const Vec3& end, const Simulation& simulation) {
  const auto part = std::find_if(simulation.cloths.begin(), simulation.cloths.end(),
                                 [&](const Cloth& cloth) { return cloth.name == join.to; });
  const std::vector<Vec3> vertices = part->embedding.positions(simulation.state.x);
  int nearest = 0;
  const auto off = [&](int v) { return (vertices[static_cast<std::size_t>(v)] - end).norm(); };
  for (int v = 1; v < part->embedding.vertices(); ++v)
    if (off(v) < off(nearest)) nearest = v;
  const std::string start = join.where + ": " + end_of(join.last) + ", at " + in_words(end) + ", is ";
  const double within = join.within.value_or(entry.material.radius);
  if (!(off(nearest) <= within))
    throw InputError(start + in_mm(off(nearest)) + " from the nearest vertex of " + one_line(part->name) +
                     " (" + std::to_string(nearest) + ", at " +
                     in_words(vertices[static_cast<std::size_t>(nearest)]) + "); expected " + in_mm(within) +
                     " or less: move the end, or set within");
  const int particle = part->embedding.particle(nearest);
  if (particle < 0)
    throw InputError(start + "nearest to vertex " + std::to_string(nearest) + " of " + one_line(part->name) +
                     ", which lies between particles; join it to a box of particles instead");
  return particle;
}

void tell_of_segments(const RopeEntry& entry, std::size_t points, Names& messages) {
  constexpr std::size_t few = 8;
  if (points > few) return;
  messages.push_back("note: rope " + entry.name + ": has " +
                     counted(static_cast<long>(points - 1), "segment") +
                     ", each of which stays straight; set segments or spacing if it is to bend");
}

}  // namespace

RopePart load_rope(const RopeEntry& entry, Simulation& simulation) {
  RopePart part;
  part.name = entry.name;
  part.material = entry.material;
  part.points = points_of(entry);
  if (entry.self_contact) part.self_contact = entry.self;
  tell_of_segments(entry, part.points.size(), simulation.messages);
  for (const JoinEntry& join : entry.joins)
    (join.last ? part.last : part.first) =
        joined_to(join, entry, join.last ? part.points.back() : part.points.front(), simulation);
  return part;
}

void anchor(const RopeEntry& entry, const Cloth& rope, const Scene& scene, Simulation& simulation) {
  for (const AnchorEntry& anchor : entry.anchors) {
    const int particle = rope.embedding.particle(anchor.last ? rope.embedding.vertices() - 1 : 0);
    const Vec3 x = simulation.state.x.segment<3>(3 * particle);
    const std::string start = anchor.where + ": " + end_of(anchor.last) + ", at " + in_words(x) + ", is ";
    if (const double off = anchor.at ? (*anchor.at - x).norm() : 0; off > entry.material.radius)
      throw InputError(start + in_mm(off) + " from where it is to be anchored; move one of both");
    const auto body = std::find_if(scene.obstacles.begin(), scene.obstacles.end(),
                                   [&](const ObstacleEntry& o) { return o.name == anchor.body; });
    const auto number = body - scene.obstacles.begin();
    const double off = simulation.constraints->bodies()[static_cast<std::size_t>(number)].distance(x);
    if (off > entry.material.radius)
      throw InputError(start + in_mm(off) + " outside of " + one_line(anchor.body) +
                       "; expected it in the body, or off its surface by the rope's radius at most");
    simulation.constraints->pin_to_body({particle}, static_cast<int>(number), simulation.state.x);
  }
}

}  // namespace drape::app
