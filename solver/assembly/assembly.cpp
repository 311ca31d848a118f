#include "solver/assembly/assembly.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "mesh/base/errors.h"
#include "mesh/base/words.h"
#include "mesh/obj/obj_groups.h"
#include "mesh/triangles/extent.h"
#include "mesh/triangles/normals.h"
#include "mesh/triangles/topology.h"
#include "solver/assembly/cloth_parts.h"
#include "solver/assembly/coincident.h"
#include "solver/assembly/imperfection.h"
#include "solver/assembly/soft_forces.h"
#include "solver/forces/choi_ko.h"
#include "solver/forces/face_clusters.h"
#include "solver/forces/face_contact_force.h"
#include "solver/forces/noh_jung.h"
#include "solver/forces/self_contact_force.h"
#include "solver/forces/woven.h"

namespace drape {

TriangleMesh internal::between_particles(const Cloth& cloth) {
  TriangleMesh mesh = cloth.mesh;
  for (Triangle& t : mesh.triangles)
    for (int& v : t) v = cloth.embedding.particle(v) - cloth.first_particle;
  mesh.positions.resize(static_cast<std::size_t>(cloth.end_particle - cloth.first_particle));
  for (int v = cloth.mesh.vertex_count(); v-- > 0;)  // the first vertex of a particle comes last
    mesh.positions[cloth.embedding.particle(v) - cloth.first_particle] = cloth.mesh.positions[v];
  return mesh;
}

namespace {

Connections connections_of(const Cloth& cloth, const TriangleMesh& mesh) {
  return cloth.model == ClothModel::choi_ko ? choi_ko_connections(mesh, cloth.rest, cloth.fabric)
                                            : noh_jung_connections(mesh, cloth.rest, cloth.fabric);
}

}  // namespace

std::vector<double> internal::cloth_masses(const Cloth& cloth) {
  const double density = cloth.fabric.area_density;
  std::vector<double> masses = cloth.model == ClothModel::choi_ko
                                   ? choi_ko_mass(cloth.mesh, cloth.rest, density)
                                   : lumped_mass(cloth.mesh, cloth.rest, density);
  if (!cloth.fabric.neighbour_weighting || cloth.model == ClothModel::woven) return masses;
  return neighbour_weighted(std::move(masses), connections_of(cloth, cloth.mesh));
}

namespace {

// The edges of a woven cloth, from its first particle; where two triangles differ about a length, the
// first's.
std::vector<RestEdge> rest_edges(const Cloth& cloth, const TriangleMesh& mesh) {
  std::vector<RestEdge> all;
  for (int t : counted_triangles(mesh))
    for (std::size_t k = 0; k < 3; ++k) {
      const auto number = static_cast<std::size_t>(t);
      const Triangle &v = mesh.triangles[number], &r = cloth.rest.triangles[number];
      const auto& rest = cloth.rest.positions;
      const double L =
          (rest[static_cast<std::size_t>(r[k])] - rest[static_cast<std::size_t>(r[(k + 1) % 3])]).norm();
      const auto [i, j] = std::minmax(v[k], v[(k + 1) % 3]);
      if (L > 0) all.push_back({cloth.first_particle + i, cloth.first_particle + j, L});
    }
  const auto ends = [](const RestEdge& e) { return std::pair(e.i, e.j); };
  std::stable_sort(all.begin(), all.end(), [&](const auto& a, const auto& b) { return ends(a) < ends(b); });
  all.erase(
      std::unique(all.begin(), all.end(), [&](const auto& a, const auto& b) { return ends(a) == ends(b); }),
      all.end());
  return all;
}

void append(std::vector<std::unique_ptr<Force>> more, std::vector<std::unique_ptr<Force>>& forces) {
  std::move(more.begin(), more.end(), std::back_inserter(forces));
}

void refuse(const MeshReport& report, const std::string& name) {
  for (const Defect& defect : report.defects)
    if (defect.severity == Severity::refusal) throw InputError(name + ": " + format(defect));
}

void check_rest(const Cloth& cloth) {
  if (cloth.rest.triangles.size() == cloth.mesh.triangles.size()) return;
  throw InputError(cloth.name + ": the rest shape has " + std::to_string(cloth.rest.triangles.size()) +
                   " triangles and the mesh " + std::to_string(cloth.mesh.triangles.size()) +
                   "; triangle k of the one is triangle k of the other");
}

void check_self_contact(const Cloth& cloth, const SelfContactOptions& options) {
  const double size = box_of(cloth.mesh.positions).diagonal().norm();
  if (!(options.thickness > 0) || !(options.thickness < size))
    throw InputError(cloth.name + ": thickness = " + std::to_string(options.thickness) +
                     " m; expected more than 0 and less than the cloth's own size");
  if (!(options.friction >= 0) || !std::isfinite(options.friction))
    throw InputError(cloth.name + ": friction = " + std::to_string(options.friction) +
                     ": it is finite and not negative");
}

double imperfection_of(const Cloth& cloth, const std::optional<double>& given) {
  const double amplitude = given.value_or(cloth.model == ClothModel::woven ? woven_imperfection : 0);
  if (!(amplitude >= 0) || !std::isfinite(amplitude))
    throw InputError(cloth.name + ": imperfection = " + std::to_string(amplitude) +
                     " m: it is finite and not negative");
  return amplitude;
}

// Of Cloth::at_one_place. Grids stay as they are.
std::vector<std::pair<int, int>> at_one_place(const ClothPart& part, const Cloth& cloth) {
  if (cloth.model == ClothModel::choi_ko) {
    if (!part.weld) return {};
    throw InputError(
        cloth.name +
        ": weld: the springs of \"choi-ko\" are those of a grid; weld the mesh itself in a modeller");
  }
  std::vector<std::pair<int, int>> pairs;
  if (part.self_contact) pairs = internal::joined_at_one_place(cloth.mesh, cloth.rest);
  if (!part.weld) return pairs;
  if (const int layers = internal::triangles_on_others(cloth.mesh); layers > 0)
    throw InputError(
        cloth.name + ": weld: " + std::to_string(layers) +
        " triangles lie on others with their corners at the same places, such as those of a copied layer, "
        "and would become one with them; weld the seams in a modeller");
  const std::vector<std::pair<int, int>> welded = internal::all_at_one_place(cloth.mesh);
  pairs.insert(pairs.end(), welded.begin(), welded.end());
  return pairs;
}

// Calls set(triangle, group) for the triangles of these groups of the mesh, none of which is in two.
template <class Group, class Set>
void by_group(const TriangleMesh& mesh, const std::string& key, const std::vector<Group>& groups,
              const Set& set) {
  std::vector<const std::string*> from(static_cast<std::size_t>(mesh.triangle_count()), nullptr);
  for (const Group& group : groups) {
    const std::vector<int> triangles = internal::triangles_of_group(mesh, group.group);
    if (triangles.empty()) {
      Names known;
      for (const VertexGroup& one : mesh.groups) known.push_back(one.name);
      throw InputError(key + ": the mesh has no faces in a group '" + group.group + "'; " +
                       suggestion(group.group, known));
    }
    for (int t : triangles) {
      const auto k = static_cast<std::size_t>(t);
      if (from[k])
        throw InputError(key + ": triangle " + std::to_string(t + 1) + " is in the groups '" + *from[k] +
                         "' and '" + group.group + "'; name one of them");
      from[k] = &group.group;
      set(k, group);
    }
  }
}

// The warp of each triangle: that of its group, else that of the cloth.
std::vector<Vec3> warps_of(const ClothPart& part, const Cloth& cloth) {
  if (cloth.model != ClothModel::woven) return {};
  std::vector<Vec3> warps(static_cast<std::size_t>(cloth.mesh.triangle_count()),
                          part.warp.value_or(Vec3::Zero()));
  by_group(cloth.mesh, "warp", part.group_warps,
           [&](std::size_t t, const GroupWarp& group) { warps[t] = group.direction; });
  return warps;
}

// The layer of each triangle in the same way; unset where none is given.
using Layers = std::vector<std::optional<int>>;
Layers layers_of(const std::optional<SelfContactOptions>& options, const TriangleMesh& mesh) {
  Layers layers(static_cast<std::size_t>(mesh.triangle_count()));
  if (!options) return layers;
  std::fill(layers.begin(), layers.end(), options->layer);
  by_group(mesh, "layer", options->group_layers,
           [&](std::size_t t, const SelfContactOptions::Group& group) { layers[t] = group.layer; });
  return layers;
}

// Where the cloth starts: off its mesh by its imperfection, and by its layers. A vertex of several layers
// belongs to the lowest. Where none is given, what lies below at exactly the same place counts (`below`, by
// vertex), half a layer lower than layers that are given, so that both kinds stay apart.
std::vector<Vec3> start_of(const Cloth& cloth, const Layers& layers, const std::vector<int>& below) {
  std::vector<Vec3> positions = cloth.mesh.positions;
  if (cloth.imperfection > 0) {
    const std::vector<Vec3> moved = imperfection(cloth.mesh, cloth.rest, cloth.imperfection);
    for (std::size_t v = 0; v < positions.size(); ++v) positions[v] += moved[v];
  }
  constexpr double apart = 5e-6;  // m
  std::vector<std::optional<int>> lowest(positions.size());
  for (std::size_t t = 0; t < layers.size(); ++t)
    for (int v : cloth.mesh.triangles[t])
      if (layers[t] && (!lowest[v] || *layers[t] < *lowest[v])) lowest[v] = layers[t];
  std::vector<double> out(positions.size(), 0);
  for (std::size_t v = 0; v < out.size(); ++v)
    out[v] = apart * (lowest[v] ? *lowest[v] : v < below.size() && below[v] > 0 ? below[v] - 0.5 : 0);
  if (std::all_of(out.begin(), out.end(), [](double way) { return way == 0; })) return positions;
  const std::vector<Vec3> normals = vertex_normals(cloth.mesh);
  for (std::size_t v = 0; v < positions.size(); ++v) positions[v] += out[v] * normals[v];
  return positions;
}

}  // namespace

Assembly::Assembly(const Vec3& gravity, ContactOptions contact, std::optional<Air> air)
    : constraints(std::make_unique<Constraints>(contact)), gravity_(gravity), air_(std::move(air)) {}

// Appends the particles of the part to those that are there.
Cloth& Assembly::take(Cloth cloth, const std::vector<Vec3>& positions, const std::vector<double>& masses) {
  masses_.insert(masses_.end(), masses.begin(), masses.end());
  const VecX own = stacked(positions);
  state.x.conservativeResize(state.x.size() + own.size());
  state.x.tail(own.size()) = own;
  state.v = VecX::Zero(state.x.size());
  cloths.push_back(std::move(cloth));
  return cloths.back();
}

Cloth& Assembly::add(ClothPart part) {
  if (system) throw InputError(part.name + ": is added after use(); add all cloths before it");
  Cloth cloth;
  cloth.name = std::move(part.name);
  cloth.mesh = std::move(part.mesh);
  cloth.rest = part.rest ? std::move(*part.rest) : cloth.mesh;
  cloth.report = part.report ? std::move(*part.report) : examine(cloth.mesh);
  refuse(cloth.report, cloth.name);
  check_rest(cloth);
  cloth.fabric = part.fabric;
  cloth.model = part.model;
  cloth.warp = warps_of(part, cloth);
  cloth.face_clusters = part.clusters;
  if (cloth.face_clusters && cloth.model == ClothModel::choi_ko)
    throw InputError(
        cloth.name +
        ": the springs of \"choi-ko\" are those of a grid, not of faces; faces that are clusters go "
        "with \"noh-jung\" and \"woven\"");
  if (cloth.fabric.weave.rest_angle > 0 && !part.seams.empty())
    throw InputError(cloth.name +
                     ": rest_angle: where panels are sewn the mesh has no angle; expected 0 with seams");
  if (cloth.model == ClothModel::choi_ko && !part.seams.empty())
    throw InputError(cloth.name +
                     ": seams: the springs of \"choi-ko\" are those of a grid, which cannot be sewn");
  cloth.imperfection = imperfection_of(cloth, part.imperfection);
  for (OpenSeam& seam : open_seams(part.seams, cloth.fabric, cloth.mesh, cloth.rest))
    cloth.seams.push_back({std::move(seam), nullptr});
  cloth.first_particle = state.particles();
  cloth.end_particle = cloth.first_particle + cloth.mesh.vertex_count();
  cloth.embedding = Embedding::each(cloth.first_particle, cloth.mesh.vertex_count());

  cloth.at_one_place = at_one_place(part, cloth);

  const std::vector<double> masses = internal::cloth_masses(cloth);
  connect(cloth, forces_);
  if (part.tear) cloth.tearing = internal::tearing_of(part, cloth);
  const int first = cloth.first_particle;
  const double stiffness = cloth.fabric.stretch_spring.value_or(mean_stretch(cloth.fabric));
  std::vector<Triangle> faces = cloth.mesh.triangles;
  for (Triangle& t : faces) {
    for (int& v : t) v += first;
    faces_.push_back({t, stiffness});
  }
  const Layers layers = layers_of(part.self_contact, cloth.mesh);
  if (part.self_contact) meet(cloth, *part.self_contact, faces, layers);
  const std::vector<Vec3> positions = start_of(
      cloth, layers, part.self_contact ? internal::layers_below(cloths, cloth.mesh) : std::vector<int>{});
  return take(std::move(cloth), positions, masses);
}

// Lets triangles of the next cloth take part in contact of cloth and cloth; faces: between particles.
void Assembly::meet(const Cloth& cloth, const SelfContactOptions& options, const std::vector<Triangle>& faces,
                    const std::vector<std::optional<int>>& layers) {
  check_self_contact(cloth, options);
  for (std::size_t k = 0; k < faces.size(); ++k)
    self_.push_back(
        {faces[k], options.thickness, options.friction, static_cast<int>(cloths.size()), layers[k]});
}

void Assembly::set_friction(std::size_t k, std::size_t l, double friction) {
  const Cloth &first = cloths.at(k), &second = cloths.at(l);
  if (!(friction >= 0) || !std::isfinite(friction))
    throw InputError("friction between " + first.name + " and " + second.name + " = " +
                     std::to_string(friction) + ": it is finite and not negative");
  constraints->set_self_friction({static_cast<int>(k), static_cast<int>(l), friction});
}

void Assembly::pin(const PinRule& rule, std::size_t k) {
  constraints->pin(pinned_particles(rule, cloths.at(k), state.x));
}

void Assembly::connect(Cloth& cloth, Forces& forces) const {
  if (cloth.soft) return append(internal::soft_forces(cloth), forces);
  if (cloth.rope) {
    std::vector<int> particles;
    particles.reserve(cloth.mesh.positions.size());
    for (int v = 0; v < cloth.mesh.vertex_count(); ++v) particles.push_back(cloth.embedding.particle(v));
    return append(rope_forces(cloth.rest.positions, particles, *cloth.rope), forces);
  }
  const TriangleMesh mesh = internal::between_particles(cloth);
  if (cloth.model == ClothModel::woven) {
    if (!cloth.memory) cloth.memory = std::make_shared<BendMemory>();
    append(
        cloth.face_clusters
            ? clustered_woven(mesh, cloth.rest, cloth.fabric, cloth.warp, cloth.first_particle, cloth.memory)
            : woven(mesh, cloth.rest, cloth.fabric, cloth.warp, cloth.first_particle, cloth.memory),
        forces);
    cloth.edges = rest_edges(cloth, mesh);
  } else {
    const Connections connections = connections_of(cloth, mesh);
    cloth.limp_below = limp_below(connections, cloth.fabric);
    cloth.edges.clear();
    for (const StretchConnection& s : connections.stretch)
      if (s.L > 0) cloth.edges.push_back({cloth.first_particle + s.i, cloth.first_particle + s.j, s.L});
    append(cloth.face_clusters ? clustered_noh_jung(mesh, cloth.rest, cloth.fabric, cloth.first_particle)
                               : forces_of(connections, cloth.fabric, cloth.first_particle),
           forces);
  }
  if (air_)
    forces.push_back(cloth.model == ClothModel::choi_ko ? air_drag_of_quads(mesh, *air_, cloth.first_particle)
                                                        : air_drag(mesh, *air_, cloth.first_particle));
  for (Cloth::Stitched& open : cloth.seams) {
    std::unique_ptr<Force> force = stitches(open.seam, cloth.embedding, state.time);
    open.force = force.get();
    if (force) forces.push_back(std::move(force));
  }
}

void Assembly::make_system(std::vector<double> masses, Forces forces) {
  system = std::make_unique<System>(std::move(masses));
  system->add(Gravity{gravity_});
  system->add(std::move(forces));
  if (!constraints->faces().all().empty()) system->add(face_contact_force(*constraints));
  if (constraints->self().any()) {
    sew();
    system->add(self_contact_force(*constraints));
  }
}

// Tells the constraints what is being sewn together. Beside stitches that are kept, which hold to a
// micrometre, everything may pass.
void Assembly::sew() {
  std::vector<SewnPair> sewn;
  for (const Cloth& cloth : cloths)
    for (const Cloth::Stitched& open : cloth.seams)
      for (const auto& [first, second] : open.seam.pairs) {
        const int a = cloth.embedding.particle(first), b = cloth.embedding.particle(second);
        sewn.push_back({a, b, a != b && !open.seam.merge});
      }
  constraints->sew(sewn);
}

void Assembly::use(MakeIntegrator make) {
  if (!system) {
    if (!constraints->bodies().empty()) constraints->add_faces(faces_);
    faces_ = {};
    if (!self_.empty()) constraints->add_self_faces(self_);
    self_ = {};
    if (!self_segments_.empty()) constraints->add_self_segments(self_segments_);
    self_segments_ = {};
    make_system(std::exchange(masses_, {}), std::exchange(forces_, {}));
    std::vector<Pairs> at_one_place;
    for (const Cloth& cloth : cloths) at_one_place.push_back(cloth.at_one_place);
    merge(at_one_place);
  }
  make_integrator = std::move(make);
  integrator = make_integrator(*system, *constraints);
}

void Assembly::use(const std::string& name, const std::string& linear_solver, const StepOptions& options) {
  use([=](System& to_step, Constraints& within) {
    return drape::make_integrator(name, to_step, within, make_linear_solver(linear_solver), options);
  });
}

StepReport Assembly::advance(double h) {
  bool open = false;
  for (Cloth& cloth : cloths)
    for (Cloth::Stitched& stitched : cloth.seams) {
      open = true;
      if (!stitched.force) continue;
      const double before = stitched.force->energy(state.x);
      close_until(*stitched.force, stitched.seam, state.time + h);
      const double more = stitched.force->energy(state.x) - before;
      integrator->count_given(std::max(0.0, more));
      given += more;
    }
  StepReport report = integrator->advance(state, h);
  if (!report.done) return report;
  report.contact_energy = system->contact_energy(state.x);
  report.torn = tear_cloths();
  if (!open) return report;
  const double before = system->total_energy(state);
  if (merge_closed_seams()) {
    integrator = make_integrator(*system, *constraints);
    given += system->total_energy(state) - before;
  }
  return report;
}

const Cloth& Assembly::cloth_of(int particle) const {
  const auto after =
      std::find_if(cloths.begin(), cloths.end(), [&](const Cloth& c) { return particle < c.end_particle; });
  return after == cloths.end() ? cloths.back() : *after;
}

}  // namespace drape
