#include "solver/integrators/bdf.h"

#include <algorithm>
#include <limits>

#include "mesh/base/errors.h"
#include "mesh/base/parallel.h"
#include "mesh/base/stopwatch.h"
#include "solver/integrators/contact_loop.h"
#include "solver/integrators/newton_loop.h"

namespace drape {

using namespace internal;

Bdf::Bdf(System& system, Constraints& constraints, std::unique_ptr<LinearSolver> solver,
         const StepOptions& options, int order)
    : system_(system),
      constraints_(constraints),
      options_(options),
      history_(order),
      A_(system, std::move(solver)),
      merit_(system) {
  if (order != 1 && order != 2) throw InputError("bdf order = " + std::to_string(order) + ": it is 1 or 2");
}

namespace {

// How often a step is halved because its contacts do not settle. What remains is told by the report.
constexpr int max_unsettled_halvings = 2;

// What a step may make of energy: of "bdf2", whose motion nothing damps, so that it adds up; of "implicit-euler",
// whose next steps take it out; and of that where any edges go slack, for there the step after one that was
// refined overshoots. The springs of contact are made anew for a step, whose bodies may move, and so say
// nothing of where it began: what they store counts for "bdf2" alone, since it is what a bounce takes.
constexpr EnergyAllowance of_order_2{.of_fall = 5e-4, .of_motion = 3e-4, .of_contacts = true},
    of_order_1{.of_fall = 0.05, .of_motion = 0.05, .of_contacts = false},
    of_order_1_slack{.of_fall = 0.5, .of_motion = 0.5, .of_contacts = false};

}  // namespace

StepReport Bdf::advance(State& state, double h) {
  check_step(system_, state, h);
  StepReport report;
  {
    const Stopwatch watch(report.step_ms);
    take_in_pieces(system_, constraints_, state, h, options_.max_halvings, before_, report,
                   [&](const Piece& piece) { return attempt(state, piece, report); });
  }
  return report;
}

// Solves S (A dv - b) = 0 within the contacts as they are.                        [Baraff & Witkin 1998, 5.3]
// Loose solves find out which contacts hold. The last solve keeps the tolerance asked for and starts from the
// last loose one. Bodies that react are moved only after that solve, and then the contacts may change again.
class Bdf::ContactSolve {
 public:
  ContactSolve(Bdf& bdf, const State& state, const NewtonLoop& newton, ContactStep& contacts,
               StepReport& report)
      : bdf_(bdf),
        state_(state),
        stiffness_(newton.stiffness()),
        first_(newton.first()),
        contacts_(contacts),
        report_(report),
        wanted_(bdf.options_.tolerance),
        tolerance_(contacts.touches_anything() ? loose() : wanted_) {
    for (int i = 0; i < bdf.system_.particles(); ++i)
      contacts.set_inertia(i, bdf.A_.inertia(i) / bdf.k().scale[i]);
  }

  bool solve() {
    const Stopwatch watch(report_.solve_ms);
    bdf_.add_friction(bdf_.friction(contacts_));
    contacts_.filter(bdf_.p_.v, bdf_.filter_);
    const LinearOptions options{tolerance_, bdf_.options_.max_linear_iterations, bdf_.merit_.weight_impulse(),
                                bdf_.most_reference_};
    bdf_.linear_ = bdf_.A_.solve(bdf_.b_rubbed_, bdf_.filter_, options, bdf_.dv_);
    count_solve(bdf_.linear_, report_);
    return bdf_.linear_.reason != StopReason::indefinite && bdf_.linear_.reason != StopReason::not_finite;
  }

  ContactTrial trial() {
    const auto& scale = bdf_.k().scale;
    const auto unscale = [&](int i) { bdf_.r_.segment<3>(3 * i) /= scale[i]; };
    bdf_.A_.reaction(bdf_.r_);
    for (const Contact& c : contacts_.touching()) unscale(c.particle);
    for (const MovingPin& p : contacts_.moving_pins()) unscale(p.particle);
    bdf_.end_.v = bdf_.p_.v + bdf_.dv_;
    bdf_.end_.x = bdf_.k().x_bar + bdf_.k().c * bdf_.end_.v;
    const double residual = bdf_.linear_.residual_impulse;
    ContactTrial trial{bdf_.end_.v, bdf_.end_.x, bdf_.r_, 2 * residual, bdf_.merit_.speed_noise(residual),
                       reference()};
    if (const VecX* const from = contacts_.accepted_velocity())
      trial.curvature = bdf_.A_.curvature(trial.v, *from);
    return trial;
  }

  bool worth_settling() {
    if (!first_) return true;
    first_ = false;
    bdf_.end_.v = bdf_.p_.v + bdf_.dv_;
    return bdf_.falls(contacts_);
  }

  void release() {}  // a particle that is let go moves in the next solve

