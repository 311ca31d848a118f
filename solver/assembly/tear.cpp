// Cloth that is strained too far: its particles part, and the system is made anew.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>

#include "mesh/base/errors.h"
#include "mesh/obj/obj.h"
#include "mesh/obj/obj_tear.h"
#include "solver/assembly/assembly.h"
#include "solver/assembly/cloth_parts.h"
#include "solver/assembly/tear_rule.h"

namespace drape {

using internal::TearingCloth;

namespace {

double strain(const RestEdge& e, const VecX& x) {
  return (x.segment<3>(3 * e.j) - x.segment<3>(3 * e.i)).norm() / e.L - 1;
}

// Whether an edge is strained too far that may be cut in this step. pinned: particles, ascending. Copies
// nothing: where cloth draws back, or is held as far as it gives way, this is so for many steps.
bool may_tear(const Cloth& cloth, const State& state, const std::vector<int>& pinned) {
  const Tearing& tearing = *cloth.tearing;
  const auto draws_back = [&](int particle) {
    return internal::draws_back(particle - cloth.first_particle, tearing, state.time);
  };
  const auto may_part = [&](int particle) {
    return internal::may_part(particle - cloth.first_particle, tearing, state.time) &&
           !std::binary_search(pinned.begin(), pinned.end(), particle);
  };
  return std::any_of(cloth.edges.begin(), cloth.edges.end(), [&](const RestEdge& e) {
    return strain(e, state.x) > tearing.limit && !draws_back(e.i) && !draws_back(e.j) &&
           (may_part(e.i) || may_part(e.j));
  });
}

// A grid of quads stays one when only their sides are cut.
std::vector<CutEdge> diagonals_of_quads(const Cloth& cloth) {
  std::vector<CutEdge> all;
  const ObjDocument& document = *cloth.mesh.document;
  const auto particle = [&](std::size_t corner) {
    return cloth.embedding.particle(document.corners[corner].v) - cloth.first_particle;
  };
  for (std::size_t f = 0; f < document.face_count(); ++f)
    for (const std::size_t k : {document.face_start[f], document.face_start[f] + 1})
      all.push_back(std::minmax({particle(k), particle(k + 2)}));
  std::sort(all.begin(), all.end());
  return all;
}

// Of the triangles between particles, numbered from the first one: a cloth tears across its seams as anywhere
// else.
std::vector<CutEdge> edges_to_cut(const Cloth& cloth, const State& state, const std::vector<int>& pinned) {
  const int first = cloth.first_particle;
  const TriangleMesh between = internal::between_particles(cloth);
  const std::vector<Vec3> x =
      unstacked(state.x.segment(3 * first, 3 * static_cast<Eigen::Index>(between.positions.size())));
  TearingCloth torn{between, x, {}, std::vector<char>(x.size(), 0), {}};
  for (const RestEdge& e : cloth.edges) {
    const auto [a, b] = std::minmax({e.i - first, e.j - first});
    torn.edges.push_back({a, b, strain(e, state.x)});
  }
  for (const int particle : pinned)
    if (particle >= first && particle < cloth.end_particle)
      torn.held[static_cast<std::size_t>(particle - first)] = 1;
  if (cloth.model == ClothModel::choi_ko) torn.never_cut = diagonals_of_quads(cloth);
  return internal::edges_to_cut(std::move(torn), *cloth.tearing, state.time);
}

// The numbers that particles get where the copies of each part come after its particles.
Parting numbers_after(const std::vector<Cloth>& cloths, const std::vector<std::vector<int>>& copies,
                      int particles) {
  std::vector<int> order(cloths.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int k, int l) {
    return cloths[static_cast<std::size_t>(k)].end_particle <
           cloths[static_cast<std::size_t>(l)].end_particle;
  });
  Parting parting;
  const auto take_until = [&](int end) {
    for (int i = static_cast<int>(parting.number.size()); i < end; ++i) {
      parting.number.push_back(static_cast<int>(parting.source.size()));
      parting.source.push_back(i);
    }
  };
  for (const int k : order) {
    const Cloth& cloth = cloths[static_cast<std::size_t>(k)];
    take_until(cloth.end_particle);
    for (const int vertex : copies[static_cast<std::size_t>(k)])
      parting.source.push_back(cloth.first_particle + vertex);
  }
  take_until(particles);
  return parting;
}

// What a cloth becomes that is cut.
struct TornCloth {
  std::vector<Triangle> before;  // its triangles between particles, numbered from the first one
  TornTriangles particles;       // the same, torn
  TornMesh mesh;
};

TornCloth torn_cloth(const Cloth& cloth, const std::vector<CutEdge>& cuts) {
  const TriangleMesh between = internal::between_particles(cloth);
  TornTriangles particles = torn_triangles(between, cuts);
  TornMesh mesh = torn_mesh(cloth.mesh, divided_triangles(cloth.mesh, particles.triangles));
  return {between.triangles, std::move(particles), std::move(mesh)};
}

// Adds the triangles of a torn cloth that changed.
void add_faces(const Cloth& cloth, const TornCloth& torn, Parting& parting) {
  const int before = cloth.first_particle, now = parting.number[static_cast<std::size_t>(before)];
  for (std::size_t t = 0; t < torn.before.size(); ++t) {
    if (torn.before[t] == torn.particles.triangles[t]) continue;
    Parting::Face face{};
    for (std::size_t k = 0; k < 3; ++k)
      face.before[k] = before + torn.before[t][k], face.now[k] = now + torn.particles.triangles[t][k];
    parting.faces.push_back(face);
  }
}

// Gives a cloth whose particles have their new numbers its torn mesh and the copies after its particles. A
// vertex is the particle that its triangles are of.
void become(TornCloth torn, Cloth& cloth) {
  Embedding embedding;
  std::vector<int> particle(torn.mesh.mesh.positions.size(), -1);
  for (int v = 0; v < cloth.mesh.vertex_count(); ++v)
    particle[static_cast<std::size_t>(v)] = cloth.embedding.particle(v);
  for (std::size_t t = 0; t < torn.before.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      particle[static_cast<std::size_t>(torn.mesh.mesh.triangles[t][k])] =
          cloth.first_particle + torn.particles.triangles[t][k];
  for (const int p : particle) embedding.add_vertex(p);
  cloth.mesh = std::move(torn.mesh.mesh);
  cloth.embedding = std::move(embedding);
  cloth.end_particle += static_cast<int>(torn.particles.copy_of.size());
  std::vector<int>& copy_of = cloth.tearing->copy_of;
  copy_of.insert(copy_of.end(), torn.mesh.copy_of.begin(), torn.mesh.copy_of.end());
}

// kg, of the particles of a cloth, from the first one, by its triangles.
std::vector<double> particle_masses(const Cloth& cloth) {
  std::vector<double> masses(static_cast<std::size_t>(cloth.end_particle - cloth.first_particle), 0.0);
  const std::vector<double> of_vertices = internal::cloth_masses(cloth);
  for (std::size_t v = 0; v < of_vertices.size(); ++v)
    masses[static_cast<std::size_t>(cloth.embedding.particle(static_cast<int>(v)) - cloth.first_particle)] +=
        of_vertices[v];
  return masses;
}

[[noreturn]] void refuse(const Cloth& cloth, double limit, const std::string& why) {
  std::ostringstream message;
  message << cloth.name << ": tear = " << limit << ": " << why;
  throw InputError(message.str());
}

}  // namespace

// The cloth has its mesh and its edges already.
Tearing internal::tearing_of(const ClothPart& part, const Cloth& cloth) {
  const double limit = *part.tear;
  if (!(limit > 0) || !std::isfinite(limit))
    refuse(cloth, limit, "a strain above which cloth tears is finite and greater than zero");
  if (cloth.fabric.neighbour_weighting)
    refuse(cloth, limit,
           "with neighbour_weighting a tear would change the mass of the cloth; leave one of them out");
  const VecX x = stacked(cloth.mesh.positions);
  for (const RestEdge& e : cloth.edges) {
    const int a = e.i - cloth.first_particle, b = e.j - cloth.first_particle;
    const double s = strain({a, b, e.L}, x);
    if (s <= limit) continue;
    std::ostringstream why;
    why << "the edge between the vertices " << a << " and " << b << " (from 0) starts with a strain of " << s
        << "; give a higher limit, or a start that is nearer to the shape at rest";
    refuse(cloth, limit, why.str());
  }
  Tearing tearing;
  tearing.limit = limit;
  return tearing;
}

int Assembly::tear_cloths() {
  const auto tears = [&](const Cloth& cloth) {
    return cloth.tearing && may_tear(cloth, state, constraints->pinned());
  };
  if (std::none_of(cloths.begin(), cloths.end(), tears)) return 0;
  if (!state.x.allFinite() || !state.v.allFinite()) return 0;  // the step has failed
  std::vector<std::vector<CutEdge>> cuts(cloths.size());
  std::size_t count = 0;
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    if (tears(cloths[k])) cuts[k] = edges_to_cut(cloths[k], state, constraints->pinned());
    count += cuts[k].size();
  }
  if (count == 0) return 0;
  part_particles(cuts);
  return static_cast<int>(count);
}

