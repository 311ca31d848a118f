#include "constraints/self_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "constraints/encounters.h"
#include "constraints/rope_rest.h"
#include "constraints/surfaces.h"
#include "constraints/tangles.h"
#include "mesh/base/parallel.h"
#include "mesh/triangles/topology.h"

namespace drape {

using namespace internal;

namespace {

constexpr double load_sinks = 0.1, arrival_sinks = 0.5;  // shares of the thickness
constexpr double rope_sinks = 5e-5;  // m, under a load: a rope is thick, and is seen to lie
// How much stiffer a contact becomes so, at most: with steps of 10 ms and r = 1 mm it then bears 3000 times
// the weight of its lighter side.
constexpr double stiffest = 1000;
// A contact is eased while it bears less than this share of what it is stiff for. Springs that become stiff
// while they are pressed, and soft before they are pressed again, make energy. And a contact that becomes
// softer bears less, so that those beside it bear more and become stiffer. A load whose least is more than
// this share of its most changes no stiffness.
constexpr double eased_below = 0.4;
// It becomes softer only when it was eased for this time [s], and then goes on to where it bears this share.
// While the contact bears its load that time runs back, this many times as fast. It begins full, so that what
// took an impact becomes softer at once.
constexpr double eased_for = 0.25, softens_to = 0.8, runs_back = 2.5;
// What is then left of its stiffness after 10 ms, at least.
constexpr double slowest_fall = 0.9;
// A contact may hold what would else snap: as the contact becomes softer the load comes back, the contact
// becomes stiff again, is eased again, and the cloth swings for ever. The load has come back where it asks
// for 1.1 times what a contact that became softer is stiff for. From then on easing ends at 1.25 times the
// stiffness at which the load came back.
constexpr double comes_back = 1.1, ends_above = 1.25;
// What pushed in the last step begins as pushing unless the free way opens it by this many times what it was
// compressed.
constexpr double goes_on = 10;

// In about this time [s] a contact grows back to its thickness.
constexpr double thickens_in = 0.01;

// How fast a contact that has become thinner than its cloth may thicken [m/s]: so slowly that, on earth, what
// it lifts flies no farther than the contact is remembered.
double lift_speed(double thickness) { return std::sqrt(2 * 9.81 * 0.5 * thickness); }

// How stiff a contact becomes of which the load asks for `wanted` [N/m], in a step of h [s]. Notes in the
// contact how its easing goes on.
double next_stiffness(SelfContact& contact, double wanted, double h) {
  using Ease = SelfContact::Ease;
  const bool eases = wanted < (contact.eased > eased_for ? softens_to : eased_below) * contact.stiff;
  contact.eased = std::clamp(contact.eased + (eases ? h : -runs_back * h), 0.0, 2 * eased_for);
  if (contact.ease == Ease::softer && wanted > comes_back * contact.stiff) {
    contact.least_stiff = std::max(contact.least_stiff, ends_above * contact.stiff);
    contact.ease = Ease::bears;
  }
  const double share_left = contact.eased > eased_for ? std::pow(slowest_fall, h / 0.01) : 1;
  const double least = std::max(share_left * contact.stiff, std::min(contact.least_stiff, contact.stiff));
  const double next = std::max(std::sqrt(wanted * contact.stiff), least);
  if (contact.ease == Ease::bears && next < contact.stiff) contact.ease = Ease::softer;
  if (contact.ease == Ease::untried && contact.eased == 0) contact.ease = Ease::bears;
  return next;
}

}  // namespace

Vec3 SelfContact::rub_at(const Vec3& p, double normal_force) const {
  const Vec3 d = drag_at(p);
  const double size = d.norm(), most = friction * normal_force;
  return size <= most ? d : Vec3(most / size * d);
}

SelfContacts::SelfContacts()
    : encounters_(std::make_unique<Encounters>()),
      on_bodies_(std::make_unique<Encounters>()),
      surfaces_(std::make_unique<Surfaces>()),
      tangles_(std::make_unique<Tangles>()),
      ropes_(std::make_unique<RopeRest>()) {}
SelfContacts::SelfContacts(const SelfContacts& other) : SelfContacts() {
  add(other.faces_);
  add(other.segments_);
  pairs_ = other.pairs_;
  sewn_ = other.sewn_;
  pass_ = other.pass_;
}
SelfContacts& SelfContacts::operator=(const SelfContacts& other) { return *this = SelfContacts(other); }
SelfContacts::SelfContacts(SelfContacts&&) noexcept = default;
SelfContacts& SelfContacts::operator=(SelfContacts&&) noexcept = default;
SelfContacts::~SelfContacts() = default;

void SelfContacts::prepare(const StepMotion& step, const std::vector<MovingBody>& bodies) {
  if (stale_) set_particles(step);
  sewn_.resize(thickness_.size(), 0);
  pass_.resize(thickness_.size(), 0);
  look_again_ = look_again_ || stale_;
  stale_ = false;
  if (look_again_ || (touched_ != 0 && !crossing())) {
    std::vector<Triangle> triangles;
    std::vector<std::optional<int>> layers;
    for (const SelfFace& face : faces_) {
      triangles.push_back(face.particles);
      layers.push_back(face.layer);
    }
    for (const SelfSegment& segment : segments_) {
      const auto [i, j] = segment.particles;
      triangles.push_back({i, j, j});
    }
    layers.resize(triangles.size());
    tangles_->begin(std::move(triangles), static_cast<int>(segments_.size()), std::move(layers), pass_,
                    step.x);
  }
  const auto cloth = static_cast<std::size_t>(cloth_particles());
  if (tangled_.size() != cloth) {
    tangled_.resize(cloth);
    for (std::size_t i = 0; i < cloth; ++i) tangled_[i] = tangles_->tangle(static_cast<int>(i)) >= 0;
  }
  touched_ = 0;
  if (look_again_) {
    last_.clear();
    encounters_->forget();
    on_bodies_->forget();
  }
  if (look_again_ || touched_body_ != 0)
    surfaces_->look(bodies, faces_);
  else
    surfaces_->look_again(bodies, faces_);
  look_again_ = false;
  touched_body_ = 0;
}

int SelfContacts::cloth_particles() const { return surfaces_->cloth(); }
bool SelfContacts::crossing() const { return tangles_->any(); }
int SelfContacts::tangled() const { return tangles_->particles(); }
int SelfContacts::pinched() const { return surfaces_->pinched(); }
bool SelfContacts::is_pinched(int particle) const { return pinched() > 0 && surfaces_->is_pinched(particle); }

bool SelfContacts::is_on_body(const Encounter& e) const {
  return e.v[0] >= cloth_particles() || e.v[3] >= cloth_particles();
}

bool SelfContacts::have_on_both_sides(const std::vector<char>& mark, const Encounter& e) {
  const auto has = [&](std::size_t from, std::size_t to) {
    return std::any_of(e.v.begin() + from, e.v.begin() + to, [&](int v) { return mark[v] != 0; });
  };
  const std::size_t cut = e.edges ? 2 : 1;
  return has(0, cut) && has(cut, 4);
}

// Whether both sides are let pass each other: they are of one tangle, or sew() lets a vertex of each pass. A
// body may pass where it pinches the cloth, or where the cloth is held.
bool SelfContacts::may_pass(const Encounter& e) const {
  if (is_on_body(e))
    return std::any_of(e.v.begin(), e.v.end(), [&](int v) {
      return v < cloth_particles() && (surfaces_->is_pinched(v) || surfaces_->step().is_held(v));
    });
  const int tangle = tangles_->tangle(e.v[0]);
  if (tangle >= 0 &&
      std::all_of(e.v.begin(), e.v.end(), [&](int v) { return tangles_->tangle(v) == tangle; }))
    return true;
  return have_on_both_sides(pass_, e);
}

// So that neither what the contact bears nor what arrives sinks in by more than a share of the thickness.
// What cannot give way, as between two layers that cross, would become stiffer in every step: so there is a
// limit.
void SelfContacts::stiffen(SelfContact& contact, const StepMotion& step) const {
  if (kappa_ < 1) return;
  const double mass = contact.stiffness * made_for_ * made_for_ / kappa_;
  const double stops = mass * std::max(0.0, -contact.normal.dot(contact.over(step.v))) / step.h;
  const double sinks = std::max(contact.thickness, 0.1 * both_thicknesses(contact.who));
  const double under_load = load_sinks * sinks;
  double bears =
      contact.load / (ropes_->is_rope(contact.who) ? std::min(under_load, rope_sinks) : under_load);
  if (last_made_for_ > 0)
    for (double* k : {&contact.stiff, &contact.least_stiff})
      *k *= last_made_for_ * last_made_for_ / (made_for_ * made_for_);
  if (contact.stiff > 0) bears = next_stiffness(contact, bears, step.h);
  const double arrives = stops / (arrival_sinks * sinks);
  if (arrives > bears)
    contact.ease = SelfContact::Ease::untried;  // the force of a blow is no load that comes back
  contact.stiffness = std::clamp(std::max(bears, arrives), contact.stiffness, stiffest * contact.stiffness);
}

// Makes a contact that let its sides pass on the way to x_new as stiff as what pushes there asks for.
bool SelfContacts::stiffen_to_hold(SelfContact& contact, const VecX& x_new) const {
  constexpr double most = 30;  // times as stiff as before
  const StepMotion& step = surfaces_->step();
  double inverse = 0;  // 1/m
  for (std::size_t k = 0; k < 4; ++k) {
    const double w = contact.weights[k] + contact.of_body[k], mass = step.mass(contact.who.v[k]);
    if (mass > 0) inverse += w * w / mass;
  }
  const double limit = stiffest * kappa_ / (made_for_ * made_for_ * inverse);
  const double sinks = std::max(contact.thickness, 0.1 * both_thicknesses(contact.who));
  const double wanted = contact.push_at(contact.at(x_new)) / (arrival_sinks * sinks);
  if (kappa_ < 1 || std::min(wanted, limit) < 1.01 * contact.stiffness) return false;
  contact.stiffness = std::min({wanted, most * contact.stiffness, limit});
  contact.ease = SelfContact::Ease::untried;  // as after a blow
  contact.active = true;
  return true;
}

// Takes over what the contact was in the last step. A contact that is stiffer now, as in a step that is
// shorter than the last one, would make energy with the thickness that it had. So it begins with about the
// force that it had, and grows back.
void SelfContacts::go_on(SelfContact& contact, const StepMotion& step, double recovery) const {
  take_over(contact, recovery);
  stiffen(contact, step);
  // It is new, or no spring of an implicit step, or grows back within the step.
  if (contact.stiff <= 0 || step.foresight != Foresight::ahead || step.h >= thickens_in) return;
  const double as_before = contact.normal.dot(contact.place) + contact.before / contact.stiffness;
  if (as_before < contact.thickness)
    contact.thickness = std::min(contact.thickness,
                                 as_before + step.h / thickens_in * (thickness_of(contact.who) - as_before));
}

void SelfContacts::begin_step(const StepMotion& of_cloth, const std::vector<MovingBody>& bodies,
                              double recovery, const SelfSprings& springs) {
  if (!any()) return;
  stale_ = surfaces_->begin_step(bodies, of_cloth) || stale_;
  const StepMotion& step = surfaces_->step();
  prepare(step, bodies);
  accepted_ = is_proven_ = false;
  caution_ = 1;
  stopped_.assign(static_cast<std::size_t>(cloth_particles()), 0);
  kappa_ = springs.kappa;
  made_for_ = springs.h > 0 ? springs.h : step.h;
  recovery_ = recovery;
  ahead_ = step.x + step.h * step.v;
  find_contacts(step);
  sort_touching();
  for_chunks<Work::heavy>(static_cast<int>(touching_.size()), [&](int begin, int end) {
    for (SelfContact& c : std::span(touching_).subspan(begin, end - begin)) {
      go_on(c, step, std::min(recovery, step.h * lift_speed(thickness_of(c.who))));
      c.push = c.before;
      const Vec3 p = c.now = c.at(ahead_);
      const double drag = c.drag_at(p).norm();
      c.active = c.linear_push(p) > -goes_on * c.before;
      c.share = drag > 0 ? std::min(1.0, c.friction * c.push / drag) : 1;
    }
  });
}

void SelfContacts::pinch(const Contact& contact, const MovingBody& body) {
  constexpr double deep = 1e-6;  // m
  const double depth = -body.obstacle().margin - contact.plane[0].gap;
  if (!any() || !surfaces_->any()) return;
  const bool inside =
      body.skin() && depth > deep && body.inside_skin(surfaces_->step().place(contact.particle), deep);
  if (contact.clamped || inside) surfaces_->pinch(contact.particle);
}

void SelfContacts::follow(const std::vector<MovingBody>& bodies) {
  if (!any() || !surfaces_->any()) return;
  surfaces_->follow(bodies);
  is_proven_ = false;
  const VecX& ends = surfaces_->with(ahead_.head(3 * cloth_particles()));
  for (SelfContact& c : touching_) {
    const Vec3 before = c.carried;
    c.carried.setZero();
    for (std::size_t k = 0; k < 4; ++k) c.carried += c.of_body[k] * ends.segment<3>(3 * c.who.v[k]);
    c.now += c.carried - before;
  }
}

double SelfContacts::push_bodies(std::vector<MovingBody>& bodies, const VecX& x_new) const {
  double work = 0;
  for (const SelfContact& c : touching_) {
    if (c.body < 0) continue;
    Vec3 start = Vec3::Zero();
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      start += c.of_body[k] * surfaces_->step().x.segment<3>(3 * c.who.v[k]);
      sum += c.of_body[k];
    }
    const double h = surfaces_->step().h;
    const Vec3 moved = (c.carried - start) / sum, impulse = sum * h * c.force_at(x_new);
    work -= moved.dot(impulse) / h;
    bodies[c.body].push(impulse, c.carried / sum, (c.over(surfaces_->step().v)).norm());
  }
  return work;
}

