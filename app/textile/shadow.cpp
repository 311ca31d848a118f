#include "app/textile/shadow.h"

#include <algorithm>
#include <cmath>

namespace drape::app {
namespace {

constexpr int kCells = 1440;  // of the raster, along a side
constexpr int kDirections = 720;
constexpr double kTurn = 2 * 3.14159265358979323846;

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

Shadow::Shadow(double plate_radius, double reach)
    : cells_(kCells),
      cell_(2 * reach / kCells),
      reach_(reach),
      plate_radius_(plate_radius),
      dark_(static_cast<std::size_t>(kCells) * kCells, 0) {
  for (int j = 0; j < cells_; ++j)
    for (int i = 0; i < cells_; ++i) {
      const Vec2 at((i + 0.5) * cell_ - reach_, (j + 0.5) * cell_ - reach_);
      if (at.norm() < plate_radius) dark_[static_cast<std::size_t>(j) * kCells + i] = 1;
    }
}

void Shadow::add(const std::vector<Triangle>& triangles, const std::vector<Vec3>& positions) {
  for (const Triangle& triangle : triangles) {
    std::array<Vec2, 3> p;  // in cells
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& x = positions[static_cast<std::size_t>(triangle[k])];
      p[k] = Vec2((x.x() + reach_) / cell_ - 0.5, (x.z() + reach_) / cell_ - 0.5);
    }
    const Vec2 low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    const double turn = cross(p[1] - p[0], p[2] - p[0]) < 0 ? -1 : 1;
    const int first_j = std::max(0, static_cast<int>(std::ceil(low.y()))),
              last_j = std::min(cells_ - 1, static_cast<int>(std::floor(high.y()))),
              first_i = std::max(0, static_cast<int>(std::ceil(low.x()))),
              last_i = std::min(cells_ - 1, static_cast<int>(std::floor(high.x())));
    for (int j = first_j; j <= last_j; ++j)
      for (int i = first_i; i <= last_i; ++i) {
        const Vec2 at(i, j);
        bool inside = true;
        for (std::size_t k = 0; k < 3 && inside; ++k)
          inside = turn * cross(p[(k + 1) % 3] - p[k], at - p[k]) >= 0;
        if (inside) dark_[static_cast<std::size_t>(j) * kCells + i] = 1;
      }
  }
}

double Shadow::area() const {
  return static_cast<double>(std::count(dark_.begin(), dark_.end(), 1)) * cell_ * cell_;
}

std::vector<double> Shadow::outline() const {
  std::vector<double> radii(kDirections, 0);
  for (int k = 0; k < kDirections; ++k) {
    const Vec2 along(std::cos(kTurn * k / kDirections), std::sin(kTurn * k / kDirections));
    for (double r = reach_; r > 0 && radii[static_cast<std::size_t>(k)] == 0; r -= 0.5 * cell_) {
      const int i = static_cast<int>(std::floor((r * along.x() + reach_) / cell_)),
                j = static_cast<int>(std::floor((r * along.y() + reach_) / cell_));
      if (i >= 0 && j >= 0 && i < cells_ && j < cells_ && dark_[static_cast<std::size_t>(j) * kCells + i])
        radii[static_cast<std::size_t>(k)] = r;
    }
  }
  return radii;
}

drawing::Image Shadow::picture(double specimen_radius, std::optional<double> measured) const {
  const double plate = plate_radius_ * plate_radius_;
  const double as_measured =
      std::sqrt(plate + measured.value_or(0) * (specimen_radius * specimen_radius - plate));
  constexpr int size = 480, sample = kCells / size;
  drawing::Image image(size, size, {255, 255, 255});
  const double cell = sample * cell_;
  for (int j = 0; j < size; ++j)
    for (int i = 0; i < size; ++i) {
      int covered = 0;
      for (int b = 0; b < sample; ++b)
        for (int a = 0; a < sample; ++a)
          covered += dark_[static_cast<std::size_t>(j * sample + b) * kCells + i * sample + a];
      const double radius = Vec2((i + 0.5) * cell - reach_, (j + 0.5) * cell - reach_).norm();
      const double dark = covered / static_cast<double>(sample * sample);
      const double shade = radius < plate_radius_ ? 90 : 150;
      auto grey = static_cast<std::uint8_t>(std::lround(255 - dark * (255 - shade)));
      if (std::abs(radius - specimen_radius) < 0.6 * cell) grey = 0;  // the specimen before it was draped
      image.at(i, j) = {grey, grey, grey};
      if (measured && std::abs(radius - as_measured) < cell) image.at(i, j) = {200, 30, 30};
    }
  return image;
}

Waves waves(const std::vector<double>& outline, double least) {
  // Begins at the lowest place. A maximum has been passed as soon as the outline has fallen by `least` below
  // it.
  const auto lowest = std::min_element(outline.begin(), outline.end()) - outline.begin();
  const auto count = static_cast<std::ptrdiff_t>(outline.size());
  Waves found{0, 0};
  double low = outline[static_cast<std::size_t>(lowest)], high = low, rise = 0;
  bool rising = true;
  for (std::ptrdiff_t k = 1; k <= count; ++k) {
    const double r = outline[static_cast<std::size_t>((lowest + k) % count)];
    if (rising) {
      high = std::max(high, r);
      if (high - r <= least) continue;
      ++found.nodes;
      rise += high - low;
      rising = false;
      low = r;
    } else {
      low = std::min(low, r);
      if (r - low <= least) continue;
      rising = true;
      high = r;
    }
  }
  found.amplitude = found.nodes > 0 ? 0.5 * rise / found.nodes : 0;
  return found;
}

}  // namespace drape::app