void Assembly::part_particles(const std::vector<std::vector<CutEdge>>& cuts) {
  std::vector<TornCloth> torn(cloths.size());
  std::vector<std::vector<int>> copies(cloths.size());  // of particles
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    if (cuts[k].empty()) continue;
    torn[k] = torn_cloth(cloths[k], cuts[k]);
    copies[k] = torn[k].particles.copy_of;
  }
  Parting parting = numbers_after(cloths, copies, state.particles());
  for (std::size_t k = 0; k < cloths.size(); ++k) add_faces(cloths[k], torn[k], parting);
  std::sort(parting.faces.begin(), parting.faces.end(),
            [](const auto& f, const auto& g) { return f.before < g.before; });

  const auto count = static_cast<Eigen::Index>(parting.source.size());
  std::vector<double> masses(parting.source.size(), 0.0);
  for (std::size_t i = 0; i < parting.number.size(); ++i)
    masses[static_cast<std::size_t>(parting.number[i])] = system->masses()[i];
  State parted{state.time, VecX(3 * count), VecX(3 * count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const int original = parting.source[static_cast<std::size_t>(i)];
    parted.x.segment<3>(3 * i) = state.x.segment<3>(3 * original);
    parted.v.segment<3>(3 * i) = state.v.segment<3>(3 * original);
  }
  std::swap(state, parted);
  if (keep_outgrown) outgrown.push_back(std::move(parted));
  constraints->part(parting);
  for (Cloth& cloth : cloths) cloth.renumber(parting.number);
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    if (cuts[k].empty()) continue;
    Cloth& cloth = cloths[k];
    become(std::move(torn[k]), cloth);
    // A copy has the mass of its triangles, and what is left stays with its original: what else hangs there,
    // too.
    const std::vector<double> of_triangles = particle_masses(cloth);
    internal::note_cuts(cuts[k], copies[k], state.time, of_triangles.size(), *cloth.tearing);
    for (std::size_t c = 0; c < copies[k].size(); ++c) {
      const std::size_t local = of_triangles.size() - copies[k].size() + c;
      const auto copy = static_cast<std::size_t>(cloth.first_particle) + local;
      masses[copy] = of_triangles[local];
      masses[static_cast<std::size_t>(cloth.first_particle + copies[k][c])] -= masses[copy];
    }
  }
  Forces forces;
  for (Cloth& cloth : cloths) connect(cloth, forces);
  make_system(std::move(masses), std::move(forces));
  integrator = make_integrator(*system, *constraints);
}

}  // namespace drape
