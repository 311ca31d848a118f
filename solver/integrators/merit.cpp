#include "solver/integrators/merit.h"

#include <limits>

#include "mesh/base/parallel.h"

namespace drape {

RoundOff round_off(const System& system, const BlockMatrix& A, const VecX& x, const VecX& v, double c) {
  constexpr double eps = 8 * std::numeric_limits<double>::epsilon();
  struct Sums {
    double energy = 0, squares = 0;  // sums of A_ii e_i^2, and of (A_ii e_i)^2
    void operator+=(const Sums& other) { energy += other.energy, squares += other.squares; }
  };
  const Sums all = sum_chunks<Work::heavy>(A.rows(), [&](int begin, int end) {
    Sums sums;
    for (int i = begin; i < end; ++i) {
      const int row = A.pattern().row_of()[i];
      const double a = A.at(A.pattern().diagonal(row)).norm();
      const double e = eps * (x.segment<3>(3 * i).norm() / c + v.segment<3>(3 * i).norm());
      sums += {a * e * e, a * e * a * e};
    }
    return sums;
  });
  double terms = 0;
  for (const auto& force : system.forces()) terms += force->energy_noise(x);
  return {.least = all.energy, .impulse = std::sqrt(all.squares), .terms = terms};
}

double dissipation_of_forces(const System& system, const VecX& damped_at, const VecX& v) {
  double sum = 0;
  for (const auto& force : system.forces()) sum += force->dissipation(damped_at, v);
  return sum;
}

void Merit::begin(double h) {
  for (Measured& last : measured_) last.known = false;
  const double fall = h * system_.gravity_acceleration().norm();
  mass_ = fall_energy_ = 0;
  for (double m : system_.masses()) {
    mass_ += m * m;
    fall_energy_ += m * fall * fall;
  }
  mass_ = std::sqrt(mass_);
  weight_impulse_ = fall * mass_;
}

double Merit::elastic_energy(const VecX& x) {
  for (const Measured& last : measured_)
    if (last.known && last.x == x) return last.energy;
  std::swap(measured_[0], measured_[1]);
  Measured& here = measured_[0];
  here.x = x;
  here.energy = system_.elastic_energy(x);
  here.known = true;
  return here.energy;
}

double Merit::speed_noise(double residual) const {
  const double evenly = 2 * residual / mass_;
  return weight_impulse_ > 0 ? std::min(evenly, 0.02 * weight_impulse_ / mass_) : evenly;
}

void Merit::measure(const BlockMatrix& A, const Point& p, double c) {
  noise_ = round_off(system_, A, p.x, p.v, c);
  linearised_at_ = p.x;
}

// What friction takes is mu N |slip|, as Coulomb's law has it: its linearisation grows with the square of a
// slip that comes out larger than the one at which it was made.
double Merit::potential(const StepCoefficients& k, const std::vector<ContactFriction>& friction,
                        const VecX& v) {
  x_ = k.x_bar + k.c * v;
  const double inertia = sum_chunks(system_.particles(), [&](int begin, int end) {
    double sum = 0;
    for (int i = begin; i < end; ++i) {
      const auto particle = static_cast<std::size_t>(i);
      const Vec3 d =
          v.segment<3>(3 * i) - k.v_bar.segment<3>(3 * i) - k.fall[particle] * system_.gravity_acceleration();
      sum += 0.5 * k.mass[particle] * d.squaredNorm();
    }
    return sum;
  });
  double rubbed = 0;
  for (const ContactFriction& f : friction)
    rubbed += f.most * (f.along * (v.segment<3>(3 * f.particle) - f.body_velocity)).norm();
  return inertia + elastic_energy(x_) + system_.contact_energy(x_) +
         k.c * dissipation_of_forces(system_, linearised_at_, v) + rubbed;
}

// The largest Phi that counts as not above `start`. A tenth of the energy that the fall of one step brings
// may come from a solve that ends at its tolerance.
double Merit::most(double start) const {
  return start + 1e-9 * std::abs(start) + 0.05 * fall_energy_ + noise_.energy(start);
}

bool Merit::falls(const StepCoefficients& k, const std::vector<ContactFriction>& friction, const VecX& v_base,
                  const VecX& v) {
  const double allowed = most(potential(k, friction, v_base));
  return potential(k, friction, v) <= allowed;
}

StepTaken Merit::descend(const StepCoefficients& k, const std::vector<ContactFriction>& friction,
                         const VecX& v_base, const VecX& dv, bool may_overshoot, VecX& v) {
  v += dv;
  const double allowed = most(potential(k, friction, v_base));
  for (int halvings = 0; halvings < 12; ++halvings) {
    const double phi = potential(k, friction, v);
    if (phi <= allowed) return halvings == 0 ? StepTaken::whole : StepTaken::cut;
    if (may_overshoot && std::isfinite(phi)) return StepTaken::overshot;
    may_overshoot = false;
    v = 0.5 * (v + v_base);
  }
  return StepTaken::cut;
}

// Energies are summed in the frame in which the cloth is at rest, which moves by u. There pins and bodies do
// less work, by u . J, where J are the impulses of the step but gravity's. (A step of order 2 looks back, so
// J is not what the momentum gains.)
bool Merit::makes_energy(const StepCoefficients& k, const State& before, const Point& after, const VecX& rest,
                         double given, const EnergyAllowance& allowed) {
  const Vec3& g = system_.gravity_acceleration();
  struct Sums {
    double gained = 0, inner = 0,
           kinetic = 0;  // J: but for what is stored; kinetic energy at rest, and in the scene
    void operator+=(const Sums& other) {
      gained += other.gained;
      inner += other.inner;
      kinetic += other.kinetic;
    }
  };
  const Sums sums = sum_chunks(system_.particles(), [&](int begin, int end) {
    Sums sum;
    for (int i = begin; i < end; ++i) {
      const auto particle = static_cast<std::size_t>(i);
      const Vec3 v = after.v.segment<3>(3 * i), from = before.v.segment<3>(3 * i), u = rest.segment<3>(3 * i);
      const Vec3 way = after.x.segment<3>(3 * i) - before.x.segment<3>(3 * i);
      const double m = system_.masses()[particle];
      const double share = k.scale[particle] == 1 ? k.h / k.c : 1 / k.scale[particle];
      const Vec3 pushed = share * k.mass[particle] * (v - k.v_bar.segment<3>(3 * i) - k.fall[particle] * g);
      sum.gained += m * (0.5 * (v - from).dot(v + from - 2 * u) - g.dot(way - k.h * u)) + u.dot(pushed);
      sum.inner += 0.5 * m * (from - u).squaredNorm();
      sum.kinetic += 0.5 * m * from.squaredNorm();
    }
    return sum;
  });
  const auto stored = [&](const VecX& x) {
    return elastic_energy(x) + (allowed.of_contacts ? system_.contact_energy(x) : 0);
  };
  const double now = stored(after.x), more = now - stored(before.x);
  return sums.gained + more > given + allowed.of_fall * fall_energy_ + allowed.of_motion * sums.inner +
                                  noise_.energy(now + sums.kinetic);
}

}  // namespace drape
