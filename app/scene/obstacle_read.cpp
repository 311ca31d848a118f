#include "app/scene/obstacle_read.h"

#include "app/scene/body_frames.h"
#include "app/scene/motion_read.h"
#include "app/scene/rigid_read.h"
#include "mesh/base/errors.h"

namespace drape {

namespace fs = std::filesystem;

Vec3 read_axis(Table& table) {
  Vec3 axis = Vec3::UnitY();
  table.read_required("axis", axis, dimension::number, "any length but zero");
  if (!(axis.norm() > 0)) table.fail("axis", "expected an axis that has a length");
  return axis.normalized();
}

Turns read_turns(Table& table) {
  Turns turns;
  for (Table& turn : table.tables("rotate", "turns, one after the other, about axes through the origin")) {
    double angle = 0;
    const Vec3 axis = read_axis(turn);
    turn.read_required("angle", angle, dimension::angle, Range::any,
                       "counter-clockwise, seen against the axis");
    turn.finish();
    turns.emplace_back(angle, axis);
  }
  return turns;
}

Mat3 product(const Turns& turns) {
  Mat3 rotation = Mat3::Identity();
  for (const Eigen::AngleAxisd& turn : turns) rotation = turn.toRotationMatrix() * rotation;
  return rotation;
}

Mat3 read_rotation(Table& table) { return product(read_turns(table)); }

Placement read_place(Table& table) {
  Placement placement;
  placement.rotation = read_rotation(table);
  table.read("translate", placement.translate, dimension::length, "moves it, last");
  return placement;
}

Placement read_placement(Table& table) {
  double scale = 1;
  table.read("scale", scale, dimension::number, Range::positive,
             "multiplies all lengths of the file, first: 0.01 for a file in cm");
  Placement placement = read_place(table);
  placement.scale = scale;
  return placement;
}

fs::path read_path(Table& table, const fs::path& folder, const About& about) {
  std::string text;
  table.read_required("mesh", text, about);
  if (text.empty()) table.fail("mesh", "expected the name of an OBJ file");
  if (fs::is_directory(folder / text)) table.fail("mesh", "is a directory; name an OBJ file in it");
  return (folder / text).lexically_normal();
}

namespace {

Shape read_plane(Table& table) {
  Plane plane;
  table.read("point", plane.point, dimension::length, "any point of it");
  table.read("normal", plane.normal, dimension::number, "to the side of the cloth; of any length");
  return plane;
}

Shape read_sphere(Table& table) {
  Sphere sphere;
  table.read("centre", sphere.centre, dimension::length, "its middle");
  table.read_required("radius", sphere.radius, dimension::length, Range::positive, "its size");
  return sphere;
}

Shape read_bowl(Table& table) {
  Bowl bowl;
  table.read("centre", bowl.centre, dimension::length, "of the half sphere");
  table.read_required("radius", bowl.radius, dimension::length, Range::positive, "of its inside");
  table.read("thickness", bowl.thickness, dimension::length, Range::positive, "of its wall, outwards");
  table.read("axis", bowl.axis, dimension::number, "to the side that is open");
  return bowl;
}

Shape read_box(Table& table) {
  Box box;
  table.read("centre", box.centre, dimension::length, "its middle, about which it is turned");
  table.read_required("size", box.size, dimension::length, "its edges");
  box.rotation = read_rotation(table);
  return box;
}

Shape read_capsule(Table& table) {
  Capsule capsule;
  table.read_required("a", capsule.a, dimension::length, "one end of its axis");
  table.read_required("b", capsule.b, dimension::length, "the other end");
  table.read_required("radius", capsule.radius, dimension::length, Range::positive,
                      "round the axis and of the half spheres beyond its ends");
  return capsule;
}

void read_level_set(Table& table, const fs::path& folder, ObstacleEntry& entry) {
  entry.mesh = read_path(table, folder, "closed OBJ file, or a .vdb file");
  entry.placement = read_placement(table);
  table.read("voxel", entry.voxel, dimension::length, Range::positive,
             {"spacing of the grid; a .vdb file has its own", "chosen from the mesh"});
  if (table.has("voxel") && is_vdb(entry.mesh))
    table.fail("voxel", "a .vdb file has its own; expected none, or an OBJ file as mesh");
  entry.obstacle.shape = LevelSetBody();
}

Friction read_friction(Table& table) {
  Friction friction;
  const About about("coefficient of friction; or of sticking and sliding apart, as a table", "0.3");
  const Node* const node = table.take("friction", "a number ≥ 0, or a table", about);
  if (!node) return friction;
  if (node->kind != Node::Kind::table) {
    double mu = friction.statics;
    table.read("friction", mu, dimension::number, Range::not_negative, about);
    return friction = mu;
  }
  Table both = table.inner("friction");
  both.read_required("static", friction.statics, dimension::number, Range::not_negative, "of what sticks");
  both.read_required("kinetic", friction.kinetic, dimension::number, Range::not_negative,
                     "of what slides; at most the static one");
  both.finish();
  if (friction.kinetic > friction.statics)
    both.fail("kinetic", "is more than static = " + shortest(friction.statics) +
                             ": what slides is not held more than what sticks; expected at most that, or a "
                             "greater static friction");
  return friction;
}

}  // namespace

Vec3 middle(const ObstacleEntry& entry) {
  const Shape& shape = entry.obstacle.shape;
  if (const Plane* const plane = std::get_if<Plane>(&shape)) return plane->point;
  if (const Sphere* const sphere = std::get_if<Sphere>(&shape)) return sphere->centre;
  if (const Bowl* const bowl = std::get_if<Bowl>(&shape)) return bowl->centre;
  if (const Box* const box = std::get_if<Box>(&shape)) return box->centre;
  if (const Capsule* const capsule = std::get_if<Capsule>(&shape)) return (capsule->a + capsule->b) / 2;
  return entry.placement.translate;
}

ObstacleEntry read_obstacle(Table& table, const fs::path& folder) {
  ObstacleEntry entry;
  entry.where = table.where();
  std::string shape;
  table.read_required("shape", shape, shape_names(), "what kind of body; each has keys of its own, below");
  table.only_of("with shape = \"" + shape + "\"");
  if (shape == "plane") entry.obstacle.shape = read_plane(table);
  if (shape == "sphere") entry.obstacle.shape = read_sphere(table);
  if (shape == "bowl") entry.obstacle.shape = read_bowl(table);
  if (shape == "box") entry.obstacle.shape = read_box(table);
  if (shape == "capsule") entry.obstacle.shape = read_capsule(table);
  if (shape == "mesh") {
    entry.mesh = read_path(table, folder, "OBJ file; a closed body, any other is a thick surface");
    entry.placement = read_placement(table);
    entry.frames = read_frames(table, folder);
    entry.obstacle.shape = MeshBody();
  }
  if (shape == "level-set") read_level_set(table, folder, entry);
  table.only_of({});
  entry.name = !entry.mesh.empty() ? entry.mesh.filename().string() : shape;
  table.read("name", entry.name,
             {"stands in messages; unique where a pin follows it", "the mesh's, or the shape"});
  entry.obstacle.friction = read_friction(table);
  table.read("margin", entry.obstacle.margin, dimension::length, Range::not_negative,
             "distance that the cloth keeps");
  table.read("restitution", entry.obstacle.restitution, dimension::number, Range::not_negative,
             "0 to 1: the part of the normal velocity that an impact gives back; with contact = "
             "\"restitution\" only");
  if (entry.obstacle.restitution > 1) table.fail("restitution", "expected a number from 0 to 1");
  entry.obstacle.motion = read_motion(table, folder, middle(entry), entry.source).value_or(Motion());
  read_rigid(table, entry, middle(entry));
  table.finish();
  try {
    if (entry.mesh.empty()) check(entry.obstacle);
  } catch (const InputError& error) {
    throw InputError(entry.where + ": " + error.what());
  }
  return entry;
}

Names shape_names() { return {"plane", "sphere", "bowl", "box", "capsule", "mesh", "level-set"}; }

bool is_vdb(const fs::path& path) { return path.extension() == ".vdb"; }

}  // namespace drape
