#include "solver/forces/cluster.h"

#include <algorithm>
#include <cmath>

#include "mesh/base/errors.h"
#include "mesh/base/parallel.h"

namespace drape {
namespace {

Vec3 at(const VecX& x, int particle) { return x.segment<3>(3 * particle); }

constexpr std::size_t fewest = 3;  // particles whose rotation is that of a body and not of a line

void check(const std::vector<int>& set, std::size_t number, const std::vector<double>& masses,
           const std::string& name) {
  const auto fail = [&](const std::string& what) {
    throw InputError(name + ": cluster " + std::to_string(number) + " " + what);
  };
  if (set.size() < fewest)
    fail("has " + std::to_string(set.size()) + (set.size() == 1 ? " particle" : " particles") +
         ", but a shape needs at least 3; ask for fewer clusters");
  std::vector<int> sorted = set;
  std::sort(sorted.begin(), sorted.end());
  if (sorted.front() < 0 || static_cast<std::size_t>(sorted.back()) >= masses.size())
    fail("names particle " + std::to_string(sorted.front() < 0 ? sorted.front() : sorted.back()) +
         ", but there are " + std::to_string(masses.size()) + ", from 0");
  if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end())
    fail("names particle " + std::to_string(*twice) + " twice");
  for (const int i : set)
    if (!(masses[i] > 0) || !std::isfinite(masses[i]))
      fail("has particle " + std::to_string(i) + ", whose mass is not positive");
}

}  // namespace

ClusterPose matched(std::span<const ClusterMember> cluster, const VecX& x, const Quaternion& last) {
  double weight = 0;
  Vec3 moment = Vec3::Zero();
  for (const ClusterMember& member : cluster) {
    weight += member.share;
    moment += member.share * at(x, member.particle);
  }
  ClusterPose pose{moment / weight, last};
  Mat3 A = Mat3::Zero();
  for (const ClusterMember& member : cluster)
    A += member.share * (at(x, member.particle) - pose.centre) * member.rest.transpose();
  pose.rotation = nearest_rotation(A, last);
  return pose;
}

double energy(std::span<const ClusterMember> cluster, const ClusterPose& pose, const VecX& x, double k) {
  double sum = 0;
  for (const ClusterMember& member : cluster)
    sum += member.share * (at(x, member.particle) - pose.goal(member)).squaredNorm();
  return k / 2 * sum;
}

double goal_share(double k, double h) {
  const double stiff = k * h * h;
  return std::isfinite(stiff) ? stiff / (1 + stiff) : 1;
}

void project(std::span<const ClusterMember> cluster, const ClusterPose& pose, double alpha, VecX& x) {
  for (const ClusterMember& member : cluster)
    x.segment<3>(3 * member.particle) +=
        alpha * member.share / member.mass * (pose.goal(member) - at(x, member.particle));
}

Clusters::Clusters(const std::vector<std::vector<int>>& sets, const std::vector<double>& masses,
                   const VecX& rest, const std::string& name) {
  std::vector<int> clusters_of(masses.size(), 0);
  for (std::size_t c = 0; c < sets.size(); ++c) {
    check(sets[c], c, masses, name);
    for (const int i : sets[c]) ++clusters_of[i];
  }
  for (const std::vector<int>& set : sets) {
    double weight = 0;
    Vec3 centre = Vec3::Zero();
    for (const int i : set) {
      const double share = masses[i] / clusters_of[i];
      weight += share;
      centre += share * at(rest, i);
      members_.push_back({i, masses[i], share, at(rest, i)});
    }
    centre /= weight;
    for (std::size_t k = start_.back(); k < members_.size(); ++k) members_[k].rest -= centre;
    start_.push_back(members_.size());
  }
  list_places(static_cast<int>(masses.size()));
}

void Clusters::list_places(int particles) {
  places_start_.assign(static_cast<std::size_t>(particles) + 1, 0);
  for (const ClusterMember& member : members_) ++places_start_[member.particle + 1];
  for (std::size_t i = 1; i < places_start_.size(); ++i) places_start_[i] += places_start_[i - 1];
  std::vector<std::size_t> next(places_start_.begin(), places_start_.end() - 1);
  places_.resize(members_.size());
  for (int c = 0; c < count(); ++c)
    for (std::size_t k = start_[c]; k < start_[c + 1]; ++k) places_[next[members_[k].particle]++] = {c, k};
}

void Clusters::match(const VecX& x, std::vector<ClusterPose>& poses) const {
  parallel_for(heavy_chunk_count(count()), static_cast<int>(members_.size()) < serial_below(Work::heavy),
               [&](int chunk) {
                 const int end = std::min(count(), (chunk + 1) * heavy_chunk_size(count()));
                 for (int c = chunk * heavy_chunk_size(count()); c < end; ++c)
                   poses[c] = matched((*this)[c], x, poses[c].rotation);
               });
}

void Clusters::take_shapes(const Clusters& others, const std::vector<ClusterPose>& poses, double s,
                           const VecX& x) {
  parallel_for(heavy_chunk_count(count()), static_cast<int>(members_.size()) < serial_below(Work::heavy),
               [&](int chunk) {
                 const int end = std::min(count(), (chunk + 1) * heavy_chunk_size(count()));
                 for (int c = chunk * heavy_chunk_size(count()); c < end; ++c)
                   for (std::size_t k = start_[c]; k < start_[c + 1]; ++k) {
                     const Vec3 here =
                         poses[c].rotation.conjugate() * (at(x, members_[k].particle) - poses[c].centre);
                     members_[k].rest = others.members_[k].rest + s * (here - others.members_[k].rest);
                   }
               });
}

void Clusters::project(const std::vector<ClusterPose>& poses, double alpha, VecX& x) const {
  for_chunks<Work::heavy>(static_cast<int>(places_start_.size()) - 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const std::size_t first = places_start_[i], last = places_start_[i + 1];
      if (first == last) continue;
      Vec3 to_goals = Vec3::Zero();
      for (std::size_t p = first; p < last; ++p)
        to_goals += poses[places_[p].cluster].goal(members_[places_[p].member]) - at(x, i);
      x.segment<3>(3 * i) += alpha / static_cast<double>(last - first) * to_goals;
    }
  });
}

}  // namespace drape
