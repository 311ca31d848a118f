// Makes a mesh with its document and a report from a pattern. See pattern.h; sides.h and refine.h explain the
// method.
#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <numeric>

#include "mesh/obj/obj.h"
#include "mesh/pattern/pattern_check.h"
#include "mesh/pattern/refine.h"

namespace drape {

using namespace internal;

namespace {

std::size_t z(int i) { return static_cast<std::size_t>(i); }

constexpr int kBox = Delaunay::kBoxCorners;
constexpr double kMostTriangles = 20e6;
constexpr double kSharpestBound = 33;  // deg: up to here refinement ends in practice [Shewchuk 2002]

double total_area(const Pattern& pattern) {
  double area = 0;
  for (const Panel& panel : pattern.panels) {
    area += std::abs(enclosed_area(panel.outline));
    for (const Chain& hole : panel.holes) area -= std::abs(enclosed_area(hole));
  }
  return area;
}

double boundary_length(const Pattern& pattern) {
  double length = 0;
  for (const Panel& panel : pattern.panels) {
    std::vector<const Chain*> chains = {&panel.outline};
    for (const Chain& c : panel.holes) chains.push_back(&c);
    for (const Chain& c : panel.lines) chains.push_back(&c);
    for (const Chain* c : chains) length += ArcLength(c->segments).length();
  }
  return length;
}

// Two digits are enough for a value that the user has not given exactly.
double two_digits(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 1);
  return std::floor(x / unit) * unit;
}

class Assembler {
 public:
  Assembler(const Pattern& pattern, const Sides& sides, const Refined& refined,
            const TriangulateOptions& options)
      : pattern_(pattern), sides_(sides), refined_(refined), options_(options) {}

  PatternMesh assemble() {
    made_.edge = options_.edge, made_.tolerance = options_.tolerance;
    made_.longest_edge = 0, made_.below = 0;
    made_.smallest_angle = made_.smallest_angle_elsewhere = std::numbers::pi;
    made_.sharp = sides_.sharp;
    document_.face_start.push_back(0);
    for (std::size_t p = 0; p < refined_.panels.size(); ++p) add_panel(static_cast<int>(p));
    for (std::size_t r = 0; r < sides_.runs.size(); ++r)
      if (!sides_.runs[r].name.empty()) add_curve(static_cast<int>(r));
    for (const Seam& seam : pattern_.seams) add_seam(seam);
    TriangleMesh mesh = std::move(made_.mesh);
    mesh.document = std::make_shared<const ObjDocument>(std::move(document_));
    made_.mesh = parse_obj(format_obj(mesh, mesh.positions), pattern_.where);  // with its groups
    return std::move(made_);
  }

 private:
  // Gives near vertices near numbers: they are sorted along the Morton curve (the bits of x and y in turn).
  std::vector<int> ordered(const Delaunay& mesh) const {
    Eigen::AlignedBox2d box;
    for (std::size_t i = kBox; i < mesh.points().size(); ++i) box.extend(mesh.points()[i]);
    const double scale = 1048575 / box.sizes().maxCoeff();
    std::vector<std::pair<std::uint64_t, int>> keys;
    for (std::size_t i = kBox; i < mesh.points().size(); ++i) {
      const Vec2 x = (mesh.points()[i] - box.min()) * scale;
      std::uint64_t key = 0;
      const auto u = static_cast<std::uint64_t>(x.x()), v = static_cast<std::uint64_t>(x.y());
      for (int bit = 0; bit < 20; ++bit)
        key |= ((u >> bit & 1) << (2 * bit)) | ((v >> bit & 1) << (2 * bit + 1));
      keys.emplace_back(key, static_cast<int>(i));
    }
    std::sort(keys.begin(), keys.end());
    std::vector<int> number(mesh.points().size(), -1);
    for (std::size_t k = 0; k < keys.size(); ++k) number[z(keys[k].second)] = first_ + static_cast<int>(k);
    return number;
  }

  void add_panel(int p) {
    const Delaunay& mesh = refined_.panels[z(p)];
    first_ = made_.mesh.vertex_count();
    numbers_.push_back(ordered(mesh));
    const std::vector<int>& number = numbers_.back();
    made_.mesh.positions.resize(made_.mesh.positions.size() + mesh.points().size() - kBox);
    for (std::size_t i = kBox; i < mesh.points().size(); ++i)
      made_.mesh.positions[z(number[i])] = Vec3(mesh.points()[i].x(), mesh.points()[i].y(), 0);
    add_texture(pattern_.panels[z(p)].grain);
    document_.statements.push_back({document_.face_count(), "g " + pattern_.panels[z(p)].name});
    PanelReport report{pattern_.panels[z(p)].name, static_cast<int>(mesh.points().size()) - kBox, 0, 0,
                       std::numbers::pi};
    std::vector<Triangle> triangles;
    for (const Delaunay::Face& f : mesh.faces()) {
      if (!f.inside) continue;
      judge(p, mesh, f, report);
      Triangle t = {number[z(f.v[0])], number[z(f.v[1])], number[z(f.v[2])]};
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      triangles.push_back(t);
    }
    std::sort(triangles.begin(), triangles.end());
    for (const Triangle& t : triangles) {
      for (const int v : t) document_.corners.push_back({v, v});
      document_.face_start.push_back(document_.corners.size());
    }
    made_.mesh.triangles.insert(made_.mesh.triangles.end(), triangles.begin(), triangles.end());
    report.triangles = static_cast<int>(triangles.size());
    made_.panels.push_back(report);
  }

