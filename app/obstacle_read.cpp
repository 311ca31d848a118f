#include "app/obstacle_read.h"

#include "app/body_frames.h"
#include "app/motion_read.h"
#include "app/rigid_read.h"
#include "mesh/obj.h"

namespace drape {

namespace fs = std::filesystem;

Vec3 read_axis(Table& table) {
  Vec3 axis = Vec3::UnitY();
  table.read_required("axis", axis, dimension::number);
  if (!(axis.norm() > 0)) table.fail("axis", "expected an axis that has a length");
  return axis.normalized();
}

Turns read_turns(Table& table) {
  Turns turns;
  for (Table& turn : table.tables("rotate")) {
    double angle = 0;
    const Vec3 axis = read_axis(turn);
    turn.read_required("angle", angle, dimension::angle);
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

Placement read_placement(Table& table) {
  Placement placement;
  table.read("scale", placement.scale, dimension::number, Range::positive);
  placement.rotation = read_rotation(table);
  table.read("translate", placement.translate, dimension::length);
  return placement;
}

fs::path read_path(Table& table, const std::string& key, const fs::path& folder) {
  std::string text;
  table.read_required(key, text);
  if (text.empty()) table.fail(key, "expected the name of an OBJ file");
  return (folder / text).lexically_normal();
}

namespace {

Shape read_plane(Table& table) {
  Plane plane;
  table.read("point", plane.point, dimension::length);
  table.read("normal", plane.normal, dimension::number);
  return plane;
}

Shape read_sphere(Table& table) {
  Sphere sphere;
  table.read("centre", sphere.centre, dimension::length);
  table.read_required("radius", sphere.radius, dimension::length, Range::positive);
  return sphere;
}

Shape read_bowl(Table& table) {
  Bowl bowl;
  table.read("centre", bowl.centre, dimension::length);
  table.read_required("radius", bowl.radius, dimension::length, Range::positive);
  table.read("thickness", bowl.thickness, dimension::length, Range::positive);
  table.read("axis", bowl.axis, dimension::number);
  return bowl;
}

Shape read_box(Table& table) {
  Box box;
  table.read("centre", box.centre, dimension::length);
  table.read_required("size", box.size, dimension::length);
  box.rotation = read_rotation(table);
  return box;
}

Shape read_capsule(Table& table) {
  Capsule capsule;
  table.read_required("a", capsule.a, dimension::length);
  table.read_required("b", capsule.b, dimension::length);
  table.read_required("radius", capsule.radius, dimension::length, Range::positive);
  return capsule;
}

void read_level_set(Table& table, const fs::path& folder, ObstacleEntry& entry) {
  entry.mesh = read_path(table, "mesh", folder);
  entry.placement = read_placement(table);
  table.read("voxel", entry.voxel, dimension::length, Range::positive);
  if (table.has("voxel") && is_vdb(entry.mesh))
    table.fail("voxel", "a .vdb file has its own; expected none, or an OBJ file as mesh");
  entry.obstacle.shape = LevelSetBody();
}

Friction read_friction(Table& table) {
  Friction friction;
  const Node* const node = table.take("friction");
  if (!node) return friction;
  if (node->kind != Node::Kind::table) {
    double mu = friction.statics;
    table.read("friction", mu, dimension::number, Range::not_negative);
    return friction = mu;
  }
  Table both = table.tables("friction").front();
  both.read_required("static", friction.statics, dimension::number, Range::not_negative);
  both.read_required("kinetic", friction.kinetic, dimension::number, Range::not_negative);
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
  table.read_required("shape", shape, shape_names());
  if (shape == "plane") entry.obstacle.shape = read_plane(table);
  if (shape == "sphere") entry.obstacle.shape = read_sphere(table);
  if (shape == "bowl") entry.obstacle.shape = read_bowl(table);
  if (shape == "box") entry.obstacle.shape = read_box(table);
  if (shape == "capsule") entry.obstacle.shape = read_capsule(table);
  if (shape == "mesh") {
    entry.mesh = read_path(table, "mesh", folder);
    entry.placement = read_placement(table);
    entry.frames = read_frames(table, folder);
    entry.obstacle.shape = MeshBody();
  }
  if (shape == "level-set") read_level_set(table, folder, entry);
  entry.name = !entry.mesh.empty() ? entry.mesh.filename().string() : shape;
  table.read("name", entry.name);
  entry.obstacle.friction = read_friction(table);
  table.read("margin", entry.obstacle.margin, dimension::length, Range::not_negative);
  table.read("restitution", entry.obstacle.restitution, dimension::number, Range::not_negative);
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
