// The examination that examine.h describes. The tolerances are relative. Two vertices are coincident when
// they are at most 1e-9 of the size of the mesh apart. A triangle has zero area when twice its area is
// below 1e-9 of its longest edge squared (an angle of 1e-9 rad). A sliver is a triangle with an angle below
// one degree.
#include "mesh/obj/examine.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <string_view>

#include "mesh/obj/obj.h"
#include "mesh/triangles/topology.h"

namespace drape {

namespace {

constexpr double kCoincident = 1e-9;  // of the size of the mesh
constexpr double kZeroArea = 1e-9;
constexpr double kSliver = 3.14159265358979323846 / 180;  // rad
constexpr double kLarge = 5, kSmall = 0.02;               // m: a size between these is not questioned

std::string number(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 3).ptr;
  return std::string(text, end);
}

// The number and its noun: "1 edge", "12 edges".
std::string count(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

void sort_unique(std::vector<int>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

class Examiner {
 public:
  Examiner(const TriangleMesh& mesh, bool will_be_welded, const std::vector<int>& sewn)
      : mesh_(mesh), will_be_welded_(will_be_welded), sewn_(mesh.positions.size(), 0) {
    for (const int v : sewn) sewn_[static_cast<std::size_t>(v)] = 1;
  }

  MeshReport examine() {
    report_.vertices = mesh_.vertex_count();
    report_.triangles = mesh_.triangle_count();
    report_.faces = mesh_.document ? static_cast<int>(mesh_.document->face_count()) : report_.triangles;
    parse_warnings();
    if (!can_be_measured()) return std::move(report_);
    counted_ = counted_triangles(mesh_);
    edges_ = edges(mesh_);
    measure_extent();
    measure_edges();
    repeated_faces();
    thin_triangles();
    edge_defects();
    coincident_vertices();
    isolated_vertices();
    unit_question();
    return std::move(report_);
  }

 private:
  void add(Severity severity, std::string what, std::vector<int> vertices = {}) {
    sort_unique(vertices);
    report_.defects.push_back({severity, std::move(what), std::move(vertices)});
  }
  void parse_warnings() {
    if (!mesh_.document) return;
    for (const std::string& warning : mesh_.document->warnings) add(Severity::warning, warning);
  }
  bool can_be_measured();
  void measure_extent();
  void measure_edges();
  void repeated_faces();
  void thin_triangles();
  void edge_defects();
  void coincident_vertices();
  void isolated_vertices();
  void unit_question();

  const TriangleMesh& mesh_;
  bool will_be_welded_;
  std::vector<char> sewn_;  // by vertex
  MeshReport report_;
  std::vector<int> counted_;
  std::vector<Edge> edges_;
  std::vector<char> carries_;  // vertices that carry triangles
  double size_ = 0;            // m, largest extent
};

// Returns false, and gives the reason in the report, when positions or vertex numbers make no sense at all.
bool Examiner::can_be_measured() {
  std::vector<int> not_finite;
  for (int v = 0; v < mesh_.vertex_count(); ++v) {
    if (!mesh_.positions[v].allFinite()) not_finite.push_back(v);
  }
  if (!not_finite.empty()) {
    add(Severity::refusal,
        count(not_finite.size(), "vertex has a position that is", "vertices have positions that are") +
            " not finite",
        not_finite);
  }
  for (const Triangle& t : mesh_.triangles) {
    for (const int v : t) {
      if (v >= 0 && v < mesh_.vertex_count()) continue;
      add(Severity::refusal, "a triangle names vertex " + std::to_string(v) + ", but the mesh has " +
                                 std::to_string(mesh_.vertex_count()));
      return false;
    }
  }
  return not_finite.empty();
}

void Examiner::measure_extent() {
  carries_.assign(mesh_.positions.size(), 0);
  Eigen::AlignedBox3d box;
  for (const int i : counted_) {
    report_.area += triangle_area(mesh_, mesh_.triangles[i]);
    for (const int v : mesh_.triangles[i]) {
      carries_[v] = 1;
      box.extend(mesh_.positions[v]);
    }
  }
  if (!box.isEmpty()) report_.lower = box.min(), report_.upper = box.max();
  size_ = report_.box().sizes().maxCoeff();
  const std::vector<int> piece = connected_pieces(mesh_);
  std::vector<char> seen(piece.size(), 0);
  for (std::size_t v = 0; v < piece.size(); ++v) {
    if (carries_[v] && !seen[piece[v]]) seen[piece[v]] = 1, ++report_.pieces;
  }
}

void Examiner::measure_edges() {
  report_.edges = static_cast<int>(edges_.size());
  report_.diagonals = static_cast<int>(diagonals(mesh_).size());
  report_.boundary_loops = static_cast<int>(boundary_loops(mesh_).size());
  report_.closed = !edges_.empty() && std::all_of(edges_.begin(), edges_.end(), [](const Edge& e) {
    return e.triangles == 2 && e.forward == 1;
  });
  if (edges_.empty()) return;
  std::vector<double> lengths;
  lengths.reserve(edges_.size());
  for (const Edge& e : edges_) lengths.push_back((mesh_.positions[e.a] - mesh_.positions[e.b]).norm());
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  report_.median_edge = *middle;
  report_.shortest_edge = *std::min_element(lengths.begin(), middle + 1);
  report_.longest_edge = *std::max_element(middle, lengths.end());
}

void Examiner::repeated_faces() {
  std::vector<int> at_repeated, at_folded;
  std::size_t repeated = 0, folded = 0, next = 0;
  for (int i = 0; i < mesh_.triangle_count(); ++i) {
    if (next < counted_.size() && counted_[next] == i) {
      ++next;
      continue;
    }
    const Triangle& t = mesh_.triangles[i];
    const bool twice = t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    ++(twice ? folded : repeated);
    (twice ? at_folded : at_repeated).insert((twice ? at_folded : at_repeated).end(), t.begin(), t.end());
  }
  if (repeated > 0) {
    add(Severity::warning,
        count(repeated, "triangle has", "triangles have") +
            " the same corners as another; such triangles count once",
        at_repeated);
  }
  if (folded > 0) {
    add(Severity::warning,
        count(folded, "triangle names", "triangles name") + " a vertex twice and will be passed over",
        at_folded);
  }
}

void Examiner::thin_triangles() {
  std::vector<int> at_flat, at_sliver;
  std::size_t flat = 0, slivers = 0;
  double smallest = counted_.empty() ? 0 : 4;
  for (const int i : counted_) {
    const Triangle& t = mesh_.triangles[i];
    double angle = 4, longest = 0;
    const double doubled_area = 2 * triangle_area(mesh_, t);
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = mesh_.positions[t[(k + 1) % 3]] - mesh_.positions[t[k]];
      const Vec3 q = mesh_.positions[t[(k + 2) % 3]] - mesh_.positions[t[k]];
      angle = std::min(angle, std::atan2(doubled_area, p.dot(q)));
      longest = std::max(longest, p.squaredNorm());
    }
    const bool is_flat = doubled_area <= kZeroArea * longest;
    smallest = std::min(smallest, is_flat ? 0 : angle);
    if (is_flat) at_flat.insert(at_flat.end(), t.begin(), t.end()), ++flat;
    if (!is_flat && angle < kSliver) at_sliver.insert(at_sliver.end(), t.begin(), t.end()), ++slivers;
  }
  report_.smallest_angle = smallest;
  if (flat == counted_.size()) {
    add(Severity::refusal, "no triangle has an area: there is nothing to simulate");
  } else if (flat > 0) {
    add(Severity::warning,
        count(flat, "triangle has", "triangles have") +
            " no area and will carry no mass and no bend; woven cloth only holds together there",
        at_flat);
  }
  if (slivers > 0) {
    add(Severity::warning,
        count(slivers, "triangle has", "triangles have") +
            " an angle below 1 degree: simulated as it is, but stiff; remesh there if it jitters",
        at_sliver);
  }
}

void Examiner::edge_defects() {
  std::vector<int> at_many, at_inconsistent;
  std::size_t many = 0, inconsistent = 0;
  for (const Edge& e : edges_) {
    if (e.triangles > 2) at_many.insert(at_many.end(), {e.a, e.b}), ++many;
    if (e.triangles == 2 && e.forward != 1)
      at_inconsistent.insert(at_inconsistent.end(), {e.a, e.b}), ++inconsistent;
  }
  if (many > 0) {
    add(Severity::warning,
        count(many, "edge has", "edges have") +
            " more than two triangles: there springs bend as a hinge for each pair of them, and woven "
            "cloth bends freely",
        at_many);
  }
  if (inconsistent > 0) {
    add(Severity::warning,
        count(inconsistent, "edge lies", "edges lie") +
            " between triangles wound against each other: the motion does not depend on it, but written "
            "normals do;"
            " make the normals consistent in your modeller",
        at_inconsistent);
  }
}

// Vertices are sorted along a direction that is in no way special, so that coincident ones stand near each
// other.
void Examiner::coincident_vertices() {
  const double tolerance = kCoincident * size_;
  const Vec3 direction = Vec3(0.6180339887, 0.4142135624, 0.7320508076).normalized();
  std::vector<std::pair<double, int>> line;
  for (int v = 0; v < mesh_.vertex_count(); ++v) {
    if (carries_[v]) line.emplace_back(mesh_.positions[v].dot(direction), v);
  }
  std::sort(line.begin(), line.end());
  const auto close = [&](int v, int w) {
    const Vec3 &x = mesh_.positions[v], &y = mesh_.positions[w];
    return (x - y).norm() <= tolerance && !(will_be_welded_ && x == y) && !(sewn_[v] && sewn_[w]);
  };

  std::vector<int> joined;
  for (const Edge& e : edges_) {
    if (close(e.a, e.b)) joined.insert(joined.end(), {e.a, e.b});
  }
  sort_unique(joined);
  std::vector<int> apart;
  std::vector<char> has_earlier(mesh_.positions.size(), 0);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const int v = line[i].second;
    // Where many vertices are at one place, the loop ends at the first one that is known to coincide with an
    // earlier one; without this end every vertex would find all the others again.
    for (std::size_t j = i + 1;
         j < line.size() && !has_earlier[v] && line[j].first - line[i].first <= tolerance; ++j) {
      const int w = line[j].second;
      if (!close(v, w)) continue;
      has_earlier[w] = 1;
      for (const int u : {v, w}) {
        if (!std::binary_search(joined.begin(), joined.end(), u)) apart.push_back(u);
      }
    }
  }
  sort_unique(apart);
  if (!joined.empty()) {
    add(Severity::warning,
        std::to_string(joined.size()) +
            " coincident vertices are joined by edges of no length, which will hold them together or make "
            "them "
            "one",
        joined);
  }
  if (!apart.empty()) {
    add(Severity::warning,
        std::to_string(apart.size()) +
            " vertices coincide with others they are not joined to and will move apart freely;"
            " if they should be joined, weld them in your modeller, or set weld = true if it is a cloth of "
            "triangles",
        apart);
  }
}

void Examiner::isolated_vertices() {
  std::vector<int> isolated;
  for (int v = 0; v < mesh_.vertex_count(); ++v) {
    if (!carries_[v]) isolated.push_back(v);
  }
  if (isolated.empty()) return;
  add(Severity::warning,
      count(isolated.size(), "vertex belongs", "vertices belong") + " to no triangle and will take no part",
      isolated);
}

void Examiner::unit_question() {
  if (size_ <= 0 || (size_ >= kSmall && size_ <= kLarge)) return;
  const Vec3 extent = report_.box().sizes();
  const char* const along = size_ == extent.y() ? " tall" : size_ == extent.x() ? " wide" : " deep";
  std::string what = "the mesh is " + number(size_) + " units" + along + " and a unit is taken as a metre";
  struct Unit {
    double metres;
    const char* scale;
    const char* name;
  };
  static constexpr Unit large_units[] = {{0.01, "0.01", "centimetres"},
                                         {0.001, "0.001", "millimetres"},
                                         {0.1, "0.1", "decimetres"},
                                         {0.0254, "0.0254", "inches"}};
  static constexpr Unit small_units[] = {{1000, "1000", "kilometres"}, {100, "100", ""}, {10, "10", ""}};
  const auto fits = [&](const Unit& unit) { return size_ * unit.metres >= 0.3 && size_ * unit.metres <= 3; };
  const Unit* found = nullptr;
  const auto look = [&](const auto& units) {
    for (const Unit& unit : units) {
      if (!found && fits(unit)) found = &unit;
    }
  };
  size_ > kLarge ? look(large_units) : look(small_units);
  constexpr const char* of_given = " (times a scale that is given already)";
  if (!found) {
    what += "; give a scale if that is not so";
  } else if (*found->name) {
    what += std::string(": are these ") + found->name + "? try scale = " + found->scale + of_given;
  } else {
    what += std::string(": if it should be larger, try scale = ") + found->scale + of_given;
  }
  add(Severity::warning, what);
}

}  // namespace

bool MeshReport::refused() const {
  return std::any_of(defects.begin(), defects.end(),
                     [](const Defect& d) { return d.severity == Severity::refusal; });
}

MeshReport examine(const TriangleMesh& mesh, bool will_be_welded, const std::vector<int>& sewn) {
  return Examiner(mesh, will_be_welded, sewn).examine();
}

std::string format(const Defect& defect) {
  static const char* const names[] = {"note: ", "warning: ", "refused: "};
  constexpr std::size_t shown = 5;
  std::string line = names[static_cast<int>(defect.severity)] + defect.what;
  const std::vector<int>& where = defect.vertices;
  if (where.empty()) return line;
  line += where.size() == 1 ? " (vertex " : " (vertices ";
  for (std::size_t i = 0; i < std::min(shown, where.size()); ++i) {
    const bool last = i + 1 == where.size() && i > 0;
    line += (i == 0 ? "" : last ? " and " : ", ") + std::to_string(where[i]);
  }
  if (where.size() > shown) line += " and " + std::to_string(where.size() - shown) + " more";
  return line + ")";
}

}  // namespace drape
