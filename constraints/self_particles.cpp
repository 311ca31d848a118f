// Which particles, triangles and segments take part in contact of cloth and cloth, and what becomes of them
// when particles are numbered anew (constraints/self_contact.h).
#include <algorithm>
#include <map>
#include <numeric>

#include "constraints/encounters.h"
#include "constraints/rope_rest.h"
#include "constraints/self_contact.h"
#include "constraints/surfaces.h"
#include "constraints/tangles.h"
#include "mesh/triangles/topology.h"

namespace drape {

using namespace internal;

void SelfContacts::add(const std::vector<SelfFace>& faces) {
  faces_.insert(faces_.end(), faces.begin(), faces.end());
  begin_anew();
}

void SelfContacts::add(const std::vector<SelfSegment>& segments) {
  segments_.insert(segments_.end(), segments.begin(), segments.end());
  begin_anew();
}

void SelfContacts::begin_anew() {
  stale_ = true;
  rest_.resize(0);
  tangled_.clear();
}

void SelfContacts::renumber(const std::vector<int>& particle_of) {
  for (SelfFace& face : faces_)
    for (int& particle : face.particles) particle = particle_of[particle];
  std::erase_if(faces_, [](const SelfFace& face) {
    const auto [a, b, c] = face.particles;
    return a == b || b == c || c == a;
  });
  for (SelfSegment& segment : segments_)
    for (int& particle : segment.particles) particle = particle_of[particle];
  std::erase_if(segments_,
                [](const SelfSegment& segment) { return segment.particles[0] == segment.particles[1]; });
  if (rest_.size() > 0) {
    const VecX before = rest_;
    for (std::size_t i = particle_of.size(); i-- > 0;)
      rest_.segment<3>(3 * particle_of[i]) = before.segment<3>(3 * static_cast<Eigen::Index>(i));
    const std::vector<char> were = tangled_;
    std::fill(tangled_.begin(), tangled_.end(), 0);
    for (std::size_t i = 0; i < were.size(); ++i)
      if (were[i] != 0) tangled_[particle_of[i]] = 1;
    rest_.conservativeResize(3 * (1 + *std::max_element(particle_of.begin(), particle_of.end())));
    if (!were.empty()) tangled_.resize(static_cast<std::size_t>(rest_.size() / 3));
  }
  stopped_.clear();
  touching_.clear();
  last_.clear();
  stale_ = true;
}

// How near the sides of a cut are at rest says nothing of their thickness: they are one place there, and only
// the guard would keep them apart, by holding them together.
void SelfContacts::part(const Parting& parting) {
  for (SelfFace& face : faces_) face.particles = parting.face(face.particles);
  for (SelfSegment& segment : segments_)
    for (int& particle : segment.particles) particle = parting.number[static_cast<std::size_t>(particle)];
  if (rest_.size() > 0) {
    const VecX rest = rest_;
    const std::vector<char> tangled = tangled_;
    rest_.resize(3 * static_cast<Eigen::Index>(parting.source.size()));
    tangled_.resize(parting.source.size());
    std::vector<int> parts(parting.number.size(), 0);
    for (std::size_t i = 0; i < parting.source.size(); ++i) {
      const int original = parting.source[i];
      rest_.segment<3>(3 * static_cast<Eigen::Index>(i)) = rest.segment<3>(3 * original);
      tangled_[i] = tangled.at(static_cast<std::size_t>(original));
      ++parts[static_cast<std::size_t>(original)];
    }
    const auto is_cut = [&](int i) {
      return parts[static_cast<std::size_t>(parting.source[static_cast<std::size_t>(i)])] > 1;
    };
    for (const SelfFace& face : faces_)
      if (std::any_of(face.particles.begin(), face.particles.end(), is_cut))
        for (const int i : face.particles) tangled_[static_cast<std::size_t>(i)] = 1;
  }
  if (!stopped_.empty()) {
    const std::vector<char> stopped = stopped_;
    stopped_.clear();
    for (const int original : parting.source) stopped_.push_back(stopped[static_cast<std::size_t>(original)]);
  }
  touching_.clear();
  last_.clear();
  stale_ = true;
}

void SelfContacts::sew(const std::vector<SewnPair>& pairs) {
  sewn_.clear();
  pass_.clear();
  const auto mark = [](int particle, std::vector<char>& marks) {
    if (static_cast<std::size_t>(particle) >= marks.size())
      marks.resize(static_cast<std::size_t>(particle) + 1, 0);
    marks[particle] = 1;
  };
  for (const SewnPair& pair : pairs)
    for (int particle : {pair.a, pair.b}) {
      mark(particle, sewn_);
      if (pair.may_pass) mark(particle, pass_);
    }
}

void SelfContacts::set_particles(const StepMotion& step) {
  const auto n = static_cast<std::size_t>(step.x.size() / 3);
  const int cloth = cloth_particles();
  if (rest_.size() != 3 * cloth) rest_ = step.x.head(3 * cloth);
  TriangleMesh mesh;
  mesh.positions.assign(n, Vec3::Zero());
  thickness_.assign(n, 0);
  friction_.assign(n, 0);
  sheet_.assign(n, 0);
  const auto take = [&](const std::vector<SelfFace>& faces) {
    for (const SelfFace& face : faces) {
      mesh.triangles.push_back(face.particles);
      for (int particle : face.particles) {
        thickness_[particle] = std::max(thickness_[particle], face.thickness);
        friction_[particle] = std::max(friction_[particle], face.friction);
        sheet_[particle] = face.sheet;
      }
    }
  };
  std::vector<std::array<int, 2>> segments;
  for (const SelfSegment& segment : segments_) {
    segments.push_back(segment.particles);
    for (int particle : segment.particles) {
      thickness_[particle] = segment.thickness;
      friction_[particle] = segment.friction;
      sheet_[particle] = segment.sheet;
    }
  }
  for (const SelfFace& face : faces_)  // where a rope is joined to them
    for (int particle : face.particles) thickness_[particle] = friction_[particle] = 0;
  take(faces_);
  encounters_->set(mesh.triangles, segments, cloth, mesh.triangles.size(), step.x);
  if (surfaces_->any()) {
    take(surfaces_->faces());
    if (faces_.empty()) {  // ropes alone, which meet bodies otherwise
      on_bodies_->set({}, {}, 0, 0, step.x);
    } else {
      std::vector<char> still(n);
      for (std::size_t i = 0; i < n; ++i) still[i] = surfaces_->is_still(static_cast<int>(i));
      on_bodies_->set(mesh.triangles, {}, static_cast<int>(n), faces_.size(), step.x, still);
    }
  }
  piece_ = connected_pieces(mesh);
  find_pieces_to_stand();
  ropes_->set(segments_, faces_, rest_, static_cast<int>(n));
  way_.assign(n, 1);
  nearest_.assign(n, 0);
  limits_.assign(n, 0);
}

// Pieces hang together by faces, and by the segments of ropes. A particle inside a soft body has neither, and
// is numbered between those of its surface.
void SelfContacts::find_pieces_to_stand() {
  std::vector<int> root(piece_.size());  // by piece
  std::iota(root.begin(), root.end(), 0);
  const auto root_of = [&](int piece) {
    while (root[piece] != piece) piece = root[piece] = root[root[piece]];
    return piece;
  };
  piece_to_stand_.assign(piece_.size(), -1);
  std::map<int, std::pair<int, int>> range;  // of each sheet, its first and its last particle
  const auto take = [&](const auto& element) {
    for (const int v : element.particles) {
      root[root_of(piece_[v])] = root_of(piece_[element.particles[0]]);
      const auto at = range.try_emplace(element.sheet, v, v).first;
      at->second = {std::min(at->second.first, v), std::max(at->second.second, v)};
      piece_to_stand_[v] = 0;
    }
  };
  for (const SelfFace& face : faces_) take(face);
  for (const SelfSegment& segment : segments_) take(segment);
  for (int v = 0; v < cloth_particles(); ++v) {
    if (piece_to_stand_[v] == 0) {
      piece_to_stand_[v] = root_of(piece_[v]);
      continue;
    }
    for (const auto& [sheet, ends] : range)
      if (ends.first < v && v < ends.second) piece_to_stand_[v] = root_of(piece_[ends.first]);
  }
}

}  // namespace drape
