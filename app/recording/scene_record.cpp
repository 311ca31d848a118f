#include "app/recording/scene_record.h"

#include <cmath>

#include "app/base/words.h"
#include "app/scene/fabric_read.h"
#include "constraints/pins.h"
#include "solver/forces/membrane.h"
#include "solver/forces/woven.h"

namespace drape::app {
namespace {

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }
Json optional_json(const std::string& text) { return text.empty() ? Json() : Json(text); }
Json vector_json(const Vec3& v) { return Json::List{v[0], v[1], v[2]}; }

const char* damping_name(DampingKind kind) { return kind == DampingKind::axial ? "axial" : "relative"; }

// How many vertices of the mesh a rule takes. A box takes particles of a soft body, which its mesh does not
// have.
Json count_of(const PinRule& rule, const Cloth& cloth) {
  if (cloth.soft && std::holds_alternative<PinBox>(rule)) return {};
  return static_cast<long>(select(rule, cloth.mesh).size());
}

Json rule_json(const PinVertices& rule) { return Json::Members{{"vertices", rule.vertices}}; }
Json rule_json(const PinBox& rule) {
  return Json::Members{{"box", Json::List{vector_json(rule.lower), vector_json(rule.upper)}}};
}
Json rule_json(const PinGroup& rule) { return Json::Members{{"group", rule.name}}; }
Json rule_json(const PinEnd& rule) { return Json::Members{{"end", rule.last ? "last" : "first"}}; }

// Words, each with what stands before and after it, but for what is not there.
class Words {
 public:
  void add(const std::string& word) {
    if (!word.empty()) text_ += (text_.empty() ? "" : ", ") + word;
  }
  void number(const std::string& before, const Json& value, const std::string& after, double scale = 1) {
    const double number = scale * value.number(NAN);
    if (std::isfinite(number)) add(before + rounded(number, 4) + after);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string fabric_words(const Json& fabric) {
  Words words;
  words.add(fabric["name"].text());
  words.add(fabric["model"].text());
  words.number("", fabric["area_density"], " kg/m^2");
  words.number("stretch ", fabric["stretch"], " N/m");
  words.number("stretch ", fabric["stretch_spring"], " N/m each edge");
  words.number("bend ", fabric["bend"], " N m");
  words.number("bend ", fabric["bend_spring"], " N m^2 each diagonal");
  words.number("buckling clamp ", fabric["buckling_clamp"], " N/m");
  words.number("damping ", fabric["damping"], " N s/m " + fabric["damping_kind"].text());
  if (fabric["neighbour_weighting"].is(true)) words.add("neighbour weighting");
  const Json& weave = fabric["weave"];
  words.number("weft ", weave["stretch_weft"], " N/m");
  words.number("shear ", weave["shear"], " N/m");
  words.number("bend of the weft ", weave["bend_weft"], " N m");
  words.number("of the bias ", weave["bend_bias"], " N m");
  words.number("Poisson's ratio ", weave["poisson"], "");
  words.number("of bending ", weave["bend_poisson"], "");
  if (const std::string bending = weave["bending"].text(); !bending.empty() && bending != "plate")
    words.add("bending by " + bending);
  words.number("compression ", weave["compression"], "");
  words.number("viscosity of stretch ", weave["stretch_time"], " s");
  words.number("of shear ", weave["shear_time"], " s");
  words.number("of bending ", weave["bend_time"], " s");
  if (!weave["warp"].items().empty()) {
    const auto at = [&](std::size_t k) { return rounded(weave["warp"].items()[k].number(NAN), 4); };
    words.add("warp along " + at(0) + ", " + at(1) + ", " + at(2));
  }
  if (weave["bend_friction_warp"].number(0) > 0) {
    words.number("friction against bending ", weave["bend_friction_warp"], " N");
    words.number("along the weft ", weave["bend_friction_weft"], " N");
  }
  if (weave["rest_angle"].number(0) > 0) words.number("rest angle ", weave["rest_angle"], " of the mesh's");
  return words.text();
}

std::string material_words(const Json& material) {
  Words words;
  words.number("", material["density"], " kg/m^3");
  words.number("", material["mass"], " kg");
  if (material["equal_masses"].is(true)) words.add("equal masses");
  words.number("", material["young"], " Pa");
  for (const char* kind : {"structural", "shear", "bend"})
    words.number(std::string(kind) + " ", material[kind], " N/m");
  words.number("damping ", material["damping"], " N s/m " + material["damping_kind"].text());
  if (material["viscosity"].number(0) > 0) words.number("viscosity ", material["viscosity"], " s");
  return words.text();
}

std::string rope_words(const Json& material) {
  Words words;
  words.number("", material["mass_per_length"], " kg/m");
  words.number("stretch ", material["stretch"], " N");
  words.number("bend ", material["bend"], " N m^2");
  if (material["damping"].number(0) > 0) words.number("damping ", material["damping"], " N s");
  if (material["bend_damping"].number(0) > 0)
    words.number("damping of bending ", material["bend_damping"], " N m^2 s");
  words.number("radius ", material["radius"], " mm", 1000);
  return words.text();
}

std::string end_words(const Json& end) {
  const bool anchored = !end["body"].is_null();
  return "the " + end["end"].text() + (anchored ? " is anchored to " : " is joined to ") +
         end[anchored ? "body" : "to"].text();
}

std::string pin_words(const Json& pin) {
  Words words;
  const double count = pin["count"].number(NAN);
  const std::string held = std::isfinite(count) ? counted(std::lround(count), "vertex") : "particles";
  words.add(!pin["group"].is_null() ? held + " of group " + pin["group"].text()
            : !pin["box"].is_null() ? held + " in a box"
            : !pin["end"].is_null() ? "the " + pin["end"].text() + " end"
                                    : held);
  if (!pin["follow"].is_null()) words.add("following " + pin["follow"].text());
  if (!pin["motion"].is_null()) words.add("moved by " + pin["motion"].text());
  return words.text();
}

std::string seam_words(const Json& seam) {
  Words words;
  words.add(seam["name"].text());
  words.number("closes in ", seam["close"], " s");
  words.number("", seam["stiffness"], " N/m");
  words.add(seam["then"].text());
  return words.text();
}

std::string contact_words(const Json& body) {
  Words words;
  const Json& friction = body["friction"];
  if (friction["static"].number(0) == friction["kinetic"].number(0))
    words.number("friction ", friction["static"], "");
  else {
    words.number("static friction ", friction["static"], "");
    words.number("kinetic ", friction["kinetic"], "");
  }
  words.number("margin ", body["margin"], " mm", 1000);
  if (body["restitution"].number(0) > 0) words.number("restitution ", body["restitution"], "");
  return words.text();
}

// One after the other, each in its words.
template <class InWords>
std::string list_words(const Json& list, const InWords& in_words) {
  std::string text;
  for (const Json& entry : list.items()) text += (text.empty() ? "" : "; ") + in_words(entry);
  return text;
}

}  // namespace

namespace {

// The direction that the scene gives, or that was chosen when the mesh was loaded.
std::optional<Vec3> warp_of(const ClothEntry& entry, const Cloth* cloth) {
  if (entry.warp || !entry.warp_is_down || !cloth || cloth->warp.empty()) return entry.warp;
  const Vec3& chosen = cloth->warp.front();
  return chosen.isZero() ? std::nullopt : std::optional(chosen);
}

// The numbers that the forces are made of, chosen ones included.
Json weave_json(const ClothEntry& entry, const std::optional<Vec3>& direction) {
  const Membrane::Common membrane = membrane_of(entry.fabric);
  const PlateStiffness plate = plate_of(entry.fabric);
  const PlateFrictionLaw friction = plate_friction_of(entry.fabric);
  const Weave& weave = entry.fabric.weave;
  Json warp;
  if (direction) warp = vector_json(*direction);
  Json::Members groups;
  for (const GroupWarp& group : entry.group_warps)
    groups.emplace_back(group.group, vector_json(group.direction));
  Json::Members members{{"warp", warp},
                        {"stretch_warp", membrane.warp},
                        {"stretch_weft", membrane.weft},
                        {"shear", membrane.shear},
                        {"poisson", weave.poisson},
                        {"compression", weave.compression},
                        {"bend_warp", plate.warp},
                        {"bend_weft", plate.weft},
                        {"bend_bias", 0.25 * (plate.warp + plate.weft + 2 * plate.cross) + plate.twist},
                        {"bend_poisson", weave.bend_poisson},
                        {"bending", name_of(weave.bending)},
                        {"stretch_time", weave.stretch_time},
                        {"shear_time", weave.shear_time},
                        {"bend_time", weave.bend_time},
                        {"bend_friction_warp", friction.warp},
                        {"bend_friction_weft", friction.weft},
                        {"bend_friction_onset", friction.onset},
                        {"rest_angle", weave.rest_angle}};
  if (!groups.empty()) members.emplace_back("group_warps", std::move(groups));
  return members;
}

}  // namespace

Json fabric_json(const ClothEntry& entry, const Cloth* cloth) {
  const Fabric& f = entry.fabric;
  const bool woven = entry.model == "woven";
  Json::Members given;
  for (const auto& [quantity, text] : entry.fabric_record.given) given.emplace_back(quantity, text);
  return Json::Members{{"name", optional_json(entry.fabric_name)},
                       {"model", entry.model},
                       {"area_density", f.area_density},
                       {"stretch", f.stretch_spring ? Json() : Json(woven ? f.stretch : mean_stretch(f))},
                       {"stretch_spring", optional_json(f.stretch_spring)},
                       {"bend", f.bend_spring ? Json() : Json(woven ? f.bend : mean_bend(f))},
                       {"bend_spring", optional_json(f.bend_spring)},
                       {"buckling_clamp", optional_json(f.buckling_clamp)},
                       {"damping", f.damping},
                       {"damping_kind", damping_name(f.damping_kind)},
                       {"neighbour_weighting", f.neighbour_weighting},
                       {"weave", woven ? weave_json(entry, warp_of(entry, cloth)) : Json()},
                       {"given", std::move(given)}};
}

Json material_json(const SoftMaterial& m) {
  const auto spring = [&](double k) { return m.young ? Json() : Json(k); };
  return Json::Members{{"density", m.mass ? Json() : Json(m.density)},
                       {"mass", optional_json(m.mass)},
                       {"equal_masses", m.equal_masses},
                       {"young", optional_json(m.young)},
                       {"structural", spring(m.structural)},
                       {"shear", spring(m.shear)},
                       {"bend", spring(m.bend)},
                       {"damping", m.damping},
                       {"damping_kind", damping_name(m.damping_kind)},
                       {"viscosity", m.viscosity}};
}

Json rope_material_json(const RopeMaterial& m) {
  return Json::Members{{"mass_per_length", m.mass_per_length},
                       {"stretch", m.stretch},
                       {"bend", m.bend},
                       {"damping", m.damping},
                       {"bend_damping", m.bend_damping},
                       {"radius", m.radius}};
}

Json ends_json(const RopeEntry& entry) {
  Json::List list;
  const auto end = [](bool last) { return Json(last ? "last" : "first"); };
  for (const AnchorEntry& anchor : entry.anchors)
    list.push_back(Json::Members{{"end", end(anchor.last)}, {"body", anchor.body}});
  for (const JoinEntry& join : entry.joins)
    list.push_back(Json::Members{{"end", end(join.last)}, {"to", join.to}});
  return list;
}

Json pins_json(const std::vector<PinEntry>& pins, const Cloth& cloth) {
  Json::List list;
  for (const PinEntry& pin : pins) {
    Json json = std::visit([](const auto& rule) { return rule_json(rule); }, pin.rule);
    auto& members = std::get<Json::Members>(json.value);
    members.emplace_back("count", count_of(pin.rule, cloth));
    members.emplace_back("follow", optional_json(pin.follow));
    members.emplace_back("motion", pin.motion ? optional_json(pin.source.kind) : Json());
    list.push_back(std::move(json));
  }
  return list;
}

Json seams_json(const Cloth& cloth) {
  Json::List list;
  for (const Cloth::Stitched& open : cloth.seams)
    list.push_back(Json::Members{{"name", open.seam.name},
                                 {"pairs", static_cast<long>(open.seam.pairs.size())},
                                 {"close", open.seam.close},
                                 {"stiffness", open.seam.stiffness},
                                 {"then", open.seam.merge ? "merge" : "keep"}});
  return list;
}

Json settings_json(const std::vector<Setting>& settings) {
  Json::List list;
  for (const Setting& setting : settings)
    list.push_back(Json::Members{{"path", setting.path}, {"value", setting.value}});
  return list;
}

Json::Members contact_json(const Obstacle& obstacle) {
  const Friction& friction = obstacle.friction;
  return {{"friction", Json::Members{{"static", friction.statics}, {"kinetic", friction.kinetic}}},
          {"margin", obstacle.margin},
          {"restitution", obstacle.restitution}};
}

Json air_json(const std::optional<Air>& air) {
  if (!air) return {};
  return Json::Members{{"wind", vector_json(air->wind)},
                       {"density", air->density},
                       {"drag", air->drag},
                       {"skin_friction", air->skin_friction}};
}

Json::Members numerics_json(const SimulationOptions& options) {
  return {{"frame_rate", options.frame_rate},
          {"gravity", vector_json(options.gravity)},
          {"air", air_json(options.air)},
          {"tolerance", options.step.tolerance},
          {"newton_iterations", options.step.newton_iterations}};
}

Json::Members scene_json(const Scene& scene, const Simulation* simulation) {
  Json::List cloths, softs, ropes, bodies;
  for (std::size_t k = 0; k < scene.cloths.size(); ++k) {
    const ClothEntry& entry = scene.cloths[k];
    Json::Members json = {{"name", entry.name},
                          {"fabric", fabric_json(entry, simulation ? &simulation->cloths[k] : nullptr)}};
    if (entry.clusters) json.emplace_back("clusters", "faces");
    if (entry.weld) json.emplace_back("weld", true);
    if (entry.tear) json.emplace_back("tear", *entry.tear);
    if (simulation) {
      json.emplace_back("pins", pins_json(entry.pins, simulation->cloths[k]));
      json.emplace_back("seams", seams_json(simulation->cloths[k]));
    }
    cloths.emplace_back(std::move(json));
  }
  for (std::size_t k = 0; k < scene.softs.size(); ++k) {
    const SoftEntry& entry = scene.softs[k];
    Json::Members json = {{"name", entry.name}, {"material", material_json(entry.material)}};
    if (entry.clusters)
      json.emplace_back("clusters", entry.clusters->count > 0   ? Json(entry.clusters->count)
                                    : is_tetrahedra(entry.mesh) ? Json("tetrahedra")
                                                                : Json("cells"));
    if (simulation)
      json.emplace_back("pins", pins_json(entry.pins, simulation->cloths[scene.cloths.size() + k]));
    softs.emplace_back(std::move(json));
  }
  for (std::size_t k = 0; k < scene.ropes.size(); ++k) {
    const RopeEntry& entry = scene.ropes[k];
    Json::Members json = {
        {"name", entry.name}, {"material", rope_material_json(entry.material)}, {"ends", ends_json(entry)}};
    const std::size_t part = scene.cloths.size() + scene.softs.size() + k;
    if (simulation) json.emplace_back("pins", pins_json(entry.pins, simulation->cloths[part]));
    ropes.emplace_back(std::move(json));
  }
  for (const ObstacleEntry& entry : scene.obstacles) {
    Json::Members json = {{"name", entry.name}, {"shape", name(entry.obstacle.shape)}};
    for (auto& member : contact_json(entry.obstacle)) json.push_back(std::move(member));
    bodies.emplace_back(std::move(json));
  }
  return {{"cloths", std::move(cloths)},
          {"softs", std::move(softs)},
          {"ropes", std::move(ropes)},
          {"bodies", std::move(bodies)},
          {"settings", settings_json(scene.settings)}};
}

std::vector<SceneFact> scene_facts(const Json& run) {
  std::vector<SceneFact> facts;
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) facts.push_back({name, value});
  };
  for (const Json& cloth : run["cloths"].items()) {
    const std::string of = " of " + cloth["name"].text();
    add("Fabric" + of, fabric_words(cloth["fabric"]));
    add("Pins" + of, list_words(cloth["pins"], pin_words));
    add("Seams" + of, list_words(cloth["seams"], seam_words));
  }
  for (const Json& soft : run["softs"].items()) {
    const std::string of = " of " + soft["name"].text();
    add("Material" + of, material_words(soft["material"]));
    add("Pins" + of, list_words(soft["pins"], pin_words));
  }
  for (const Json& rope : run["ropes"].items()) {
    const std::string of = " of " + rope["name"].text();
    add("Rope " + rope["name"].text(), rope_words(rope["material"]));
    add("Pins" + of, list_words(rope["pins"], pin_words));
    add("Ends" + of, list_words(rope["ends"], end_words));
  }
  for (const Json& body : run["bodies"].items())
    add("Contact with " + body["name"].text(), contact_words(body));
  add("Settings", list_words(run["settings"], [](const Json& setting) {
        return setting["path"].text() + " = " + setting["value"].text();
      }));
  return facts;
}

}  // namespace drape::app
