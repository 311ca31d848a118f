#include "constraints/face_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "constraints/inertia.h"
#include "constraints/lowest_point.h"
#include "mesh/base/parallel.h"

namespace drape {
namespace {

using internal::FaceCorners;
using internal::Lowest;
using internal::lowest_point;

constexpr double slow = 1e-3;  // m/s
// A damper may rub with this many times mu N, since it is of the N and the slip of the step before.
constexpr double overrubbed = 1.05;
// How often a triangle begins to rub within a step. After that it slides freely for the rest of the step.
constexpr int most_begun = 3;
// A contact that has changed this often within a step changes again only when no other does, and alone.
constexpr int most_changes = 3;
constexpr double apart = 0.1;  // of two points at which a body touches a triangle, as such a share
// A normal that is nearer to the body's own than this cosine says is that of a smooth place, not of a corner
// or a rim.
constexpr double smooth = 0.99;
// A triangle that moves on against the body by more than this share of its size has another lowest point at
// the end.
constexpr double moved = 0.1;
// What a triangle comes to within a step counts as the same side of a body where the normals are nearer than
// this.
constexpr double alike = 0.5;

double half_margin(const MovingBody& body) { return 0.5 * body.obstacle().margin; }

// The least turn of a triangle, and none where it turns over.
Mat3 turn_of(const FaceCorners& now, const FaceCorners& then) {
  const Vec3 from = now.normal(), to = then.normal();
  if (from.dot(to) < alike) return Mat3::Identity();
  return Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

// Where the body touches the triangle at the end of the step as at its start: it turns with the body.
FacePoint carried(const MovingBody& body, const FacePoint& begins) {
  const Vec3& place = begins.place;
  const ContactPlane plane = body.plane(place, body.at_start(place), body.carried(place));
  return {begins.weights, place, body.turned(begins.normal), plane.gap + half_margin(body)};
}

// From where a body that reacts touches the triangle when the step begins, to where it will when the step
// ends. anew: at the lowest point then, where that may be another one; else at the same point. (A body that
// does not react feels no moment, and on corners that cloth hangs over at rest the lowest point at the end
// would be now this, now that.)
FacePoint foresee(const MovingBody& body, const FacePoint& begins, const FaceCorners& now,
                  const FaceCorners& then, bool anew) {
  const double offset = half_margin(body);
  const Vec3 &w = begins.weights, &place = begins.place;
  const SurfacePoint here = body.at_start(place);
  if (begins.normal.dot(body.start().direction_to_world(here.normal)) < smooth) {
    FacePoint corner = carried(body, begins);
    corner.normal = turn_of(now, then) * begins.normal;
    return corner;
  }
  const Vec3 centre = body.reacting()->centre(), shift = then.at(w) - place - (body.carried(centre) - centre);
  if (anew && std::max(shift.norm(), body.travel(place, then.at(w))) > moved * now.radius()) {
    const auto at_end = [&](const Vec3& p) { return body.near_end(p); };
    const Lowest end = lowest_point(then, at_end, offset, w);
    const Vec3& n = end.surface.normal;
    const bool touches = end.surface.distance <= offset && !end.surface.covered;
    if (touches && n.dot(body.turned(begins.normal)) > alike) {
      const Vec3 p = now.at(end.weights);
      return {end.weights, p, n, end.surface.distance - offset - n.dot(end.point - body.carried(p))};
    }
  }
  const ContactPlane plane = body.plane(place, here, then.at(w));
  return {w, place, plane.normal, plane.gap + offset};
}

// Sets push and slip by the motion that was found, and returns the gap [m].
double measure(FaceContact& c, const VecX& x_new, const VecX& v_new) {
  const double gap = c.gap_at(x_new);
  c.push = std::max(-c.stiffness * gap, 0.0);
  c.slip = c.slip_at(v_new).norm();
  return gap;
}

// Makes the damper for what a solve came to: where the triangle did not rub before, and where it rubs harder
// than its law allows. Then it is taken down, by one step of Newton's method for a point that is alone. True
// when it changed.
bool rub(FaceContact& c, const StepMotion& step) {
  const double before = c.damper, most = c.friction * c.push, given = before * c.slip;  // N s/m, N, N
  if (before == 0 && c.rubbing() > 0 && c.begun < most_begun) {
    c.damper = std::min(c.rubbing(), c.most_damper);
    ++c.begun;
  } else if (step.foresight == Foresight::ahead && given > overrubbed * most) {
    const double mobility = step.h * c.mobility(step);  // m/s for 1 N
    c.damper = most / std::max(c.slip + mobility * (given - most), slow);
  }
  return c.damper != before;
}

}  // namespace

double FaceContact::rubbing() const { return friction * push / std::max(slip, slow); }

double FaceContact::wrong_friction(const VecX& x, const VecX& v) const {
  const double given = damper * slip_at(v).norm(), most = friction * stiffness * std::max(-gap_at(x), 0.0);
  return given > overrubbed * most ? given - most : 0;
}

double FaceContact::mobility(const StepMotion& step) const {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const int particle = particles[static_cast<std::size_t>(k)];
    if (!step.is_held(particle)) sum += weights[k] * weights[k] / internal::inertia_met(step, particle);
  }
  return sum;
}

void FaceContacts::add(const std::vector<ClothFace>& faces) {
  faces_.insert(faces_.end(), faces.begin(), faces.end());
  room_.clear();
}

void FaceContacts::renumber(const std::vector<int>& particle_of) {
  std::vector<int> number(faces_.size(), -1);  // by face before
  std::size_t kept = 0;
  for (std::size_t f = 0; f < number.size(); ++f) {
    ClothFace face = faces_[f];
    for (int& i : face.particles) i = particle_of[i];
    const auto& [a, b, c] = face.particles;
    if (a == b || b == c || c == a) continue;
    number[f] = static_cast<int>(kept);
    faces_[kept++] = face;
  }
  faces_.resize(kept);
  room_.clear();
  touching_.clear();
  for (FaceContact& c : last_) c.face = number[c.face];
  std::erase_if(last_, [](const FaceContact& c) { return c.face < 0; });
  for (FaceContact& c : last_) c.particles = faces_[c.face].particles;
}

void FaceContacts::part(const Parting& parting) {
  for (ClothFace& face : faces_) face.particles = parting.face(face.particles);
  room_.clear();
  touching_.clear();
  for (FaceContact& c : last_) c.particles = faces_[c.face].particles;
}

void FaceContacts::measure_travel(const MovingBody& body, const VecX& x, const VecX& x_new) {
  travel_.resize(static_cast<std::size_t>(x.size() / 3));
  for_chunks<Work::heavy>(static_cast<int>(travel_.size()), [&](int begin, int end) {
    for (int i = begin; i < end; ++i) travel_[i] = body.travel(x.segment<3>(3 * i), x_new.segment<3>(3 * i));
  });
}

double FaceContacts::travel(const ClothFace& face) const {
  double most = 0;
  for (int i : face.particles) most = std::max(most, travel_[i]);
  return most;
}

void FaceContacts::begin_step(const std::vector<MovingBody>& bodies, const std::vector<Contact>& contacts,
                              const VecX& x, const VecX& x_new, Foresight foresight, double recovery) {
  foresight_ = foresight;
  const int n = static_cast<int>(faces_.size()), size = heavy_chunk_size(n);
  if (n == 0 || bodies.empty()) return;
  if (room_.size() != bodies.size() * faces_.size()) {
    room_.assign(bodies.size() * faces_.size(), 0.0);
    likely_.assign(room_.size(), internal::middle_weights);
    found_.resize(static_cast<std::size_t>(heavy_chunk_count(n)));
  }
  touching_.clear();
  counted_ = false;
  clamped_.assign(static_cast<std::size_t>(x.size() / 3), 0);
  for (const Contact& c : contacts)
    if (c.clamped && !bodies[c.plane[0].obstacle].near_start(x.segment<3>(3 * c.particle)).covered)
      clamped_[c.particle] = 1;  // between two surfaces, and not where a body overlaps itself
  for (const MovingBody& body : bodies) {
    measure_travel(body, x, x_new);
    parallel_for(heavy_chunk_count(n), n < serial_below(Work::heavy), [&](int k) {
      auto& found = found_[k];
      found.clear();
      for (int f = k * size; f < std::min(n, (k + 1) * size); ++f) look(f, body, x, x_new, recovery, found);
    });
    for (const auto& found : found_) touching_.insert(touching_.end(), found.begin(), found.end());
  }
}

void FaceContacts::limit_dampers(const std::vector<double>& masses, double h) {
  const auto of_one_face = [&](std::size_t a, std::size_t b) {
    return b < touching_.size() && touching_[a].body == touching_[b].body &&
           touching_[a].face == touching_[b].face;
  };
  for (std::size_t i = 0; i < touching_.size(); ++i) {
    FaceContact& c = touching_[i];
    double mobility = 0;  // 1/kg
    for (std::size_t k = 0; k < 3; ++k)
      if (const double m = masses[c.particles[k]]; m > 0)
        mobility += c.weights[static_cast<int>(k)] * c.weights[static_cast<int>(k)] / m;
    const int contacts = of_one_face(i, i + 1) || (i > 0 && of_one_face(i - 1, i)) ? 2 : 1;
    c.most_damper = 0.125 / (contacts * h * mobility);
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
  const double offset = half_margin(body), reach = offset + travel(face);
  const auto& corners = face.particles;
  if (room > reach || std::any_of(corners.begin(), corners.end(), [&](int i) { return clamped_[i] != 0; }))
    return;
  const FaceCorners now(corners, x), then(corners, x_new);
  const auto at_start = [&](const Vec3& p) { return body.near_start(p); };
  const auto at_end = [&](const Vec3& p) { return body.near_end(p); };
  const Lowest start = lowest_point(now, at_start, reach, likely);
  likely = start.weights;
  room = start.surface.distance;
  if (room > reach) return;
  if (room > offset && lowest_point(then, at_end, offset, likely).surface.distance > offset)
    return;                           // the triangle passes by
  if (start.surface.covered) return;  // its vertices go with the body

  // A rim that lies along the triangle touches it at many points, and the lowest is now this one, now that.
  const Before last = before(body.number(), f, start.weights);
  const auto touches_still = [&](const FaceContact* c) {
    if (!c) return false;
    const Vec3 p = c->at(x);
    if ((p - start.point).norm() < apart * now.radius()) return false;
    const SurfacePoint there = at_start(p);
    return !there.covered && there.normal.dot(start.surface.normal) > 0 &&
           (there.distance < offset || at_end(c->at(x_new)).distance < offset);
  };
  const FaceContact* const other = touches_still(last.farthest)  ? last.farthest
                                   : touches_still(last.nearest) ? last.nearest
                                                                 : nullptr;
  const bool ahead = foresight_ == Foresight::ahead && body.reacting();
  const auto touch = [&](const Vec3& weights, const Vec3& place, bool anew, const FaceContact* old) {
    // The second point has the normal of the first where that is one of a corner, between several faces of
    // the body.
    Vec3 normal = start.surface.normal;
    if (ahead && !anew && normal.dot(at_start(start.point).normal) >= smooth) normal = at_start(place).normal;
    const FacePoint begins{weights, place, normal, 0};
    const FacePoint point = ahead ? foresee(body, begins, now, then, anew) : carried(body, begins);
    FaceContact contact = make(f, body, point, recovery, old ? old : last.nearest);
    contact.active = contact.gap_at(x_new) < 0 || (old && old->active);
    if (old) contact.damper = old->rubbing();
    found.push_back(contact);
  };
  touch(start.weights, start.point, true, last.nearest != other ? last.nearest : nullptr);
  if (other) touch(other->weights, other->at(x), false, other);
}

FaceContact FaceContacts::make(int f, const MovingBody& body, const FacePoint& point, double recovery,
                               const FaceContact* old) const {
  const double most_sunk = old ? old->sunk - recovery : begins_ ? -point.gap : 0.0;
  const double sunk = std::max(std::min(most_sunk, -point.gap), 0.0);
  const double gap = std::max(point.gap + sunk, -std::max(recovery, half_margin(body)));
  return {.body = body.number(),
          .face = f,
          .particles = faces_[f].particles,
          .weights = point.weights,
          .stiffness = faces_[f].stiffness,
          .normal = point.normal,
          .place = point.place,
          .gap = gap - point.normal.dot(body.carried(point.place)),
          .sunk = sunk,
          .body_velocity = body.velocity(point.place),
          .friction = body.obstacle().friction.kinetic};
}

FaceContacts::Before FaceContacts::before(int body, int face, const Vec3& weights) const {
  const auto key = [](const FaceContact& c) { return std::pair(c.body, c.face); };
  const auto begin = std::ranges::lower_bound(last_, std::pair(body, face), {}, key);
  const auto end = std::ranges::upper_bound(begin, last_.end(), std::pair(body, face), {}, key);
  if (begin == end) return {};
  const auto away = [&](const FaceContact& c) { return (c.weights - weights).squaredNorm(); };
  return {&*std::ranges::min_element(begin, end, {}, away), &*std::ranges::max_element(begin, end, {}, away)};
}

void FaceContacts::follow(const std::vector<MovingBody>& bodies) {
  for (FaceContact& c : touching_) {
    const MovingBody& body = bodies[c.body];
    const Vec3 before = c.body_velocity;
    c.changes = c.begun = 0;
    c.body_velocity = body.velocity(c.place);
    c.gap -= body.step() * c.normal.dot(c.body_velocity - before);
  }
}

double FaceContacts::imbalance(const StepMotion& step, const VecX& x_new, const VecX& v_new) const {
  double squares = 0;
  for (const FaceContact& c : touching_) {
    if (const double gap = c.gap_at(x_new); c.active != (gap < 0))
      squares += std::pow(step.h * c.stiffness * gap, 2);
    squares += std::pow(step.h * c.wrong_friction(x_new, v_new), 2);
  }
  return std::sqrt(squares);
}

FaceContacts::Change FaceContacts::react(const StepMotion& step, const VecX& x_new, const VecX& v_new) {
  Change change;
  FaceContact* worst = nullptr;
  for (FaceContact& c : touching_) {
    const double gap = measure(c, x_new, v_new);
    if (rub(c, step)) change.rubs = true;
    if (c.active == (gap < 0)) continue;
    if (c.changes == most_changes) {
      if (!worst || c.stiffness * std::abs(gap) > worst->stiffness * std::abs(worst->gap_at(x_new)))
        worst = &c;
      continue;
    }
    c.active = gap < 0;
    ++c.changes;
    change.acts = true;
  }
  if (!change.acts && !change.rubs && worst) {
    // Friction of other contacts may lift the triangle off the spring that acts, and press it on without one.
    // Between them is a softer spring that just carries it.
    if (worst->active)
      worst->stiffness *= 0.5;
    else
      worst->active = true;
    change.acts = true;
  }
  return change;
}

void FaceContacts::end_step(const std::vector<MovingBody>& bodies, const VecX& x, const VecX& x_new,
                            const VecX& v_new) {
  if (faces_.empty()) return;
  begins_ = false;
  for (FaceContact& c : touching_) measure(c, x_new, v_new);
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
