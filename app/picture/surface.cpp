#include "app/picture/surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/triangles/normals.h"

namespace drape::app::drawing {
namespace {

constexpr double cloth_crease = 80, body_crease = 40;       // degrees
constexpr double ground_begins = 0.55, ground_ends = 1.15;  // to fade, of the scene's size
constexpr float line_share = 0.5F;                          // of a triangle's edge over its colour
constexpr double line_width = 0.8;                          // pixels, half of it in each triangle
const Light line_light = light({40, 40, 45});

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

Surface::Surface(const Still& still, const Look& look) : still_(still), look_(look) {
  for (const StillPart& part : still.parts) {
    const Light own = part.body ? light(body_colour) : Light(0.97F * light(cloth_colour(part.cloth)) + 0.03F);
    pieces_.push_back({static_cast<int>(triangles_.size()), &part, own,
                       part.body ? own : Light(0.86F * own + 0.07F), light(body_mark)});
    const auto normals =
        corner_normals(part.positions, *part.triangles, part.body ? body_crease : cloth_crease);
    const int shift = static_cast<int>(positions_.size());
    for (const Triangle& t : *part.triangles)
      triangles_.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    positions_.insert(positions_.end(), part.positions.begin(), part.positions.end());
    normals_.insert(normals_.end(), normals.begin(), normals.end());
    piece_of_.resize(triangles_.size(), static_cast<int>(pieces_.size()) - 1);
  }
  if (!triangles_.empty()) tree_.emplace(positions_, triangles_, look.middle, TriangleTree::Quality::quick);
}

Light Surface::colour(const Piece& piece, int triangle, const Vec3& weights, bool front) const {
  const std::vector<double>& values = piece.part->values;
  const Triangle& t = (*piece.part->triangles)[triangle - piece.begin];
  if (look_.scale && !piece.part->crossing.empty())
    return light(colour_of(*look_.scale, piece.part->crossing[triangle - piece.begin]));
  if (values.empty() || !look_.scale) {
    if (piece.part->sectors) {
      const std::vector<Vec3>& x = *piece.part->sectors;
      const Vec3 out = weights[0] * x[t[0]] + weights[1] * x[t[1]] + weights[2] * x[t[2]];
      const double sector = std::floor(std::atan2(out.z(), out.x()) / (std::numbers::pi / 4));
      if (std::lround(sector) % 2 == 0) return piece.mark;
    }
    return front ? piece.front : piece.back;
  }
  if (look_.scale->field == Field::contact) {  // no vertex touches by half
    Eigen::Index nearest = 0;
    weights.maxCoeff(&nearest);
    return light(colour_of(*look_.scale, values[t[nearest]]));
  }
  return light(colour_of(*look_.scale,
                         weights[0] * values[t[0]] + weights[1] * values[t[1]] + weights[2] * values[t[2]]));
}

void Surface::meet(Seen& seen, const Vec3& direction, const TriangleTree::Hit& hit, double slope) const {
  const Triangle& t = triangles_[hit.triangle];
  const Piece& piece = pieces_[piece_of_[hit.triangle]];
  const CornerNormals& normals = normals_[hit.triangle];
  const Vec3 &a = positions_[t[0]], &b = positions_[t[1]], &c = positions_[t[2]];
  const Vec3 twice_area = twice_area_normal(a, b, c);
  const bool front = twice_area.dot(direction) < 0;
  const double side = front ? 1 : -1;
  seen.part = piece_of_[hit.triangle];
  seen.distance = hit.distance;
  seen.point = hit.weights[0] * a + hit.weights[1] * b + hit.weights[2] * c;

  Vec3 normal = Vec3::Zero();
  seen.from = seen.point;
  for (int k = 0; k < 3; ++k) {
    const Vec3 n = side * normals[k].cast<double>();
    normal += hit.weights[k] * n;
    // Out of the flat triangle onto the round surface that its normals tell of: else its own neighbours would
    // shade it along their edges [Hanika 2021, Hacking the shadow terminator].
    const double below = (seen.point - positions_[t[k]]).dot(n);
    seen.from -= hit.weights[k] * std::min(0.0, below) * n;
  }
  const double towards = normal.dot(direction);
  if (towards > 0) normal -= 1.001 * towards * direction;  // at an outline: no farther than across the view
  if (!(normal.squaredNorm() > 0)) normal = -direction;
  normal.normalize();
  seen.normal = normal.cast<float>();
  seen.from += 2e-4 * look_.size * side * twice_area.stableNormalized();
  seen.colour = colour(piece, hit.triangle, hit.weights, front);
  if (!look_.edges) return;
  const double pixel = slope * hit.distance;  // m
  for (int k = 0; k < 3; ++k) {
    const Vec3 edge = positions_[t[(k + 2) % 3]] - positions_[t[(k + 1) % 3]];
    if (hit.weights[k] * twice_area.norm() < 0.5 * line_width * pixel * edge.norm()) {
      seen.colour = (1 - line_share) * seen.colour + line_share * line_light;
      return;
    }
  }
}

void Surface::meet_planes(Seen& seen, const Vec3& eye, const Vec3& direction) const {
  for (std::size_t k = 0; k < still_.planes.size(); ++k) {
    const auto& [name, point, normal] = still_.planes[k];
    const double towards = -direction.dot(normal), height = (eye - point).dot(normal);
    if (!(towards > 0 && height > 0) || (seen.part != -1 && height / towards >= seen.distance)) continue;
    const Vec3 met = eye + height / towards * direction;
    const Vec3 below = look_.middle - (look_.middle - point).dot(normal) * normal;
    const double fade =
        1 - smooth_step(ground_begins * look_.size, ground_ends * look_.size, (met - below).norm());
    if (fade <= 0) continue;
    seen.part = -2 - static_cast<int>(k);
    seen.distance = height / towards;
    seen.point = met;
    seen.from = met + 1e-4 * look_.size * normal;
    seen.normal = normal.cast<float>();
    seen.fade = static_cast<float>(fade);
  }
}

Seen Surface::seen(const Vec3& eye, const Vec3& direction, double slope) const {
  Seen seen;
  if (tree_)
    if (const TriangleTree::Hit hit = tree_->first_hit(eye, direction); hit.hit())
      meet(seen, direction, hit, slope);
  meet_planes(seen, eye, direction);
  return seen;
}

bool Surface::covered(const Vec3& from, const Vec3& direction, double distance) const {
  for (const auto& [name, point, normal] : still_.planes) {
    const double towards = -direction.dot(normal), height = (from - point).dot(normal);
    if (height >= 0 && towards > 0 && height < distance * towards) return true;
  }
  return blocked(from, direction, distance);
}

}  // namespace drape::app::drawing
