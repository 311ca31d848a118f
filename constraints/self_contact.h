// Cloth against cloth, and a cloth against itself: springs that carry the load, and a guard that lets nothing
// through.
//   A contact is a vertex and a triangle, or two edges, that come within the thickness r of each other.
//     p = sum w_k x_k     from the point of one side to the nearest of the other; at the start p = distance * n
//     g = n . p - r       the gap
//     f = max(0, -k g)    the force along n, on the first side
//     t = what friction leaves of d = t_0 - k s     across n; s is the part of p across n since the step began,
//                                                   t_0 the t of the last step
//         t = d while |d| <= mu f (it sticks), else mu f d/|d| (it slides)         [Cundall & Strack 1979]
//     k = kappa m / h^2,  1/m = sum w_k^2 / m_k     as stiff as the time step allows, whatever the mesh: a
//                         layer sinks into the thickness by g h^2 / kappa, 33 um with h = 10 ms. Where an
//                         implicit step is taken in pieces h is that of the whole
//   kappa is larger, up to a limit, where the load, or what arrives, would sink in by more than a share of r.
//   It goes half of the way to what the load asks for in a step, in ratios, and falls only after a while in
//   which much less was asked for: what shares a load would else take it by turns, and a pile would swing up
//   and down for ever. In steps shorter than 10 ms what is stiffer than before begins with about the force
//   that it had: r is so much less at first, and grows back in 10 ms or so.
//   Within a solve a contact is linear: it acts or not, and friction is a spring weakened to share
//   (t_0 - k s). With such springs no solve goes too far, but where many contacts slide, each solve takes away
//   only an eighth of the error. So what slid in the solve before, too, is linearised as the force along d that
//   friction is, with the spring across d [Newton's method: Alart & Curnier 1991]. Along d the spring goes in
//   steps of a tenth, and comes back where a solve went too far. react() corrects all until they agree with
//   the solve.
//   The guard: every vertex goes all of its way d_i at first. The pairs that would come nearer than `floor`
//   on the way are found [mesh/distance/approach.h]. First they are pushed apart along their normals, by
//   impulses, as far as no vertex has to go farther than the cloth is thick. Where that does not help, their
//   vertices become a zone, which keeps the motion D that it has on the whole, or that of pins or of a body
//   in it, so that cloth in motion is not held up:
//     x_i + D + t_i (d_i - D)
//   t_i is made less until no pair fails, and after a fixed number of rounds all stands still. It holds for
//   every integrator.
//   Ropes take part with their segments, as thick as twice their radius: a segment is met by the vertices that
//   come near it and by its edge, and its ends meet triangles. What hangs together with a rope is kept apart
//   from it by no more than half of the way between both at rest [rope_rest.h]. Bodies meet ropes otherwise,
//   by their particles.
//   Where the cloth starts through itself, nothing near there pushes or is guarded until it is apart
//   [tangles.h].
//   Bodies that are meshes, and convex shapes that move, take part: their corners meet the triangles of the
//   cloth, and their edges its edges [surfaces.h]. A zone that touches one goes with it. Where cloth cannot be
//   kept both off a body and off cloth, the body yields.
// x [m], v [m/s], f [N], k [N/m], h [s].
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "constraints/contact.h"
#include "constraints/moving_body.h"
#include "constraints/parting.h"
#include "constraints/step_motion.h"
#include "mesh/distance/approach.h"