  // Of the last panel: where its vertices are, turned about its middle so that the grain points up or, which
  // is the same to a fabric, down.
  void add_texture(const std::optional<Vec2>& grain) {
    const auto begin = made_.mesh.positions.begin() + first_;
    Eigen::AlignedBox2d box;
    std::for_each(begin, made_.mesh.positions.end(), [&](const Vec3& x) { box.extend(Vec2(x.head<2>())); });
    const Vec2 middle = box.center();
    Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
    if (grain) {
      const Vec2 g = (grain->y() < 0 ? -1 : 1) * grain->normalized();
      turn << g.y(), -g.x(), g.x(), g.y();
    }
    for (auto x = begin; x != made_.mesh.positions.end(); ++x) {
      const Vec2 place = x->head<2>();
      document_.texcoords.push_back(written(grain ? Vec2(middle + turn * (place - middle)) : place));
    }
  }

  static std::string written(const Vec2& x) {
    char text[64];
    char* end = std::to_chars(text, text + 32, x.x()).ptr;
    *end++ = ' ';
    end = std::to_chars(end, text + sizeof text, x.y()).ptr;
    return {text, end};
  }

  void judge(int p, const Delaunay& mesh, const Delaunay::Face& f, PanelReport& report) {
    const auto at = [&](int i) -> const Vec2& { return mesh.points()[z(f.v[z(i)])]; };
    double smallest = std::numbers::pi;
    for (int i = 0; i < 3; ++i) {
      const Vec2 u = at((i + 1) % 3) - at(i), w = at((i + 2) % 3) - at(i);
      smallest = std::min(smallest, std::atan2(u.x() * w.y() - u.y() * w.x(), u.dot(w)));
      made_.longest_edge = std::max(made_.longest_edge, u.norm());
      if (i == 0) report.area += (u.x() * w.y() - u.y() * w.x()) / 2;
    }
    report.smallest_angle = std::min(report.smallest_angle, smallest);
    made_.smallest_angle = std::min(made_.smallest_angle, smallest);
    if (at_sharp_corner(sides_, mesh, p, f)) return;
    made_.smallest_angle_elsewhere = std::min(made_.smallest_angle_elsewhere, smallest);
    if (smallest < options_.min_angle * (1 - 1e-12)) ++made_.below;
  }

  std::vector<int> vertices_of(int r) const {
    std::vector<const Subsegment*> pieces;
    for (const Subsegment& piece : refined_.pieces)
      if (piece.run == r) pieces.push_back(&piece);
    std::sort(pieces.begin(), pieces.end(),
              [](const Subsegment* a, const Subsegment* b) { return a->f0 < b->f0; });
    const std::vector<int>& number = numbers_[z(sides_.runs[z(r)].panel)];
    std::vector<int> vertices = {number[z(pieces.front()->a + kBox)]};
    for (const Subsegment* piece : pieces) vertices.push_back(number[z(piece->b + kBox)]);
    return vertices;
  }

  void add_curve(int r) {
    std::string line = "l";
    for (const int v : vertices_of(r)) line += " " + std::to_string(v + 1);
    document_.statements.push_back({document_.face_count(), "g " + sides_.runs[z(r)].name});
    document_.statements.push_back({document_.face_count(), std::move(line)});
  }

  void add_seam(const Seam& seam) {
    SeamReport report{seam.a, seam.b, 0, 0, 0};
    for (std::size_t r = 0; r < sides_.runs.size(); ++r) {
      const ChainRun& run = sides_.runs[r];
      if (run.name == seam.a) report.length_a = run.curve.length();
      if (run.name == seam.b) report.length_b = run.curve.length();
      if (run.name == seam.a) report.pairs = static_cast<int>(vertices_of(static_cast<int>(r)).size());
    }
    made_.seams.push_back(report);
    document_.statements.push_back(
        {document_.face_count(), "# seam " + seam.a + " " + seam.b + (seam.same_way ? " same way" : "")});
  }

  const Pattern& pattern_;
  const Sides& sides_;
  const Refined& refined_;
  const TriangulateOptions& options_;
  PatternMesh made_;
  ObjDocument document_;
  std::vector<std::vector<int>> numbers_;  // of each panel: vertex of its triangulation to vertex of the mesh
  int first_ = 0;
};

}  // namespace

PatternMesh triangulate(const Pattern& pattern, const TriangulateOptions& asked) {
  check_pattern(pattern);
  TriangulateOptions options = asked;
  const double area = total_area(pattern), degrees = options.min_angle * 180 / std::numbers::pi;
  if (!(area > 0)) throw InputError(pattern.where + ": the holes are as large as the panels");
  if (options.edge <= 0) options.edge = two_digits(std::sqrt(area) / 40);
  if (options.tolerance <= 0) options.tolerance = options.edge / 50;
  if (!(degrees >= 0 && degrees <= kSharpestBound)) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "a smallest angle of %.4g deg cannot be promised; ask for 0 to %.4g deg, such as 28 deg",
                  degrees, kSharpestBound);
    throw InputError(text);
  }
  const double estimate =
      4.5 * area / (options.edge * options.edge) + 8 * boundary_length(pattern) / options.edge;
  if (!(estimate <= kMostTriangles)) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "%s: an edge of %.3g mm gives about %.2g triangles, and more than %.2g are refused; use a "
                  "longer edge",
                  pattern.where.c_str(), 1000 * options.edge, estimate, kMostTriangles);
    throw InputError(text);
  }
  Sides sides = cut_sides(pattern, options.edge, options.tolerance, options.min_angle);
  check_pieces(pattern, sides, options.tolerance);
  const long most = static_cast<long>(4 * estimate) + 20 * static_cast<long>(sides.pieces.size()) + 100000;
  const Refined refined = refine(pattern, sides, options.edge, options.min_angle, most);
  return Assembler(pattern, sides, refined, options).assemble();
}

}  // namespace drape
