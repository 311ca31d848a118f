#include "app/simulation/warnings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/scene/fabric_words.h"
#include "app/simulation/schedule.h"
#include "app/simulation/unlikely.h"
#include "mesh/base/errors.h"
#include "mesh/distance/triangle_crossings.h"
#include "mesh/pattern/panels.h"
#include "mesh/triangles/extent.h"
#include "mesh/triangles/topology.h"
#include "solver/forces/choi_ko.h"

namespace drape::app {
namespace {

std::string body_name(const Obstacle& obstacle, const std::string& name_given) {
  const std::string kind(name(obstacle.shape));
  return name_given == kind ? "the " + kind : kind + " " + name_given;
}

// Which of a cloth's vertices start inside which body, and how deep.
void warn_of_vertices_inside(const Scene& scene, Simulation& simulation) {
  constexpr double negligible = 1e-9;  // m
  const std::vector<double> depth = simulation.constraints->penetration(simulation.state.x);
  const std::vector<MovingBody>& bodies = simulation.constraints->bodies();
  for (const Cloth& cloth : simulation.cloths) {
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      int inside = 0, deepest = -1;
      const double least = negligible + cloth.imperfection;
      double deepest_depth = least;
      for (int i = cloth.first_particle; i < cloth.end_particle; ++i) {
        const auto particle = static_cast<std::size_t>(i);
        if (!(depth[particle] > least) || simulation.system->masses()[particle] == 0) continue;
        const double d =
            simulation.constraints->radius_of(i) - bodies[k].distance(simulation.state.x.segment<3>(3 * i));
        if (!(d > least)) continue;
        ++inside;
        if (d > deepest_depth) deepest = i, deepest_depth = d;
      }
      if (inside == 0) continue;
      const std::string all = inside == 1 ? "it" : "they", &method = scene.simulation.integrator;
      const bool may_hold = method.starts_with("cvode-") || method.starts_with("arkode-");
      simulation.messages.push_back(
          "warning: " + counted(inside, "vertex") + " of " + cloth.name +
          (inside == 1 ? " starts" : " start") + " inside " +
          body_name(bodies[k].obstacle(), scene.obstacles[k].name) + ", the deepest (vertex " +
          std::to_string(cloth.embedding.vertex(deepest)) + ") by " + rounded(1000 * deepest_depth, 3) +
          " mm; " + all + " will be brought out at " + rounded(scene.simulation.contact.recovery_speed, 3) +
          " m/s" +
          (may_hold
               ? ", but where the cloth pulls outwards this integrator holds it inside: take implicit-euler"
               : ""));
    }
  }
}

// Which of a cloth's vertices start outside a body, but nearer to it than half of its margin.
void tell_of_vertices_within_margin(const Scene& scene, Simulation& simulation) {
  const std::vector<MovingBody>& bodies = simulation.constraints->bodies();
  std::vector<char> carried(simulation.system->masses().size(), 0);  // held, or moved along a path
  for (const int i : simulation.constraints->pinned()) carried[static_cast<std::size_t>(i)] = 1;
  for (const Cloth& cloth : simulation.cloths)
    for (const MovingBody& body : bodies) {
      const double margin = body.obstacle().margin;
      int within = 0, nearest = -1;
      double least = 0.5 * margin - cloth.imperfection;
      for (int i = cloth.first_particle; i < cloth.end_particle; ++i) {
        if (simulation.system->masses()[i] == 0 || carried[static_cast<std::size_t>(i)]) continue;
        const double distance =
            body.distance(simulation.state.x.segment<3>(3 * i)) - simulation.constraints->radius_of(i);
        if (distance < 0 || distance >= 0.5 * margin - cloth.imperfection) continue;
        ++within;
        if (nearest < 0 || distance < least) nearest = i, least = distance;
      }
      if (within == 0) continue;
      simulation.messages.push_back(
          "note: " + counted(within, "vertex") + " of " + cloth.name + (within == 1 ? " starts" : " start") +
          " nearer to " + body_name(body.obstacle(), scene.obstacles[body.number()].name) +
          " than half of its margin of " + rounded(1000 * margin, 3) + " mm, the nearest (vertex " +
          std::to_string(cloth.embedding.vertex(nearest)) + ") " + rounded(1000 * least, 3) +
          " mm off it; cloth comes out to the margin at " +
          rounded(scene.simulation.contact.recovery_speed, 3) +
          " m/s: where that stretches it, a smaller margin helps");
    }
}

// Where a body with triangles comes through a cloth between its vertices. Of a cloth with vertices inside
// that is told already.
void warn_of_crossed_bodies(const Scene& scene, Simulation& simulation) {
  for (const Cloth& cloth : simulation.cloths)
    for (const MovingBody& body : simulation.constraints->bodies()) {
      if (!body.skin()) continue;
      constexpr double negligible = 1e-9;  // m
      const std::vector<Vec3> own = cloth.embedding.positions(simulation.state.x);
      if (std::any_of(own.begin(), own.end(),
                      [&](const Vec3& x) { return body.distance(x) < -negligible - cloth.imperfection; }))
        continue;
      std::vector<Vec3> places = own;
      std::vector<Triangle> triangles = cloth.mesh.triangles;
      const TriangleMesh& mesh = *body.skin();
      const int first = static_cast<int>(places.size()), count = static_cast<int>(triangles.size());
      for (int v = 0; v < mesh.vertex_count(); ++v) places.push_back(body.vertex_at_end(v));
      for (const Triangle& t : mesh.triangles)
        triangles.push_back({first + t[0], first + t[1], first + t[2]});
      const std::vector<CrossingContour> contours = contours_between(places, triangles, count);
      if (contours.empty()) continue;
      const Vec3& at = contours[0].place;
      simulation.messages.push_back(
          "warning: no vertex of " + cloth.name + " starts inside " +
          body_name(body.obstacle(), scene.obstacles[body.number()].name) + ", but " +
          counted(crossing_count(contours), "pair") + " of their triangles cross, as at (" +
          rounded(at[0], 4) + ", " + rounded(at[1], 4) + ", " + rounded(at[2], 4) +
          ") m: the body may pass through the cloth there; move the cloth, or subdivide it");
    }
}

void warn_of_overlapping_bodies(const Scene& scene, Simulation& simulation) {
  constexpr double negligible = 1e-5;  // m
  const auto called = [&](int body) {
    return body_name(simulation.constraints->bodies()[body].obstacle(), scene.obstacles[body].name);
  };
  for (const BodyMeeting::Overlap& pair : simulation.constraints->overlapping_bodies(negligible))
    simulation.messages.push_back("warning: " + called(pair.a) + " and " + called(pair.b) + " start " +
                                  rounded(1000 * pair.depth, 3) +
                                  " mm inside each other: they are moved apart slowly (recovery_speed)");
}

void tell_of_idle_keys(const std::string& start, const Names& keys, const std::string& chosen,
                       Names& messages) {
  if (keys.empty()) return;
  messages.push_back("note: " + start + listed(keys) + (keys.size() == 1 ? " has" : " have") +
                     " no effect with " + chosen);
}

// The files of fabrics have damping for models of springs.
void tell_of_damping(const ClothEntry& entry, Names& messages) {
  if (entry.model != "woven" || !entry.has_own_damping || entry.fabric.damping == 0) return;
  messages.push_back(
      "note: cloth " + entry.name +
      ": damping is of connections, and model = \"woven\" has none; viscosity calms its folds");
}

void tell_of_friction(const Cloth& cloth, Names& messages) {
  const Weave& w = cloth.fabric.weave;
  if (w.bend_friction == 0) return;
  messages.push_back("note: cloth " + cloth.name + ": its threads rub when they are bent, 2HB " +
                     rounded(2000 * w.bend_friction, 4) +
                     (w.bend_friction_weft ? " / " + rounded(2000 * *w.bend_friction_weft, 4) : "") +
                     " mN: it stays bent by up to " + rounded(w.bend_friction / cloth.fabric.bend, 3) +
                     " 1/m, and how it comes to rest depends on how it came there");
}

// Springs are the same in all directions.
void tell_of_directions(const ClothEntry& entry, Names& messages) {
  const Weave& w = entry.fabric.weave;
  const std::string rest = beyond_springs(entry.fabric);
  if (entry.model == "woven" || (!w.stretch_weft && !w.bend_weft && rest.empty())) return;
  messages.push_back("note: cloth " + entry.name + ": model = \"" + entry.model + "\" takes of its fabric " +
                     mean_in_words(entry.fabric) + ": the mean of warp and weft" +
                     (rest.empty() ? "" : ", and leaves out " + rest));
}

// Folds are some three bending lengths wide. An edge as long as one bending length cannot follow them, and
// one of one and a half not even where the fabric wrinkles finer than the mesh: measured with `drape
// test-fabric` on meshes of half a bending length to two.
void warn_if_coarse_for_folds(const ClothEntry& entry, const Cloth& cloth, Names& messages) {
  const Fabric& fabric = cloth.fabric;
  const double bend = std::min(fabric.bend, fabric.weave.bend_weft.value_or(fabric.bend)),
               c = std::cbrt(bend / (9.81 * fabric.area_density));  // m
  const bool wrinkles = fabric.weave.compression <= 0.1;
  if (cloth.model != ClothModel::woven || cloth.report.median_edge <= (wrinkles ? 1.5 * c : c)) return;
  messages.push_back(
      "warning: cloth " + cloth.name + ": its edges (median " + rounded(1000 * cloth.report.median_edge, 2) +
      " mm) are longer than " + (wrinkles ? "one and a half times " : "") +
      "the bending length of the fabric, " + rounded(1000 * c, 2) + " mm: folds come out too stiff; " +
      (is_pattern(entry.mesh) ? "give the pattern a smaller edge" : "subdivide the mesh in a modeller") +
      (wrinkles ? "" : ", or set compression = 0.1, so that it wrinkles finer than the mesh"));
}

// A file with few digits parts what a modeller shows at one place.
void tell_of_weld(const ClothEntry& entry, const Cloth& cloth, Names& messages) {
  if (!entry.weld) return;
  const std::vector<int> first = welded(cloth.mesh.positions);
  for (int v = 0; v < cloth.mesh.vertex_count(); ++v)
    if (first[static_cast<std::size_t>(v)] != v) return;
  messages.push_back(
      "warning: cloth " + entry.name +
      ": weld = true joins nothing, since no two of its vertices are at exactly the same place; where "
      "they are meant to be, merge them by distance in a modeller, or leave weld out");
}

// How many particles are at exactly the place of another one with which they do not become one in the first
// step.
int coincident(const Cloth& cloth) {
  std::vector<char> counted(static_cast<std::size_t>(cloth.end_particle - cloth.first_particle), 0);
  const auto mark = [&](int vertex) -> char& {
    return counted[static_cast<std::size_t>(cloth.embedding.particle(vertex) - cloth.first_particle)];
  };
  for (const Cloth::Stitched& open : cloth.seams)
    for (std::size_t k = 0; k < open.seam.pairs.size(); ++k)
      if (open.seam.merge && open.seam.begins_closed(k)) mark(open.seam.pairs[k].second) = 1;
  std::vector<std::array<double, 3>> places;
  for (int v = 0; v < cloth.mesh.vertex_count(); ++v) {
    if (mark(v)) continue;
    mark(v) = 1;
    const Vec3& x = cloth.mesh.positions[static_cast<std::size_t>(v)];
    places.push_back({x[0], x[1], x[2]});
  }
  std::ranges::sort(places);
  int count = 0;
  for (std::size_t k = 0; k < places.size(); ++k)
    count += (k > 0 && places[k] == places[k - 1]) || (k + 1 < places.size() && places[k] == places[k + 1]);
  return count;
}

// Frames have floats, and no layers that are nearer to each other than those can tell.
void check_place(const ClothEntry& entry, const Cloth& cloth, const VecX& x, Names& messages) {
  const int first = 3 * cloth.first_particle, count = 3 * (cloth.end_particle - cloth.first_particle);
  const double far = x.segment(first, count).cwiseAbs().maxCoeff(),
               step = far * std::numeric_limits<float>::epsilon();
  const std::string what = "cloth " + cloth.name + ": reaches " + rounded(far, 3) +
                           " m from the origin, where the floats of frames tell places to " +
                           rounded(1000 * step, 2) + " mm only";
  if (step > 0.1 * entry.self.thickness)
    throw InputError(entry.where + ": " + what + ", too coarse for layers " +
                     rounded(1000 * entry.self.thickness, 3) +
                     " mm apart; move the scene nearer to the origin, or set self_contact = false");
  if (step > 0.01 * entry.self.thickness)
    messages.push_back("warning: " + what + ": layers " + rounded(1000 * entry.self.thickness, 3) +
                       " mm apart may be held up; move the scene nearer to the origin");
}

// Seams that the drawing or the mesh declares and the scene does not ask for.
void tell_of_open_seams(const ClothEntry& entry, const Cloth& cloth, Names& messages) {
  if (!entry.seams.empty() || entry.weld) return;
  if (const auto seams = static_cast<long>(declared_seams(cloth.mesh).size()); seams > 0)
    messages.push_back("note: cloth " + cloth.name + ": its mesh declares " + counted(seams, "seam") +
                       ", and none is sewn: seams = [{}] sews " + (seams == 1 ? "it" : "them"));
}

double size_of(const VecX& x) {
  Eigen::AlignedBox3d box;
  for (Eigen::Index i = 0; i + 2 < x.size(); i += 3) box.extend(Vec3(x.segment<3>(i)));
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

// The same of cloth that nothing keeps from itself: where floats tell places to a thousandth of its edges
// only, what is written is not what was computed.
void tell_of_place(const Cloth& cloth, const VecX& x, Names& messages) {
  const double far = x.segment(3 * cloth.first_particle, 3 * (cloth.end_particle - cloth.first_particle))
                         .cwiseAbs()
                         .maxCoeff();
  const double step = far * std::numeric_limits<float>::epsilon();
  if (step > 1e-3 * cloth.report.median_edge)
    messages.push_back("warning: cloth " + cloth.name + ": reaches " + rounded(far, 3) +
                       " m from the origin, where the floats of frames tell places to " +
                       rounded(1000 * step, 2) + " mm only, and its edges (median) are " +
                       rounded(1000 * cloth.report.median_edge, 2) +
                       " mm; move the scene nearer to the origin");
}

// What contact of cloth with cloth takes for granted.
void tell_of_self_contact(const ClothEntry& entry, const Cloth& cloth, Names& messages) {
  constexpr double coarse = 20;   // edges that long, in thicknesses
  constexpr double thick = 0.05;  // of the size of the cloth
  if (!entry.self_contact) return;
  if (const int count = coincident(cloth); count > 0)
    messages.push_back(
        "warning: cloth " + cloth.name + ": " + std::to_string(count) +
        " of its vertices are at the same place as another one: triangles that meet there may pass "
        "through each other, self_contact or not; " +
        (entry.model == "choi-ko" ? "" : "set weld = true, or ") + "weld them in a modeller");
  const std::string start = "note: cloth " + cloth.name + ": ";
  if (!entry.fabric_record.thickness)
    messages.push_back(start + "no thickness is given: layers rest " +
                       rounded(1000 * entry.self.thickness, 3) + " mm apart");
  const double size = box_of(cloth.mesh.positions).diagonal().norm();
  if (entry.self.thickness > thick * size)
    messages.push_back("warning: cloth " + cloth.name + ": layers " +
                       rounded(1000 * entry.self.thickness, 3) + " mm apart are thick for a cloth of " +
                       rounded(1000 * size, 3) + " mm from corner to corner; give a smaller thickness");
  if (cloth.report.median_edge > coarse * entry.self.thickness)
    messages.push_back(start + "its edges (median " + rounded(1000 * cloth.report.median_edge, 2) +
                       " mm) are long for layers " + rounded(1000 * entry.self.thickness, 3) +
                       " mm apart: where it is folded over, they lie farther apart; subdivide the mesh if "
                       "that matters");
}

void tell_of_self_contact(const SoftEntry& entry, Names& messages) {
  if (entry.self_contact && !entry.mesh.empty() && !is_tetrahedra(entry.mesh))
    messages.push_back("note: soft body " + entry.name +
                       ": cloth meets the surface of its lattice, which is up to a cell (" +
                       rounded(1000 * entry.spacing[0], 3) + " mm) outside its mesh");
}

// A rope meets what has self_contact, too, and passes through the rest.
void tell_of_self_contact(const RopeEntry& entry, const Scene& scene, Names& messages) {
  if (!entry.self_contact) return;
  if (!entry.has_own_radius)
    messages.push_back("note: rope " + entry.name + ": no radius is given: it is " +
                       rounded(2000 * entry.material.radius, 3) + " mm thick");
  Names passed;
  const auto look = [&](const auto& parts) {
    for (const auto& part : parts)
      if (!part.self_contact) passed.push_back(part.name);
  };
  look(scene.cloths);
  look(scene.softs);
  look(scene.ropes);
  if (!passed.empty())
    messages.push_back("note: rope " + entry.name + " passes through " + listed(passed) +
                       (passed.size() == 1 ? ", which has" : ", which have") + " no self_contact = true");
}

void warn_if_limp(const Cloth& cloth, Names& messages) {
  const double curvature = cloth.limp_below;
  if (!(curvature > 2 * limp_curvature(mean_bend(cloth.fabric), cloth.fabric.area_density))) return;
  messages.push_back("warning: cloth " + cloth.name +
                     ": the buckling clamp makes it limp below a curvature of " + rounded(curvature, 2) +
                     " 1/m (a radius of " + rounded(100 / curvature, 2) +
                     " cm): gentler folds have no bending stiffness; " +
                     (cloth.fabric.buckling_clamp ? "raise buckling_clamp, or leave it out"
                                                  : "model = \"woven\" has no clamp"));
}

void warn_if_long(const Cloth& cloth, Names& messages) {
  if (cloth.model != ClothModel::choi_ko) return;
  const bool of_fabric = !cloth.fabric.stretch_spring || !cloth.fabric.bend_spring;
  const double longest = longest_cell(cloth.mesh, cloth.rest);
  if (!of_fabric || longest <= std::sqrt(3.0)) return;
  messages.push_back("warning: cloth " + cloth.name + ": has cells " + rounded(longest, 3) +
                     " times as long as wide; beyond 1.73 the grid's springs make it stiffer across than "
                     "along; use a grid of squares, or model = \"noh-jung\"");
}

// Contact holds vertices. What is between them is held by springs. A body that is narrower than an edge may
// pass a triangle within one step, and then they do not see it. Cloth with self_contact meets all of a body
// that is a mesh, or a convex shape that moves.
void warn_if_coarse(const Scene& scene, Simulation& simulation) {
  const std::vector<MovingBody>& bodies = simulation.constraints->bodies();
  for (std::size_t part = 0; part < simulation.cloths.size(); ++part) {
    const Cloth& cloth = simulation.cloths[part];
    const bool meets = part < scene.cloths.size() && scene.cloths[part].self_contact;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const double radius = longest_edge(bodies[k].obstacle().shape);
      if (cloth.report.median_edge <= radius || (meets && bodies[k].meets_triangles())) continue;
      simulation.messages.push_back(std::string("warning: ") + (cloth.rope ? "rope " : "cloth ") +
                                    cloth.name + " is too coarse for " +
                                    body_name(bodies[k].obstacle(), scene.obstacles[k].name) +
                                    ": its edges (median " + rounded(cloth.report.median_edge, 2) +
                                    " m) are longer than the body's radius (" + rounded(radius, 2) +
                                    " m), and between its vertices only springs hold it off: met fast, a "
                                    "thin body comes through; subdivide "
                                    "the mesh");
    }
  }
}

void warn_of_restitution(const Scene& scene, Names& messages) {
  const SimulationOptions& options = scene.simulation;
  const ContactMode mode = contact_mode(options.integrator, options.step.contact);
  if (mode == ContactMode::restitution) return;
  const auto reacts = [](const ObstacleEntry& entry) { return entry.rigid.has_value(); };
  if (scene.obstacles.size() > 1 && std::any_of(scene.obstacles.begin(), scene.obstacles.end(), reacts))
    return;  // bodies that meet spring back in any mode
  for (const ObstacleEntry& entry : scene.obstacles)
    if (entry.obstacle.restitution > 0)
      messages.push_back("warning: " + body_name(entry.obstacle, entry.name) +
                         ": restitution has no effect with contact = \"" + std::string(name(mode)) +
                         "\"; it needs contact = \"restitution\" and an explicit integrator");
}

// These settle contact once a step, and then an impulse that grew during the step is given back all at once.
void warn_of_inner_steps(const Scene& scene, Names& messages) {
  const std::string& integrator = scene.simulation.integrator;
  if (!integrator.starts_with("cvode-") && !integrator.starts_with("arkode-")) return;
  for (const ObstacleEntry& entry : scene.obstacles)
    if (entry.rigid)
      messages.push_back(
          "warning: " + body_name(entry.obstacle, entry.name) + ": " + integrator +
          " does not keep its momentum with the cloth's, and may give a light body several times "
          "the energy; implicit-euler keeps it");
  constexpr double short_enough = 1.5e-3;  // s
  if (!scene.obstacles.empty() && scene.simulation.time_step > short_enough)
    messages.push_back(
        "warning: " + integrator +
        " settles contact once a step, and cloth that falls on a body may gain energy in steps of " +
        rounded(1000 * scene.simulation.time_step, 3) +
        " ms, several times its own in 10 ms: look at the energies in steps.csv, and set time_step to "
        "1 ms or less");
}

void warn_of_time(const SimulationOptions& options, Names& messages) {
  constexpr double longest = 0.1;  // s: a fall of 5 cm within one step
  if (options.time_step > longest)
    messages.push_back("warning: a time step of " + rounded(options.time_step, 3) +
                       " s is long: motion is lost in it; 10 ms is usual");
}

// The step that is taken where it is not the one asked for.
void tell_of_step(const SimulationOptions& options, Names& messages) {
  const StepGrid grid(options.time_step, options.frame_rate);
  if (grid.as_asked()) return;
  messages.push_back("note: steps of " + rounded(1000 * grid.step(), 4) + " ms instead of " +
                     rounded(1000 * grid.asked(), 4) + " ms: " +
                     (grid.per_frame() == 1 ? "one comes" : std::to_string(grid.per_frame()) + " come") +
                     " to a frame at " + rounded(options.frame_rate, 6) + " Hz");
}

}  // namespace

