#include "app/recording/run_json.h"

#include <Eigen/Geometry>

#include "app/base/json.h"
#include "app/simulation/measure.h"

namespace drape::app {
namespace {

Json cloths_json(const std::vector<ClothCounts>& cloths) {
  Json::List list;
  for (const ClothCounts& c : cloths)
    list.push_back(Json::Members{{"name", c.name},
                                 {"particles", c.particles},
                                 {"triangles", c.triangles},
                                 {"edges", c.edges},
                                 {"diagonals", c.diagonals},
                                 {"fabric", c.fabric},
                                 {"imperfection", c.imperfection},
                                 {"pins", c.pins},
                                 {"seams", c.seams},
                                 {"tear", c.tear ? Json(*c.tear) : Json()},
                                 {"torn", c.torn},
                                 {"copy_of", c.copy_of},
                                 {"edges_at_end", c.edges_at_end},
                                 {"diagonals_at_end", c.diagonals_at_end}});
  return list;
}

Json softs_json(const std::vector<SoftCounts>& softs) {
  Json::List list;
  for (const SoftCounts& s : softs)
    list.push_back(Json::Members{{"name", s.name},
                                 {"particles", s.particles},
                                 {"vertices", s.vertices},
                                 {"triangles", s.triangles},
                                 {"structural", s.springs.structural},
                                 {"shear", s.springs.shear},
                                 {"bend", s.springs.bend},
                                 {"material", s.material},
                                 {"pins", s.pins}});
  return list;
}

Json ropes_json(const std::vector<RopeCounts>& ropes) {
  Json::List list;
  for (const RopeCounts& r : ropes)
    list.push_back(Json::Members{{"name", r.name},
                                 {"particles", r.particles},
                                 {"segments", r.segments},
                                 {"length", r.length},
                                 {"material", r.material},
                                 {"pins", r.pins},
                                 {"ends", r.ends}});
  return list;
}

Json vector_json(const Vec3& v) { return Json::List{v[0], v[1], v[2]}; }

// The turn as a unit quaternion qw qx qy qz.
Json place_json(const Pose& place) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(place.rotation).normalized();
  return Json::Members{{"translation", vector_json(place.translation)},
                       {"rotation", Json::List{q.w(), q.x(), q.y(), q.z()}}};
}

Json bodies_json(const std::vector<BodyRecord>& bodies) {
  Json::List list;
  for (const BodyRecord& b : bodies) {
    Json::Members json = {{"name", b.name},
                          {"file", b.file.empty() ? Json() : Json(b.file)},
                          {"shape", b.shape},
                          {"moves", b.moves},
                          {"deforms", b.deforms},
                          {"reacts", b.reacting.has_value()},
                          {"place", place_json(b.place)}};
    json.insert(json.end(), b.contact.begin(), b.contact.end());
    if (b.plane) {
      json.emplace_back("point", vector_json(b.plane->point));
      json.emplace_back("normal", vector_json(b.plane->normal));
    }
    if (b.reacting) {
      json.emplace_back("mass", b.reacting->mass);
      json.emplace_back("position", vector_json(b.reacting->position));
      json.emplace_back("velocity", vector_json(b.reacting->velocity));
      json.emplace_back("spin", vector_json(b.reacting->spin));
      json.emplace_back("momentum", vector_json(b.reacting->momentum));
    }
    list.emplace_back(std::move(json));
  }
  return list;
}

Json failure_json(const Failure& f) {
  return Json::Members{{"step", f.step},   {"time", f.time},
                       {"what", f.what},   {"term", f.term},
                       {"cloth", f.cloth}, {"vertex", f.vertex < 0 ? Json() : Json(f.vertex)}};
}

}  // namespace

std::string run_json(const RunRecord& record) {
  const Distribution step_ms = distribution(record.step_ms),
                     iterations = distribution(record.linear_iterations),
                     solves = distribution(record.linear_solves),
                     inner_steps = distribution(record.inner_steps);
  Json::Members json = {
      {"drape_version", DRAPE_VERSION},
      {"scene", record.scene},
      {"cloths", cloths_json(record.cloths)},
      {"softs", softs_json(record.softs)},
      {"ropes", ropes_json(record.ropes)},
      {"bodies", bodies_json(record.bodies)},
      {"integrator", record.integrator},
      {"contact", record.contact},
      {"linear_solver", record.linear_solver},
      {"threads", record.threads},
      {"duration", record.duration},
      {"time_step", record.time_step},
      {"time_step_asked", record.time_step_asked},
      {"steps", record.steps},
      {"simulated_seconds", record.simulated_seconds},
      {"wall_seconds", record.wall_seconds},
      {"ms_per_step", Json::Members{{"median", step_ms.median}, {"p95", step_ms.p95}, {"max", step_ms.max}}},
      {"phases_ms", Json::Members{{"assemble", record.assemble_ms},
                                  {"solve", record.solve_ms},
                                  {"collide", record.collide_ms},
                                  {"write", record.write_ms}}},
      {"linear_iterations",
       Json::Members{{"mean", iterations.mean}, {"max", static_cast<long>(iterations.max)}}},
      {"linear_solves", Json::Members{{"mean", solves.mean},
                                      {"max", static_cast<long>(solves.max)},
                                      {"by_multigrid", record.multigrid_solves}}},
      {"state", record.state()},
      {"interrupted", record.interrupted},
      {"energy", Json::Members{{"start", record.energy.start},
                               {"end", record.energy.end},
                               {"largest_rise", record.energy.largest_rise}}},
      {"max_speed", record.max_speed},
      {"max_edge_strain", record.max_edge_strain},
      {"strain_min", record.strains.least},
      {"strain_min_1pct", record.strains.first_percent},
      {"strain_max", record.strains.largest},
      {"area_min", record.strains.area_least},
      {"area_kept", record.strains.area_kept},
      {"max_penetration", record.max_penetration},
      {"contact_residual", record.contact_residual},
      {"self_contacts", Json::Members{{"end", record.self_contacts}, {"max", record.self_contacts_max}}},
      {"self_guarded", record.self_guarded},
      {"self_held", record.self_held},
      {"torn", Json::Members{{"edges", record.torn},
                             {"first_time", record.first_torn ? Json(*record.first_torn) : Json()}}},
      {"pinched", Json::Members{{"end", record.pinched}, {"max", record.pinched_max}}},
      {"crossings",
       Json::Members{
           {"start", record.crossings_at_start}, {"end", record.crossings}, {"max", record.crossings_max}}},
      {"largest_speed", record.largest_speed},
      {"largest_edge_strain", record.largest_edge_strain},
      {"substeps_max", record.substeps_max},
      {"steps_cut", record.steps_cut},
      {"steps_not_converged", record.steps_not_converged},
      {"inner_steps", Json::Members{{"mean", inner_steps.mean}, {"max", static_cast<long>(inner_steps.max)}}},
      {"inner_rejected", record.inner_rejected},
      {"frames", record.frames},
      {"frame_times", record.frame_times},
      {"state_hash", record.state_hash},
      {"warnings", record.warnings},
  };
  json.insert(json.end(), record.numerics.begin(), record.numerics.end());
  json.emplace_back("settings", record.settings);
  if (record.failure) json.emplace_back("failure", failure_json(*record.failure));
  return json_text(json);
}

}  // namespace drape::app