double SelfContacts::imbalance(double h, const VecX& x_new) const {
  double sum = 0;
  for (const SelfContact& c : touching_) {
    const Vec3 p = c.at(x_new);
    const double push = c.push_at(p), assumed = c.active ? c.linear_push(p) : 0;
    const Vec3 rub = c.rub_at(p, push), taken = c.active ? c.linear_rub(p) : Vec3(Vec3::Zero());
    sum += (push - assumed) * (push - assumed) + (rub - taken).squaredNorm();
  }
  return h * std::sqrt(sum);
}

// Where along the way to x_new the energy is least, 0 to 1. Its slope rises along the way, because the energy
// is convex.
double SelfContacts::share_of_way(double slope, double curvature, const VecX& x_new) const {
  const auto slope_at = [&](double t) {
    return slope + curvature * (t - 1) +
           sum_chunks<Work::heavy>(static_cast<int>(touching_.size()), [&](int begin, int end) {
             double sum = 0;
             for (int k = begin; k < end; ++k) {
               const SelfContact& c = touching_[k];
               const Vec3 way = c.at(x_new) - c.now, p = c.now + t * way;
               sum += way.dot(c.slope(p) - c.solved_slope(p));
             }
             return sum;
           });
  };
  double low = 0, high = 1, at_low = slope_at(0), at_high = slope_at(1);
  if (!(curvature > 0) || !(at_low < 0) || !(at_high > 0)) return 1;
  for (int k = 0; k < 8; ++k) {
    const double t = k % 2 == 0 ? low + (high - low) * at_low / (at_low - at_high) : 0.5 * (low + high);
    const double here = slope_at(t);
    (here < 0 ? low : high) = t;
    (here < 0 ? at_low : at_high) = here;
  }
  return std::max(0.5 * (low + high), 1e-3);
}

