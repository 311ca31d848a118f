#include "app/scene/rope_read.h"

#include <algorithm>

#include "app/scene/obstacle_read.h"
#include "app/scene/pin_read.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

void read_points(Table& table, RopeEntry& rope) {
  const Node* const node = table.take("points", "[[x, y, z], ...], lengths in m",
                                      {"the points that it starts through; this, or mesh", "by mesh"});
  if (node->kind != Node::Kind::array)
    table.fail("points", "expected a list of points, [[x, y, z], [x, y, z]]");
  try {
    for (const Node& point : node->items) rope.points.push_back(vector(point, dimension::length));
  } catch (const InputError& error) {
    table.fail("points", error.what());
  }
  if (rope.points.size() < 2)
    table.fail("points", "a rope has two points at least, and there " +
                             (rope.points.empty() ? std::string("are none") : "is one"));
  for (std::size_t k = 1; k < rope.points.size(); ++k)
    if (rope.points[k] == rope.points[k - 1])
      table.fail("points", "points " + std::to_string(k - 1) + " and " + std::to_string(k) +
                               " (from 0) are at one place; leave one of them out");
}

void read_course(Table& table, const std::filesystem::path& folder, RopeEntry& rope) {
  if (table.has("points") == table.has("mesh"))
    table.fail(table.has("mesh") ? "points" : "",
               "expected either points = [[x, y, z], ...], or mesh = \"rope.obj\" with lines ('l')");
  if (table.has("mesh")) {
    table.only_of("of a file");
    rope.mesh = read_path(table, folder, "OBJ file with lines (`l`)");
    table.read("line", rope.line, {"name of the line: that of the `g` or `o` before it", "the only one"});
    table.only_of({});
  } else {
    read_points(table, rope);
  }
  const char* const as_it_is = "the points as they are";
  if (table.has("segments") && table.has("spacing"))
    table.fail("segments", "give either segments or spacing, not both");
  int segments = 0;
  table.read("segments", segments, 1,
             {"it is divided anew, into so many segments of one length; this or spacing", as_it_is});
  if (table.has("segments")) rope.segments = segments;
  table.read("spacing", rope.spacing, dimension::length, Range::positive,
             {"the same by their length, as nearly as a whole number of them has it", as_it_is});
  rope.placement = read_placement(table);
}

void read_material(Table& table, RopeMaterial& material) {
  table.read_required("mass_per_length", material.mass_per_length, dimension::line_density, Range::positive,
                      "half of each segment's mass goes to each of its ends");
  table.read("stretch", material.stretch, dimension::force, Range::positive,
             "EA, the force that would stretch it to twice its length; it resists compression as well");
  table.read("bend", material.bend, dimension::rope_bend, Range::not_negative, "B, it rests straight");
  table.read("damping", material.damping, dimension::rope_damping, Range::not_negative,
             "of stretch: the force at a rate of strain of 1/s");
  table.read(
      "bend_damping", material.bend_damping, dimension::rope_bend_damping, Range::not_negative,
      "of bending: the moment at a rate of curvature of 1/(m s); a bend that goes round is not damped");
  table.read("radius", material.radius, dimension::length, Range::positive,
             "its axis rests that far, and a margin, off a body, and as far off cloth, beside half of its "
             "thickness; "
             "it is drawn that thick");
}

AnchorEntry read_anchor(Table& table) {
  AnchorEntry anchor;
  anchor.where = table.where();
  anchor.last = read_is_last(table, "the end that is fastened");
  table.read_required("body", anchor.body,
                      "name of the obstacle that carries the end, and is pulled by it where it has a mass");
  Vec3 at = Vec3::Zero();
  table.read("at", at, dimension::length,
             {"where the end has to be at the start, to check the scene", "anywhere in the body"});
  if (table.has("at")) anchor.at = at;
  table.finish();
  return anchor;
}

JoinEntry read_join(Table& table) {
  JoinEntry join;
  join.where = table.where();
  join.last = read_is_last(table, "the end that is joined");
  table.read_required(
      "to", join.to,
      "name of a cloth, a soft body or an earlier rope: the end becomes its nearest vertex, for good");
  table.read("within", join.within, dimension::length, Range::positive,
             {"how far off that vertex may be; the end starts where it is", "the radius"});
  table.finish();
  return join;
}

}  // namespace

RopeEntry read_rope(Table& table, const std::filesystem::path& folder) {
  RopeEntry rope;
  rope.where = table.where();
  read_course(table, folder, rope);
  read_material(table, rope.material);
  rope.has_own_radius = table.has("radius");
  for (Table& anchor : table.tables("anchors", "ends that are fastened to bodies"))
    rope.anchors.push_back(read_anchor(anchor));
  for (Table& join : table.tables("joins", "ends that are joined to cloths, soft bodies or ropes"))
    rope.joins.push_back(read_join(join));
  return rope;
}

void check_ends(const RopeEntry& rope, const Scene& scene) {
  const auto check_once = [](const auto& ends) {
    for (std::size_t k = 1; k < ends.size(); ++k)
      for (std::size_t l = 0; l < k; ++l)
        if (ends[k].last == ends[l].last)
          throw InputError(ends[k].where + ": end = \"" + (ends[k].last ? "last" : "first") +
                           "\": " + ends[l].where + " has the same end; leave one of them out");
  };
  for (const PinEntry& pin : rope.pins)
    for (const AnchorEntry& anchor : rope.anchors)
      if (const auto* end = std::get_if<PinEnd>(&pin.rule); end && end->last == anchor.last)
        throw InputError(pin.where + ": end = \"" + (anchor.last ? "last" : "first") + "\": " + anchor.where +
                         " anchors that end to a body; leave one of them out");
  check_once(rope.anchors);
  check_once(rope.joins);
  for (const AnchorEntry& anchor : rope.anchors)
    check_obstacle(anchor.where, "body", anchor.body, scene.obstacles);
  Names names;
  for (const ClothEntry& cloth : scene.cloths) names.push_back(cloth.name);
  for (const SoftEntry& soft : scene.softs) names.push_back(soft.name);
  for (const RopeEntry& other : scene.ropes) {
    if (other.name == rope.name) break;
    names.push_back(other.name);
  }
  for (const JoinEntry& join : rope.joins)
    if (std::find(names.begin(), names.end(), join.to) == names.end())
      throw InputError(join.where + ": to = \"" + one_line(join.to) +
                       "\": there is no cloth, soft body or earlier rope of that name; " +
                       suggestion(join.to, names));
}

}  // namespace drape::app
