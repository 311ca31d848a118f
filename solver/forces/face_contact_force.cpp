#include "solver/forces/face_contact_force.h"

#include <algorithm>

namespace drape {
namespace {

class FaceContactForce final : public Force {
 public:
  explicit FaceContactForce(const Constraints& constraints) : constraints_(constraints) {}

  std::string_view name() const override { return "face-contact"; }

  void list_pairs(std::vector<ParticlePair>& pairs) const override {
    for (const ClothFace& face : constraints_.faces().all())
      for (std::size_t k = 0; k < 3; ++k) pairs.push_back({face.particles[k], face.particles[(k + 1) % 3]});
  }

  void bind(const BlockPattern& pattern) override { pattern_ = &pattern; }

  double energy(const VecX& x) const override {
    double sum = 0;
    for (const FaceContact& c : touching()) {
      const double g = std::min(c.gap_at(x), 0.0);
      sum += 0.5 * c.stiffness * g * g;
    }
    return sum;
  }

  double dissipation(const VecX&, const VecX& v) const override {
    double sum = 0;
    for (const FaceContact& c : touching()) sum += 0.5 * c.damper * c.slip_at(v).squaredNorm();
    return sum;
  }

  void add_force(const VecX& x, const VecX& v, VecX& f) const override {
    for (const FaceContact& c : touching()) spread(c, c.force_at(x, v), f);
  }

  void add_linearised(const VecX& x, const VecX& v, const VecX& y, double c, Stiffness stiffness,
                      BlockMatrix& A, VecX& b) const override {
    for (const FaceContact& contact : touching()) {
      const double g = contact.gap_at(x), d = contact.damper;
      const bool acts = stiffness == Stiffness::tangent ? g < 0 : contact.active;
      const double push = acts ? contact.stiffness * (g + contact.normal.dot(contact.at(y))) : 0;
      spread(contact, c * (-push * contact.normal - d * contact.slip_at(v)), b);
      const double k = acts || stiffness == Stiffness::majorant ? contact.stiffness : 0;
      const Mat3 along = contact.normal * contact.normal.transpose();
      add_blocks(contact, c * c * k * along + c * d * (Mat3::Identity() - along), A);
    }
  }

 private:
  const std::vector<FaceContact>& touching() const { return constraints_.faces().touching(); }

  static void spread(const FaceContact& c, const Vec3& force, VecX& f) {
    for (int k = 0; k < 3; ++k)
      f.segment<3>(3 * c.particles[static_cast<std::size_t>(k)]) += c.weights[k] * force;
  }

  void add_blocks(const FaceContact& c, const Mat3& block, BlockMatrix& A) const {
    std::array<int, 3> row;
    for (std::size_t k = 0; k < 3; ++k) row[k] = pattern_->row_of()[static_cast<std::size_t>(c.particles[k])];
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l)
        if (row[k] <= row[l])
          A.at(pattern_->slot(row[k], row[l])) +=
              c.weights[static_cast<int>(k)] * c.weights[static_cast<int>(l)] * block;
  }

  const Constraints& constraints_;
  const BlockPattern* pattern_ = nullptr;
};

}  // namespace

std::unique_ptr<Force> face_contact_force(const Constraints& constraints) {
  return std::make_unique<FaceContactForce>(constraints);
}

}  // namespace drape
