#include "mesh/triangles/line.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace drape {
namespace {

// The unit direction of the line at each point; where there is none, that of the point before.
std::vector<Vec3> directions_of(const std::vector<Vec3>& line) {
  std::vector<Vec3> directions(line.size(), Vec3::Zero());
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Vec3 d = (line[k] - line[k - 1]).stableNormalized();
    directions[k - 1] += d;
    directions[k] += d;
  }
  Vec3 last = Vec3::UnitX();
  for (const Vec3& d : directions)
    if (d.norm() > 1e-9) {
      last = d.normalized();
      break;
    }
  for (Vec3& d : directions) last = d = d.norm() > 1e-9 ? d.normalized() : last;
  return directions;
}

Vec3 any_across(const Vec3& d) {
  Eigen::Index least = 0;
  d.cwiseAbs().minCoeff(&least);
  return d.cross(Vec3::Unit(least)).normalized();
}

}  // namespace

double length_of(const std::vector<Vec3>& line) {
  double length = 0;
  for (std::size_t k = 1; k < line.size(); ++k) length += (line[k] - line[k - 1]).norm();
  return length;
}

std::vector<Vec3> evenly_divided(const std::vector<Vec3>& line, int parts) {
  const double length = length_of(line);
  std::vector<Vec3> points = {line.front()};
  double before = 0;  // length of the line up to point k - 1
  std::size_t k = 1;
  for (int n = 1; n < parts; ++n) {
    const double at = length * n / parts;
    while (k + 1 < line.size() && before + (line[k] - line[k - 1]).norm() < at) {
      before += (line[k] - line[k - 1]).norm();
      ++k;
    }
    const double segment = (line[k] - line[k - 1]).norm();
    points.push_back(line[k - 1] +
                     (segment > 0 ? std::min(1.0, (at - before) / segment) : 0) * (line[k] - line[k - 1]));
  }
  points.push_back(line.back());
  return points;
}

std::vector<Vec3> tube_positions(const std::vector<Vec3>& line, double radius, int sides) {
  std::vector<Vec3> positions;
  if (line.empty()) return positions;
  positions.reserve(line.size() * static_cast<std::size_t>(sides));
  const std::vector<Vec3> directions = directions_of(line);
  Vec3 across = any_across(directions.front());
  for (std::size_t k = 0; k < line.size(); ++k) {
    const Vec3& d = directions[k];
    if (k > 0) across = Eigen::Quaterniond::FromTwoVectors(directions[k - 1], d) * across;
    across = (across - d.dot(across) * d).normalized();  // free of round-off
    const Vec3 other = d.cross(across);
    for (int s = 0; s < sides; ++s) {
      const double angle = 2 * std::numbers::pi * s / sides;
      positions.push_back(line[k] + radius * (std::cos(angle) * across + std::sin(angle) * other));
    }
  }
  return positions;
}

std::vector<Triangle> tube_triangles(int points, int sides) {
  std::vector<Triangle> triangles;
  for (int k = 0; k + 1 < points; ++k)
    for (int s = 0; s < sides; ++s) {
      const int a = k * sides + s, b = k * sides + (s + 1) % sides;
      triangles.push_back({a, b, a + sides});
      triangles.push_back({b, b + sides, a + sides});
    }
  const int last = (points - 1) * sides;
  for (int s = 1; points > 1 && s + 1 < sides; ++s) {
    triangles.push_back({0, s + 1, s});
    triangles.push_back({last, last + s, last + s + 1});
  }
  return triangles;
}

}  // namespace drape
