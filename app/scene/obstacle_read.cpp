#include "app/scene/obstacle_read.h"

#include "app/scene/body_frames.h"
#include "app/scene/motion_read.h"
#include "app/scene/rigid_read.h"
#include "app/scene/shape_table.h"
#include "mesh/base/errors.h"

namespace drape::app {

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

template <class Kind>
void read_field(Table& table, const Field<Kind, double>& field, double& value) {
  table.read(field.name, value, dimension::length,
             field.measure == Measure::rounding ? Range::not_negative : Range::positive, field.about);
}

template <class Kind>
void read_field(Table& table, const Field<Kind, Vec3>& field, Vec3& value) {
  const bool direction = field.measure == Measure::direction;
  table.read(field.name, value, direction ? dimension::number : dimension::length, field.about);
}

template <class Kind>
void read_field(Table& table, const Field<Kind, Mat3>&, Mat3& value) {
  value = read_rotation(table);
}

template <class Kind>
Kind read_built_in(Table& table) {
  Kind shape;
  for_each_field<Kind>([&](const auto& field) {
    if (field.required) table.require(field.key());
    read_field(table, field, shape.*field.member);
  });
  return shape;
}

void read_mesh(Table& table, const fs::path& folder, ObstacleEntry& entry) {
  entry.mesh = read_path(table, folder, "OBJ file; a closed body, any other is a thick surface");
  entry.placement = read_placement(table);
  entry.frames = read_frames(table, folder);
  entry.obstacle.shape = MeshBody();
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
  return entry.mesh.empty() ? middle_of(entry.obstacle.shape) : entry.placement.translate;
}

ObstacleEntry read_obstacle(Table& table, const fs::path& folder) {
  ObstacleEntry entry;
  entry.where = table.where();
  std::string shape;
  table.read_required("shape", shape, shape_names(), "what kind of body; each has keys of its own, below");
  table.only_of("with shape = \"" + shape + "\"");
  for_each_built_in([&]<class Kind>(const Kind& standard) {
    if (shape == name(standard)) entry.obstacle.shape = read_built_in<Kind>(table);
  });
  if (shape == "mesh") read_mesh(table, folder, entry);
  if (shape == "level-set") read_level_set(table, folder, entry);
  table.only_of({});
  entry.name = !entry.mesh.empty() ? entry.mesh.filename().string() : shape;
  table.read("name", entry.name,
             {"stands in messages; unique where a pin follows it", "the mesh's, or the shape"});
  entry.obstacle.friction = read_friction(table);
  table.read("margin", entry.obstacle.margin, dimension::length, Range::not_negative,
             "distance that the cloth keeps");
  table.read("restitution", entry.obstacle.restitution, dimension::number, Range::not_negative,
             "0 to 1: the part of the normal velocity that an impact gives back; of cloth with contact = "
             "\"restitution\" only, of bodies always");
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

Names shape_names() {
  Names names;
  for_each_built_in([&](const auto& standard) { names.emplace_back(name(standard)); });
  names.insert(names.end(), {"mesh", "level-set"});
  return names;
}

bool is_vdb(const fs::path& path) { return path.extension() == ".vdb"; }

}  // namespace drape::app
