// Which pairs of constraints/self_contact.h are contacts in a step.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "constraints/encounters.h"
#include "constraints/rope_rest.h"
#include "constraints/self_contact.h"
#include "constraints/surfaces.h"

namespace drape {

using namespace internal;

namespace {

constexpr double same_way = 0.5;  // the cosine from which two normals belong to one contact
// Edges are a contact where they are nearer than this share of what their ends are from the other sheet.
constexpr double clearly_nearer = 0.7;
constexpr double infinity = std::numeric_limits<double>::infinity();

// What is lifted flies no farther than this on earth (self_contact.cpp), and is found to be near while it
// does.
double reach_about(double thickness) { return 1.5 * thickness; }

Vec3 across(const Vec3& n, const Vec3& a) { return a - n.dot(a) * n; }

bool share_a_particle(const Encounter& a, const Encounter& b) {
  return std::any_of(a.v.begin() + 1, a.v.end(),
                     [&](int v) { return std::find(b.v.begin() + 1, b.v.end(), v) != b.v.end(); });
}

}  // namespace

bool SelfContacts::has_contact(const Encounter& e) const {
  const auto at = std::lower_bound(touching_.begin(), touching_.end(), e,
                                   [](const SelfContact& c, const Encounter& key) { return c.who < key; });
  return at != touching_.end() && at->who == e;
}

// Fills last_ones_ and last_from_.
void SelfContacts::list_last_ones() {
  last_ones_.clear();
  for (std::vector<int>& from : last_from_) from.assign(nearest_.size() + 1, 0);
  for (const SelfContact& c : last_) {
    last_ones_.push_back(c.who);
    ++last_from_[c.who.edges][c.who.v[0] + 1];
  }
  int before = 0;  // the pairs of vertices stand before those of edges
  for (std::vector<int>& from : last_from_)
    for (int& count : from) count = before += count;
}

// The contact of this pair in the last step; null when there was none.
const SelfContact* SelfContacts::last_of(const Encounter& e) const {
  const std::vector<int>& from = last_from_[e.edges];
  for (int k = from[e.v[0]]; k < from[e.v[0] + 1]; ++k)
    if (last_ones_[k] == e) return &last_[k];
  return nullptr;
}

int SelfContacts::one_of(const Encounter& e, bool second) const { return ropes_->one_of(e, second); }

double SelfContacts::both_thicknesses(const Encounter& e) const {
  if (is_on_body(e)) return std::max(0.0, thickness_[std::max(e.v[0], e.v[3])]);
  return 0.5 * (thickness_[one_of(e, false)] + thickness_[one_of(e, true)]);
}

// The thickness at which the pair comes to rest: the mean of both sides. Where one piece of cloth is near
// itself at rest, no more than half the distance there. Of what passes through each other at rest that says
// nothing: there it may always be a quarter of the shortest edge between the four. What a rope is joined to:
// rope_rest.h.
double SelfContacts::thickness_of(const Encounter& e) const {
  const double both = both_thicknesses(e);
  if (ropes_->is_rope(e)) return std::min(both, 0.5 * ropes_->way(e));
  if (piece_[e.v[0]] != piece_[e.v[3]]) return both;
  const FourPoints x = corners(rest_, e);
  const double half = 0.5 * nearest(e.edges, x).distance;
  if (std::any_of(e.v.begin(), e.v.end(), [&](int v) { return tangled_[v] == 0; }))
    return std::min(both, half);
  const double shortest = e.edges
                              ? std::min((x[1] - x[0]).norm(), (x[3] - x[2]).norm())
                              : std::min({(x[2] - x[1]).norm(), (x[3] - x[2]).norm(), (x[1] - x[3]).norm()});
  return std::min(both, std::max(half, 0.25 * shortest));
}

double SelfContacts::friction_of(const Encounter& e) const {
  if (is_on_body(e)) return friction_[std::max(e.v[0], e.v[3])];
  const int first = one_of(e, false), second = one_of(e, true);
  const auto between = std::minmax(sheet_[first], sheet_[second]);
  for (auto pair = pairs_.rbegin(); pair != pairs_.rend(); ++pair)
    if (std::minmax(pair->first, pair->second) == between) return pair->friction;
  return std::sqrt(friction_[first] * friction_[second]);
}

// Nothing where the contact could move none of its particles, or has no thickness.
std::optional<SelfContact> SelfContacts::contact_of(const StepMotion& step, const Encounter& who,
                                                    const Nearest& near) const {
  double inverse = 0, free = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double w = near.weights[k], mass = step.mass(who.v[k]);
    if (mass > 0) inverse += w * w / mass;
    if (!step.is_held(who.v[k])) free += std::abs(w);
  }
  constexpr double least_share = 1e-3;
  if (!(inverse > 0) || !(free > least_share) || !(near.distance > 0)) return {};
  SelfContact contact{.who = who,
                      .particles = who.v,
                      .weights = near.weights,
                      .of_body = {},
                      .carried = Vec3::Zero(),
                      .normal = near.normal,
                      .place = Vec3::Zero(),
                      .now = Vec3::Zero(),
                      .stiffness = kappa_ / (made_for_ * made_for_ * inverse),
                      .thickness = thickness_of(who),
                      .friction = friction_of(who)};
  if (is_on_body(who)) {
    contact.body = surfaces_->body_of(std::max(who.v[0], who.v[3]));
    const int own = *std::min_element(who.v.begin(), who.v.end());
    for (std::size_t k = 0; k < 4; ++k) {
      if (who.v[k] < cloth_particles()) continue;
      contact.particles[k] = own;
      contact.of_body[k] = std::exchange(contact.weights[k], 0);
      contact.carried += contact.of_body[k] * (step.place(who.v[k]) + step.h * step.velocity(who.v[k]));
    }
  }
  contact.place = contact.over(step.x);
  // What starts nearer than r begins with the distance that it has.
  contact.thickness = std::min(contact.thickness, std::max(contact.normal.dot(contact.place), near.distance));
  if (!(contact.thickness > 0)) return {};
  return contact;
}

