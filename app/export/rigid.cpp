#include "app/export/rigid.h"

#include <Eigen/SVD>

namespace drape::app {
namespace {

constexpr double tolerance = 1e-6;  // of the shape's size

Eigen::Matrix3Xd columns(const std::vector<Vec3>& positions) {
  Eigen::Matrix3Xd matrix(3, static_cast<Eigen::Index>(positions.size()));
  for (std::size_t i = 0; i < positions.size(); ++i) matrix.col(static_cast<Eigen::Index>(i)) = positions[i];
  return matrix;
}

}  // namespace

std::optional<std::vector<RigidPlace>> rigid_places(const ExportSource& source, std::size_t s) {
  Eigen::Matrix3Xd first = columns(source.positions(s, 0));
  const Vec3 start = first.rowwise().mean();
  first.colwise() -= start;
  const double size = first.colwise().norm().maxCoeff();
  std::vector<RigidPlace> places;
  for (std::size_t k = 0; k < source.frame_count(); ++k) {
    Eigen::Matrix3Xd now = columns(source.positions(s, k));
    const Vec3 centre = now.rowwise().mean();
    const double far = std::max(size, now.colwise().norm().maxCoeff());  // float32 is finer near the origin
    now.colwise() -= centre;
    const Mat3 turn = Eigen::umeyama(first, now, false).topLeftCorner<3, 3>();
    if (!((turn * first - now).colwise().norm().maxCoeff() <= tolerance * far)) return std::nullopt;
    Eigen::Quaterniond quaternion(turn);
    if (!places.empty() && places.back().turn.dot(quaternion) < 0) quaternion.coeffs() *= -1;
    places.push_back({centre, quaternion});
  }
  return places;
}

}  // namespace drape::app
