// A scene as it was asked for: what to drape, over what, for how long. Plain data in SI units; docs/scene.md
// lists the keys. Nothing is loaded yet: app/simulation/simulation.h makes it run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/base/key_notes.h"
#include "app/base/settings.h"
#include "app/base/words.h"
#include "constraints/constraints.h"
#include "mesh/pattern/pattern.h"
#include "solver/forces/fabric.h"
#include "solver/forces/soft.h"
#include "solver/integrators/integrator.h"

namespace drape {

// x -> rotation (scale x) + translate
struct Placement {
  double scale = 1;
  Mat3 rotation = Mat3::Identity();
  Vec3 translate = Vec3::Zero();  // m
};

// How a motion was given, for what is said of it.
struct MotionSource {
  std::string kind;             // "keyframes", "poses", "velocity and spin"; empty: there is none
  double start = 0;             // s
  std::filesystem::path poses;  // the CSV file that it was read from, if it was
};

struct PinEntry {
  PinRule rule;
  std::string where;             // "scene.toml:21"
  std::string follow;            // the obstacle that it is fastened to; empty: none
  std::optional<Motion> motion;  // or a path of its own
  MotionSource source;
};

// Where a panel of a pattern starts: the middle of its box is brought to the origin, what lies flat in the
// plane z = 0 is wrapped round the y axis, and it is placed.
struct PanelEntry {
  std::string group;           // of the OBJ file
  std::optional<double> wrap;  // m, the radius of the cylinder
  Placement placement;         // without a scale
  std::string where;
};

// Two curves that are sewn together: pulled from where they are to each other, vertex by vertex.
struct SeamEntry {
  Names curves;                     // two lines of the OBJ file; none: every seam that the file declares
  bool same_direction = false;      // the first vertices of both belong together; else the first and the last
  double close = 1;                 // s
  std::optional<double> stiffness;  // N/m, of a stitch; none: chosen
  bool merge = true;                // once closed the particles of a pair become one
  std::string where;
};

struct ClothEntry {
  std::string name;            // of the output files
  std::filesystem::path mesh;  // OBJ, or a pattern (SVG, TOML)
  TriangulateOptions pattern;  // how a pattern is made a mesh
  Placement placement;         // of the rest shape and of the start
  bool rest_is_flat = false;   // the texture coordinates are the rest shape
  double uv_scale = 1;         // m
  std::vector<PanelEntry> panels;
  std::vector<SeamEntry> seams;
  std::string model = "noh-jung";
  std::string fabric_name;  // empty: none was named
  Fabric fabric;
  std::vector<PinEntry> pins;
  std::string where;
};

// A lattice of particles and springs: a box of them, or the inside of a mesh.
struct SoftEntry {
  std::string name;                          // of the output files
  std::filesystem::path mesh;                // OBJ, closed; empty: a box
  std::array<int, 3> particles = {0, 0, 0};  // of a box, along x, y and z
  Vec3 spacing = Vec3::Zero();               // m; of a mesh the same along all
  Placement placement;                       // of mesh and lattice together
  SoftMaterial material;
  std::vector<PinEntry> pins;
  std::string where;
};

// A body that moves by what acts on it.
struct RigidBodyEntry {
  double mass = 0;               // kg
  std::optional<Vec3> inertia;   // kg m^2, about the axes through its centre of mass; a mesh's: by the mesh
  Vec3 centre = Vec3::Zero();    // m, of mass, at first; a mesh's: by the mesh
  Mat3 axes = Mat3::Identity();  // as it stands at first: a box's edges, a capsule's a b and two across
  Vec3 velocity = Vec3::Zero();  // m/s, of the centre of mass, at first
  Vec3 spin = Vec3::Zero();      // rad/s
};

// Where a deforming body is in time: app/scene/body_frames.h reads it.
struct FramesEntry {
  // OBJ files in order, one PC2 file, or one pattern; none: it stands.
  std::vector<std::filesystem::path> files;
  bool pattern = false;  // "walk/body_%04d.obj"
  double rate = 25;      // 1/s
  double start = 0;      // s, time of the first frame
  std::string where;
};

struct ObstacleEntry {
  std::string name;
  Obstacle obstacle;           // a mesh's shape is null until it is loaded
  std::filesystem::path mesh;  // OBJ, of the shapes "mesh" and "level-set"; of the latter also .vdb
  Placement placement;         // of the mesh and its frames
  FramesEntry frames;          // of a mesh
  double voxel = 0;            // m, of the level set; 0: chosen
  MotionSource source;         // of its motion
  std::optional<RigidBodyEntry> rigid;
  std::string where;
};

struct SimulationOptions {
  double duration = 2;           // s
  double time_step = 0.01;       // s
  double frame_rate = 25;        // 1/s; 0: only the last
  Vec3 gravity = {0, -9.81, 0};  // m/s^2
  std::string integrator = "implicit-euler";
  std::string linear_solver = "mpcg+block-ic0";  // README.md says why
  StepOptions step;
  ContactOptions contact;
  int threads = 0;                 // 0: as many as there are processors
  bool stop_when_settled = false;  // end as soon as nothing has moved for settle_time
  double settle_speed = 1e-3;      // m/s, below which a cloth counts as settled
};

inline constexpr double settle_time = 0.2;  // s

struct Scene {
  std::string label;  // the scene's file as it was given, or the command line of a drop
  SimulationOptions simulation;
  std::vector<ClothEntry> cloths;
  std::vector<SoftEntry> softs;
  std::vector<ObstacleEntry> obstacles;

  // Of a cloth, or after them of a soft body.
  const std::vector<PinEntry>& pins_of(std::size_t k) const {
    return k < cloths.size() ? cloths[k].pins : softs[k - cloths.size()].pins;
  }
};

// Reads and checks the whole scene, with the settings applied first. Throws InputError "scene.toml:12: ...".
Scene read_scene(const std::filesystem::path& path, const std::vector<Setting>& settings);

// The same from data; paths in it are relative to `folder`.
// notes: where to note what is said of the keys.
Scene read_scene(Node root, const std::vector<Setting>& settings, const std::filesystem::path& folder,
                 std::string label, KeyNotes* notes = nullptr);

Names shape_names();
Names model_names();
bool is_vdb(const std::filesystem::path& path);      // by its extension
bool is_pattern(const std::filesystem::path& path);  // by its extension: .svg, .toml

}  // namespace drape
