#include "app/textile/specimen.h"

#include <algorithm>
#include <cmath>

#include "mesh/pattern/pattern.h"

namespace drape::app {
namespace {

// The distance of the two columns or rings of vertices in a clamp: about that of neighbours in the mesh.
double clamp_width(double edge) { return 0.8 * edge; }

TriangleMesh mesh_of(Panel panel, double edge) {
  panel.name = "specimen";
  panel.outline.names.resize(panel.outline.segments.size());
  for (Chain& hole : panel.holes) hole.names.resize(hole.segments.size());
  Pattern pattern;
  pattern.panels = {std::move(panel)};
  TriangleMesh mesh = triangulate(pattern, {.edge = edge}).mesh;
  for (Vec3& x : mesh.positions) x = Vec3(x.x(), 0, x.y());
  return mesh;
}

TriangleMesh rectangle(double from, double to, double width, double edge) {
  const Vec2 a(from, -0.5 * width), b(to, -0.5 * width), c(to, 0.5 * width), d(from, 0.5 * width);
  Panel panel;
  panel.outline.segments = {line_segment(a, b), line_segment(b, c), line_segment(c, d), line_segment(d, a)};
  return mesh_of(std::move(panel), edge);
}

Chain circle(double radius) {
  const Vec2 left(-radius, 0), right(radius, 0);
  Chain loop;
  loop.segments = {arc_segment(right, left, radius, radius, 0, false, true),
                   arc_segment(left, right, radius, radius, 0, false, true)};
  return loop;
}

template <class Test>
std::vector<int> vertices_where(const TriangleMesh& mesh, const Test& test) {
  std::vector<int> found;
  for (int i = 0; i < mesh.vertex_count(); ++i)
    if (test(mesh.positions[static_cast<std::size_t>(i)])) found.push_back(i);
  return found;
}

// Adds a copy of a chain of vertices, moved by `place`, and the triangles between the chain and its copy.
// Holds both.
template <class Place>
void clamp(Specimen& specimen, const std::vector<int>& chain, bool closed, const Place& place) {
  TriangleMesh& mesh = specimen.mesh;
  const int first = mesh.vertex_count(), count = static_cast<int>(chain.size());
  for (int i : chain) mesh.positions.push_back(place(mesh.positions[static_cast<std::size_t>(i)]));
  for (int k = 0; k + (closed ? 0 : 1) < count; ++k) {
    const int next = (k + 1) % count;
    const int a = chain[static_cast<std::size_t>(k)], b = chain[static_cast<std::size_t>(next)];
    mesh.triangles.push_back({a, first + k, first + next});
    mesh.triangles.push_back({a, first + next, b});
  }
  specimen.held = chain;
  for (int k = 0; k < count; ++k) specimen.held.push_back(first + k);
}

}  // namespace

Specimen overhanging_strip(double length, double width, double edge) {
  const double apart = clamp_width(edge), begin = 0.5 * apart;
  Specimen specimen{rectangle(begin, length, width, edge), {}, {}};
  const auto& x = specimen.mesh.positions;
  std::vector<int> column =
      vertices_where(specimen.mesh, [&](const Vec3& p) { return p.x() < begin + 1e-9 * length; });
  std::sort(column.begin(), column.end(), [&](int i, int j) {
    return x[static_cast<std::size_t>(i)].z() < x[static_cast<std::size_t>(j)].z();
  });
  clamp(specimen, column, false, [&](const Vec3& p) { return Vec3(p.x() - apart, 0, p.z()); });
  return specimen;
}

Specimen strip_between_clamps(double length, double width, double edge) {
  Specimen specimen{rectangle(0, length, width, edge), {}, {}};
  specimen.held = vertices_where(specimen.mesh, [&](const Vec3& p) { return p.x() < 1e-9 * length; });
  specimen.moved = vertices_where(specimen.mesh, [&](const Vec3& p) { return p.x() > (1 - 1e-9) * length; });
  return specimen;
}

Specimen hinged_frame(double side, double edge) {
  Specimen frame = strip_between_clamps(side, side, edge);
  const double inner = 0.5 * side * (1 - 1e-9), first = 1e-9 * side, last = (1 - 1e-9) * side;
  for (int i : vertices_where(frame.mesh, [&](const Vec3& p) {
         return std::abs(p.z()) > inner && p.x() > first && p.x() < last;
       }))
    frame.held.push_back(i);
  return frame;
}

Specimen disc_on_plate(double radius, double plate_radius, double edge) {
  const double apart = clamp_width(edge), inner = plate_radius + 0.5 * apart;
  Panel panel;
  panel.outline = circle(radius);
  panel.holes = {circle(inner)};
  Specimen specimen{mesh_of(std::move(panel), edge), {}, {}};
  const auto& x = specimen.mesh.positions;
  std::vector<int> ring =
      vertices_where(specimen.mesh, [&](const Vec3& p) { return p.norm() < inner * (1 + 1e-9); });
  const auto angle = [&](int i) {
    const Vec3& p = x[static_cast<std::size_t>(i)];
    return std::atan2(p.z(), p.x());
  };
  std::sort(ring.begin(), ring.end(), [&](int i, int j) { return angle(i) < angle(j); });
  clamp(specimen, ring, true, [&](const Vec3& p) { return Vec3(p * (1 - apart / inner)); });
  return specimen;
}

}  // namespace drape::app
