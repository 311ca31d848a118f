#include "app/simulation/parts.h"

#include <cmath>

#include "app/pattern/pattern_read.h"
#include "app/pattern/remarks.h"
#include "app/scene/load_mesh.h"
#include "app/simulation/sewing.h"
#include "mesh/obj/obj.h"
#include "mesh/pattern/flat_pattern.h"
#include "mesh/triangles/topology.h"
#include "solver/forces/woven.h"

namespace drape::app {
namespace {

// As drape triangulate writes it and reads it again.
TriangleMesh cut_pattern(const ClothEntry& entry, Names& messages) try {
  Names notes;
  PatternMesh cut = triangulate(read_pattern(entry.mesh, notes), entry.pattern);
  for (const std::string& note : notes) messages.push_back("note: " + note);
  for (std::string& line : remarks(cut, entry.pattern.min_angle, entry.mesh.string()))
    messages.push_back(std::move(line));
  return std::move(cut.mesh);
} catch (const InputError& error) {
  throw InputError(entry.where + ": mesh: " + error.what());
}

// Texture coordinates are often without a length: the rest shape has then nothing to do with the mesh.
void warn_of_scale(const ClothEntry& entry, const TriangleMesh& mesh, const TriangleMesh& rest,
                   Names& messages) {
  if (!entry.rest_is_flat) return;
  double area = 0, flat = 0;
  for (const Triangle& t : mesh.triangles) area += triangle_area(mesh, t);
  for (const Triangle& t : rest.triangles) flat += triangle_area(rest, t);
  if (flat > 0.5 * area && flat < 2 * area) return;
  messages.push_back("warning: cloth " + entry.name + ": rests with an area of " + rounded(flat, 3) +
                     " m^2 by its uv, and its mesh has " + rounded(area, 3) +
                     " m^2: was another uv_scale meant? (lengths would agree with " +
                     rounded(entry.uv_scale * std::sqrt(area / flat), 4) + " m)");
}

// Where the warp runs that nobody gave: y of a mesh that stands, as the grain of a garment does, and z of one
// that lies. A trace of the other direction says it for triangles that are square to the first.
Vec3 down_the_cloth(const TriangleMesh& rest) {
  constexpr double trace = 1e-3;
  double standing = 0;  // m^2, area that stands less area that lies
  for (const Triangle& t : rest.triangles) {
    const auto at = [&](std::size_t k) { return rest.positions[static_cast<std::size_t>(t[k])]; };
    const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0));
    if (normal.norm() > 0) standing += 0.5 * normal.norm() - normal.y() * normal.y() / normal.norm();
  }
  return standing >= 0 ? Vec3(0, 1, trace) : Vec3(0, trace, 1);
}

void choose_warp(const ClothEntry& entry, ClothPart& part, Names& messages) {
  if (!entry.warp_is_down || !needs_warp(part.fabric)) return;
  part.warp = down_the_cloth(*part.rest);
  const bool stands = part.warp->y() > part.warp->z();
  messages.push_back("note: cloth " + entry.name +
                     ": no direction of the warp is given: it runs down the cloth, along " +
                     (stands ? "y, for the mesh stands" : "z, for the mesh lies") +
                     "; set warp = [x, y, z] if it runs otherwise" +
                     (entry.rest_is_flat ? "" : ", or rest = \"uv\" if it is v of the uv"));
}

}  // namespace

// As the file has it, its panels placed; the rest shape is the flat pattern, or what the file has.
ClothPart load_cloth(const ClothEntry& entry, Names& messages) {
  require_file(entry.mesh, entry.where);
  ClothPart part;
  part.name = entry.name;
  part.fabric = entry.fabric;
  part.model = entry.model == "choi-ko" ? ClothModel::choi_ko
               : entry.model == "woven" ? ClothModel::woven
                                        : ClothModel::noh_jung;
  part.warp = entry.warp;
  part.group_warps = entry.group_warps;
  part.imperfection = entry.imperfection;
  part.tear = entry.tear;
  part.clusters = entry.clusters;
  part.weld = entry.weld;
  if (entry.self_contact) part.self_contact = entry.self;
  part.mesh = placed(is_pattern(entry.mesh) ? cut_pattern(entry, messages) : read_obj(entry.mesh),
                     {.scale = entry.placement.scale}, entry.mesh.string());
  try {
    part.rest =
        entry.rest_is_flat ? flat_pattern(part.mesh, entry.uv_scale * entry.placement.scale) : part.mesh;
  } catch (const InputError& error) {
    throw InputError(entry.where + ": " + entry.mesh.string() + ": " + error.what());
  }
  warn_of_scale(entry, part.mesh, *part.rest, messages);
  choose_warp(entry, part, messages);
  place_panels(entry, part.mesh, messages);
  const Placement rest_of_it{.rotation = entry.placement.rotation, .translate = entry.placement.translate};
  part.mesh = placed(std::move(part.mesh), rest_of_it, entry.mesh.string());
  part.seams = seam_plans(entry, part.mesh);
  std::vector<int> sewn;
  for (const SeamPlan& seam : part.seams)
    for (const auto& [one, two] : seam.pairs) sewn.insert(sewn.end(), {one, two});
  part.report = examine(part.mesh, part.weld, sewn);
  add_messages(*part.report, entry.mesh.string(), messages);
  return part;
}

namespace {

void add_cloth(const ClothEntry& entry, Simulation& simulation) {
  ClothPart part = load_cloth(entry, simulation.messages);
  try {
    for (const Cloth::Stitched& open : simulation.add(std::move(part)).seams)
      tell_of_gathers(open.seam, simulation.messages);
  } catch (const InputError& error) {
    if (entry.model != "choi-ko") throw InputError(entry.where + ": " + error.what());
    throw InputError(entry.where + ": model = \"choi-ko\": " + entry.mesh.string() + ": " + error.what() +
                     "; use model = \"noh-jung\" for any other mesh");
  }
}

}  // namespace

void load_parts(const Scene& scene, Simulation& simulation) {
  for (const ClothEntry& entry : scene.cloths) add_cloth(entry, simulation);
  for (const SoftEntry& entry : scene.softs) {
    SoftPart part = load_soft(entry, simulation.messages);
    try {
      if (entry.self_contact) part.self_contact = entry.self;
      simulation.add(std::move(part));
    } catch (const InputError& error) {
      throw InputError(entry.where + ": " + error.what());
    }
  }
  for (const RopeEntry& entry : scene.ropes) {
    RopePart part = load_rope(entry, simulation);
    try {
      simulation.add(std::move(part));
    } catch (const InputError& error) {
      throw InputError(entry.where + ": " + error.what());
    }
  }
}

}  // namespace drape::app