namespace drape {

// How stiff the springs are [m/h^2]: for methods that solve for the end of a step, and for those that do not.
inline constexpr double implicit_kappa = 30, explicit_kappa = 0.2;
struct SelfSprings {
  double kappa = implicit_kappa;  // m/h^2
  double h = 0;  // the length of step that they are made for [s]; 0: that of the step under way
};

namespace internal {
class Encounters;
class RopeRest;
struct Meeting;
class Surfaces;
class Tangles;
}  // namespace internal

// A triangle between particles that takes part.
struct SelfFace {
  std::array<int, 3> particles;
  double thickness;  // m
  double friction;   // mu
  int sheet = 0;     // the cloth or soft body that it is of
  // What is worn over what: of two layers that cross the higher one comes out on the side where the normal of
  // the lower one points. Unset: no order is known.
  std::optional<int> layer = {};
};

// A segment of a rope between particles that takes part. Those of one rope follow each other.
struct SelfSegment {
  std::array<int, 2> particles;
  double thickness;  // m, of the rope: twice its radius
  double friction;   // mu
  int sheet = 0;     // the rope that it is of, by a number that is no cloth's
};

// How two sheets rub, or one on itself, instead of by the friction of both.
struct SelfFriction {
  int first, second;  // sheets, in any order
  double friction;    // mu
};

// Two particles that are being sewn together.
struct SewnPair {
  int a, b;
  bool may_pass;  // whether what is beside one of them may pass what is beside the other
};

struct SelfContact {
  Encounter who;
  int body = -1;  // the body that one side is of, whose particles have numbers beyond those of the cloth
  std::array<int, 4> particles;   // of the cloth; in place of those of a body any other
  std::array<double, 4> weights;  // w_k of these, 0 in place of those of a body
  std::array<double, 4> of_body;  // w_k of the particles of the body, else 0
  Vec3 carried;                   // what the body adds to p at the end of the step [m]
  Vec3 normal;                    // n: unit, towards the first side
  Vec3 place;                     // p at the start of the step [m]
  Vec3 now;                       // p at the point that the contacts were made for last [m]
  double stiffness;               // k [N/m]
  double thickness;               // r [m]
  double friction;                // mu
  double before = 0;              // f at the end of the last step [N]
  double load = 0;   // f there, or in the last solve of the step where the guard then stopped it [N]
  double stiff = 0;  // k of the last step [N/m]; 0: there was no contact
  // For how long the load has asked for much less [s]; of a new contact, for ever.
  double eased = std::numeric_limits<double>::infinity();
  // What easing it has come to: nothing yet, it bears its load, or it became softer after it had borne it.
  enum class Ease { untried, bears, softer } ease = Ease::untried;
  double least_stiff = 0;      // where easing ends [N/m]: above where the load came back before
  Vec3 hold = Vec3::Zero();    // t_0 [N]
  bool active = false;         // whether it acts in the next solve
  double push = 0;             // f of the last solve [N]
  double share = 0;            // of the spring that friction is in the next solve, 0 to 1
  Vec3 slides = Vec3::Zero();  // d/|d| where friction is a force along d in the next solve, else zero
  double slide = 0;            // that force [N]
  double spring = 1;           // what is left there of the spring along d, as a share of the weakened one
  bool slid = false;           // whether it pushed and slid at the point that the contacts were made for last
  bool by_carriers = false;    // carriers (constraints/carriers.h) answer it, and it has no spring
  Vec3 carried_force = Vec3::Zero();  // which these put on the first side in the step [N]

  // The slope of the energy along a way of p [N]: of the law, and of the linear contact of the solve.
  Vec3 slope(const Vec3& p) const { return -push_at(p) * normal - rub_at(p, push); }
  Vec3 solved_slope(const Vec3& p) const {
    return active ? Vec3(-linear_push(p) * normal - linear_rub(p)) : Vec3(Vec3::Zero());
  }

  double linear_push(const Vec3& p) const { return stiffness * (thickness - normal.dot(p)); }  // N
  double push_at(const Vec3& p) const { return std::max(0.0, linear_push(p)); }                // f
  Vec3 drag_at(const Vec3& p) const {                                                          // d
    const Vec3 moved = p - place;
    return hold - stiffness * (moved - normal.dot(moved) * normal);
  }
  Vec3 rub_at(const Vec3& p, double normal_force) const;  // t
  Vec3 linear_rub(const Vec3& p) const {                  // what t is in a solve
    const Vec3 d = share * drag_at(p);
    return d + (slide - (1 - spring) * slides.dot(d)) * slides;
  }
  // p when the step takes the cloth to x [m].
  template <class Vector>
  Vec3 at(const Vector& x) const {
    Vec3 sum = weights[0] * x.template segment<3>(3 * particles[0]);
    for (std::size_t k = 1; k < 4; ++k) sum += weights[k] * x.template segment<3>(3 * particles[k]);
    return sum + carried;
  }
  // sum w_k x_k, with places or velocities of all particles, those of bodies included.
  Vec3 over(const VecX& x) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) sum += (weights[k] + of_body[k]) * x.segment<3>(3 * who.v[k]);
    return sum;
  }
  bool is_sliding() const {
    return hold.norm() > (1 - 1e-6) * friction * before;
  }  // at the end of the last step
  // The force on the first side [N].
  Vec3 force_at(const VecX& x) const {
    const Vec3 p = at(x);
    return push_at(p) * normal + rub_at(p, push_at(p));
  }
};

