#include "solver/integrators/held_motion.h"

#include <Eigen/LU>
#include <algorithm>

#include "mesh/base/parallel.h"
#include "mesh/base/stopwatch.h"
#include "solver/integrators/contact_loop.h"

namespace drape {

using namespace internal;

void HeldMotion::begin(const State& state, double h, StepReport& report) {
  const Stopwatch watch(report.collide_ms);
  contacts_ = constraints_.begin_step(state.x, state.v, system_.masses(), state.time, h,
                                      contact_ == ContactMode::constraint ? Foresight::here : Foresight::none,
                                      {.kappa = kappa_});
  system_.begin_step({state.time, h, state.x, state.v, 0.5 * h});
  contacts_->filter(state.v, held_);
  pull_.setZero(state.x.size());
  pulled_.setZero(state.x.size());
  v_start_ = state.v;
  for (const FilterEntry& e : held_.entries()) v_start_.segment<3>(3 * e.particle) += e.z;
}

void HeldMotion::acceleration(const VecX& x, const VecX& v, VecX& a) {
  a.setZero(x.size());
  for (const auto& force : system_.forces()) force->add_force(x, v, a);
  const std::vector<double>& mass = system_.masses();
  for_chunks(system_.particles(), [&](int begin, int end) {
    for (int i = begin; i < end; ++i)  // a particle without mass is held in any case
      a.segment<3>(3 * i) = a.segment<3>(3 * i) / std::max(mass[i], 1e-300) + system_.gravity_acceleration();
  });
  power_ = 0;
  for (const FilterEntry& e : held_.entries()) {
    const Vec3 whole = a.segment<3>(3 * e.particle);
    const Vec3 kept = e.S.isZero(0) ? Vec3(Vec3::Zero()) : Vec3(e.S * whole);
    pull_.segment<3>(3 * e.particle) = mass[e.particle] * (kept - whole);
    power_ += v.segment<3>(3 * e.particle).dot(pull_.segment<3>(3 * e.particle));
    a.segment<3>(3 * e.particle) = kept;
  }
  for (const FaceContact& c : contacts_->touching_faces()) power_ += c.body_velocity.dot(c.force_at(x, v));
}

bool HeldMotion::counts() const {
  return !contacts_->touching().empty() || !contacts_->touching_faces().empty() ||
         (contacts_->bodies() && !contacts_->moving_pins().empty());
}

void HeldMotion::count(double duration, const VecX& x, const VecX& v) {
  contacts_->count_face_impulse(duration, x, v);
  for (const FilterEntry& e : held_.entries())
    pulled_.segment<3>(3 * e.particle) += duration * pull_.segment<3>(3 * e.particle);
}

// The constrained step with the mass alone, as an Attempt of settle_contacts.
class HeldMotion::ContactSolve {
 public:
  ContactSolve(HeldMotion& motion, const State& state, const VecX& x, const VecX& v, double h)
      : motion_(motion), state_(state), x_(x), v_(v), h_(h) {}

  bool solve() {
    motion_.move_within_constraints(state_, x_, h_);
    return true;
  }
  ContactTrial trial() {
    const double noise = 1e-9 * h_ * motion_.system_.gravity_acceleration().norm();
    return {motion_.v_new_, motion_.x_new_,
            motion_.r_,     motion_.impulse_noise(h_),
            noise,          motion_.weight_impulse(h_)};
  }
  bool worth_settling() { return true; }
  void release() { motion_.let_go(x_, v_, h_); }
  bool refine(double) { return false; }
  void changed(const ContactChange&) {}
  void bodies_moved() {}

