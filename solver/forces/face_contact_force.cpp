#include "solver/forces/face_contact_force.h"

#include "solver/forces/stencil_force.h"

namespace drape {
namespace {

struct FaceLaw {
  static constexpr const char* name = "face-contact";
  static constexpr int particles = 3;
  using Rest = const FaceContact*;  // points to a contact of the step
  struct Common {};

  static std::array<double, 3> weights(const Rest& c) {
    return {c->weights[0], c->weights[1], c->weights[2]};
  }

  static double energy(const Common&, const Rest& c, const Vec3& p) {
    const double g = std::min(c->gap_of(p), 0.0);
    return 0.5 * c->stiffness * g * g;
  }
  static double dissipation(const Common&, const Rest& c, const Vec3&, const auto& velocity) {
    return 0.5 * c->damper * c->slip_of(velocity()).squaredNorm();
  }
  static Vec3 pull(const Common&, const Rest& c, const Vec3& p, const auto& velocity) {
    return c->stiffness * std::min(c->gap_of(p), 0.0) * c->normal + c->damper * c->slip_of(velocity());
  }
  static VectorResponse linearised(const Common&, const Rest& contact, const Vec3& p, const auto& velocity,
                                   const auto& shift, double c, Stiffness stiffness) {
    const double g = contact->gap_of(p), d = contact->damper;
    const Vec3& n = contact->normal;
    const bool acts = stiffness == Stiffness::tangent ? g < 0 : contact->active;
    const double push = acts ? contact->stiffness * (g + n.dot(shift())) : 0;
    // No majorant: the stiffness of a spring that does not act would brake the cloth without an impulse on
    // the body, and momentum would be lost.
    const double k = acts ? contact->stiffness : 0;
    const Mat3 along = n * n.transpose();
    return {.impulse = c * (push * n + d * contact->slip_of(velocity())),
            .block = c * c * k * along + c * d * (Mat3::Identity() - along),
            .acts = true};
  }
};

class FaceContactForce final : public StencilForce<FaceLaw> {
 public:
  explicit FaceContactForce(const Constraints& constraints)
      : StencilForce([&constraints](const StepStart&, std::vector<Element>& found) {
          return find(constraints, found);
        }),
        constraints_(constraints) {}

  bool from_contact() const override { return true; }
  // The edges of all triangles are listed, because other triangles touch in every step.
  void list_pairs(std::vector<ParticlePair>& pairs) const override {
    for (const ClothFace& face : constraints_.faces().all())
      for (std::size_t k = 0; k < 3; ++k) pairs.push_back({face.particles[k], face.particles[(k + 1) % 3]});
  }

 private:
  static bool find(const Constraints& constraints, std::vector<Element>& found) {
    const bool were = !found.empty();
    found.clear();
    for (const FaceContact& contact : constraints.faces().touching())
      found.push_back({.particles = contact.particles, .rest = &contact});
    return were || !found.empty();
  }

  const Constraints& constraints_;
};

}  // namespace

std::unique_ptr<Force> face_contact_force(const Constraints& constraints) {
  return std::make_unique<FaceContactForce>(constraints);
}

}  // namespace drape
