#include "solver/assembly/cloth.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace drape {
namespace {

// What particle first + k has, number[first + k] - low has from now on: the most where several become one.
template <class Value>
void follow(const std::vector<int>& number, int first, int low, std::vector<Value>& by_particle) {
  const std::vector<Value> before = std::exchange(by_particle, {});
  for (std::size_t k = 0; k < before.size(); ++k) {
    const auto to = static_cast<std::size_t>(number[static_cast<std::size_t>(first) + k] - low);
    if (to >= by_particle.size()) by_particle.resize(to + 1);
    by_particle[to] = std::max(by_particle[to], before[k]);
  }
}

}  // namespace

void Cloth::renumber(const std::vector<int>& number) {
  embedding.renumber(number);
  for (RestEdge& e : edges) {
    e.i = number[e.i];
    e.j = number[e.j];
  }
  int low = number[first_particle], high = low;
  for (int i = first_particle; i < end_particle; ++i) {
    low = std::min(low, number[i]);
    high = std::max(high, number[i]);
  }
  if (tearing) {
    follow(number, first_particle, low, tearing->at_cut);
    follow(number, first_particle, low, tearing->rests_until);
  }
  first_particle = low;
  end_particle = high + 1;
}

double largest_strain(const std::vector<Cloth>& cloths, const VecX& x) {
  double largest = 0;
  for (const Cloth& cloth : cloths)
    for (const RestEdge& e : cloth.edges)
      largest = std::max(largest, (x.segment<3>(3 * e.j) - x.segment<3>(3 * e.i)).norm() / e.L - 1);
  return largest;
}

std::optional<PrincipalStrains> principal_strains(const Cloth& cloth, std::size_t triangle, const VecX& x) {
  const auto metric = [](const Vec3& a, const Vec3& b, const Vec3& c) {
    Eigen::Matrix<double, 3, 2> edges;
    edges << b - a, c - a;
    return Eigen::Matrix2d(edges.transpose() * edges);
  };
  const Triangle &r = cloth.rest.triangles[triangle], &v = cloth.mesh.triangles[triangle];
  const auto particle = [&](std::size_t k) { return cloth.embedding.particle(v[k]); };
  if (particle(0) == particle(1) || particle(1) == particle(2) || particle(2) == particle(0)) return {};
  const auto rest = [&](std::size_t k) { return cloth.rest.positions[static_cast<std::size_t>(r[k])]; };
  const auto now = [&](std::size_t k) { return Vec3(x.segment<3>(3 * particle(k))); };
  const Eigen::Matrix2d before = metric(rest(0), rest(1), rest(2)), after = metric(now(0), now(1), now(2));
  const double twice = before.determinant();
  if (!(twice > 1e-18 * before.trace() * before.trace())) return {};
  // The squares of the factors are the eigenvalues of before^-1 after.
  const double mean =
      0.5 * (before(1, 1) * after(0, 0) + before(0, 0) * after(1, 1) - 2 * before(0, 1) * after(0, 1)) /
      twice;
  const double off = std::sqrt(std::max(0.0, mean * mean - after.determinant() / twice));
  return PrincipalStrains{.least = std::sqrt(std::max(0.0, mean - off)) - 1,
                          .largest = std::sqrt(mean + off) - 1,
                          .area = 0.5 * std::sqrt(std::max(0.0, after.determinant())),
                          .area_at_rest = 0.5 * std::sqrt(twice)};
}

TriangleStrains triangle_strains(const std::vector<Cloth>& cloths, const VecX& x,
                                 std::vector<double>& smallest) {
  TriangleStrains all;
  double area = 0, area_at_rest = 0;
  smallest.clear();
  for (const Cloth& cloth : cloths) {
    for (std::size_t t = 0; !cloth.soft && t < cloth.mesh.triangles.size(); ++t) {
      const std::optional<PrincipalStrains> strains = principal_strains(cloth, t, x);
      if (!strains) continue;
      area += strains->area;
      area_at_rest += strains->area_at_rest;
      all.area_least = std::min(all.area_least, strains->area / strains->area_at_rest);
      smallest.push_back(strains->least);
      all.largest = std::max(all.largest, strains->largest);
    }
  }
  if (smallest.empty()) return all;
  const auto hundredth = smallest.begin() + static_cast<std::ptrdiff_t>(smallest.size() / 100);
  std::nth_element(smallest.begin(), hundredth, smallest.end());
  all.first_percent = *hundredth;
  all.least = std::min(0.0, *std::min_element(smallest.begin(), hundredth + 1));
  all.area_kept = area / area_at_rest;
  return all;
}

void particle_strains(const Cloth& cloth, const VecX& x, std::vector<double>& strain) {
  strain.assign(static_cast<std::size_t>(x.size() / 3), 0);
  const auto widen = [&](int particle, double value) {
    double& here = strain[static_cast<std::size_t>(particle)];
    if (std::abs(value) > std::abs(here)) here = value;
  };
  if (cloth.soft || cloth.model != ClothModel::woven) {
    for (const RestEdge& e : cloth.edges) {
      const double value = (x.segment<3>(3 * e.j) - x.segment<3>(3 * e.i)).norm() / e.L - 1;
      for (const int i : {e.i, e.j}) widen(i, value);
    }
    return;
  }
  for (std::size_t t = 0; t < cloth.mesh.triangles.size(); ++t)
    if (const std::optional<PrincipalStrains> strains = principal_strains(cloth, t, x))
      for (const int vertex : cloth.mesh.triangles[t])
        for (const double value : {strains->least, strains->largest})
          widen(cloth.embedding.particle(vertex), value);
}

std::vector<int> pinned_particles(const PinRule& rule, const Cloth& cloth, const VecX& x) {
  std::vector<int> particles;
  if (cloth.soft && std::holds_alternative<PinBox>(rule)) {
    TriangleMesh points;  // the particles themselves
    points.positions =
        unstacked(x.segment(3 * cloth.first_particle, 3 * (cloth.end_particle - cloth.first_particle)));
    particles = select(rule, points);
    for (int& p : particles) p += cloth.first_particle;
    return particles;
  }
  for (int v : select(rule, cloth.mesh))
    for (const Embedding::Share& share : cloth.embedding.shares(v)) particles.push_back(share.particle);
  std::sort(particles.begin(), particles.end());
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  return particles;
}

}  // namespace drape