void add_warnings(const Scene& scene, Simulation& simulation) {
  for (const Cloth& cloth : simulation.cloths) {
    if (cloth.soft || cloth.rope) continue;
    warn_if_long(cloth, simulation.messages);
    warn_if_limp(cloth, simulation.messages);
    tell_of_friction(cloth, simulation.messages);
  }
  tell_of_idle_keys("simulation: ", scene.simulation.idle_keys,
                    "integrator = \"" + scene.simulation.integrator + "\"", simulation.messages);
  for (const ClothEntry& cloth : scene.cloths) {
    tell_of_idle_keys("cloth " + cloth.name + ": ", cloth.idle_keys, "model = \"" + cloth.model + "\"",
                      simulation.messages);
    tell_of_damping(cloth, simulation.messages);
    tell_of_directions(cloth, simulation.messages);
  }
  tell_of_unlikely_values(scene, size_of(simulation.state.x), simulation.messages);
  warn_of_unlikely_frames(scene, simulation.constraints->bodies(), simulation.messages);
  for (std::size_t k = 0; k < scene.cloths.size(); ++k) {
    tell_of_weld(scene.cloths[k], simulation.cloths[k], simulation.messages);
    tell_of_open_seams(scene.cloths[k], simulation.cloths[k], simulation.messages);
    warn_if_coarse_for_folds(scene.cloths[k], simulation.cloths[k], simulation.messages);
    if (!scene.cloths[k].self_contact)
      tell_of_place(simulation.cloths[k], simulation.state.x, simulation.messages);
    else
      check_place(scene.cloths[k], simulation.cloths[k], simulation.state.x, simulation.messages);
    tell_of_self_contact(scene.cloths[k], simulation.cloths[k], simulation.messages);
  }
  for (const SoftEntry& soft : scene.softs) tell_of_self_contact(soft, simulation.messages);
  for (const RopeEntry& rope : scene.ropes) tell_of_self_contact(rope, scene, simulation.messages);
  warn_of_vertices_inside(scene, simulation);
  tell_of_vertices_within_margin(scene, simulation);
  warn_of_crossed_bodies(scene, simulation);
  warn_of_overlapping_bodies(scene, simulation);
  warn_if_coarse(scene, simulation);
  warn_of_restitution(scene, simulation.messages);
  warn_of_inner_steps(scene, simulation.messages);
  warn_of_time(scene.simulation, simulation.messages);
  tell_of_step(scene.simulation, simulation.messages);
  if (simulation.constraints->bodies().empty() && simulation.constraints->pinned().empty() &&
      !scene.simulation.gravity.isZero(0))
    simulation.messages.push_back(
        "warning: nothing holds the cloth up, neither pins nor a body: it will fall for ever; add an "
        "obstacle (drop: --floor or --onto) or pins");
}

}  // namespace drape::app