// What the guard did to the particles of cloth.
struct GuardReport {
  int guarded = 0;      // were pushed or stopped
  int held = 0;         // of these, were pushed only, and kept the rest of their way
  int stood_still = 0;  // stayed where they began, with all of their piece, since nothing else kept it apart
};

class SelfContacts {
 public:
  SelfContacts();
  SelfContacts(const SelfContacts& other);  // takes the faces, and begins anew
  SelfContacts& operator=(const SelfContacts& other);
  SelfContacts(SelfContacts&&) noexcept;
  SelfContacts& operator=(SelfContacts&&) noexcept;
  ~SelfContacts();

  void add(const std::vector<SelfFace>& faces);
  void add(const std::vector<SelfSegment>& segments);
  void set_friction(const SelfFriction& pair) { pairs_.push_back(pair); }  // of equal pairs the last counts
  // Particle i gets the number particle_of[i]; a triangle of which two corners become one particle is
  // removed, and so is a segment of which both ends do.
  void renumber(const std::vector<int>& particle_of);
  // The two sides of a cut begin at the same place: they touch, and do not push each other before they are
  // apart.
  void part(const Parting& parting);
  // These pairs are being sewn together, in place of those named before. What is beside sewn particles is
  // pushed apart only where it would pass on its way, so that they can meet.
  void sew(const std::vector<SewnPair>& pairs);
  bool any() const { return !faces_.empty() || !segments_.empty(); }
  bool touches_bodies() const {
    return std::any_of(touching_.begin(), touching_.end(), [](const SelfContact& c) { return c.body >= 0; });
  }

  // Finds what comes near along x -> x + h v. recovery: by how much the thickness of a contact that started
  // nearer than r grows in the step at most [m]. springs.kappa: their stiffness at least [m/h^2]; below 1, as
  // explicit methods bear it, it is no larger anywhere.
  void begin_step(const StepMotion& step, const std::vector<MovingBody>& bodies, double recovery,
                  const SelfSprings& springs);
  void follow(const std::vector<MovingBody>& bodies);  // bodies that react have changed their motion
  // Gives the bodies what the contacts push them with when the step takes the cloth to x_new; returns the
  // work on the cloth [J].
  double push_bodies(std::vector<MovingBody>& bodies, const VecX& x_new) const;
  // The norm of the impulses that are wrong in a solve that came to x_new [N s].
  double imbalance(double h, const VecX& x_new) const;
  // Lets a particle that is inside a body, or clamped between two, pass the surfaces of bodies.
  void pinch(const Contact& contact, const MovingBody& body);
  // Changes the contacts to what a solve asks for that came to v and x_new with the reaction r [N s]; true
  // when one changes. Where that would overshoot, they are made for a point on the way there from the last
  // such point: the one at which the energy of the contacts as they are, and of the motion, is least.
  // curvature: d . A d of that way [J];
  // 0: v is taken whole.                                              [Nocedal & Wright 2006, section 3.1]
  bool react(const VecX& v, const VecX& r, const VecX& x_new, double curvature);
  // The velocity of that point [m/s]; null before the first react() of a step.
  const VecX* accepted_velocity() const { return accepted_ ? &v_at_ : nullptr; }
  // Adds the pairs that would meet on the way to x_new and are no contacts yet, and makes those stiffer that
  // are; true when there are any.
  bool meet(const VecX& x_new);
  // Changes the ways to x_new so that nothing meets.
  // on_bodies: the contacts with bodies. in_common: whether what is stopped goes on by a common way, which
  // may lead into a body; without it, everything stays on its own way.
  GuardReport guard(const std::vector<MovingBody>& bodies, const std::vector<Contact>& on_bodies,
                    bool in_common, VecX& x_new, VecX& v_new);
  void end_step(const VecX& x_new);

