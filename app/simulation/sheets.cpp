#include "app/simulation/sheets.h"

#include <algorithm>

#include "mesh/triangles/topology.h"

namespace drape::app {

Sheets::Sheets(const std::vector<Cloth>& cloths, const VecX& x) {
  for (const Cloth& cloth : cloths)
    if (!cloth.rope) add(cloth.name, cloth.mesh.triangles, cloth.embedding.positions(x));
  for (const Cloth& cloth : cloths)
    if (cloth.rope) add_rope(cloth.name, cloth.embedding.positions(x));
}

void Sheets::add(const std::string& name, const std::vector<Triangle>& triangles,
                 const std::vector<Vec3>& positions) {
  parts_.push_back({name, static_cast<int>(triangles_.size())});
  const int first = static_cast<int>(positions_.size());
  for (const Triangle& t : triangles) triangles_.push_back({first + t[0], first + t[1], first + t[2]});
  positions_.insert(positions_.end(), positions.begin(), positions.end());
}

void Sheets::add_rope(const std::string& name, const std::vector<Vec3>& points) {
  std::vector<Triangle> segments;
  for (int k = 1; k < static_cast<int>(points.size()); ++k) segments.push_back({k - 1, k, k});
  add(name, segments, points);
  segments_ += static_cast<int>(segments.size());
}

std::vector<CrossingContour> Sheets::contours() const {
  const std::vector<int> number = welded(positions_);
  std::vector<Triangle> triangles = triangles_;
  for (Triangle& t : triangles)
    for (int& v : t) v = number[v];
  return crossing_contours(positions_, triangles, segments_);
}

std::size_t Sheets::part_of(int triangle) const {
  const auto after = std::upper_bound(parts_.begin(), parts_.end(), triangle,
                                      [](int t, const Part& part) { return t < part.first_triangle; });
  return static_cast<std::size_t>(after - parts_.begin()) - 1;
}

const std::string& Sheets::name_of(int triangle) const { return parts_[part_of(triangle)].name; }

std::vector<std::vector<int>> Sheets::crossing_triangles() const {
  std::vector<std::vector<int>> found(parts_.size());
  for (const CrossingContour& contour : contours())
    for (const TrianglePair& pair : contour.pairs)
      for (const int t : {pair.first, pair.second}) {
        const std::size_t part = part_of(t);
        found[part].push_back(t - parts_[part].first_triangle);
      }
  for (std::vector<int>& triangles : found) {
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  }
  return found;
}

}  // namespace drape::app