  bool refine(double imbalance) {
    if (bdf_.linear_.residual <= wanted_ || tolerance_ <= wanted_) return false;
    // A solve that is nearly as accurate as wanted would only be followed by another one.
    tolerance_ = imbalance > 50 * wanted_ ? std::min(0.1 * imbalance, tolerance_) : wanted_;
    return true;
  }

  void changed(const ContactChange& change) {
    if (change.caught || change.faces) bdf_.history_.restart_touching(contacts_);
    if (change.met) {
      tolerance_ = loose();  // the new contacts have to settle first
      const Stopwatch watch(report_.collide_ms);
      bdf_.system_.find_contacts({state_.time, bdf_.k().h, state_.x, state_.v, bdf_.k().h});
    }
    if (change.faces || change.rubs || change.met || (change.caught && bdf_.k().order_2())) linearise();
  }

  void bodies_moved() {
    if (bdf_.k().order_2() || contacts_.springs_on_bodies()) linearise();
  }

 private:
  double loose() const { return std::max(wanted_, 0.3 * std::sqrt(wanted_)); }
  double reference() const {
    const LinearReport& linear = bdf_.linear_;
    return linear.residual > 0 ? linear.residual_impulse / linear.residual : bdf_.merit_.weight_impulse();
  }
  // The point stays where it was. So what the cloth adds is the same but for order 2, whose particles may
  // start anew.
  void linearise() {
    if (bdf_.k().order_2()) return bdf_.linearise(state_, stiffness_, contacts_, report_, Assembly::all);
    bdf_.linearise(state_, stiffness_, contacts_, report_, kept_ ? Assembly::changing : Assembly::keep);
    kept_ = true;
  }