// The forces of the last step, and the thickness reached there: of the same pair, or of a contact that the
// vertex had on the same side and has no more.
void SelfContacts::take_over(SelfContact& contact, double recovery) const {
  const SelfContact* at = last_of(contact.who);
  if (!at && !contact.who.edges) {
    const int* const from = &last_from_[0][contact.who.v[0]];
    const auto c =
        std::find_if(last_.begin() + from[0], last_.begin() + from[1], [&](const SelfContact& one) {
          return !(one.normal.dot(contact.normal) < same_way) && share_a_particle(one.who, contact.who);
        });
    if (c != last_.begin() + from[1] && !has_contact(c->who)) at = &*c;
  }
  if (!at) return;
  contact.before = at->before;
  contact.load = at->load;
  contact.stiff = at->stiff;
  contact.eased = at->eased;
  contact.ease = at->ease;
  contact.least_stiff = at->least_stiff;
  contact.hold = across(contact.normal, at->hold);
  contact.thickness =
      std::min(thickness_of(contact.who), std::max(contact.thickness, at->thickness + recovery));
}

bool SelfContacts::follow_all(const VecX& x, const VecX& x_new) {
  const double floor = floor_of(x, x_new);  // of the guard
  if (!encounters_->follow(x, x_new, std::max(reach_, floor))) return false;
  return !surfaces_->any() || on_bodies_->follow(x, x_new, std::max(body_reach_, floor));
}

// How far apart two edges may be to become a contact [m]. It takes nearest_ of their ends.
double SelfContacts::farthest_of_edges(const Encounter& e) const {
  double farthest = infinity;
  if (ropes_->is_rope(e)) return farthest;
  for (int v : e.v)
    if (!is_on_body(e) || v >= cloth_particles()) farthest = std::min(farthest, clearly_nearer * nearest_[v]);
  return farthest;
}

// Fills limits_ with what farthest_of_edges() is at most for pairs of each particle.
void SelfContacts::find_limits(bool on_bodies) {
  for_chunks<Work::light>(static_cast<int>(limits_.size()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const bool any = ropes_->any() || (on_bodies && v < cloth_particles());
      limits_[v] = any ? infinity : clearly_nearer * nearest_[v];
    }
  });
}

// How a pair comes within its thickness, and a little more, on the way to ahead_. start, end: the corners of
// both ends; thickest: of pairs without a rope; likely: the normal.
Approach SelfContacts::approach_of(const StepMotion& step, const Encounter& e, const FourPoints& start,
                                   const FourPoints& end, double thickest, const Vec3& likely) const {
  if (may_pass(e) || is_sewn(e) ||
      std::all_of(e.v.begin(), e.v.end(), [&](int v) { return step.is_held(v); }))
    return {};
  const double most = ropes_->is_rope(e) ? thickness_of(e) : thickest;
  const double reach = reach_about(most), more = reach - most;
  Approach near = approach(e.edges, start, end, reach, likely);
  if (near.apart) return near;
  const double own = thickness_of(e);
  if (own < most) near = approach(e.edges, start, end, own + more);
  const auto inside = [](double w) { return std::abs(w) > 1e-3 && std::abs(w) < 1 - 1e-3; };
  const auto& w = near.last.weights;
  near.apart = near.apart || (e.edges && !(inside(w[0]) && inside(w[2])));
  if (!near.apart)  // below 1: they meet
    near.until = approach_from_within(e.edges, start, end, 0.1 * own, near.last.normal).until;
  return near;
}