  void look_again() { look_again_ = true; }  // the particles were moved from outside
  const std::vector<SelfContact>& touching() const { return touching_; }  // sorted
  std::vector<SelfContact>& touching() { return touching_; }              // for carriers
  const std::vector<SelfContact>& pushed() const {
    return last_;
  }                                         // of the last step; `before` says how hard
  int pushing() const { return pushing_; }  // how many of them pushed at its end
  // Whether the guard of the last step pushed or stopped the particle.
  bool is_stopped(int particle) const { return any() && !stopped_.empty() && stopped_[particle] != 0; }
  // Whether the cloth passed through itself when the step began.
  bool crossing() const;
  int tangled() const;  // particles near triangles that pass through each other at the end of the last step
  int pinched() const;  // particles that may pass a body, because it could not be kept out of there
  bool is_pinched(int particle) const;

 private:
  void begin_anew();
  void prepare(const StepMotion& step, const std::vector<MovingBody>& bodies);
  void set_particles(const StepMotion& step);
  void find_pieces_to_stand();
  int cloth_particles() const;
  int zone_of(int particle);
  void find_common(const StepMotion& step, const VecX& x_new, bool in_common);
  Vec3 way_with_body(int particle, const StepMotion& step);
  void go_shares(const StepMotion& step, const VecX& x_new, bool in_common);
  void stop(const std::vector<internal::Meeting>& failing, const StepMotion& step, const VecX& x_new,
            bool in_common);
  bool may_leave(int particle, const Vec3& push) const;
  bool push_apart(const std::vector<internal::Meeting>& failing, const StepMotion& step);
  bool let_bodies_yield(const std::vector<internal::Meeting>& failing);
  void stop_tangles(const std::vector<int>& tangles);
  void find_relief(const StepMotion& step, const std::vector<Contact>& on_bodies);
  GuardReport go_ahead(const StepMotion& step, bool first, VecX& x_new, VecX& v_new);
  void shorten(const StepMotion& step, const VecX& x_new, bool in_common);
  void let_pieces_stand(const StepMotion& step);
  bool pieces_part(const StepMotion& step, std::vector<char>& stands);
  bool is_marked(const std::vector<char>& pieces, int particle) const;
  void mark_farthest(const StepMotion& step, std::vector<char>& pieces) const;
  bool stand_still(const StepMotion& step, const std::vector<char>& pieces);
  double share_of_way(double slope, double curvature, const VecX& x_new) const;
  bool is_on_body(const Encounter& e) const;
  bool may_pass(const Encounter& e) const;
  bool is_sewn(const Encounter& e) const { return have_on_both_sides(sewn_, e); }
  static bool have_on_both_sides(const std::vector<char>& mark, const Encounter& e);  // a marked particle
  bool has_contact(const Encounter& e) const;
  void list_last_ones();
  const SelfContact* last_of(const Encounter& e) const;
  // The pairs that are not surely apart all the way from x to x_new, in order.
  std::vector<internal::Meeting>& meetings(const VecX& x, const VecX& x_new);
  // Prepares both searches for this motion; false: so much is near that there is no list.
  bool follow_all(const VecX& x, const VecX& x_new);
  Approach approach_of(const StepMotion& step, const Encounter& e, const FourPoints& start,
                       const FourPoints& end, double thickest, const Vec3& likely) const;
  bool meets_bodies(const StepMotion& step) const;
  std::vector<internal::Meeting>& near_vertices(const StepMotion& step, internal::Encounters& encounters,
                                                double thickest, double reach);
  std::vector<internal::Meeting>& near_edges(const StepMotion& step, internal::Encounters& encounters,
                                             double thickest, double reach);
  std::vector<internal::Meeting>& edges_that_go_on(const StepMotion& step, double thickest);
  void add_found(const std::vector<internal::Meeting>& more);
  double farthest_of_edges(const Encounter& e) const;
  void find_limits(bool on_bodies);
  bool is_borne_otherwise(const internal::Meeting& edges) const;
  void look_at_ends(std::vector<internal::Meeting>::iterator begin,
                    std::vector<internal::Meeting>::iterator end) const;
  void find_contacts(const StepMotion& step);
  void sort_touching();
  void find_contacts_of_vertices(const StepMotion& step, double thickest);
  void find_contacts_of_edges(const StepMotion& step, double thickest);
  std::optional<SelfContact> contact_of(const StepMotion& step, const Encounter& who,
                                        const Nearest& near) const;
  void take_over(SelfContact& contact, double recovery) const;
  void go_on(SelfContact& contact, const StepMotion& step, double recovery) const;
  void stiffen(SelfContact& contact, const StepMotion& step) const;
  bool stiffen_to_hold(SelfContact& contact, const VecX& x_new) const;
  double both_thicknesses(const Encounter& e) const;
  double thickness_of(const Encounter& e) const;
  double friction_of(const Encounter& e) const;
  int one_of(const Encounter& e, bool second) const;