  Bdf& bdf_;
  const State& state_;
  Stiffness stiffness_;
  bool first_;  // the next solve is the first of the step
  ContactStep& contacts_;
  StepReport& report_;
  double wanted_, tolerance_;
  bool kept_ = false;  // what lasts was kept at this point
};

bool Bdf::attempt(State& state, const Piece& piece, StepReport& report) {
  ContactStep contacts = begin(state, piece, report);  // what touches; c = gamma h; the first (x, v) and dv
  bool energy = false;                                 // whether the motion makes some
  for (NewtonLoop newton(options_, system_.goes_slack()); newton.next();) {
    if (newton.exhausted()) return fail(report, "no step lowers the energy");
    // A = M + c D + c^2 K,  b = M (v_bar - v) + c (f - K y)                            [BW98, eq. 6 and 18]
    linearise(state, newton.stiffness(), contacts, report, Assembly::all);
    if (newton.may_stop() && residual(contacts) <= residual_wanted()) break;
    if (!newton.first()) dv_.setZero();
    // Solve S (A dv - b) = 0 within the contacts, until the contacts agree with dv.    [BW98, 5.1 to 5.3]
    ContactSolve solve(*this, state, newton, contacts, report);
    if (!settle_contacts(contacts, options_, solve, report, imbalance_) || !good(linear_))
      return fail(report, "linear solve: " + std::string(drape::name(linear_.reason)));
    const StepTaken taken =
        descend(contacts, newton);    // v += dv, as far as Phi falls               [NW06, 3.1]
    p_.x = k().x_bar + k().c * p_.v;  // x = x_bar + c v
    if (!p_.x.allFinite()) return fail(report, "the new positions are not finite numbers");
    if (taken == StepTaken::overshot && linear_.residual > 0)
      most_reference_ = linear_.residual_impulse / linear_.residual;
    // The impulses of a step that was cut short are those of the whole one.
    energy = taken == StepTaken::whole && makes_energy(state, contacts, piece.h);
    newton.took(taken, energy && falls_back(), energy && !falls_back(), report);
  }
  if (k().order_2() && energy) {
    ++report.rescues;
    return attempt(state, {piece.h, piece.halvings, piece.shortest, true}, report);  // taken again by order 1
  }
  // A shorter step lets the cloth weigh less on the bodies. When even the shortest piece is too long, the
  // report says so.
  if (!contacts.bodies_agree() && !piece.shortest)
    return fail(report, "the motion of a body that reacts and that of the cloth do not agree");
  // What couples the contacts through the cloth goes with the square of the step, so they settle in a shorter
  // one.
  if (piece.halvings < max_unsettled_halvings && !piece.shortest && imbalance_ > contact_tolerance(options_))
    return fail(report, "the contacts have not settled");
  finish(state, contacts, report);
  return true;
}

ContactStep Bdf::begin(const State& state, const Piece& piece, StepReport& report) {
  if (A_.follow_system()) {
    const Eigen::Index n = 3 * system_.particles();
    for (VecX* vector : {&y_, &b_, &b_rubbed_, &dv_, &v_base_, &at_rest_, &rest_, &r_, &end_.x, &end_.v})
      vector->setZero(n);
    filter_.reserve(static_cast<std::size_t>(system_.particles()));
    friction_.reserve(2 * static_cast<std::size_t>(system_.particles()));  // two bodies may rub a particle
    history_.forget(system_);
    rest_frame_.follow(A_.matrix().pattern());
    rigid_.follow(A_.matrix().pattern());
  }
  adrift_ = false;
  linear_ = {};
  most_reference_ = std::numeric_limits<double>::infinity();
  merit_.begin(piece.h);
  const Stopwatch watch(report.collide_ms);
  ContactStep contacts = constraints_.begin_step(state.x, state.v, system_.masses(), state.time, piece.h,
                                                 Foresight::ahead, {.h = piece.of_step()});
  system_.begin_step({state.time, piece.h, state.x, state.v, piece.h});
  history_.begin(state, piece, contacts);
  history_.first_point(state, p_);
  if (!k().order_2()) {
    find_held(state, contacts);
    rigid_.go_on(system_.masses(), held_, piece.h, v_base_, p_.x);
  }
  // The first dv is free fall. So what flies is right from the first iterate, and a solve that is cut short
  // cannot lose gravity. The point of order 2 already includes the fall, except for particles that start
  // anew.
  for (int i = 0; i < system_.particles(); ++i)
    dv_.segment<3>(3 * i) =
        history_.extrapolates(i) ? Vec3(Vec3::Zero()) : Vec3(piece.h * system_.gravity_acceleration());
  return contacts;
}

// What pins hold, and what sticks to bodies, as it seems before the first solve; and in v_base_ how fast what
// holds it goes there, of the others how fast they go.
void Bdf::find_held(const State& state, const ContactStep& contacts) {
  held_.assign(static_cast<std::size_t>(system_.particles()), 0);
  v_base_ = state.v;
  for (int i : constraints_.pinned()) held_[i] = 1;
  contacts.filter(state.v, filter_);
  for (const FilterEntry& e : filter_.entries())
    if (held_[e.particle] != 0) v_base_.segment<3>(3 * e.particle) += e.z;
  for (const Contact& c : contacts.touching())
    if (c.active() && held_[c.particle] == 0 && (c.clamped || c.grip == Grip::stick)) {
      held_[c.particle] = 1;
      v_base_.segment<3>(3 * c.particle) = c.body_velocity();
    }
}

void Bdf::linearise(const State& state, Stiffness stiffness, const ContactStep& contacts, StepReport& report,
                    Assembly assembly) {
  const Stopwatch watch(report.assemble_ms);
  if (assembly == Assembly::changing) {
    A_.assemble_changing({p_.x, p_.v, y_, k().c, stiffness}, b_);
    merit_.measure(A_.matrix(), p_, k().c);
    return;
  }
  history_.update(system_, state, contacts);
  y_ = k().x_bar + k().c * p_.v - p_.x;
  for_chunks(system_.particles(), [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const auto particle = static_cast<std::size_t>(i);
      b_.segment<3>(3 * i) = k().mass[particle] * (k().v_bar.segment<3>(3 * i) - p_.v.segment<3>(3 * i) +
                                                   k().fall[particle] * system_.gravity_acceleration());
    }
  });
  A_.assemble({p_.x, p_.v, y_, k().c, stiffness}, k().mass, b_, assembly == Assembly::keep);
  merit_.measure(A_.matrix(), p_, k().c);
}

// The norm |S b| at (x, v), in the free directions: how far the nonlinear equation is from being met [N s].
double Bdf::residual(ContactStep& contacts) {
  add_friction(friction(contacts));
  contacts.filter(p_.v, filter_);
  filter_.apply(b_rubbed_);
  return std::sqrt(dot(b_rubbed_, b_rubbed_));
}

// The wind may give twice what its power at one end of the step comes to, because the power is not steady.
bool Bdf::makes_energy(const State& start, const ContactStep& contacts, double h) {
  const double power = std::max(system_.given_power(start.x, start.v), system_.given_power(p_.x, p_.v));
  const double given = contacts.work() + 2 * h * power;
  const EnergyAllowance& allowed = history_.order() == 2  ? of_order_2
                                   : system_.goes_slack() ? of_order_1_slack
                                                          : of_order_1;
  // In a step of order 1 the frame that is at rest only says how much the motion may make. Most steps make
  // none even where it may make nothing.
  if (!k().order_2() && !merit_.makes_energy(k(), start, p_, start.v, given, allowed)) return false;
  contacts.filter(p_.v, filter_);
  rest_frame_.find(A_.matrix(), constraints_, contacts, filter_, p_, k(), system_.gravity_acceleration(),
                   adrift_, rest_);
  // What the solve left over is not told from an impulse.
  const double left = h / k().c * linear_.residual_impulse * std::sqrt(dot(rest_, rest_));
  return merit_.makes_energy(k(), start, p_, rest_, given + left, allowed);
}

