#include "app/scene/motion_read.h"

#include <string>

#include "app/scene/obstacle_read.h"
#include "app/scene/pose_csv.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

namespace fs = std::filesystem;

// One turn counts whole turns, several are one orientation, the nearest to the one before.
Vec3 rotation_of(const Turns& turns, const Vec3& before) {
  if (turns.size() == 1) return turns.front().angle() * turns.front().axis();
  return unwrapped(Eigen::Quaterniond(product(turns)), before);
}

std::vector<Keyframe> read_keyframes(Table& motion) {
  std::vector<Keyframe> all;
  for (Table& table : motion.tables("keyframes", "places and turns in the order of time")) {
    Keyframe keyframe = all.empty() ? Keyframe{} : all.back();  // what is not given stays
    table.read_required("time", keyframe.time, dimension::time, Range::any, "when it is there");
    const char* const before = "as before; at first not moved";
    table.read("translate", keyframe.translate, dimension::length, {"how far it is moved, d", before});
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
  return all;
}

fs::path pose_file(const Table& motion, const std::string& name, const fs::path& folder) {
  if (name.empty()) motion.fail("poses", "expected the name of a CSV file");
  const fs::path path = (folder / name).lexically_normal();
  if (!fs::exists(path)) motion.fail("poses", path.string() + ": no such file");
  return path;
}

// A steady motion: the keys that it may have.
struct Steady {
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();  // m/s, rad/s
  double start = 0;                                   // s
  std::optional<double> end;                          // s

  explicit Steady(Table& motion) {
    motion.read("velocity", velocity, dimension::speed, "steady; how it is moved");
    spin = read_spin(motion);
    motion.read("start", start, dimension::time, Range::any, "of velocity and spin: before, it stands");
    motion.read("end", end, dimension::time, Range::any, {"of these: after it, it stays", "never"});
  }

  Motion about(const Table& motion, const Vec3& centre) const {
    if (!motion.has("velocity") && !motion.has("spin"))
      motion.fail("", "there is a start or an end, but neither velocity nor spin");
    if (end && !(*end > start)) motion.fail("end", "must come after the start, " + rounded(start, 6) + " s");
    return end ? Motion::constant(velocity, spin, centre, start, *end)
               : Motion::constant(velocity, spin, centre, start);
  }
};

}  // namespace

Vec3 read_spin(Table& table) {
  const Node* const node = table.take("spin", "a table", "how it turns");
  if (!node) return Vec3::Zero();
  if (node->kind != Node::Kind::table)
    table.fail("spin", "expected { axis = [0, 1, 0], rate = \"90 deg/s\" }");
  Table spin = table.inner("spin");
  double rate = 0;
  const Vec3 axis = read_axis(spin);
  spin.read_required("rate", rate, dimension::angular_rate, Range::any,
                     "names its angle: rpm, deg/s, rad/s, turn/s (Hz is refused)");
  spin.finish();
  return rate * axis;
}

std::optional<Motion> read_motion(Table& table, const fs::path& folder, const Vec3& default_centre,
                                  MotionSource& source) {
  const Node* const node =
      table.take("motion", "a table", "how it is moved: steadily, by keyframes or by poses");
  if (!node) return std::nullopt;
  const std::string kinds = "one of velocity and spin, keyframes = [...], poses = \"poses.csv\"";
  if (node->kind != Node::Kind::table) table.fail("motion", "expected a table with " + kinds);
  Table motion = table.inner("motion");
  Vec3 centre = default_centre;
  motion.read("centre", centre, dimension::length,
              {"c, about which it turns",
               "the body's middle: of a plane its point, of a mesh its translate; of "
               "pins the origin"});
  const Steady steady(motion);
  std::vector<Keyframe> all = read_keyframes(motion);
  std::string poses;
  motion.read("poses", poses, "a CSV file");
  motion.finish();
  const bool is_steady =
      motion.has("velocity") || motion.has("spin") || motion.has("start") || motion.has("end");
  if (is_steady + motion.has("keyframes") + motion.has("poses") != 1) motion.fail("", "expected " + kinds);

  if (is_steady) {
    source.kind = "velocity and spin";
    source.start = steady.start;
    return steady.about(motion, centre);
  }
  source.kind = motion.has("keyframes") ? "keyframes" : "poses";
  if (motion.has("poses")) {
    source.poses = pose_file(motion, poses, folder);
    all = read_poses(source.poses);
  }
  if (all.empty())
    motion.fail("keyframes", "expected at least one, as { time = \"0 s\", translate = [...] }");
  const Motion path = Motion::keyframes(all, centre);  // refuses none
  source.start = all.front().time;
  return path;
}

}  // namespace drape::app
