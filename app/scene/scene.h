// A scene as it was asked for: what is draped, over what, for how long. It is plain data in SI units;
// docs/scene.md lists the keys. No mesh is loaded yet: app/simulation/simulation.h does that.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/base/key_notes.h"
#include "app/base/settings.h"
#include "app/base/words.h"
#include "app/scene/laboratory.h"
#include "constraints/constraints.h"
#include "mesh/pattern/pattern.h"
#include "solver/assembly/cloth.h"
#include "solver/forces/air.h"
#include "solver/forces/fabric.h"
#include "solver/forces/soft.h"
#include "solver/forces/woven.h"
#include "solver/integrators/integrator.h"

namespace drape::app {

// x -> rotation (scale x) + translate.
struct Placement {
  double scale = 1;
  Mat3 rotation = Mat3::Identity();
  Vec3 translate = Vec3::Zero();  // m
};

// How a motion was given, for messages about it.
struct MotionSource {
  std::string kind;             // "keyframes", "poses", "velocity and spin"; empty when there is no motion
  double start = 0;             // s, when the motion begins
  std::filesystem::path poses;  // the CSV file of the poses; else empty
};

struct PinEntry {
  PinRule rule;
  std::string where;             // "scene.toml:21"
  std::string follow;            // name of the obstacle that the pin is fastened to; empty when there is none
  std::optional<Motion> motion;  // the pin's own motion, if it has one
  MotionSource source;
};

// Where a panel of a pattern starts. The middle of its box is moved to the origin. The panel, flat in the
// plane z = 0, is wrapped round the y axis if that is asked for. At last it is placed.
struct PanelEntry {
  std::string group;           // name of the panel's group in the OBJ file
  std::optional<double> wrap;  // m, radius of the cylinder; none: flat
  Placement placement;         // its scale is 1
  std::string where;
};

// Two curves that are sewn together: the vertices of each pair are pulled to each other from where they
// start.
struct SeamEntry {
  Names curves;  // two lines of the OBJ file; empty: every seam that the file declares
  // True when the first vertices of both curves belong together; else the first of one belongs to the last of
  // the other.
  bool same_direction = false;
  double close = 1;                 // s, how long closing takes
  std::optional<double> stiffness;  // N/m, of each stitch; none: the k_s of the cloth
  bool merge = true;  // whether the particles of a pair become one particle once they have closed
  std::string where;
};

struct ClothEntry {
  std::string name;            // of the cloth and of its output files
  std::filesystem::path mesh;  // OBJ file, or a pattern (SVG, TOML)
  TriangulateOptions pattern;  // how a pattern is triangulated
  Placement placement;         // applied to the rest shape and to the start
  bool rest_is_flat = false;   // whether the texture coordinates are the rest shape
  double uv_scale = 1;         // m, length of one unit of the texture coordinates
  std::vector<PanelEntry> panels;
  std::vector<SeamEntry> seams;
  std::string model = "noh-jung";
  std::optional<Vec3> warp;            // direction in the rest shape, of model = "woven"
  std::vector<GroupWarp> group_warps;  // the same of groups of the mesh, instead of that
  bool warp_is_down = false;           // the direction is chosen when the mesh is loaded: down the cloth
  bool clusters = false;               // whether each face is a cluster in place of what stretches
  bool weld = false;                   // vertices at one place become one particle
  std::optional<double> imperfection;  // m, how far the start is off the mesh; unset: by the model
  bool self_contact = false;           // whether the cloth meets itself and others
  SelfContactOptions self;             // how, where it does
  std::optional<double> tear;          // strain above which it tears; unset: never
  std::string fabric_name;             // empty when the scene names none
  Fabric fabric;
  FabricRecord fabric_record;
  bool has_own_damping = false;  // the scene gives damping, and not only the fabric's file
  Names idle_keys;               // what the scene gives and its model does not use
  std::vector<PinEntry> pins;
  std::string where;
};

// A soft body: a lattice of particles and springs that is a box or fills a mesh.
struct SoftEntry {
  std::string name;                          // of the body and of its output files
  std::filesystem::path mesh;                // closed OBJ file, or tetrahedra (.msh); empty for a box
  std::optional<SoftClusters> clusters;      // unset: springs
  std::array<int, 3> particles = {0, 0, 0};  // number along x, y and z, of a box
  Vec3 spacing = Vec3::Zero();               // m; equal along x, y and z where a mesh is filled
  Placement placement;                       // of the mesh and the lattice together
  SoftMaterial material;
  bool self_contact = false;  // whether it meets cloth and other soft bodies
  SelfContactOptions self;    // how, where it does
  std::vector<PinEntry> pins;
  std::string where;
};

// An end of a rope that is fastened to a body.
struct AnchorEntry {
  bool last = false;       // which end
  std::string body;        // name of the obstacle
  std::optional<Vec3> at;  // m, where the end has to be at the start
  std::string where;
};

// An end of a rope that is a vertex of another part.
struct JoinEntry {
  bool last = false;             // which end
  std::string to;                // name of the part
  std::optional<double> within;  // m, how far off the vertex may be; unset: the radius
  std::string where;
};

struct RopeEntry {
  std::string name;               // of the rope and of its output files
  std::vector<Vec3> points;       // m, before they are placed; empty for a line of a file
  std::filesystem::path mesh;     // OBJ file; empty for points
  std::string line;               // of the file; empty: the only one
  std::optional<int> segments;    // into how many of one length it is divided anew
  std::optional<double> spacing;  // m, the same by their length
  Placement placement;
  RopeMaterial material;
  bool has_own_radius = false;  // the scene gives it
  bool self_contact = false;    // whether it meets itself, cloths, soft bodies and other ropes
  RopeContact self;             // how, where it does
  std::vector<AnchorEntry> anchors;
  std::vector<JoinEntry> joins;
  std::vector<PinEntry> pins;
  std::string where;
};

// How two cloths, soft bodies or ropes rub on each other, or one on itself.
struct FrictionEntry {
  std::array<std::string, 2> between;  // names
  double friction = 0;
  std::string where;
};

// A rigid body that moves under the forces on it.
struct RigidBodyEntry {
  double mass = 0;  // kg
  // Moments of inertia [kg m^2] about the axes through the centre of mass. Unset: those of a solid of the
  // shape.
  std::optional<Vec3> inertia;
  Vec3 centre = Vec3::Zero();    // m, the middle of the shape at the start; of mass where it is no solid
  Mat3 axes = Mat3::Identity();  // axes of the shape at the start, as columns
  Vec3 velocity = Vec3::Zero();  // m/s, of the centre of mass at the start
  Vec3 spin = Vec3::Zero();      // rad/s, at the start
};

// The frames of an animated body; app/scene/body_frames.h reads them.
struct FramesEntry {
  // OBJ files in order, one PC2 file, or one pattern; empty when the body does not deform.
  std::vector<std::filesystem::path> files;
  bool pattern = false;  // true when `files` is a pattern such as "walk/body_%04d.obj"
  double rate = 25;      // 1/s
  double start = 0;      // s, time of the first frame
  std::string where;
};

struct ObstacleEntry {
  std::string name;
  Obstacle obstacle;           // the shape of a mesh is null until it is loaded
  std::filesystem::path mesh;  // OBJ file, for the shapes "mesh" and "level-set"; for a level set also .vdb
  Placement placement;         // of the mesh and its frames
  FramesEntry frames;          // of an animated mesh
  double voxel = 0;            // m, of a level set; 0: chosen automatically
  MotionSource source;         // where its motion comes from
  std::optional<RigidBodyEntry> rigid;
  std::string where;
};

constexpr double most_steps = 1e9;        // of a run
constexpr double least_of_a_step = 1e-6;  // a shorter time is no step

struct SimulationOptions {
  double duration = 2;           // s
  double time_step = 0.01;       // s
  double frame_rate = 25;        // 1/s; 0: only the last state is written
  Vec3 gravity = {0, -9.81, 0};  // m/s^2
  std::optional<Air> air;        // unset: there is none
  std::string integrator = "implicit-euler";
  std::string linear_solver = "auto";  // docs/solvers.md compares the solvers
  StepOptions step;
  ContactOptions contact;
  int threads = 0;                 // 0: the number of processors
  bool require_clean = false;      // refuses a start in which triangles pass through each other
  bool stop_when_settled = false;  // ends the run as soon as nothing has moved for settle_time
  double settle_speed = 1e-3;      // m/s; a cloth that is slower counts as settled
  Names idle_keys;                 // what the scene gives and its integrator does not use
};

inline constexpr double settle_time = 0.2;  // s

struct Scene {
  std::string label;              // the scene's file as it was given, or the command line of `drape drop`
  std::vector<Setting> settings;  // what was changed in the scene before it was read
  SimulationOptions simulation;
  std::vector<ClothEntry> cloths;
  std::vector<SoftEntry> softs;
  std::vector<RopeEntry> ropes;
  std::vector<ObstacleEntry> obstacles;
  std::vector<FrictionEntry> frictions;

  // Cloths, then soft bodies, then ropes are the parts of a simulation.
  std::size_t part_count() const { return cloths.size() + softs.size() + ropes.size(); }
  const std::vector<PinEntry>& pins_of(std::size_t part) const {
    if (part < cloths.size()) return cloths[part].pins;
    part -= cloths.size();
    return part < softs.size() ? softs[part].pins : ropes[part - softs.size()].pins;
  }
};

// Reads and checks the whole scene after applying the settings. Throws InputError "scene.toml:12: ...".
Scene read_scene(const std::filesystem::path& path, const std::vector<Setting>& settings);

// The same, with the scene as data. Paths in it are relative to `folder`. notes: receives what is said of
// the keys; may be null.
Scene read_scene(Node root, const std::vector<Setting>& settings, const std::filesystem::path& folder,
                 std::string label, KeyNotes* notes = nullptr);

Names shape_names();
Names model_names();
bool is_vdb(const std::filesystem::path& path);         // by its extension
bool is_tetrahedra(const std::filesystem::path& path);  // by its extension: .msh
bool is_pattern(const std::filesystem::path& path);     // by its extension: .svg, .toml

}  // namespace drape::app
