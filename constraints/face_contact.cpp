#include "constraints/face_contact.h"

#include <algorithm>

#include "mesh/base/parallel.h"
#include "mesh/distance/closest_on_triangle.h"
#include "mesh/triangles/normals.h"

namespace drape {
namespace {

constexpr double slow = 1e-3;  // m/s
// A contact that has changed this often within a step changes again only when no other does, and alone.
constexpr int most_changes = 3;
constexpr int most_steps = 24;  // steps of the search for the lowest point
constexpr double fine = 0.01;   // where the search ends, as a share of the size of the triangle
const Vec3 middle = Vec3::Constant(1.0 / 3);

struct Corners {
  Vec3 a, b, c;
  Corners(const ClothFace& face, const VecX& x)
      : a(x.segment<3>(3 * face.particles[0])),
        b(x.segment<3>(3 * face.particles[1])),
        c(x.segment<3>(3 * face.particles[2])) {}
  Vec3 middle() const { return (a + b + c) / 3; }
  double radius() const {
    const Vec3 m = middle();
    return std::sqrt(std::max({(a - m).squaredNorm(), (b - m).squaredNorm(), (c - m).squaredNorm()}));
  }
};

struct Lowest {
  Vec3 point;
  Vec3 weights;
  double distance;
};

// Finds the point of the triangle that is nearest to the body. The search starts from the middle of the
// triangle or from the likely point, whichever is nearer. Its first step goes towards the closest point of
// the surface (alternating projections, which find a corner or a rim at once) [Cheney & Goldstein 1959]. The
// further steps go down the slope of the distance along the triangle, halved where they do not come nearer:
// on a surface as smooth as the cloth that lies on it, projections alone would creep.
template <class Distance>
Lowest lowest_point(const Corners& t, const Distance& distance, double enough, const Vec3& likely) {
  Vec3 p = t.middle();
  SurfacePoint here = distance(p);
  Vec3 weights = middle;
  const double size = t.radius();
  if (here.distance - size > enough) return {p, weights, here.distance - size};  // all of it is farther
  if (likely != weights) {
    const Vec3 q = likely[0] * t.a + likely[1] * t.b + likely[2] * t.c;
    if (const SurfacePoint there = distance(q); there.distance < here.distance) {
      p = q;
      here = there;
      weights = likely;
    }
  }
  const Vec3 upright = twice_area_normal(t.a, t.b, t.c).stableNormalized();
  double step = size;
  for (int i = 0; i < most_steps && step > fine * size; ++i) {
    const Vec3 along = here.normal - upright.dot(here.normal) * upright;
    const double slope = along.norm();
    if (slope < fine) break;
    const bool first = i == 0 && here.distance > 0;
    const Vec3 wanted = first ? Vec3(p - here.distance * here.normal) : Vec3(p - step / slope * along);
    const auto [q, feature] = closest_on_triangle(wanted, t.a, t.b, t.c);
    if ((q - p).squaredNorm() < fine * fine * size * size) {
      if (first) continue;
      break;  // p is at the rim of the triangle, and the slope leads out of it
    }
    const SurfacePoint there = distance(q);
    if (there.distance < here.distance - 1e-9) {
      weights = weights_on_triangle(q, feature, t.a, t.b, t.c);
      p = q;
      here = there;
    } else if (!first) {
      step /= 2;
    }
  }
  return {p, weights, here.distance};
}

}  // namespace

double FaceContact::rubbing() const { return friction * push / std::max(slip, slow); }

void FaceContacts::add(const std::vector<ClothFace>& faces) {
  faces_.insert(faces_.end(), faces.begin(), faces.end());
  room_.clear();
}

void FaceContacts::renumber(const std::vector<int>& particle_of) {
  for (ClothFace& face : faces_)
    for (int& i : face.particles) i = particle_of[i];
  std::erase_if(faces_, [](const ClothFace& face) {
    const auto& [a, b, c] = face.particles;
    return a == b || b == c || c == a;
  });
  room_.clear();
  touching_.clear();
  last_.clear();
}

void FaceContacts::part(const Parting& parting) {
  for (ClothFace& face : faces_) face.particles = parting.face(face.particles);
  room_.clear();
  touching_.clear();
  last_.clear();
}

void FaceContacts::measure_travel(const MovingBody& body, const VecX& x, const VecX& x_new) {
  travel_.resize(static_cast<std::size_t>(x.size() / 3));
  for_chunks(static_cast<int>(travel_.size()), [&](int begin, int end) {
    for (int i = begin; i < end; ++i) travel_[i] = body.travel(x.segment<3>(3 * i), x_new.segment<3>(3 * i));
  });
}

double FaceContacts::travel(const ClothFace& face) const {
  double most = 0;
  for (int i : face.particles) most = std::max(most, travel_[i]);
  return most;
}

void FaceContacts::begin_step(const std::vector<MovingBody>& bodies, const std::vector<Contact>& contacts,
                              const VecX& x, const VecX& x_new, double recovery) {
  const int n = static_cast<int>(faces_.size());
  if (n == 0 || bodies.empty()) return;
  if (room_.size() != bodies.size() * faces_.size()) {
    room_.assign(bodies.size() * faces_.size(), 0.0);
    likely_.assign(room_.size(), middle);
    found_.resize(static_cast<std::size_t>(chunk_count(n)));
    last_.clear();
  }
  touching_.clear();
  counted_ = false;
  clamped_.assign(static_cast<std::size_t>(x.size() / 3), 0);
  for (const Contact& c : contacts)
    if (c.clamped && !bodies[c.plane[0].obstacle].near_start(x.segment<3>(3 * c.particle)).covered)
      clamped_[c.particle] = 1;  // by two bodies, and not where one overlaps itself
  for (const MovingBody& body : bodies) {
    measure_travel(body, x, x_new);
    parallel_for(chunk_count(n), n < serial_below, [&](int k) {
      auto& found = found_[k];
      found.clear();
      for (int f = k * chunk_size; f < std::min(n, (k + 1) * chunk_size); ++f)
        look(f, body, x, x_new, recovery, found);
    });
    for (const auto& found : found_) touching_.insert(touching_.end(), found.begin(), found.end());
  }
}

void FaceContacts::limit_dampers(const std::vector<double>& masses, double h) {
  for (FaceContact& c : touching_) {
    double mobility = 0;  // 1/kg
    for (std::size_t k = 0; k < 3; ++k)
      if (const double m = masses[c.particles[k]]; m > 0)
        mobility += c.weights[static_cast<int>(k)] * c.weights[static_cast<int>(k)] / m;
    c.most_damper = 0.125 / (h * mobility);
    c.damper = std::min(c.damper, c.most_damper);
  }
}

void FaceContacts::count_impulse(double duration, const VecX& x, const VecX& v) {
  counted_ = true;
  for (FaceContact& c : touching_) c.impulse += duration * c.force_at(x, v);
}

void FaceContacts::take_impulse(double h, const VecX& x_new, const VecX& v_new) {
  if (counted_) return;
  for (FaceContact& c : touching_) c.impulse = h * c.force_at(x_new, v_new);
}

void FaceContacts::look(int f, const MovingBody& body, const VecX& x, const VecX& x_new, double recovery,
                        std::vector<FaceContact>& found) {
  const ClothFace& face = faces_[f];
  const std::size_t entry =
      static_cast<std::size_t>(body.number()) * faces_.size() + static_cast<std::size_t>(f);
  double& room = room_[entry];
  Vec3& likely = likely_[entry];
  const double offset = 0.5 * body.obstacle().margin, reach = offset + travel(face);
  const auto& corners = faces_[f].particles;
  if (room > reach || std::any_of(corners.begin(), corners.end(), [&](int i) { return clamped_[i] != 0; }))
    return;
  const Lowest start = lowest_point(
      Corners(face, x), [&](const Vec3& p) { return body.near_start(p); }, reach, likely);
  likely = start.weights;
  room = start.distance;
  if (room > reach) return;
  const Lowest end = lowest_point(
      Corners(face, x_new), [&](const Vec3& p) { return body.near_end(p); }, offset, likely);
  if (start.distance > offset && end.distance > offset) return;  // the triangle passes by
  const SurfacePoint below = body.at_start(start.point);
  if (below.covered) return;  // its vertices go with the body
  const ContactPlane plane = body.plane(start.point, below, body.carried(start.point));
  const double depth = std::max(plane.gap + body.obstacle().margin - offset, -std::max(recovery, offset));
  FaceContact contact{.body = body.number(),
                      .face = f,
                      .particles = face.particles,
                      .weights = start.weights,
                      .stiffness = face.stiffness,
                      .normal = plane.normal,
                      .place = start.point,
                      .gap = depth - plane.normal.dot(body.carried(start.point)),
                      .body_velocity = plane.body_velocity,
                      .friction = body.obstacle().friction.kinetic};
  contact.active = contact.gap_at(x_new) < 0;
  if (const FaceContact* const old = before(contact.body, f)) {
    contact.active = contact.active || old->active;
    contact.damper = old->rubbing();
  }
  found.push_back(contact);
}

const FaceContact* FaceContacts::before(int body, int face) const {
  const auto at = std::lower_bound(
      last_.begin(), last_.end(), std::pair(body, face),
      [](const FaceContact& c, const std::pair<int, int>& key) { return std::pair(c.body, c.face) < key; });
  return at != last_.end() && at->body == body && at->face == face ? &*at : nullptr;
}

void FaceContacts::follow(const std::vector<MovingBody>& bodies) {
  for (FaceContact& c : touching_) {
    const MovingBody& body = bodies[c.body];
    const Vec3 before = c.body_velocity;
    c.changes = 0;
    c.body_velocity = body.velocity(c.place);
    c.gap -= body.step() * c.normal.dot(c.body_velocity - before);
  }
}

double FaceContacts::imbalance(double h, const VecX& x_new) const {
  double squares = 0;
  for (const FaceContact& c : touching_)
    if (const double gap = c.gap_at(x_new); c.active != (gap < 0))
      squares += std::pow(h * c.stiffness * gap, 2);
  return std::sqrt(squares);
}

bool FaceContacts::react(const VecX& x_new, const VecX& v_new) {
  bool changed = false;
  FaceContact* worst = nullptr;
  for (FaceContact& c : touching_) {
    const double gap = c.gap_at(x_new);
    c.push = std::max(-c.stiffness * gap, 0.0);
    c.slip = c.slip_at(v_new).norm();
    if (c.damper == 0 && c.rubbing() > 0) {
      c.damper = std::min(c.rubbing(), c.most_damper);
      changed = true;
    }
    if (c.active == (gap < 0)) continue;
    if (c.changes == most_changes) {
      if (!worst || c.stiffness * std::abs(gap) > worst->stiffness * std::abs(worst->gap_at(x_new)))
        worst = &c;
      continue;
    }
    c.active = gap < 0;
    ++c.changes;
    changed = true;
  }
  if (!changed && worst) {
    // Friction of other contacts may lift the triangle off the spring that acts, and press it on without one. Between
    // them is a softer spring that just carries it.
    if (worst->active)
      worst->stiffness *= 0.5;
    else
      worst->active = true;
    changed = true;
  }
  return changed;
}

void FaceContacts::end_step(const std::vector<MovingBody>& bodies, const VecX& x, const VecX& x_new) {
  if (faces_.empty()) return;
  last_ = touching_;
  for (const MovingBody& body : bodies) {
    measure_travel(body, x, x_new);
    double* const room = &room_[static_cast<std::size_t>(body.number()) * faces_.size()];
    for_chunks(static_cast<int>(faces_.size()), [&](int begin, int end) {
      for (int f = begin; f < end; ++f) room[f] -= travel(faces_[f]);
    });
  }
}

}  // namespace drape