  std::vector<SelfFace> faces_;
  std::vector<SelfSegment> segments_;
  std::vector<SelfFriction> pairs_;
  std::unique_ptr<internal::Encounters> encounters_, on_bodies_;  // cloth with cloth, cloth with bodies
  std::unique_ptr<internal::Surfaces> surfaces_;
  std::unique_ptr<internal::Tangles> tangles_;
  std::unique_ptr<internal::RopeRest> ropes_;
  bool stale_ = true, look_again_ = true;
  double kappa_ = 0;                         // m/h^2
  double made_for_ = 0, last_made_for_ = 0;  // h of this: SelfSprings::h, now and in the last step [s]
  double caution_ = 1;                       // SelfContact::spring of what slides in the next solve
  double reach_ = 0, body_reach_ = 0;        // m, from which on pairs are looked at
  double recovery_ = 0;                      // m, by which tangles move in a step at most
  int touched_body_ = 0;                     // not 0: the same of cloth and a body
  int touched_ = 0;  // not 0: a pair touched at the start of the step, and may have crossed in it
  int pushing_ = 0, stood_still_ = 0;
  // By particle, those of bodies included.
  std::vector<double> thickness_, friction_;  // m, mu
  std::vector<int> piece_, sheet_;            // the connected piece, and the sheet, that it belongs to
  std::vector<int>
      piece_to_stand_;             // the same with ropes and what is inside soft bodies; -1: it meets nothing
  std::vector<char> stopped_;      // is_stopped(), by particle of the cloth
  std::vector<int> stops_;         // how often its way was shortened in this step
  std::vector<char> sewn_, pass_;  // sew(): all of its particles, and those that may pass
  VecX rest_;                      // places of the cloth when the faces were added [m]
  std::vector<char> tangled_;      // whether it was in a tangle there, or is beside a cut
  std::vector<SelfContact> touching_, last_;  // of this step and of the last one, sorted
  std::vector<SelfContact> unsorted_;         // scratch of sort_touching()
  std::vector<int> sorted_;                   // scratch of it: numbers in unsorted_
  std::vector<Encounter> last_ones_;          // scratch: the pairs of last_, in its order
  // Scratch: where in last_ the pairs of vertices, and those of edges, begin whose first particle is this
  // one.
  std::array<std::vector<int>, 2> last_from_;
  std::vector<SelfContact> met_;                          // scratch
  std::vector<internal::Meeting> found_;                  // scratch
  std::vector<internal::Meeting> going_on_;               // scratch
  std::vector<double> way_, shorter_, nearest_, limits_;  // scratch, by particle
  // Of the guard: in one zone are particles with the same root; the others are by root.
  std::vector<int> zone_;
  std::vector<Vec3> common_, kept_;
  std::vector<double> weight_;
  std::vector<int> zone_body_;  // the body in the zone, or one of these
  std::vector<Vec3> body_way_;  // the mean way of what it has in the zone [m]
  static constexpr int no_body = -1, several = -2;
  const std::vector<MovingBody>* bodies_ = nullptr;  // of the guard under way
  enum class Held : char { no, by_body, yes };
  std::vector<Held> hold_, zone_hold_;   // of each particle; the firmest of its zone
  std::vector<const Contact*> touches_;  // the active contact of each particle with bodies; null: none
  std::vector<char> still_;              // of a tangle that moves as a whole, but for its relief
  double share_of(int particle) const { return still_[particle] != 0 ? 0 : way_[particle]; }
  VecX push_;            // m, by which the guard pushed it
  VecX relief_, given_;  // m, see Tangles; what the first guard of the step gave of it
  VecX ahead_, wanted_, v_at_, proven_;
  bool accepted_ = false;   // whether v_at_ is of this step
  bool is_proven_ = false;  // whether nothing meets on the way to proven_ in this step
};

}  // namespace drape
