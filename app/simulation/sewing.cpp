#include "app/simulation/sewing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/obj/obj.h"
#include "mesh/obj/obj_scan.h"
#include "solver/forces/pair_force.h"
#include "solver/forces/seam_spring.h"

namespace drape {
namespace {

using SeamForce = PairForce<SeamSpring>;

const Vec3& at(const std::vector<Vec3>& positions, int v) { return positions[static_cast<std::size_t>(v)]; }

const std::vector<int>& group_of(const TriangleMesh& mesh, const PanelEntry& panel) {
  Names known, lines;
  for (const Polyline& line : polylines(mesh)) lines.push_back(line.name);
  for (const VertexGroup& group : mesh.groups) {
    const bool panel_of_faces = std::find(lines.begin(), lines.end(), group.name) == lines.end();
    if (group.name == panel.group && !panel_of_faces)
      throw InputError(panel.where + ": group = \"" + one_line(panel.group) +
                       "\": is a line of the mesh, not a panel");
    if (group.name == panel.group && !group.vertices.empty()) return group.vertices;
    if (panel_of_faces) known.push_back(group.name);
  }
  throw InputError(panel.where + ": group = \"" + one_line(panel.group) + "\": the mesh has no such group; " +
                   (known.empty() ? "it has none" : suggestion(panel.group, known)));
}

// The plane z = 0 wrapped round the y axis: x runs round it, from the point nearest to the viewer.
Vec3 wrapped(const Vec3& x, double radius) {
  const double angle = x.x() / radius, r = radius + x.z();
  return {r * std::sin(angle), x.y(), r * std::cos(angle)};
}

// The seams that the file declares: "# seam A B", or "# seam A B same" where both run the same way.
std::vector<SeamEntry> declared(const SeamEntry& like, const TriangleMesh& mesh) {
  std::vector<SeamEntry> seams;
  if (mesh.document)
    for (const ObjStatement& statement : mesh.document->statements) {
      std::string_view rest = statement.text;
      if (obj::next_word(rest) != "#" || obj::next_word(rest) != "seam") continue;
      SeamEntry seam = like;
      seam.curves = {std::string(obj::next_word(rest)), std::string(obj::next_word(rest))};
      seam.same_direction = obj::next_word(rest) == "same";
      if (!seam.curves[1].empty()) seams.push_back(seam);
    }
  if (seams.empty())
    throw InputError(like.where +
                     ": seams: the mesh declares none ('# seam A B' lines); name two of its lines: curves = "
                     "[\"front.left\", \"back.right\"]");
  return seams;
}

const Polyline& curve_named(const std::string& name, const std::vector<Polyline>& curves,
                            const std::string& where) {
  Names known;
  const Polyline* found = nullptr;
  for (const Polyline& curve : curves) {
    known.push_back(curve.name);
    if (curve.name != name) continue;
    if (found)
      throw InputError(where + ": curves: '" + one_line(name) + "' is in several pieces; name each piece");
    found = &curve;
  }
  if (!found)
    throw InputError(where + ": curves: the mesh has no line '" + one_line(name) + "'; " +
                     (known.empty()
                          ? "it has no lines ('l' in the OBJ file, as drape triangulate writes them)"
                          : suggestion(name, known)));
  return *found;
}

// Where the vertices rest; one that lies in several panels has one of its places.
std::vector<Vec3> rest_places(const TriangleMesh& mesh, const TriangleMesh& rest) {
  std::vector<Vec3> places = mesh.positions;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      places[static_cast<std::size_t>(mesh.triangles[t][k])] = at(rest.positions, rest.triangles[t][k]);
  return places;
}

double length(const std::vector<int>& curve, const std::vector<Vec3>& places) {
  double sum = 0;
  for (std::size_t k = 1; k < curve.size(); ++k)
    sum += (at(places, curve[k]) - at(places, curve[k - 1])).norm();
  return sum;
}

void tell_of_gathers(const OpenSeam& seam, double one, double two, Names& messages) {
  const double more = std::max(one, two) / std::min(one, two) - 1;
  if (!(more > 0.01)) return;
  const bool much = more > 2;  // three times as long
  messages.push_back((much ? "warning: seam " : "note: seam ") + one_line(seam.name) + ": " +
                     rounded(100 * one, 4) + " cm are sewn to " + rounded(100 * two, 4) +
                     " cm: gathered by " + rounded(100 * more, 3) + " %" +
                     (much ? "; is it the right pair?" : ""));
}

OpenSeam open_seam(const SeamEntry& entry, const Fabric& fabric, const TriangleMesh& mesh,
                   const std::vector<Vec3>& places, const std::vector<Polyline>& curves, Names& messages) {
  const std::vector<int>& one = curve_named(entry.curves[0], curves, entry.where).vertices;
  std::vector<int> two = curve_named(entry.curves[1], curves, entry.where).vertices;
  if (entry.curves[0] == entry.curves[1])
    throw InputError(entry.where + ": curves: '" + one_line(entry.curves[0]) + "' cannot be sewn to itself");
  OpenSeam seam;
  seam.name = entry.curves[0] + " / " + entry.curves[1];
  if (one.size() != two.size())
    throw InputError(entry.where + ": seam " + one_line(seam.name) + ": its curves have " +
                     std::to_string(one.size()) + " and " + std::to_string(two.size()) +
                     " vertices, and are sewn vertex by vertex; declare the seam in the pattern, so that "
                     "drape triangulate gives both as many");
  if (!entry.same_direction) std::reverse(two.begin(), two.end());
  for (std::size_t k = 0; k < one.size(); ++k) {
    if (one[k] == two[k]) continue;  // where both begin or end
    seam.pairs.emplace_back(one[k], two[k]);
    seam.apart.push_back((at(mesh.positions, one[k]) - at(mesh.positions, two[k])).norm());
  }
  const double length_one = length(one, places), length_two = length(two, places);
  seam.edge = 0.5 * (length_one + length_two) / static_cast<double>(std::max<std::size_t>(one.size(), 2) - 1);
  seam.close = entry.close;
  seam.merge = entry.merge;
  // As stiff as the cloth while it closes; what is kept for good is held much harder.
  constexpr double kept = 1000;
  const double cloth = std::max(fabric.stretch_spring.value_or(fabric.stretch), 1e-3);
  seam.stiffness = entry.stiffness.value_or(seam.merge ? cloth : kept * cloth);
  tell_of_gathers(seam, length_one, length_two, messages);
  return seam;
}

}  // namespace

double OpenSeam::gap(const Embedding& embedding, const VecX& x) const {
  double widest = 0;
  for (const auto& [a, b] : pairs) {
    const double wide =
        (x.segment<3>(3 * embedding.particle(a)) - x.segment<3>(3 * embedding.particle(b))).norm();
    if (!(wide <= widest)) widest = wide;  // what is no number is not closed
  }
  return widest;
}

bool OpenSeam::closed(const Embedding& embedding, const State& state) const {
  return merge && state.time >= close * (1 - 1e-9) && gap(embedding, state.x) <= near_enough * edge;
}

void place_panels(const ClothEntry& entry, TriangleMesh& mesh, Names& messages) {
  std::vector<int> panel_of(mesh.positions.size(), -1);
  for (std::size_t p = 0; p < entry.panels.size(); ++p) {
    const PanelEntry& panel = entry.panels[p];
    const std::vector<int>& vertices = group_of(mesh, panel);
    Eigen::AlignedBox3d box;
    for (int v : vertices) {
      int& other = panel_of[static_cast<std::size_t>(v)];
      if (other >= 0)
        throw InputError(panel.where + ": group = \"" + one_line(panel.group) + "\": vertex " +
                         std::to_string(v) + " is in panel '" +
                         one_line(entry.panels[static_cast<std::size_t>(other)].group) +
                         "', too; panels that share vertices cannot be placed apart");
      other = static_cast<int>(p);
      box.extend(at(mesh.positions, v));
    }
    const Vec3 middle = box.center();
    constexpr double turn = 6.283185307179586;
    if (panel.wrap && box.sizes().x() > turn * *panel.wrap * (1 + 1e-6))
      messages.push_back("warning: panel " + one_line(panel.group) + " is " +
                         rounded(100 * box.sizes().x(), 4) +
                         " cm wide and goes more than once round a "
                         "cylinder of radius " +
                         rounded(100 * *panel.wrap, 4) + " cm: give a larger wrap");
    for (int v : vertices) {
      Vec3& x = mesh.positions[static_cast<std::size_t>(v)];
      x -= middle;
      if (panel.wrap) x = wrapped(x, *panel.wrap);
      x = panel.placement.rotation * x + panel.placement.translate;
    }
  }
}

std::vector<OpenSeam> open_seams(const ClothEntry& entry, const TriangleMesh& mesh, const TriangleMesh& rest,
                                 Names& messages) {
  std::vector<OpenSeam> seams;
  if (entry.seams.empty()) return seams;
  const std::vector<Polyline> curves = polylines(mesh);
  const std::vector<Vec3> places = rest_places(mesh, rest);
  for (const SeamEntry& given : entry.seams)
    for (const SeamEntry& seam :
         given.curves.empty() ? declared(given, mesh) : std::vector<SeamEntry>{given}) {
      seams.push_back(open_seam(seam, entry.fabric, mesh, places, curves, messages));
      for (std::size_t k = 0; k + 1 < seams.size(); ++k)
        if (seams[k].name == seams.back().name || seams[k].name == seam.curves[1] + " / " + seam.curves[0])
          throw InputError(seam.where + ": seam " + one_line(seams.back().name) +
                           ": these two curves are sewn twice");
    }
  return seams;
}

std::unique_ptr<Force> stitches(const OpenSeam& seam, const Embedding& embedding, double t) {
  std::vector<SeamForce::Element> elements;
  for (std::size_t k = 0; k < seam.pairs.size(); ++k) {
    const int i = embedding.particle(seam.pairs[k].first), j = embedding.particle(seam.pairs[k].second);
    SeamSpring::Rest rest;
    rest.k = seam.stiffness;
    rest.L_0 = seam.apart[k];
    if (i != j) elements.push_back({i, j, rest});
  }
  if (elements.empty()) return nullptr;
  auto force = std::make_unique<SeamForce>(std::move(elements));
  close_until(*force, seam, t);
  return force;
}

void close_until(Force& force, const OpenSeam& seam, double t) {
  const double open = SeamSpring::open(t, seam.close);
  static_cast<SeamForce&>(force).change_rest([&](SeamSpring::Rest& r) { r.L = open * r.L_0; });
}

std::vector<int> merged(const std::vector<int>& number, const std::vector<const OpenSeam*>& seams,
                        const Embedding& embedding) {
  std::vector<int> lower(number.size());  // union-find among the numbers, towards the lowest
  std::iota(lower.begin(), lower.end(), 0);
  const auto root = [&](int i) {
    while (lower[static_cast<std::size_t>(i)] != i) i = lower[static_cast<std::size_t>(i)];
    return i;
  };
  const auto root_of = [&](int vertex) {
    return root(number[static_cast<std::size_t>(embedding.particle(vertex))]);
  };
  for (const OpenSeam* seam : seams)
    for (const auto& [a, b] : seam->pairs) {
      const auto [low, high] = std::minmax({root_of(a), root_of(b)});
      lower[static_cast<std::size_t>(high)] = low;
    }
  const int before = number.empty() ? 0 : 1 + *std::max_element(number.begin(), number.end());
  std::vector<int> again(lower.size()), result = number;
  int count = 0;
  for (int i = 0; i < before; ++i)
    again[static_cast<std::size_t>(i)] = root(i) == i ? count++ : again[static_cast<std::size_t>(root(i))];
  for (int& n : result) n = again[static_cast<std::size_t>(n)];
  return result;
}

}  // namespace drape
