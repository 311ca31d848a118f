#include "app/scene/pin_read.h"

#include <algorithm>

#include "app/scene/motion_read.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

namespace fs = std::filesystem;

PinBox read_pin_box(const Table& pin, const Node& box) {
  if (box.kind != Node::Kind::array || box.items.size() != 2)
    pin.fail("box", "expected two corners, [[x, y, z], [x, y, z]]");
  PinBox by_box;
  try {
    by_box.lower = vector(box.items[0], dimension::length);
    by_box.upper = vector(box.items[1], dimension::length);
  } catch (const InputError& error) {
    pin.fail("box", error.what());
  }
  if ((by_box.lower.array() > by_box.upper.array()).any())
    pin.fail("box", "the first corner must be the lower one");
  return by_box;
}

PinRule read_end(Table& pin) {
  pin.only_of("of a rope");
  PinEnd rule;
  rule.last = read_is_last(pin, "which end of the rope; this, vertices or box");
  pin.only_of({});
  for (const char* key : {"vertices", "box"})
    if (pin.has(key)) pin.fail(key, "goes without end; give one of both");
  return rule;
}

PinRule read_pin_rule(Table& pin, PinsOf of) {
  if (of == PinsOf::rope && pin.has("end")) return read_end(pin);
  PinVertices by_number;
  PinGroup by_group;
  pin.read("vertices", by_number.vertices, "numbers of vertices, from 0, in the file's order");
  const Node* const box =
      pin.take("box", "[[x, y, z], [x, y, z]], lengths in m",
               "lower and upper corner: all vertices that are in it after the cloth is placed");
  if (of == PinsOf::mesh) pin.read("group", by_group.name, "a group of the mesh: all its vertices");
  if (pin.has("vertices") + pin.has("box") + pin.has("group") != 1)
    pin.fail("", of == PinsOf::mesh
                     ? "expected one of vertices = [...], box = [[...], [...]], group = \"...\""
                     : "expected one of end = \"first\" or \"last\", vertices = [...], box = [[...], [...]]");
  if (pin.has("vertices")) return by_number;
  if (pin.has("group")) return by_group;
  return read_pin_box(pin, *box);
}

}  // namespace

PinEntry read_pin(Table& pin, const fs::path& folder, PinsOf of) {
  PinEntry entry;
  entry.where = pin.where();
  pin.read("follow", entry.follow, "name of an obstacle that the vertices move with");
  entry.motion = read_motion(pin, folder, Vec3::Zero(), entry.source);
  entry.rule = read_pin_rule(pin, of);
  pin.finish();
  if (pin.has("follow") && entry.follow.empty()) pin.fail("follow", "expected the name of an obstacle");
  if (pin.has("follow") && pin.has("motion"))
    pin.fail("follow", "a pin follows a body or has a motion of its own, not both");
  return entry;
}

bool read_is_last(Table& table, const About& about) {
  std::string end;
  table.read_required("end", end, Names{"first", "last"}, about);
  return end == "last";
}

void check_obstacle(const std::string& where, const std::string& key, const std::string& name,
                    const std::vector<ObstacleEntry>& obstacles) {
  Names names;
  for (const ObstacleEntry& obstacle : obstacles) names.push_back(obstacle.name);
  const auto count = std::count(names.begin(), names.end(), name);
  if (count == 1) return;
  const std::string start = where + ": " + key + " = \"" + one_line(name) + "\": ";
  if (count == 0) throw InputError(start + "there is no obstacle of that name; " + suggestion(name, names));
  throw InputError(start + "there are " + std::to_string(count) +
                   " obstacles of that name; give each a name of its own");
}

void check_follow(const PinEntry& pin, const std::vector<ObstacleEntry>& obstacles) {
  if (!pin.follow.empty()) check_obstacle(pin.where, "follow", pin.follow, obstacles);
}

}  // namespace drape::app
