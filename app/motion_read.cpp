#include "app/motion_read.h"

#include <string>

#include "app/obstacle_read.h"
#include "app/pose_csv.h"
#include "mesh/obj.h"

namespace drape {
namespace {

namespace fs = std::filesystem;

// One turn counts whole turns, several are one orientation, the nearest to the one before.
Vec3 rotation_of(const Turns& turns, const Vec3& before) {
  if (turns.size() == 1) return turns.front().angle() * turns.front().axis();
  return unwrapped(Eigen::Quaterniond(product(turns)), before);
}

std::vector<Keyframe> read_keyframes(Table& motion) {
  std::vector<Keyframe> all;
  for (Table& table : motion.tables("keyframes")) {
    Keyframe keyframe = all.empty() ? Keyframe{} : all.back();  // what is not given stays
    table.read_required("time", keyframe.time, dimension::time);
    table.read("translate", keyframe.translate, dimension::length);
    const Turns turns = read_turns(table);
    if (table.has("rotate")) keyframe.rotation = rotation_of(turns, keyframe.rotation);
    table.finish();
    try {
      if (!all.empty()) check_order(all.back(), keyframe);
    } catch (const InputError& error) {
      table.fail("time", error.what());
    }
    all.push_back(keyframe);
  }
  if (all.empty())
    motion.fail("keyframes", "expected at least one, as { time = \"0 s\", translate = [...] }");
  return all;
}

fs::path pose_file(Table& motion, const fs::path& folder) {
  std::string name;
  motion.read("poses", name);
  if (name.empty()) motion.fail("poses", "expected the name of a CSV file");
  const fs::path path = (folder / name).lexically_normal();
  if (!fs::exists(path)) motion.fail("poses", path.string() + ": no such file");
  return path;
}

Motion read_steady(Table& motion, const Vec3& centre, double& start) {
  if (!motion.has("velocity") && !motion.has("spin"))
    motion.fail("", "there is a start or an end, but neither velocity nor spin");
  Vec3 velocity = Vec3::Zero();
  std::optional<double> end;
  motion.read("velocity", velocity, dimension::speed);
  motion.read("start", start, dimension::time);
  motion.read("end", end, dimension::time);
  if (end && !(*end > start)) motion.fail("end", "must come after the start, " + rounded(start, 6) + " s");
  const Vec3 spin = read_spin(motion);
  return end ? Motion::constant(velocity, spin, centre, start, *end)
             : Motion::constant(velocity, spin, centre, start);
}

}  // namespace

Vec3 read_spin(Table& table) {
  const Node* const node = table.take("spin");
  if (!node) return Vec3::Zero();
  if (node->kind != Node::Kind::table)
    table.fail("spin", "expected { axis = [0, 1, 0], rate = \"90 deg/s\" }");
  Table spin = table.tables("spin").front();
  double rate = 0;
  const Vec3 axis = read_axis(spin);
  spin.read_required("rate", rate, dimension::angular_rate);
  spin.finish();
  return rate * axis;
}

std::optional<Motion> read_motion(Table& table, const fs::path& folder, const Vec3& default_centre,
                                  MotionSource& source) {
  const Node* const node = table.take("motion");
  if (!node) return std::nullopt;
  const std::string kinds = "one of velocity and spin, keyframes = [...], poses = \"poses.csv\"";
  if (node->kind != Node::Kind::table) table.fail("motion", "expected a table with " + kinds);
  Table motion = table.tables("motion").front();
  for (const char* key : {"velocity", "spin", "start", "end", "keyframes", "poses", "centre"})
    motion.take(key);
  motion.finish();
  const bool steady =
      motion.has("velocity") || motion.has("spin") || motion.has("start") || motion.has("end");
  if (steady + motion.has("keyframes") + motion.has("poses") != 1) motion.fail("", "expected " + kinds);

  Vec3 centre = default_centre;
  motion.read("centre", centre, dimension::length);
  if (steady) {
    source.kind = "velocity and spin";
    return read_steady(motion, centre, source.start);
  }
  source.kind = motion.has("keyframes") ? "keyframes" : "poses";
  if (motion.has("poses")) source.poses = pose_file(motion, folder);
  const std::vector<Keyframe> all =
      motion.has("keyframes") ? read_keyframes(motion) : read_poses(source.poses);
  const Motion path = Motion::keyframes(all, centre);  // refuses none
  source.start = all.front().time;
  return path;
}

}  // namespace drape
