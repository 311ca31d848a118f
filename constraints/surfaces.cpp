#include "constraints/surfaces.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "mesh/base/parallel.h"
#include "mesh/distance/triangle_crossings.h"

namespace drape::internal {
namespace {

// Springs keep edges and corners off by this share of the margin, at which vertices rest: so what lies flat
// touches no spring, and what lies over an edge that is not sharp is borne by the faces [face_contact.h].
constexpr double share_of_margin = 0.25;
constexpr double inside = 1e-9;    // m: less is rounding
constexpr int steps_between = 10;  // after which is looked again who is pinched

}  // namespace

bool Surfaces::begin_step(const std::vector<MovingBody>& bodies, const StepMotion& cloth) {
  const int n = static_cast<int>(cloth.x.size() / 3);
  const bool other = n != cloth_ || static_cast<int>(bodies.size()) != bodies_;
  if (other) {
    cloth_ = n;
    set(bodies);
  }
  const Eigen::Index own = cloth.x.size(), all = own + 3 * static_cast<Eigen::Index>(body_.size());
  step_.h = cloth.h;
  step_.foresight = cloth.foresight;
  step_.x.resize(all);
  step_.v.resize(all);
  step_.x.head(own) = cloth.x;
  step_.v.head(own) = cloth.v;
  step_.masses = cloth.masses;
  step_.masses.resize(static_cast<std::size_t>(all / 3), 0);
  step_.held = cloth.held;
  step_.held.resize(static_cast<std::size_t>(all / 3), 1);
  place(bodies, true);
  follow(bodies);
  return other;
}

void Surfaces::set(const std::vector<MovingBody>& bodies) {
  bodies_ = static_cast<int>(bodies.size());
  surfaces_.clear();
  faces_.clear();
  body_.clear();
  still_.clear();
  placed_ = false;
  thickest_ = 0;
  for (const MovingBody& body : bodies) {
    if (!body.meets_triangles()) continue;
    const TriangleMesh* const skin = body.skin();
    const int first = cloth_ + static_cast<int>(body_.size());
    const Obstacle& obstacle = body.obstacle();
    const bool still = !obstacle.motion.moves() && !obstacle.rigid && !deforming(obstacle.shape);
    surfaces_.push_back({body.number(), first, still});
    body_.resize(body_.size() + skin->positions.size(), body.number());
    still_.resize(body_.size(), still);
    const double thickness = share_of_margin * body.obstacle().margin;
    thickest_ = std::max(thickest_, thickness);
    for (const Triangle& t : skin->triangles)
      faces_.push_back({{first + t[0], first + t[1], first + t[2]},
                        thickness,
                        body.obstacle().friction.kinetic,
                        -1 - body.number()});
  }
  pinched_.assign(static_cast<std::size_t>(cloth_), 0);
  count_ = 0;
}

void Surfaces::place(const std::vector<MovingBody>& bodies, bool start) {
  for (const auto& [number, first, still] : surfaces_) {
    if (still && placed_) continue;
    const MovingBody& body = bodies[number];
    const int count = body.skin()->vertex_count(), at = first;
    for_chunks(count, [&](int begin, int end) {
      for (int v = begin; v < end; ++v) {
        if (start)
          step_.x.segment<3>(3 * (at + v)) = body.vertex_at_start(v);
        else
          ends_.segment<3>(3 * (at - cloth_ + v)) = body.vertex_at_end(v);
      }
    });
  }
}

void Surfaces::follow(const std::vector<MovingBody>& bodies) {
  const auto size = 3 * static_cast<Eigen::Index>(body_.size());
  ends_.resize(size);
  place(bodies, false);
  placed_ = true;
  step_.v.tail(size) = (ends_ - step_.x.tail(size)) / step_.h;
}

const VecX& Surfaces::with(const VecX& x_new) {
  x_new_.resize(step_.x.size());
  x_new_.head(x_new.size()) = x_new;
  x_new_.tail(ends_.size()) = ends_;
  return x_new_;
}

void Surfaces::pinch(int particle) {
  count_ += pinched_[particle] == 0;
  pinched_[particle] = 1;
}

void Surfaces::look(const std::vector<MovingBody>& bodies, const std::vector<SelfFace>& cloth) {
  pinched_.assign(pinched_.size(), any() ? 1 : 0);
  count_ = any() ? cloth_ : 0;
  since_ = steps_between;
  look_again(bodies, cloth);
}

void Surfaces::look_again(const std::vector<MovingBody>& bodies, const std::vector<SelfFace>& cloth) {
  if (count_ == 0 || ++since_ < steps_between) return;
  since_ = 0;
  std::vector<Vec3> places(static_cast<std::size_t>(step_.x.size() / 3));
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i] = step_.x.segment<3>(3 * static_cast<Eigen::Index>(i));
  std::vector<char> in(places.size(), 0);
  for_chunks<Work::heavy>(cloth_, [&](int begin, int end) {
    for (int i = begin; i < end; ++i)
      for (const auto& [number, first, still] : surfaces_)
        if (pinched_[i] != 0 && bodies[number].inside_skin(places[i], inside)) in[i] = 1;
  });
  std::vector<Triangle> triangles;
  for (const SelfFace& face : cloth)
    if (std::any_of(face.particles.begin(), face.particles.end(), [&](int i) { return pinched_[i] != 0; }))
      triangles.push_back(face.particles);
  const int of_cloth = static_cast<int>(triangles.size());
  Eigen::AlignedBox3d box;
  for (const Triangle& t : triangles)
    for (int i : t) box.extend(places[i]);
  for (const SelfFace& face : faces_) {
    Eigen::AlignedBox3d own;
    for (int i : face.particles) own.extend(places[i]);
    if (box.intersects(own)) triangles.push_back(face.particles);
  }
  for (const CrossingContour& contour : contours_between(places, triangles, of_cloth))
    for (const TrianglePair& pair : contour.pairs)
      for (int i : triangles[pair.first]) in[i] = 1;
  pinched_.assign(pinched_.size(), 0);
  for (int k = 0; k < of_cloth; ++k)
    if (std::any_of(triangles[k].begin(), triangles[k].end(), [&](int i) { return in[i] != 0; }))
      for (int i : triangles[k]) pinched_[i] = 1;
  count_ = static_cast<int>(std::count(pinched_.begin(), pinched_.end(), 1));
}

}  // namespace drape::internal