double Bdf::residual_wanted() const {
  return options_.newton_tolerance * merit_.weight_impulse() + merit_.noise_impulse();
}

// The friction of the contacts, scaled as the rows of the matrix are.
const std::vector<ContactFriction>& Bdf::friction(ContactStep& contacts) {
  friction_ = contacts.friction();
  for (ContactFriction& f : friction_) {
    f.damping *= k().scale[f.particle];
    f.impulse *= k().scale[f.particle];
    f.most *= k().scale[f.particle];
  }
  return friction_;
}

// Adds friction to both sides:  A += h D,  b_rubbed = b + the impulse - h D slip.
void Bdf::add_friction(const std::vector<ContactFriction>& friction) {
  b_rubbed_ = b_;
  for (const ContactFriction& f : friction) {
    const Vec3 slip = p_.v.segment<3>(3 * f.particle) - f.body_velocity;
    b_rubbed_.segment<3>(3 * f.particle) += f.impulse - k().h * (f.damping * slip);
  }
  A_.rub(
      friction.size(), [&](std::size_t f) { return friction[f].particle; },
      [&](std::size_t f) { return Mat3(k().h * friction[f].damping); });
}

bool Bdf::falls(ContactStep& contacts) {
  set_base(contacts, true);
  return merit_.falls(k(), friction(contacts), v_base_, end_.v);
}

// Sets the velocity towards which a step goes back when it is too long: the last one, or that of a cloth at
// rest. It meets the constraints, as the step does: the energy that it takes to meet them must not count
// against the step. What only slides is at rest with what it slides on or adrift, whichever has less to
// spend.
void Bdf::set_base(ContactStep& contacts, bool at_rest) {
  contacts.filter(p_.v, filter_);
  const auto from_frame = [&](bool adrift) {
    const bool slides = rest_frame_.find(A_.matrix(), constraints_, contacts, filter_, p_, k(),
                                         system_.gravity_acceleration(), adrift, rest_);
    v_base_ = rest_ - p_.v;
    filter_.impose(v_base_);
    v_base_ += p_.v;
    return slides;
  };
  if (!at_rest) {
    v_base_.setZero();
    filter_.impose(v_base_);
    v_base_ += p_.v;
  } else if (adrift_ = false; from_frame(false)) {
    const double with_bodies = merit_.potential(k(), friction(contacts), v_base_);
    from_frame(true);
    adrift_ = merit_.potential(k(), friction(contacts), v_base_) < with_bodies;
    if (!adrift_) from_frame(false);
  }
}

// Dampers, friction and contacts count as they are now. So a motion that was below rest need not be so any
// more; then the step is judged against rest once more, or several iterations could make energy.
StepTaken Bdf::descend(ContactStep& contacts, const NewtonLoop& newton) {
  set_base(contacts, true);
  if (!newton.from_rest()) {
    at_rest_ = v_base_;
    set_base(contacts, false);
    if (!merit_.falls(k(), friction(contacts), at_rest_, v_base_)) v_base_.swap(at_rest_);
  }
  return merit_.descend(k(), friction(contacts), v_base_, dv_, newton.may_overshoot(), p_.v);
}

void Bdf::finish(State& state, ContactStep& contacts, StepReport& report) {
  end_ = p_;
  end_step(contacts, end_.x, end_.v, report);
  report.residual = std::max(report.residual, linear_.residual);
  report.converged = report.converged && linear_.reason == StopReason::converged;
  note_contacts(imbalance_, options_, report);
  history_.remember(state, end_, contacts);
  system_.end_step(end_.x);
  state.x = end_.x;
  state.v = end_.v;
  state.time += k().h;
}

bool Bdf::good(const LinearReport& linear) const {
  if (!dv_.allFinite()) return false;
  return linear.reason == StopReason::converged ||
         (linear.reason == StopReason::iteration_limit && options_.max_linear_iterations > 0);
}

bool Bdf::fail(StepReport& report, const std::string& what) {
  report.residual = linear_.residual;
  report.failure = {what, -1, std::string(system_.not_finite_force(p_.x, p_.v))};
  double worst = -1;
  for (int i = 0; i < system_.particles(); ++i) {
    const double size = dv_.segment<3>(3 * i).norm();
    if (std::isfinite(size) && size <= worst) continue;
    worst = size;
    report.failure.particle = i;
    if (!std::isfinite(size)) break;
  }
  if (report.failure.force.empty())
    report.failure.force =
        A_.stiffest_force(report.failure.particle, {p_.x, p_.v, y_, k().c, Stiffness::majorant});
  return false;
}

}  // namespace drape
