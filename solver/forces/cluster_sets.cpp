#include "solver/forces/cluster_sets.h"

#include <algorithm>
#include <limits>

#include "mesh/base/errors.h"
#include "mesh/base/words.h"
#include "mesh/triangles/topology.h"

namespace drape {

ParticleSets sets_of(const std::vector<std::array<int, 4>>& tetrahedra) {
  ParticleSets sets;
  for (const std::array<int, 4>& t : tetrahedra) sets.emplace_back(t.begin(), t.end());
  return sets;
}

ParticleSets sets_of_faces(const TriangleMesh& mesh) {
  ParticleSets sets;
  for (const int t : counted_triangles(mesh))
    sets.emplace_back(mesh.triangles[t].begin(), mesh.triangles[t].end());
  return sets;
}

ParticleSets sets_of_cells(const Lattice& lattice) {
  const int nx = lattice.cells[0], ny = lattice.cells[1], nz = lattice.cells[2];
  const auto corner = [&](int x, int y, int z) {
    return lattice.particle[static_cast<std::size_t>(x) +
                            static_cast<std::size_t>(nx + 1) *
                                (static_cast<std::size_t>(y) +
                                 static_cast<std::size_t>(ny + 1) * static_cast<std::size_t>(z))];
  };
  ParticleSets sets;
  std::size_t cell = 0;
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        if (!lattice.filled[cell++]) continue;
        std::vector<int> set;
        for (int k = 0; k < 8; ++k) set.push_back(corner(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)));
        sets.push_back(std::move(set));
      }
  return sets;
}

namespace {

class KMeans {
 public:
  KMeans(const std::vector<Vec3>& positions, int count, const std::string& name)
      : positions_(positions), nearest_(positions.size(), -1) {
    seed(count, name);
    constexpr int rounds = 100;  // where rounding lets a particle go back and forth between two centres
    for (int round = 0; round < rounds && assign(); ++round) move_centres();
  }

  ParticleSets sets() const {
    ParticleSets sets(centres_.size());
    for (std::size_t i = 0; i < nearest_.size(); ++i) sets[nearest_[i]].push_back(static_cast<int>(i));
    std::erase_if(sets, [](const std::vector<int>& set) { return set.empty(); });
    return sets;
  }

 private:
  void seed(int count, const std::string& name) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& x : positions_) middle += x / static_cast<double>(positions_.size());
    std::vector<double> distance(positions_.size());
    for (std::size_t i = 0; i < distance.size(); ++i) distance[i] = (positions_[i] - middle).squaredNorm();
    for (int c = 0; c < count; ++c) {
      const auto farthest = std::max_element(distance.begin(), distance.end());  // the first of equals
      if (farthest == distance.end() || (c > 0 && *farthest == 0))
        throw InputError(name + ": " + counted(count, "cluster") + " of " +
                         counted(static_cast<long>(positions_.size()), "particle") + " at " +
                         counted(c, "place") + "; a cluster needs a place of its own");
      centres_.push_back(positions_[farthest - distance.begin()]);
      for (std::size_t i = 0; i < distance.size(); ++i) {
        const double here = (positions_[i] - centres_.back()).squaredNorm();
        distance[i] = c == 0 ? here : std::min(distance[i], here);
      }
    }
  }

  // Sends every particle to its nearest centre; returns whether that changed anything.
  bool assign() {
    bool changed = false;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      int best = 0;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t c = 0; c < centres_.size(); ++c) {
        const double here = (positions_[i] - centres_[c]).squaredNorm();
        if (here < least) least = here, best = static_cast<int>(c);
      }
      changed = changed || best != nearest_[i];
      nearest_[i] = best;
    }
    return changed;
  }

  // A centre that is nearest to no particle stays where it is.
  void move_centres() {
    std::vector<int> size(centres_.size(), 0);
    std::vector<Vec3> sum(centres_.size(), Vec3::Zero());
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      sum[nearest_[i]] += positions_[i];
      ++size[nearest_[i]];
    }
    for (std::size_t c = 0; c < centres_.size(); ++c)
      if (size[c] > 0) centres_[c] = sum[c] / size[c];
  }

  const std::vector<Vec3>& positions_;
  std::vector<Vec3> centres_;
  std::vector<int> nearest_;  // the centre of each particle
};

// Adds to every set what is joined to it.
void grow(ParticleSets& sets, const std::vector<std::vector<int>>& joined) {
  for (std::vector<int>& set : sets) {
    const std::size_t own = set.size();
    for (std::size_t k = 0; k < own; ++k) {
      const std::vector<int>& others = joined[set[k]];
      set.insert(set.end(), others.begin(), others.end());
    }
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
  }
}

}  // namespace

ParticleSets overlapping_sets(const std::vector<Vec3>& positions,
                              const std::vector<std::pair<int, int>>& pairs, int count, int rings,
                              const std::string& name) {
  if (count < 1)
    throw InputError(name + ": clusters = " + std::to_string(count) + ", but at least 1 is needed");
  ParticleSets sets = KMeans(positions, count, name).sets();
  std::vector<std::vector<int>> joined(positions.size());
  for (const auto& [i, j] : pairs) {
    joined[i].push_back(j);
    joined[j].push_back(i);
  }
  for (int ring = 0; ring < rings; ++ring) grow(sets, joined);
  return sets;
}

}  // namespace drape
