#include "constraints/response.h"

namespace drape {

const std::array<ContactModeInfo, 3>& contact_modes() {
  static constexpr std::array<ContactModeInfo, 3> all = {{
      {ContactMode::constraint, "constraint", "what touches is locked, slides or is let go within the solve"},
      {ContactMode::velocity, "velocity",
       "velocities projected so that the step ends on the surface, explicit"},
      {ContactMode::restitution, "restitution", "impacts that rebound by each body's restitution, explicit"},
  }};
  return all;
}

std::string_view name(ContactMode mode) {
  for (const ContactModeInfo& info : contact_modes())
    if (info.mode == mode) return info.name;
  return {};
}

double slip_kept(const Friction& mu, double normal_change, double slip) {
  if (mu.statics * normal_change >= slip) return 0;
  return std::max(0.0, 1 - mu.kinetic * normal_change / slip);
}

Vec3 projected(const Vec3& v, const Vec3& v_b, const Vec3& n, double phi, const Friction& mu, double h) {
  const Vec3 w = v - v_b;
  const double v_N = w.dot(n), phi_new = phi + h * v_N;
  if (phi_new >= 0) return v;
  const Vec3 v_T = w - v_N * n;
  return v_b + (v_N - phi_new / h) * n + slip_kept(mu, -phi_new / h, v_T.norm()) * v_T;
}

Vec3 reflected(const Vec3& v, const Vec3& v_b, const Vec3& n, double k_r) {
  const double v_N = (v - v_b).dot(n);
  return v_N < 0 ? Vec3(v - (1 + k_r) * v_N * n) : v;
}

bool project(StepVelocities& step, const ContactPlane& plane, const Friction& mu, double recovery_speed,
             double h) {
  const Vec3 &n = plane.normal, &v_b = plane.body_velocity;
  const double phi = std::max(plane.gap, -recovery_speed * h);
  const Vec3 w = step.end - v_b, u = step.mean - v_b;
  const double phi_end = phi + h * w.dot(n), u_N = u.dot(n), phi_mean = phi + h * u_N;
  if (phi_end >= 0 && phi_mean >= 0) return false;
  const double kept = phi_end < 0 ? slip_kept(mu, -phi_end / h, (w - w.dot(n) * n).norm()) : 1;
  step.end = projected(step.end, v_b, n, phi, mu, h);
  step.mean = v_b + (u_N - std::min(phi_mean, 0.0) / h) * n + kept * (u - u_N * n);
  return true;
}

bool rebound(StepVelocities& step, const ContactPlane& plane, const Friction& mu, double k_r, double eps,
             double recovery_speed, double h) {
  const Vec3 &n = plane.normal, &v_b = plane.body_velocity;
  const Vec3 w = step.start - v_b, forced = step.end - step.start, u = step.mean - v_b;
  const double phi = plane.gap, phi_new = phi + h * u.dot(n);
  double s = 0;
  if (phi >= eps) {
    if (phi_new >= 0) return false;
    s = phi / (phi - phi_new);
  } else if (w.dot(n) >= 0 && (w + forced).dot(n) >= 0) {
    return false;
  }
  const Vec3 met = w + s * forced;
  const Vec3 impact = reflected(met, Vec3::Zero(), n, k_r) - met;
  Vec3 end = w + forced + impact;
  Vec3 after = met + impact + (1 - s) * (step.mean - step.start);  // mean velocity in the rest of the step
  if (const double pressed = -end.dot(n); pressed > 0) {
    end += pressed * n;
    const double kept = slip_kept(mu, pressed, end.norm());
    end *= kept;
    after = kept * (after - after.dot(n) * n);
  }
  const double out = std::clamp(-phi / h, 0.0, recovery_speed);
  step.start += impact;
  step.end = v_b + end;
  step.mean = v_b + s * u + (1 - s) * after + out * n;
  return true;
}

}  // namespace drape