 private:
  HeldMotion& motion_;
  const State& state_;
  const VecX &x_, &v_;
  double h_;
};

bool HeldMotion::finish(const VecX& x, const VecX& v, double h, const StepOptions& options, State& state,
                        StepReport& report) {
  if (!x.allFinite() || !v.allFinite()) {
    report.done = false;
    report.failure = not_finite(system_, x, v, "the new positions are not finite numbers");
    return false;
  }
  x_new_ = x;
  v_new_ = v;
  if (contacts_->bodies()) {
    if (contact_ == ContactMode::constraint) {
      set_free(v);
      ContactSolve solve(*this, state, x, v, h);
      double imbalance = 0;
      settle_contacts(*contacts_, options, solve, report, imbalance);
      note_contacts(imbalance, options, report);
    } else {
      const Stopwatch watch(report.collide_ms);
      contacts_->respond(contact_, x, v, pulled_, {}, x_new_, v_new_, impulse_noise(h));
    }
    contacts_->settle_faces(x_new_, v_new_);
    if (!contacts_->bodies_agree(0.5)) {  // a smaller difference counts as not converged
      report.done = false;
      report.failure = {.what = "the motion of a body that reacts and that of the cloth do not agree",
                        .force = {}};
      return false;
    }
  }
  end_step(*contacts_, x_new_, v_new_, report);
  system_.end_step(x_new_);
  state.x = x_new_;
  state.v = v_new_;
  state.time += h;
  return true;
}

// Finds the velocity without the constraints: what they took at the start and during the step is given back.
void HeldMotion::set_free(const VecX& v) {
  v_free_ = v;
  for (const FilterEntry& e : held_.entries())
    if (const double mass = system_.masses()[e.particle]; mass > 0)
      v_free_.segment<3>(3 * e.particle) -= pulled_.segment<3>(3 * e.particle) / mass + e.z;
}

// A particle that was held and is let go, or comes loose, gets back the velocity that was taken from it at
// the start, less friction; it moves from the next step on. It does not get h (I - S) M^-1 f, which is
// explicit: where the cloth is stiff and h long, that is far more than the particle would gain. A body can
// only push: where it led the particle away, as a lift does that goes down, the particle goes back by that
// way.
void HeldMotion::let_go(const VecX& x, const VecX& v, double h) {
  for (const Contact& c : contacts_->touching()) {
    if (c.active() && c.grip == Grip::stick) continue;
    const auto held = std::find_if(held_.entries().begin(), held_.entries().end(),
                                   [&](const FilterEntry& e) { return e.particle == c.particle; });
    if (held == held_.entries().end() || (c.active() && !held->S.isZero(0))) continue;
    Vec3 back = -held->z;
    if (c.active()) {
      const Mat3 Q = c.locked_directions();
      back -= Q * (Q.transpose() * back);
      const double most = c.friction_impulse.norm() / system_.masses()[c.particle];
      back *= back.norm() > most ? 1 - most / back.norm() : 0;
    }
    const Vec3& n = c.plane[0].normal;
    const double led = c.active() ? 0 : std::max(n.dot(back), 0.0);  // m/s
    x_new_.segment<3>(3 * c.particle) = x.segment<3>(3 * c.particle) + h * led * n;
    v_new_.segment<3>(3 * c.particle) = v.segment<3>(3 * c.particle) + back;
  }
}

// The impulse below which all is round-off [N s].
double HeldMotion::impulse_noise(double h) const {
  double heaviest = 0;
  for (double m : system_.masses()) heaviest = std::max(heaviest, m);
  return 1e-9 * heaviest * h * system_.gravity_acceleration().norm();
}

double HeldMotion::weight_impulse(double h) const {
  double squares = 0;
  for (double m : system_.masses()) squares += m * m;
  return h * system_.gravity_acceleration().norm() * std::sqrt(squares);
}

// Solves S (A dv - b) = 0 within the filter, one particle at a time; A = m + h D, where D is the damper of
// friction.
void HeldMotion::move_within_constraints(const State& state, const VecX& x, double h) {
  x_new_ = x;
  v_new_ = v_free_;
  r_.setZero(x.size());
  const auto mass = [&](int i) { return system_.masses()[i]; };
  const auto& friction = contacts_->friction();
  for (const ContactFriction& f : friction) {
    const Mat3 A = mass(f.particle) * Mat3::Identity() + h * f.damping;
    const Vec3 b = f.impulse - h * (f.damping * (v_free_.segment<3>(3 * f.particle) - f.body_velocity));
    v_new_.segment<3>(3 * f.particle) += A.inverse() * b;
    r_.segment<3>(3 * f.particle) -= b;
  }
  contacts_->filter(v_free_, filter_);
  for (const FilterEntry& e : filter_.entries()) {
    const Vec3 v = v_free_.segment<3>(3 * e.particle), dv = v_new_.segment<3>(3 * e.particle) - v;
    v_new_.segment<3>(3 * e.particle) = v + (e.S * dv + e.z);
  }
  for (const ContactFriction& f : friction)
    r_.segment<3>(3 * f.particle) +=
        h * (f.damping * (v_new_.segment<3>(3 * f.particle) - v_free_.segment<3>(3 * f.particle)));
  for (const MovingPin& pin : contacts_->moving_pins()) {
    const int i = 3 * pin.particle;
    x_new_.segment<3>(i) = state.x.segment<3>(i) + h * v_new_.segment<3>(i);
    r_.segment<3>(i) =
        pulled_.segment<3>(i) + mass(pin.particle) * (v_new_.segment<3>(i) - state.v.segment<3>(i));
  }
  for (const Contact& c : contacts_->touching()) {
    const int i = 3 * c.particle;
    r_.segment<3>(i) += mass(c.particle) * (v_new_.segment<3>(i) - v_free_.segment<3>(i));
    // Along the normals the place is the one that the planes ask for; across them it is where the method came
    // to, and not h v, because the particle may vibrate within a step.
    const Mat3 Q = c.locked_directions();
    const Vec3 wanted = h * v_new_.segment<3>(i) - (x.segment<3>(i) - state.x.segment<3>(i));
    x_new_.segment<3>(i) += Q * (Q.transpose() * wanted) + contacts_->correction().segment<3>(i);
  }
}

StepFailure not_finite(const System& system, const VecX& x, const VecX& v, const std::string& what) {
  StepFailure failure{what, -1, {}};
  for (int i = 0; i < system.particles() && failure.particle < 0; ++i)
    if (!x.segment<3>(3 * i).allFinite() || !v.segment<3>(3 * i).allFinite()) failure.particle = i;
  failure.force = system.not_finite_force(x, v);
  return failure;
}

}  // namespace drape
