#include "solver/forces/self_contact_force.h"

#include "solver/forces/stencil_force.h"

namespace drape {
namespace {

struct SelfLaw {
  static constexpr const char* name = "self-contact";
  static constexpr int particles = 4;
  using Rest = const SelfContact*;  // points to a contact of the step
  struct Common {};

  static std::array<double, 4> weights(const Rest& c) { return c->weights; }

  // of_cloth: the part of p that is summed over particles of the cloth.
  static double energy(const Common&, const Rest& c, const Vec3& of_cloth) {
    const Vec3 p = of_cloth + c->carried;
    const double push = c->push_at(p), d = c->drag_at(p).norm(), most = c->friction * c->push;
    const double rub = d <= most ? 0.5 * d * d : most * d - 0.5 * most * most;
    return (0.5 * push * push + rub - 0.5 * c->hold.squaredNorm()) / c->stiffness;
  }
  static double dissipation(const Common&, const Rest&, const Vec3&, const auto&) { return 0; }
  static Vec3 pull(const Common&, const Rest& c, const Vec3& of_cloth, const auto&) {
    const Vec3 p = of_cloth + c->carried;
    return -c->push_at(p) * c->normal - c->rub_at(p, c->push);
  }
  static VectorResponse linearised(const Common&, const Rest& contact, const Vec3& of_cloth, const auto&,
                                   const auto& shift, double c, Stiffness stiffness) {
    const Vec3 p = of_cloth + contact->carried;
    const Vec3& n = contact->normal;
    const bool acts = stiffness == Stiffness::tangent ? contact->linear_push(p) > 0 : contact->active;
    if (!acts) return {};
    const Vec3 s = shift();
    const Vec3& t = contact->slides;
    const Mat3 along = n * n.transpose(),
               across = Mat3::Identity() - along - (1 - contact->spring) * t * t.transpose();
    return {.impulse = -c * (contact->linear_push(p + s) * n + contact->linear_rub(p + s)),
            .block = c * c * contact->stiffness * (along + contact->share * across),
            .acts = true};
  }
  // Coulomb's law as it is, for the gap and the slip without the contact.
  static Vec3 alone(const Common&, const Rest& c, const Vec3&, const Vec3& free, double W, double h,
                    const auto&) {
    const Vec3 p = free + c->carried;
    const double gives_way = 1 + h * h * W * c->stiffness;
    const double push = c->push_at(p) / gives_way, most = c->friction * push;
    const Vec3 drag = c->drag_at(p) / gives_way;
    const double size = drag.norm();
    return h * (push * c->normal + (size <= most ? drag : Vec3(most / size * drag)));
  }
};

class SelfContactForce final : public StencilForce<SelfLaw> {
 public:
  explicit SelfContactForce(const Constraints& constraints)
      : StencilForce([&constraints](const StepStart&, std::vector<Element>& found) {
          const bool were = !found.empty();
          found.clear();
          for (const SelfContact& contact : constraints.self().touching())
            if (!contact.by_carriers) found.push_back({.particles = contact.particles, .rest = &contact});
          return were || !found.empty();
        }) {}

  bool from_contact() const override { return true; }
};

}  // namespace

std::unique_ptr<Force> self_contact_force(const Constraints& constraints) {
  return std::make_unique<SelfContactForce>(constraints);
}

}  // namespace drape