// Other methods look at a contact within the step, when the body is not yet where its end takes it.
bool SelfContacts::meets_bodies(const StepMotion& step) const {
  return surfaces_->any() && step.foresight == Foresight::ahead;
}

// The pairs of vertices with triangles that come near.
std::vector<Meeting>& SelfContacts::near_vertices(const StepMotion& step, Encounters& encounters,
                                                  double thickest, double reach) {
  return encounters.select(
      Encounters::Kind::vertices, step.x, ahead_, reach, [reach](const Encounter&) { return reach; },
      [&](const Encounter& e, const FourPoints& start, const FourPoints& end, const Vec3& likely) {
        return approach_of(step, e, start, end, thickest, likely);
      });
}

// The pairs of edges that come near enough to become contacts, without those that are.
std::vector<Meeting>& SelfContacts::near_edges(const StepMotion& step, Encounters& encounters,
                                               double thickest, double reach) {
  find_limits(&encounters == on_bodies_.get());
  return encounters.select(
      Encounters::Kind::edges, step.x, ahead_, reach,
      [&](const Encounter& e) { return std::min(reach, farthest_of_edges(e)); },
      [&](const Encounter& e, const FourPoints& start, const FourPoints& end, const Vec3& likely) {
        return last_of(e) ? Approach{} : approach_of(step, e, start, end, thickest, likely);
      },
      &limits_);
}

// The pairs of edges that were contacts in the last step, and are near.
std::vector<Meeting>& SelfContacts::edges_that_go_on(const StepMotion& step, double thickest) {
  const auto first =
      std::find_if(last_.begin(), last_.end(), [](const SelfContact& c) { return c.who.edges; });
  going_on_.resize(static_cast<std::size_t>(last_.end() - first));
  for_chunks<Work::heavy>(static_cast<int>(going_on_.size()), [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      const Encounter& e = first[k].who;
      const double most = is_on_body(e) ? surfaces_->thickest() : thickest;
      going_on_[k] = {e, approach_of(step, e, corners(step.x, e), corners(ahead_, e), most, first[k].normal)};
    }
  });
  std::erase_if(going_on_, [&](const Meeting& m) {
    return m.approach.apart || (is_on_body(m.who) && !meets_bodies(step));
  });
  return going_on_;
}

// A vertex that meets nothing on its way is pushed from the place where it ends: pushed from where it came
// near, it would stumble over the rim of a sheet that it slides onto. A vertex that meets something may end
// on the other side of it, so these contacts stay as they were when the vertex came near.
void SelfContacts::look_at_ends(std::vector<Meeting>::iterator begin,
                                std::vector<Meeting>::iterator end) const {
  if (std::any_of(begin, end, [](const Meeting& m) { return m.approach.until < 1; })) return;
  for (auto m = begin; m != end; ++m) m->approach.last = nearest(m->who.edges, corners(ahead_, m->who));
}

// Whether an end of one of two edges, one of which is a rope's and one a cloth's, is nearly as near to what
// the other edge is of: the contact of that vertex bears it then. Those of vertices are in touching_, sorted
// by their vertices. Where two ropes cross, their edges meet in any case: or they would sink into each other
// wherever no vertex is near.
bool SelfContacts::is_borne_otherwise(const Meeting& edges) const {
  constexpr double nearly = 0.98;
  if (ropes_->are_ropes(edges.who)) return false;
  const Encounter& e = edges.who;
  for (std::size_t k = 0; k < 4; ++k) {
    const int other = sheet_[one_of(e, k < 2)];
    auto c = std::lower_bound(touching_.begin(), touching_.end(), e.v[k], [](const SelfContact& one, int v) {
      return !one.who.edges && one.who.v[0] < v;
    });
    for (; c != touching_.end() && !c->who.edges && c->who.v[0] == e.v[k]; ++c)
      if (sheet_[one_of(c->who, true)] == other &&
          edges.approach.last.distance > nearly * c->normal.dot(c->place))
        return true;
  }
  return false;
}

