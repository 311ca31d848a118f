#include "mesh/pattern/panels.h"

#include <algorithm>
#include <cmath>

#include "mesh/base/errors.h"
#include "mesh/base/words.h"
#include "mesh/obj/obj_scan.h"

namespace drape {

using namespace internal;

namespace {

// The beginning of a message: a place in a file, or the thing that the message is about when no place is
// known.
std::string at(const std::string& where, const std::string& what) {
  return (where.empty() ? what : where) + ": ";
}

const std::vector<int>& group_of(const TriangleMesh& mesh, const PanelPlace& panel) {
  const std::string found = at(panel.where, "panel") + "group = \"" + one_line(panel.group) + "\": ";
  Names known, lines;
  for (const Polyline& line : polylines(mesh)) lines.push_back(line.name);
  for (const VertexGroup& group : mesh.groups) {
    const bool panel_of_faces = std::find(lines.begin(), lines.end(), group.name) == lines.end();
    if (group.name == panel.group && !panel_of_faces)
      throw InputError(found + "is a line of the mesh, not a panel");
    if (group.name == panel.group && !group.vertices.empty()) return group.vertices;
    if (panel_of_faces) known.push_back(group.name);
  }
  throw InputError(found + "the mesh has no such group; " +
                   (known.empty() ? "it has none" : suggestion(panel.group, known)));
}

Vec3 wrapped(const Vec3& x, double radius) {
  const double angle = x.x() / radius, r = radius + x.z();
  return {r * std::sin(angle), x.y(), r * std::cos(angle)};
}

const Polyline& line_named(const std::string& name, const std::vector<Polyline>& lines,
                           const std::string& place) {
  Names known;
  const Polyline* found = nullptr;
  for (const Polyline& line : lines) {
    known.push_back(line.name);
    if (line.name != name) continue;
    if (found)
      throw InputError(place + "curves: '" + one_line(name) + "' is in several pieces; name each piece");
    found = &line;
  }
  if (!found)
    throw InputError(place + "curves: the mesh has no line '" + one_line(name) + "'; " +
                     (known.empty()
                          ? "it has no lines ('l' in the OBJ file, as drape triangulate writes them)"
                          : suggestion(name, known)));
  return *found;
}

}  // namespace

std::vector<double> place_panels(TriangleMesh& mesh, const std::vector<PanelPlace>& panels) {
  std::vector<int> panel_of(mesh.positions.size(), -1);
  std::vector<double> widths;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const PanelPlace& panel = panels[p];
    const std::vector<int>& vertices = group_of(mesh, panel);
    Vec3 lower = mesh.positions[vertices.front()], upper = lower;
    for (int v : vertices) {
      int& other = panel_of[v];
      if (other >= 0)
        throw InputError(at(panel.where, "panel") + "group = \"" + one_line(panel.group) + "\": vertex " +
                         std::to_string(v) + " is in panel '" + one_line(panels[other].group) +
                         "', too; panels that share vertices cannot be placed apart");
      other = static_cast<int>(p);
      const Vec3& x = mesh.positions[v];
      lower = lower.cwiseMin(x), upper = upper.cwiseMax(x);
    }
    const Vec3 middle = 0.5 * (lower + upper);
    for (int v : vertices) {
      Vec3& x = mesh.positions[v];
      x -= middle;
      if (panel.wrap) x = wrapped(x, *panel.wrap);
      x = panel.rotation * x + panel.translate;
    }
    widths.push_back(upper.x() - lower.x());
  }
  return widths;
}

std::vector<Seam> declared_seams(const TriangleMesh& mesh) {
  std::vector<Seam> seams;
  if (!mesh.document) return seams;
  for (const ObjStatement& statement : mesh.document->statements) {
    std::string_view rest = statement.text;
    if (obj::next_word(rest) != "#" || obj::next_word(rest) != "seam") continue;
    Seam seam;
    seam.a = obj::next_word(rest);
    seam.b = obj::next_word(rest);
    seam.same_way = obj::next_word(rest) == "same";
    if (!seam.b.empty()) seams.push_back(std::move(seam));
  }
  return seams;
}

std::vector<std::pair<int, int>> seam_pairs(const std::vector<Polyline>& lines, const Seam& seam) {
  const std::string name = "seam " + one_line(seam.a) + " / " + one_line(seam.b);
  const std::string place = at(seam.where, name);
  const std::vector<int>& one = line_named(seam.a, lines, place).vertices;
  std::vector<int> two = line_named(seam.b, lines, place).vertices;
  if (seam.a == seam.b)
    throw InputError(place + "curves: '" + one_line(seam.a) + "' cannot be sewn to itself");
  if (one.size() != two.size())
    throw InputError(at(seam.where, "the mesh") + name + ": its curves have " + std::to_string(one.size()) +
                     " and " + std::to_string(two.size()) +
                     " vertices, and are sewn vertex by vertex; declare the seam in the pattern, so that "
                     "drape triangulate gives both as many");
  if (!seam.same_way) std::reverse(two.begin(), two.end());
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t k = 0; k < one.size(); ++k) pairs.emplace_back(one[k], two[k]);
  return pairs;
}

}  // namespace drape