bool SelfContacts::react(const VecX& v, const VecX& r, const VecX& x_new, double curvature) {
  if (touching_.empty()) return false;
  const bool searches = accepted_ && curvature > 0;
  const double share_of = searches ? share_of_way(dot(r, v) - dot(r, v_at_), curvature, x_new) : 1;
  if (accepted_)
    v_at_ += share_of * (v - v_at_);
  else
    v_at_ = v;
  accepted_ = true;
  bool changed = share_of < 1;
  // Without a search along the way nothing tells whether a solve went too far: then friction stays a spring.
  constexpr double too_far = 0.9;  // when less of its way is taken
  if (!searches)
    caution_ = 1;
  else
    caution_ = share_of < too_far ? std::min(1.0, 3 * caution_ + 0.1) : 0.1 * caution_;
  for (SelfContact& c : touching_) {
    c.now += share_of * (c.at(x_new) - c.now);
    const Vec3 d = c.drag_at(c.now);
    const double push = c.push_at(c.now), drag = d.norm(), most = c.friction * push;
    const double share = drag > most ? most / drag : 1;
    const bool slides_on = share < 1 && c.slid && caution_ < 1;
    const Vec3 slides = slides_on ? Vec3(d / drag) : Vec3(Vec3::Zero());
    const double spring = slides_on ? caution_ : 1;
    changed = changed || c.active != (push > 0) || std::abs(share - c.share) > 1e-9 ||
              (slides - c.slides).norm() > 1e-9 || std::abs(spring - c.spring) > 1e-3;
    c.slides = slides;
    c.spring = spring;
    c.slide = (1 - spring) * most;
    c.slid = push > 0 && share < 1;
    c.active = push > 0;
    c.push = push;
    c.share = share;
  }
  return changed;
}

void SelfContacts::end_step(const VecX& x_new) {
  if (!any()) return;
  pushing_ = 0;
  last_made_for_ = made_for_;
  last_ = touching_;
  for (SelfContact& c : last_) {
    const Vec3 p = c.at(x_new);
    const double push = c.by_carriers ? c.normal.dot(c.carried_force) : c.push_at(p);
    c.hold = c.by_carriers ? Vec3(c.carried_force - push * c.normal) : c.rub_at(p, push);
    c.before = push;
    c.load = std::any_of(c.particles.begin(), c.particles.end(), [&](int v) { return is_stopped(v); })
                 ? std::max(push, c.push)
                 : push;
    c.stiff = c.stiffness;
    pushing_ += push > 0;
  }
  const VecX& ends = surfaces_->with(x_new);
  encounters_->went(surfaces_->step().x, ends);
  if (surfaces_->any()) on_bodies_->went(surfaces_->step().x, ends);
  if (crossing()) tangles_->end_step(ends);
}

}  // namespace drape