void SelfContacts::find_contacts(const StepMotion& step) {
  touching_.clear();
  list_last_ones();
  double thickest = 0, thickest_rope = 0;
  for (const SelfFace& face : faces_) thickest = std::max(thickest, face.thickness);
  for (const SelfSegment& segment : segments_) thickest_rope = std::max(thickest_rope, segment.thickness);
  reach_ = reach_about(std::max(thickest, thickest_rope));
  body_reach_ = reach_about(surfaces_->thickest());
  if (!follow_all(step.x, ahead_)) return;
  find_contacts_of_vertices(step, thickest);
  find_contacts_of_edges(step, thickest);
}

// Moves each contact once: they are large. Pointers to contacts are no longer good then.
void SelfContacts::sort_touching() {
  std::swap(touching_, unsorted_);
  sorted_.resize(unsorted_.size());
  std::iota(sorted_.begin(), sorted_.end(), 0);
  std::sort(sorted_.begin(), sorted_.end(),
            [&](int a, int b) { return unsorted_[a].who < unsorted_[b].who; });
  touching_.clear();
  for (int k : sorted_) touching_.push_back(unsorted_[k]);
}

// A vertex has one contact with each sheet beside it: the nearest, of triangles that share a particle and lie
// the same way. What pushed the vertex over the inside of a triangle goes on: in a valley two triangles bear
// it, and would do so by turns.
void SelfContacts::find_contacts_of_vertices(const StepMotion& step, double thickest) {
  std::swap(found_, near_vertices(step, *encounters_, thickest, reach_));
  if (meets_bodies(step)) add_found(near_vertices(step, *on_bodies_, surfaces_->thickest(), body_reach_));
  const auto add = [&](const Meeting& m) {
    if (const auto contact = contact_of(step, m.who, m.approach.last)) touching_.push_back(*contact);
  };
  const auto goes_on = [&](const Meeting& m) {
    const SelfContact* const before = last_of(m.who);
    const auto& w = m.approach.last.weights;
    return before && before->before > 0 &&
           std::all_of(w.begin() + 1, w.end(), [](double k) { return k < -1e-3; });
  };
  std::sort(found_.begin(), found_.end(), [](const Meeting& a, const Meeting& b) { return a.who < b.who; });
  std::fill(nearest_.begin(), nearest_.end(), infinity);
  for (auto first = found_.begin(); first != found_.end();) {
    const int vertex = first->who.v[0];
    const auto last =
        std::find_if(first, found_.end(), [&](const Meeting& m) { return m.who.v[0] != vertex; });
    look_at_ends(first, last);
    std::sort(first, last, [](const Meeting& a, const Meeting& b) {
      const double of_a = a.approach.last.distance, of_b = b.approach.last.distance;
      return of_a != of_b ? of_a < of_b : a.who < b.who;
    });
    const auto cloth = std::find_if(first, last, [&](const Meeting& m) { return !ropes_->is_rope(m.who); });
    if (cloth != last) nearest_[vertex] = cloth->approach.last.distance;
    for (; first != last; ++first) {
      bool told = false;
      if (goes_on(*first)) {
        add(*first);
        continue;
      }
      for (auto c = touching_.rbegin(); c != touching_.rend() && c->who.v[0] == vertex && !told; ++c)
        told = share_a_particle(c->who, first->who) && c->normal.dot(first->approach.last.normal) > same_way;
      if (!told) add(*first);
    }
  }
}

void SelfContacts::add_found(const std::vector<Meeting>& more) {
  found_.insert(found_.end(), more.begin(), more.end());
}

// Two edges that cross are a contact where they are clearly nearer than their ends are to the other sheet,
// and stay one as long as they are near (edges_that_go_on()): or a rim would drop and be lifted by turns. The
// others are not looked at.
void SelfContacts::find_contacts_of_edges(const StepMotion& step, double thickest) {
  std::swap(found_, near_edges(step, *encounters_, thickest, reach_));
  if (meets_bodies(step)) add_found(near_edges(step, *on_bodies_, surfaces_->thickest(), body_reach_));
  std::erase_if(found_, [&](const Meeting& m) {
    return ropes_->is_rope(m.who) ? is_borne_otherwise(m)
                                  : !(m.approach.last.distance < farthest_of_edges(m.who));
  });
  add_found(edges_that_go_on(step, thickest));
  for (const Meeting& m : found_)
    if (const auto contact = contact_of(step, m.who, m.approach.last)) touching_.push_back(*contact);
}

}  // namespace drape
